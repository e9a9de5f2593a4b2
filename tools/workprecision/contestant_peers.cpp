// SPDX-License-Identifier: MIT
#include "tools/workprecision/contestant.hpp"
#include "tools/workprecision/workprecision_outcome.hpp"

#ifdef DELF_HAS_PEERS

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "lattice/error.hpp"
#include "schemes/state.hpp"
#include "schemes/turn.hpp"
#include "tools/peers/body_peers.hpp"
#include "tools/peers/peer.hpp"

namespace delf {

namespace {

using peers::WaveEquation;

// The scene's equation in the peers' words, if it is one of theirs: a single field on a circle.
std::optional<WaveEquation> equation_of(const Scene& scene) {
  const Problem& p = scene.problem;
  if (!p.lattice.is_circle() || p.circle_valued || scene.from_file()) return std::nullopt;
  const auto parameter = [&](const char* key) { return p.parameters.maybe<double>(key).value_or(1); };
  auto equation =
      peers::wave_equation(p.theory, parameter("theory.mass"), parameter("theory.lambda"), p.lattice.length(), 0, 0);
  if (!equation) return equation;
  const auto state = make_state(scene.initial, p.lattice);
  equation->turn = 2 * std::numbers::pi * scene.initial.winding.value_or(state->winding()) + gain_of(p.parameters);
  return equation;
}

double potential(const WaveEquation& e, double phi) {
  switch (e.potential) {
    case WaveEquation::Potential::quadratic:
      return 0.5 * e.mass * e.mass * phi * phi;
    case WaveEquation::Potential::sine_gordon:
      return e.mass * e.mass * (1 - std::cos(phi));
    case WaveEquation::Potential::phi4:
      return 0.25 * e.lambda * (phi * phi - 1) * (phi * phi - 1);
    default:
      return 0;
  }
}

class PeerRacer final : public Racer {
 public:
  PeerRacer(const Scene& scene, const WaveEquation& equation, const peers::PeerInfo& info, const Resolution& r)
      : equation_(equation),
        h_(r.time_step),
        forces_(equation.potential == WaveEquation::Potential::none ? WorkPrecisionRun::unknown
                                                                    : static_cast<double>(info.forces)),
        phi_(static_cast<std::size_t>(r.sites)),
        phi_t_(phi_.size()) {
    equation_.sites = r.sites;
    const Lattice lattice = lattice_of(scene, r.sites);
    const auto state = make_state(scene.initial, lattice);
    state->values(0, lattice, phi_);
    state->velocities(0, lattice, phi_t_);
    first_ = phi_, first_t_ = phi_t_;
    try {
      peer_ = info.make(equation_);
    } catch (const std::invalid_argument& error) {
      throw BadInput("", error.what());
    }
    PeerRacer::restart();
  }
  void restart() override {
    peer_->start(first_, first_t_);
    peer_->advance(h_, 0);  // a processor is no step
    newest_ = 0;
  }
  std::int64_t newest() const override { return newest_; }
  void advance(std::int64_t steps, const RunLimit& limit) override {
    // in one call, unless it takes so long that Ctrl-C would have to wait
    const std::int64_t most = std::max<std::int64_t>(1, 4000000 / equation_.sites);
    while (steps > 0 && !limit.reached()) {
      const std::int64_t now = std::min(steps, most);
      peer_->advance(h_, now);
      newest_ += now, steps -= now;
    }
  }
  void copy(std::span<double> out) const override {
    peer_->copy(out, phi_t_);
    for (const double v : out)
      if (!std::isfinite(v)) throw NotFinite("the field is no longer finite");
  }
  double forces() const override { return forces_; }
  // k Σ ½φ_t² + ½φ_x² + V, with φ_x by central differences of order eight
  double energy() const override {
    peer_->copy(phi_, phi_t_);
    constexpr double weights[] = {4. / 5, -1. / 5, 4. / 105, -1. / 280};
    const int N = equation_.sites;
    const double k = equation_.length / N;
    const auto phi = [&](int i) {
      const int home = ((i % N) + N) % N;
      return phi_[static_cast<std::size_t>(home)] + equation_.turn * ((i - home) / N);
    };
    double sum = 0;
    for (int i = 0; i < N; ++i) {
      double slope = 0;
      for (int m = 1; m <= 4; ++m) slope += weights[m - 1] * (phi(i + m) - phi(i - m)) / k;
      const double phi_t = phi_t_[static_cast<std::size_t>(i)];
      sum += 0.5 * (phi_t * phi_t + slope * slope) + potential(equation_, phi(i));
    }
    return k * sum;
  }

 private:
  WaveEquation equation_;
  double h_, forces_;
  mutable std::vector<double> phi_, phi_t_;
  std::vector<double> first_, first_t_;
  std::unique_ptr<peers::Peer> peer_;
  std::int64_t newest_ = 0;
};

class BodyRacer final : public Racer {
 public:
  BodyRacer(const Scene& scene, peers::BodyPeerInfo info, const Resolution& r)
      : info_(std::move(info)), mass_(mass_of(scene)), h_(r.time_step), peer_(info_.make(mass_)) {
    const auto state = make_state(scene.initial, scene.problem.lattice);
    for (std::vector<double>* row : {&q_, &q_t_, &first_, &first_t_})
      row->resize(static_cast<std::size_t>(state->components()));
    state->values(0, scene.problem.lattice, first_);
    state->velocities(0, scene.problem.lattice, first_t_);
    BodyRacer::restart();
  }
  static double mass_of(const Scene& scene) {
    return scene.problem.parameters.maybe<double>("theory.mass").value_or(1);
  }
  void restart() override {
    peer_->start(first_, first_t_);
    newest_ = 0;
  }
  std::int64_t newest() const override { return newest_; }
  void advance(std::int64_t steps, const RunLimit& limit) override {
    constexpr std::int64_t between_interrupts = 1 << 20;
    while (steps > 0 && !limit.reached()) {
      const std::int64_t now = std::min(steps, between_interrupts);
      peer_->advance(h_, now);
      newest_ += now, steps -= now;
    }
  }
  void copy(std::span<double> out) const override {
    peer_->copy(out, q_t_);
    for (const double q : out)
      if (!std::isfinite(q)) throw NotFinite("the body is no longer at a finite place");
  }
  double forces() const override { return static_cast<double>(info_.forces); }
  double energy() const override {
    peer_->copy(q_, q_t_);
    return info_.energy(mass_, q_, q_t_);
  }

 private:
  peers::BodyPeerInfo info_;
  double mass_, h_;
  std::unique_ptr<peers::Peer> peer_;
  mutable std::vector<double> q_, q_t_;
  std::vector<double> first_, first_t_;
  std::int64_t newest_ = 0;
};

std::vector<Contestant> body_contestants(const Scene& scene) {
  std::vector<Contestant> all;
  if (scene.from_file()) return all;
  for (const peers::BodyPeerInfo& info : peers::body_peers(scene.problem.theory))
    all.push_back({.name = info.name, .peer = true, .start = [&scene, info](const Resolution& r) {
                     return std::unique_ptr<Racer>(new BodyRacer(scene, info, r));
                   }});
  return all;
}

}  // namespace

std::vector<Contestant> peer_contestants(const Scene& scene) {
  if (scene.problem.lattice.space() == Space::point) return body_contestants(scene);
  std::vector<Contestant> all;
  const auto equation = equation_of(scene);
  if (!equation) return all;
  for (const peers::PeerInfo& info : peers::peers())
    all.push_back({info.name, true, info.processed, false, 1, 0, false,
                   [&scene, &info, equation = *equation](const Resolution& r) {
                     return std::unique_ptr<Racer>(new PeerRacer(scene, equation, info, r));
                   }});
  return all;
}

}  // namespace delf

#else

namespace delf {

std::vector<Contestant> peer_contestants(const Scene&) { return {}; }

}  // namespace delf

#endif

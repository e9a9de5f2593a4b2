// SPDX-License-Identifier: MIT
#include "tools/workprecision/entry.hpp"
#include "tools/workprecision/workprecision_outcome.hpp"

#ifdef DELF_HAS_PEERS

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "lattice/error.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/state.hpp"
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
  equation->monodromy = 2 * std::numbers::pi * scene.initial.winding.value_or(state->winding()) + gain_of(p.parameters);
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

/// A program of the peers, from the first values and rates of a scene on.
class PeerEntry : public StartedEntry {
 public:
  std::int64_t newest() const override { return newest_; }
  void advance(std::int64_t steps, const RunLimit& limit) override {
    // in one call, unless it takes so long that Ctrl-C would have to wait
    while (steps > 0 && !limit.reached()) {
      const std::int64_t now = std::min(steps, most_in_a_call_);
      peer_->advance(h_, now);
      newest_ += now, steps -= now;
    }
  }
  void copy(std::span<double> out) const override {
    peer_->copy(out, phi_t_);
    for (const double v : out)
      if (!std::isfinite(v)) throw NotFinite("the field is no longer finite");
  }

 protected:
  PeerEntry(const Scene& scene, const Lattice& lattice, double h, std::int64_t most_in_a_call)
      : h_(h), most_in_a_call_(most_in_a_call) {
    const auto state = make_state(scene.initial, lattice);
    for (std::vector<double>* row : {&phi_, &phi_t_}) row->resize(lattice.sites() * state->components());
    state->values(0, lattice, phi_);
    state->velocities(0, lattice, phi_t_);
  }
  void start(std::unique_ptr<peers::Peer> peer) {
    peer_ = std::move(peer);
    peer_->start(phi_, phi_t_);
    peer_->advance(h_, 0);  // a processor is no step
  }
  /// Values and rates of the newest row, phi_ and phi_t_.
  void fetch() const { peer_->copy(phi_, phi_t_); }

  mutable std::vector<double> phi_, phi_t_;

 private:
  double h_;
  std::int64_t most_in_a_call_, newest_ = 0;
  std::unique_ptr<peers::Peer> peer_;
};

class FieldEntry final : public PeerEntry {
 public:
  FieldEntry(const Scene& scene, const WaveEquation& equation, const peers::PeerInfo& info, const Resolution& r)
      : PeerEntry(scene, lattice_of(scene, r.sites), r.time_step, std::max<std::int64_t>(1, 4000000 / r.sites)),
        equation_(equation),
        forces_(equation.potential == WaveEquation::Potential::none ? WorkPrecisionRun::unknown
                                                                    : static_cast<double>(info.forces)) {
    equation_.sites = r.sites;
    try {
      start(info.make(equation_));
    } catch (const std::invalid_argument& error) {
      throw BadInput("", error.what());
    }
  }
  double forces() const override { return forces_; }
  // k Σ ½φ_t² + ½φ_x² + V, with φ_x by central differences of order eight
  double energy() const override {
    fetch();
    constexpr double weights[] = {4. / 5, -1. / 5, 4. / 105, -1. / 280};
    const int N = equation_.sites;
    const double k = equation_.length / N;
    const auto phi = [&](int i) {
      const int home = ((i % N) + N) % N;
      return phi_[home] + equation_.monodromy * ((i - home) / N);
    };
    double sum = 0;
    for (int i = 0; i < N; ++i) {
      double slope = 0;
      for (int m = 1; m <= 4; ++m) slope += weights[m - 1] * (phi(i + m) - phi(i - m)) / k;
      const double phi_t = phi_t_[i];
      sum += 0.5 * (phi_t * phi_t + slope * slope) + potential(equation_, phi(i));
    }
    return k * sum;
  }

 private:
  WaveEquation equation_;
  double forces_;
};

class BodyEntry final : public PeerEntry {
 public:
  BodyEntry(const Scene& scene, peers::BodyPeerInfo info, const Resolution& r)
      : PeerEntry(scene, scene.problem.lattice, r.time_step, 1 << 20),
        info_(std::move(info)),
        mass_(scene.problem.parameters.maybe<double>("theory.mass").value_or(1)) {
    start(info_.make(mass_));
  }
  double forces() const override { return static_cast<double>(info_.forces); }
  double energy() const override {
    fetch();
    return info_.energy(mass_, phi_, phi_t_);
  }

 private:
  peers::BodyPeerInfo info_;
  double mass_;
};

std::vector<WorkPrecisionEntry> body_entries(const Scene& scene) {
  std::vector<WorkPrecisionEntry> all;
  if (scene.from_file()) return all;
  for (const peers::BodyPeerInfo& info : peers::body_peers(scene.problem.theory))
    all.push_back({.name = info.name, .peer = true, .start = [&scene, info](const Resolution& r) {
                     return std::unique_ptr<StartedEntry>(new BodyEntry(scene, info, r));
                   }});
  return all;
}

}  // namespace

std::vector<WorkPrecisionEntry> peer_entries(const Scene& scene) {
  if (scene.problem.lattice.space() == Space::point) return body_entries(scene);
  std::vector<WorkPrecisionEntry> all;
  const auto equation = equation_of(scene);
  if (!equation) return all;
  for (const peers::PeerInfo& info : peers::peers())
    all.push_back({info.name, true, info.processed, false, 1, 0, false,
                   [&scene, &info, equation = *equation](const Resolution& r) {
                     return std::unique_ptr<StartedEntry>(new FieldEntry(scene, equation, info, r));
                   }});
  return all;
}

}  // namespace delf

#else

namespace delf {

std::vector<WorkPrecisionEntry> peer_entries(const Scene&) { return {}; }

}  // namespace delf

#endif

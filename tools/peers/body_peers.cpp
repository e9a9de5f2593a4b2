// SPDX-License-Identifier: MIT
#include "tools/peers/body_peers.hpp"

#include <algorithm>
#include <array>
#include <boost/numeric/odeint/algebra/array_algebra.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <boost/numeric/odeint/stepper/symplectic_rkn_sb3a_mclachlan.hpp>
#include <boost/numeric/odeint/stepper/velocity_verlet.hpp>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

namespace delf::peers {
namespace {

namespace odeint = boost::numeric::odeint;

template <std::size_t d>
using Vector = std::array<double, d>;

/// q_tt = −m² sin q
struct PendulumBody {
  static constexpr std::size_t d = 1;
  double mass;
  void operator()(const Vector<d>& q, Vector<d>& a) const { a[0] = -mass * mass * std::sin(q[0]); }
  double potential(std::span<const double> q) const { return mass * mass * (1 - std::cos(q[0])); }
};

/// q_tt = −q/|q|³
struct KeplerBody {
  static constexpr std::size_t d = 2;
  explicit KeplerBody(double /*mass*/) {}
  void operator()(const Vector<d>& q, Vector<d>& a) const {
    const double square = q[0] * q[0] + q[1] * q[1], cube = square * std::sqrt(square);
    a[0] = -q[0] / cube, a[1] = -q[1] / cube;
  }
  double potential(std::span<const double> q) const { return -1 / std::hypot(q[0], q[1]); }
};

template <class Body>
class BodyPeer : public Peer {
 public:
  explicit BodyPeer(double mass) : body_(mass) {}
  void start(std::span<const double> q, std::span<const double> q_t) override {
    if (q.size() != Body::d || q_t.size() != Body::d) throw std::invalid_argument("a body of other coordinates");
    std::ranges::copy(q, q_.begin()), std::ranges::copy(q_t, q_t_.begin());
  }
  void copy(std::span<double> q, std::span<double> q_t) const override {
    std::ranges::copy(q_, q.begin()), std::ranges::copy(q_t_, q_t.begin());
  }

 protected:
  Body body_;
  Vector<Body::d> q_{}, q_t_{};
};

template <class Body>
class BodyVerlet final : public BodyPeer<Body> {
 public:
  static constexpr const char* name = "velocity Verlet 2";
  static constexpr const char* source = "verlet-1967";
  static constexpr int order = 2;
  static constexpr std::size_t forces = 1;
  using BodyPeer<Body>::BodyPeer;
  void start(std::span<const double> q, std::span<const double> q_t) override {
    BodyPeer<Body>::start(q, q_t);
    Vector<Body::d> a;
    this->body_(this->q_, a);
    stepper_.initialize(a);
  }
  void advance(double h, std::int64_t steps) override {
    const auto system = [this](const auto& q, const auto&, auto& a, double) { this->body_(q, a); };
    auto state = std::make_pair(std::ref(this->q_), std::ref(this->q_t_));
    for (std::int64_t n = 0; n < steps; ++n) stepper_.do_step(system, state, 0.0, h);
  }

 private:
  odeint::velocity_verlet<Vector<Body::d>> stepper_;
};

template <class Body>
class BodyMcLachlan final : public BodyPeer<Body> {
 public:
  static constexpr const char* name = "rkn-mclachlan 4";
  static constexpr const char* source = "mclachlan-1995";
  static constexpr int order = 4;
  static constexpr std::size_t forces = 5;
  using BodyPeer<Body>::BodyPeer;
  // The last of the six forces of a step is multiplied by zero: it is not computed.
  void advance(double h, std::int64_t steps) override {
    int force = 0;
    const auto system = [this, &force](const auto& q, auto& a) {
      if (++force == 6) force = 0;
      else this->body_(q, a);
    };
    for (std::int64_t n = 0; n < steps; ++n) stepper_.do_step(std::ref(system), this->q_, this->q_t_, 0.0, h);
  }

 private:
  odeint::symplectic_rkn_sb3a_mclachlan<Vector<Body::d>> stepper_;
};

template <class Body>
class BodyFehlberg final : public BodyPeer<Body> {
  static constexpr std::size_t d = Body::d;
  using State = Vector<2 * d>;

 public:
  static constexpr const char* name = "fehlberg 8";
  static constexpr const char* source = "fehlberg-1968";
  static constexpr int order = 8;
  static constexpr std::size_t forces = 13;
  using BodyPeer<Body>::BodyPeer;
  void advance(double h, std::int64_t steps) override {
    State y;
    std::ranges::copy(this->q_, y.begin()), std::ranges::copy(this->q_t_, y.begin() + d);
    const auto system = [this](const State& state, State& rate, double) {
      Vector<d> q, a;
      std::copy_n(state.begin(), d, q.begin());
      this->body_(q, a);
      std::copy_n(state.begin() + d, d, rate.begin()), std::ranges::copy(a, rate.begin() + d);
    };
    for (std::int64_t n = 0; n < steps; ++n) stepper_.do_step(std::ref(system), y, 0.0, h);
    std::copy_n(y.begin(), d, this->q_.begin()), std::copy_n(y.begin() + d, d, this->q_t_.begin());
  }

 private:
  odeint::runge_kutta_fehlberg78<State> stepper_;
};

template <template <class> class Method, class Body>
BodyPeerInfo info() {
  return {std::string("odeint ") + Method<Body>::name,
          Method<Body>::order,
          Method<Body>::forces,
          [](double mass) -> std::unique_ptr<Peer> { return std::make_unique<Method<Body>>(mass); },
          [](double mass, std::span<const double> q, std::span<const double> q_t) {
            double kinetic = 0;
            for (const double v : q_t) kinetic += 0.5 * v * v;
            return kinetic + Body(mass).potential(q);
          },
          {Method<Body>::source, "ahnert-mulansky-2011"}};
}

template <class Body>
std::vector<BodyPeerInfo> all_of() {
  return {info<BodyVerlet, Body>(), info<BodyMcLachlan, Body>(), info<BodyFehlberg, Body>()};
}

}  // namespace

std::vector<BodyPeerInfo> body_peers(std::string_view theory) {
  static const std::pair<std::string_view, std::vector<BodyPeerInfo>> known[] = {{"pendulum", all_of<PendulumBody>()},
                                                                                 {"kepler", all_of<KeplerBody>()}};
  for (const auto& [name, all] : known)
    if (theory == name) return all;
  return {};
}

}  // namespace delf::peers

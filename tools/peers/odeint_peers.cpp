// SPDX-License-Identifier: MIT
#include "tools/peers/odeint_peers.hpp"

#include <algorithm>
#include <boost/numeric/odeint/stepper/base/symplectic_rkn_stepper_base.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <boost/numeric/odeint/stepper/symplectic_rkn_sb3a_mclachlan.hpp>
#include <boost/numeric/odeint/stepper/velocity_verlet.hpp>
#include <cmath>
#include <functional>
#include <utility>

#include "jets/tables/splitting.hpp"
#include "tools/peers/flush_to_zero.hpp"
#include "tools/peers/method_of_lines.hpp"
#include "tools/peers/odeint_algebra.hpp"

namespace delf::peers {
namespace {

namespace odeint = boost::numeric::odeint;

// odeint hands states over as const; the copies of neighbours beside them, which acceleration() makes, are no part of
// a state, and no state here was defined const.
double* writable(const Row& row) { return const_cast<double*>(row.data()); }

/// φ and φ_t as two rows.
template <class Lines>
class TwoRows : public Peer {
 public:
  explicit TwoRows(const WaveEquation& equation)
      : lines_(equation), monodromy_(equation.monodromy), phi_(lines_.circle.size()), phi_t_(lines_.circle.size()) {}

  void start(std::span<const double> phi, std::span<const double> phi_t) override {
    lines_.circle.scatter(phi, phi_.data(), monodromy_);
    lines_.circle.scatter(phi_t, phi_t_.data(), 0);
  }
  void copy(std::span<double> phi, std::span<double> phi_t) const override {
    lines_.circle.gather(phi_.data(), phi);
    lines_.circle.gather(phi_t_.data(), phi_t);
  }

 protected:
  Lines lines_;
  double monodromy_;
  Row phi_, phi_t_;
};

template <class Lines>
class VelocityVerlet final : public TwoRows<Lines> {
 public:
  static constexpr const char* name = "velocity Verlet 2";
  static constexpr const char* source = "verlet-1967";
  static constexpr int order = 2;
  static constexpr double stable = 2;  ///< h times the highest frequency
  static constexpr std::size_t forces = 1;

  explicit VelocityVerlet(const WaveEquation& equation) : TwoRows<Lines>(equation), acceleration_(this->phi_.size()) {
    stepper_.adjust_size(this->phi_);
  }
  void start(std::span<const double> phi, std::span<const double> phi_t) override {
    TwoRows<Lines>::start(phi, phi_t);
    this->lines_.acceleration(this->phi_.data(), acceleration_.data());
    stepper_.initialize(acceleration_);
  }
  void advance(double h, std::int64_t steps) override {
    const FlushToZero guard;
    const auto system = [this](const Row& q, const Row&, Row& a, double) {
      this->lines_.acceleration(writable(q), a.data());
    };
    auto state = std::make_pair(std::ref(this->phi_), std::ref(this->phi_t_));
    for (std::int64_t n = 0; n < steps; ++n) stepper_.do_step(system, state, 0.0, h);
  }

 private:
  odeint::velocity_verlet<Row, Row, double, Row, double, double, PackAlgebra, odeint::default_operations> stepper_;
  Row acceleration_;
};

template <class Lines>
class McLachlan final : public TwoRows<Lines> {
 public:
  static constexpr const char* name = "rkn-mclachlan 4";
  static constexpr const char* source = "mclachlan-1995";
  static constexpr int order = 4;
  static constexpr double stable = 2.92;
  static constexpr std::size_t forces = 5;

  explicit McLachlan(const WaveEquation& equation) : TwoRows<Lines>(equation) { stepper_.adjust_size(this->phi_); }

  // The last of the six forces of a step is multiplied by zero: it is not computed.
  void advance(double h, std::int64_t steps) override {
    const FlushToZero guard;
    int force = 0;
    const auto system = [this, &force](const Row& q, Row& a) {
      if (++force == 6) force = 0;
      else this->lines_.acceleration(writable(q), a.data());
    };
    for (std::int64_t n = 0; n < steps; ++n) stepper_.do_step(std::ref(system), this->phi_, this->phi_t_, 0.0, h);
  }

 private:
  odeint::symplectic_rkn_sb3a_mclachlan<Row, Row, double, Row, Row, double, PackAlgebra, odeint::default_operations>
      stepper_;
};

/// Blanes and Moan's symmetric Nyström methods, kicks first, by odeint's stepper for coefficients of one's own. Kicks where two
/// steps meet are one: a call begins with a kick before its first step, and takes the half that is too much back at its end.
template <class Lines, int order_in_time, std::size_t stages>
class BlanesMoan : public TwoRows<Lines> {
 public:
  static constexpr int order = order_in_time;
  static constexpr std::size_t forces = stages;

  explicit BlanesMoan(const WaveEquation& equation)
      : TwoRows<Lines>(equation),
        end_(splitting_of_order(order).kicks.front()),
        stepper_(drifts(), kicks()),
        first_(this->phi_.size()),
        newest_(&first_) {
    stepper_.adjust_size(this->phi_);
  }
  void start(std::span<const double> phi, std::span<const double> phi_t) override {
    TwoRows<Lines>::start(phi, phi_t);
    this->lines_.acceleration(this->phi_.data(), first_.data());
    newest_ = &first_;
  }
  void advance(double h, std::int64_t steps) override {
    if (steps <= 0) return;
    const FlushToZero guard;
    const auto system = [this](const Row& q, Row& a) {
      this->lines_.acceleration(writable(q), a.data());
      newest_ = &a;  // the stepper keeps one row for all of them
    };
    kick(end_ * h);
    for (std::int64_t n = 0; n < steps; ++n) stepper_.do_step(std::ref(system), this->phi_, this->phi_t_, 0.0, h);
    kick(-end_ * h);
  }

 private:
  using Stepper =
      odeint::symplectic_nystroem_stepper_base<stages, order_in_time, Row, Row, double, Row, Row, double, PackAlgebra,
                                               odeint::default_operations, odeint::initially_resizer>;
  static typename Stepper::coef_type drifts() {
    typename Stepper::coef_type a;
    std::ranges::copy(splitting_of_order(order).drifts, a.begin());
    return a;
  }
  static typename Stepper::coef_type kicks() {
    const std::vector<double> all = splitting_of_order(order).kicks;
    typename Stepper::coef_type b;
    std::copy(all.begin() + 1, all.end(), b.begin());
    b[stages - 1] += all.front();
    return b;
  }
  void kick(double c) {
    PackAlgebra::for_each3(this->phi_t_, this->phi_t_, *newest_,
                           odeint::default_operations::scale_sum2<double>(1.0, c));
  }

  double end_;
  Stepper stepper_;
  Row first_;
  const Row* newest_;  ///< the force at φ
};
// Beyond these h times the highest frequency grows at once; there are weak resonances near π before.
template <class Lines>
struct BlanesMoan4 final : BlanesMoan<Lines, 4, 6> {
  static constexpr const char* name = "srkn-6b 4";
  static constexpr const char* source = "blanes-moan-2002";
  static constexpr double stable = 5.026;
  using BlanesMoan<Lines, 4, 6>::BlanesMoan;
};
template <class Lines>
struct BlanesMoan6 final : BlanesMoan<Lines, 6, 11> {
  static constexpr const char* name = "srkn-11b 6";
  static constexpr const char* source = "blanes-moan-2002";
  static constexpr double stable = 9.073;
  using BlanesMoan<Lines, 6, 11>::BlanesMoan;
};

/// The state is φ, then φ_t.
template <class Lines>
class Fehlberg final : public Peer {
 public:
  static constexpr const char* name = "fehlberg 8";
  static constexpr const char* source = "fehlberg-1968";
  static constexpr int order = 8;
  static constexpr double stable = 2.36;
  static constexpr std::size_t forces = 13;

  explicit Fehlberg(const WaveEquation& equation)
      : lines_(equation), monodromy_(equation.monodromy), state_(2 * lines_.circle.size()) {
    stepper_.adjust_size(state_);
  }
  void start(std::span<const double> phi, std::span<const double> phi_t) override {
    lines_.circle.scatter(phi, state_.data(), monodromy_);
    lines_.circle.scatter(phi_t, state_.data() + lines_.circle.size(), 0);
  }
  void advance(double h, std::int64_t steps) override {
    const FlushToZero guard;
    const auto system = [this](const Row& y, Row& y_t, double) {
      const auto half = static_cast<std::ptrdiff_t>(lines_.circle.size());
      std::copy(y.begin() + half, y.end(), y_t.begin());
      lines_.acceleration(writable(y), y_t.data() + half);
    };
    for (std::int64_t n = 0; n < steps; ++n) stepper_.do_step(std::ref(system), state_, 0.0, h);
  }
  void copy(std::span<double> phi, std::span<double> phi_t) const override {
    lines_.circle.gather(state_.data(), phi);
    lines_.circle.gather(state_.data() + lines_.circle.size(), phi_t);
  }

 private:
  Lines lines_;
  double monodromy_;
  Row state_;
  odeint::runge_kutta_fehlberg78<Row, double, Row, double, PackAlgebra, odeint::default_operations> stepper_;
};

template <template <class> class Method, int p>
PeerInfo info() {
  using Any = Method<MethodOfLines<p, NoForce>>;
  return {std::string("odeint ") + Any::name + ", differences " + std::to_string(2 * p),
          Any::order,
          2 * p,
          Any::stable / std::sqrt(highest_square<p>()),
          Any::forces,
          [](const WaveEquation& equation) {
            equation.check(2 * p + 1);
            return with_force(equation, [&]<class Force>(Force) -> std::unique_ptr<Peer> {
              return std::make_unique<Method<MethodOfLines<p, Force>>>(equation);
            });
          },
          false,
          {Any::source, "ahnert-mulansky-2011"}};
}

}  // namespace

std::vector<PeerInfo> odeint_peers() {
  return {info<VelocityVerlet, 1>(), info<VelocityVerlet, 2>(), info<VelocityVerlet, 3>(), info<VelocityVerlet, 4>(),
          info<McLachlan, 1>(),      info<McLachlan, 2>(),      info<McLachlan, 3>(),      info<McLachlan, 4>(),
          info<BlanesMoan4, 2>(),    info<BlanesMoan4, 4>(),    info<BlanesMoan4, 6>(),    info<McLachlan, 6>(),
          info<BlanesMoan6, 3>(),    info<BlanesMoan6, 4>(),    info<BlanesMoan6, 6>(),    info<Fehlberg, 1>(),
          info<Fehlberg, 2>(),       info<Fehlberg, 3>(),       info<Fehlberg, 4>()};
}

}  // namespace delf::peers

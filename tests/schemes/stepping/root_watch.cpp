// SPDX-License-Identifier: MIT
#include "schemes/stepping/root_watch.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

using Numbers = Eigen::VectorXd;
using Lagrangian = std::function<double(const Numbers& q, const Numbers& v)>;

/// A body with the implicit midpoint rule, L_d = h L(½(q₀ + q₁), (q₁ − q₀)/h), by hand.
class MidpointBody {
 public:
  MidpointBody(Lagrangian L, double h, Numbers q, const Numbers& v)
      : L_(std::move(L)), h_(h), q_(std::move(q)), p_(by_rate(q_, v)) {}

  /// The velocity (q₁ − q₀)/h that a small step leads to: p₀ + ½sh ∂_qL − ∂_vL = 0, followed from s = 0 to 1. Nothing where
  /// the path turns back.
  std::optional<Numbers> continued() const {
    Numbers v = Numbers::Zero(q_.size());
    constexpr int strides = 400;
    double sign = 0;
    for (int n = 0; n <= strides; ++n) {
      const double s = static_cast<double>(n) / strides;
      double change = 1;
      for (int it = 0; it < 20 && change > 1e-9 * (1 + v.norm()); ++it) {
        Eigen::MatrixXd J(v.size(), v.size());
        constexpr double little = 1e-4;
        for (Eigen::Index a = 0; a < v.size(); ++a) {
          const Numbers by = little * Numbers::Unit(v.size(), a);
          J.col(a) = (gap(v + by, s) - gap(v - by, s)) / (2 * little);
        }
        const double determinant = J.determinant();
        if (sign == 0) sign = determinant;
        if (!(sign * determinant > 0)) return std::nullopt;
        const Numbers by = J.fullPivLu().solve(gap(v, s));
        change = by.norm();
        if (n > 0 && change > 0.3 * (1 + v.norm())) return std::nullopt;  // no path, but a leap
        v -= by;
      }
      if (!(change < 1e-6 * (1 + v.norm()))) return std::nullopt;
    }
    return q_ + h_ * v;
  }
  /// Goes on to q₁, with p₁ = ½h ∂_qL + ∂_vL.
  void move_to(const Numbers& q) {
    const Numbers middle = (q_ + q) / 2, v = (q - q_) / h_;
    p_ = h_ / 2 * by_place(middle, v) + by_rate(middle, v);
    q_ = q;
  }

 private:
  Numbers gap(const Numbers& v, double s) const {
    const Numbers middle = q_ + s * h_ / 2 * v;
    return p_ + s * h_ / 2 * by_place(middle, v) - by_rate(middle, v);
  }
  static Numbers slopes(const std::function<double(const Numbers&)>& f, const Numbers& at) {
    constexpr double little = 1e-4;
    Numbers all(at.size());
    for (Eigen::Index a = 0; a < at.size(); ++a) {
      const Numbers by = little * Numbers::Unit(at.size(), a);
      all[a] = (8 * (f(at + by) - f(at - by)) - (f(at + 2 * by) - f(at - 2 * by))) / (12 * little);
    }
    return all;
  }
  Numbers by_place(const Numbers& q, const Numbers& v) const {
    return slopes([&](const Numbers& at) { return L_(at, v); }, q);
  }
  Numbers by_rate(const Numbers& q, const Numbers& v) const {
    return slopes([&](const Numbers& at) { return L_(q, at); }, v);
  }

  Lagrangian L_;
  double h_;
  Numbers q_, p_;
};

Problem on_a_point(const std::string& theory, const std::string& method, double h) {
  Problem p;
  p.theory = theory, p.method = method, p.lattice = Lattice::point(), p.time_step = h;
  return p;
}
Problem elements(const std::string& theory, const std::string& tableau, double h,
                 const std::string& continuity = "shared") {
  Problem p = on_a_point(theory, "cgvi", h);
  p.parameters["scheme.tableau"] = tableau, p.parameters["scheme.continuity"] = continuity;
  return p;
}
/// At every node of the first step the value of the vertex.
void start(Simulation& simulation, const Numbers& q, const Numbers& v) {
  Row row, rate;
  for (const Component& c : simulation.components()) {
    const bool has_value = c.role != Role::multiplier;
    row.push_back(has_value ? q[c.field] : 0);
    rate.push_back(has_value ? v[c.field] : 0);
  }
  simulation.start_legendre(row, rate);
}
Numbers newest(const Simulation& simulation) {
  Row row(delf::at(simulation.count(Role::field)));
  simulation.copy_row(0, row);
  return Eigen::Map<const Numbers>(row.data(), static_cast<Eigen::Index>(row.size()));
}

struct Count {
  int solved = 0, refused = 0, other_root = 0, no_path = 0;
};
struct Motion {
  std::string theory;
  double h;
  Lagrangian L;
  Numbers q, v;
  int steps = 30;
  std::string continuity = "shared";
};
/// Steps of a body, each held against the root that a small step leads to.
void add(Count& count, const Motion& motion) {
  MidpointBody by_hand(motion.L, motion.h, motion.q, motion.v);
  Simulation simulation(elements(motion.theory, "midpoint", motion.h, motion.continuity));
  for (int n = 0; n < motion.steps; ++n) {
    const auto right = by_hand.continued();
    try {
      if (n == 0) start(simulation, motion.q, motion.v);
      else simulation.step();
    } catch (const NumericalFailure&) {
      ++count.refused;
      return;
    }
    const Numbers q = newest(simulation);
    if (!right) {
      ++count.no_path;
      return;
    }
    if ((q - *right).norm() > 1e-5 * (1 + q.norm())) {
      ++count.other_root;
      return;
    }
    ++count.solved;
    by_hand.move_to(q);
  }
}
Numbers numbers(std::initializer_list<double> values) {
  Numbers all(static_cast<Eigen::Index>(values.size()));
  std::ranges::copy(values, all.begin());
  return all;
}

double pendulum(const Numbers& q, const Numbers& v) { return 0.5 * v[0] * v[0] + std::cos(q[0]); }
double double_pendulum(const Numbers& q, const Numbers& v) {
  return v[0] * v[0] + 0.5 * v[1] * v[1] + v[0] * v[1] * std::cos(q[0] - q[1]) + 2 * std::cos(q[0]) + std::cos(q[1]);
}
double kepler(const Numbers& q, const Numbers& v) { return 0.5 * v.squaredNorm() + 1 / q.norm(); }

}  // namespace

TEST_CASE("a step that is too long goes to the root that a small step leads to, or is reported") {
  Random random(82);
  const auto check = [](const char* what, double h, const Count& count, int least) {
    CAPTURE(what, h, count.solved, count.refused);
    CHECK(count.other_root == 0);
    CHECK(count.no_path == 0);
    CHECK(count.solved >= least);
  };
  for (const double h : {2.5, 3.0, 4.0}) {  // near the top: steps begin beyond the fold of the straight way there
    Count count;
    for (int n = 0; n < 4; ++n)
      add(count, {"pendulum", h, pendulum, numbers({random(2.6, 3.0)}), numbers({random(-0.5, 0.5)}), 1});
    check("pendulum", h, count, 1);
  }
  Count count;
  for (int n = 0; n < 4; ++n)
    add(count, {"double-pendulum", 0.2, double_pendulum, numbers({random(-3, 3), random(-3, 3)}),
                numbers({random(-1, 1), random(-1, 1)}), 10});
  check("double pendulum", 0.2, count, 20);
  Count orbit;
  for (const double speed : {0.99, 1.0, 1.01})  // of e = 0.9 at its far end
    add(orbit, {"kepler", 0.1, kepler, numbers({1.9, 0}), numbers({0, speed * std::sqrt(0.1 / 1.9)}), 40});
  check("Kepler", 0.1, orbit, 30);
}

namespace {

/// Predators and prey from (1, 1) by discontinuous elements of one function, whose traces alternate about the orbit.
std::vector<Numbers> predators_and_prey(double h, double until) {
  Problem p = on_a_point("lotka-volterra", "dgvi", h);
  p.parameters["theory.gauge"] = std::string("full"), p.parameters["scheme.functions"] = 1;
  p.parameters["scheme.basis"] = std::string("lagrange-gauss"),
  p.parameters["scheme.quadrature"] = std::string("gauss");
  p.parameters["scheme.points"] = 1, p.parameters["scheme.flux"] = std::string("gauss2");
  Simulation simulation(p);
  Row row;
  for (const Component& c : simulation.components()) row.push_back(c.role == Role::multiplier ? 0 : 1);
  simulation.start({row});
  std::vector<Numbers> orbit{newest(simulation)};
  while (static_cast<double>(simulation.newest()) * h < until - 1e-9) {
    simulation.step();
    CHECK(simulation.residual() < 1e-12);
    orbit.push_back(newest(simulation));
  }
  return orbit;
}
/// The largest distance from an orbit with steps `finer` times as short.
double distance(const std::vector<Numbers>& orbit, const std::vector<Numbers>& reference, std::size_t finer) {
  double most = 0;
  for (std::size_t n = 0; n < orbit.size(); ++n) most = std::max(most, (orbit[n] - reference[finer * n]).norm());
  return most;
}

}  // namespace

TEST_CASE("the first step is watched where multipliers join the steps, though the start has solved for it") {
  Random random(83);
  Count all;
  for (const double h : {1.5, 2.0, 2.5, 3.0, 4.0}) {
    Count count;
    for (int n = 0; n < 12; ++n)
      add(count,
          {"pendulum", h, pendulum, numbers({random(2.4, 3.0)}), numbers({random(-0.5, 0.5)}), 1, "multipliers"});
    CAPTURE(h, count.solved, count.refused);
    CHECK(count.other_root == 0);
    CHECK(count.no_path == 0);
    all.solved += count.solved, all.refused += count.refused;
  }
  CHECK(all.solved >= 12);
  CHECK(all.refused >= 12);
}

TEST_CASE("discontinuous elements whose traces alternate stay on the orbit that shorter steps have") {
  // From step 13 on h = 1/16 went on from another root, with q1 = 0.11 in place of 0.50.
  const double until = 6;
  const auto reference = predators_and_prey(1. / 256, until);
  const double eighth = distance(predators_and_prey(1. / 8, until), reference, 32),
               sixteenth = distance(predators_and_prey(1. / 16, until), reference, 16),
               next = distance(predators_and_prey(1. / 32, until), reference, 8);
  CHECK(next < 0.01);
  CHECK(sixteenth / next == Approx(4).margin(0.8));
  CHECK(eighth / sixteenth == Approx(4).margin(0.8));
}

TEST_CASE("a body on a hyperbola stays on its branch") {
  // L = ½(u_t² + v_t²) − ½v² on u² − v² = 1 from rest at (√2, −1): with h = 2 the row after is (√2, 1) by its own branch, and
  // (−√2, −1) on the other, which has the same energy.
  Problem p = elements("text", "stormer-verlet", 2);
  p.parameters["theory.fields"] = std::string("u, v");
  p.parameters["theory.density"] = std::string("0.5*(u_t^2 + v_t^2) - 0.5*v^2");
  p.parameters["theory.constraint"] = std::string("u^2 - v^2 - 1");
  Simulation simulation(p);
  start(simulation, numbers({std::sqrt(2.0), -1}), numbers({0, 0}));
  for (int n = 1; n <= 10; ++n) {
    CAPTURE(n);
    if (n > 1) simulation.step();
    const Numbers q = newest(simulation);
    CHECK(q[0] == Approx(std::sqrt(2.0)).epsilon(1e-12));
    CHECK(q[1] == Approx(n % 2 == 1 ? 1 : -1).epsilon(1e-12));
  }
}

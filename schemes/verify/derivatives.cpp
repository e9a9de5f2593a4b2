// SPDX-License-Identifier: MIT
#include "schemes/verify/derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/differentiation/finite_difference.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <span>
#include <string>
#include <utility>

namespace delf {
namespace {

constexpr int jets = 20;
constexpr double good = 1e-12;  ///< relative error of a measured derivative that needs no shorter increment

/// The cell and the values of one stencil.
struct StencilJet {
  Cell cell;
  std::vector<double> y;
};

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// Uniform in [−1, 1).
  double operator()() { return 2.0 * static_cast<double>(engine_() >> 11) * 0x1p-53 - 1.0; }
  /// An integer 0 … count − 1.
  int below(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }

 private:
  std::mt19937_64 engine_;
};

bool all_finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double x) { return std::isfinite(x); });
}

std::vector<double> residual(const StencilFamily& family, const Cell& cell, std::span<const double> y) {
  std::vector<double> r(y.size());
  family.residual(cell, y, r);
  return r;
}
std::vector<double> jacobian(const StencilFamily& family, const StencilJet& at) {
  std::vector<double> J(at.y.size() * at.y.size());
  family.jacobian(at.cell, at.y, J);
  return J;
}

bool is_defined(const StencilFamily& family, const StencilJet& at) {
  return std::isfinite(family.lagrangian(at.cell, at.y).value_or(0)) && all_finite(residual(family, at.cell, at.y)) &&
         all_finite(jacobian(family, at));
}

Cell random_cell(const LatticeSystem& system, Random& random) {
  const Lattice& lattice = system.lattice();
  const double h = system.time_step();
  return {h, lattice.space_step(), random.below(100) * h, lattice.position(random.below(lattice.sites()))};
}

/// Values of order one suit most densities. Where one is not defined there, smaller ones do (a root), or values around
/// 1, 1.25, … of its components (a logarithm, a centre of attraction).
StencilJet random_jet(const LatticeSystem& system, const StencilFamily& family, Random& random) {
  StencilJet at{random_cell(system, random), std::vector<double>(family.size())};
  for (double amplitude = 2; amplitude > 1e-8; amplitude /= 10)
    for (const double centre : {0.0, 1.0}) {
      for (std::size_t i = 0; i < at.y.size(); ++i)
        at.y[i] = centre * (1 + 0.25 * family.values()[i].component) + amplitude * random();
      if (is_defined(family, at)) return at;
    }
  return at;
}

/// f′(0) by central differences of eighth order, over increments that shrink until the estimated error is `enough`:
/// near a singularity of the density the first are too long. The best is taken.
template <class Function>
double slope(const Function& f, double enough) {
  double best = std::numeric_limits<double>::quiet_NaN(), least = std::numeric_limits<double>::infinity();
  for (double scale = 1; scale > 1e-5 && !(least <= enough); scale /= 8) {
    const auto stretched = [&](double s) { return f(scale * s); };
    double error = 0;
    // f′(0) = (d/ds f(scale·s))/scale
    const double value = boost::math::differentiation::finite_difference_derivative<decltype(stretched), double, 8>(
                             stretched, 0.0, &error) /
                         scale;
    if (error / scale < least) least = error / scale, best = value;
  }
  return best;
}

/// The entry that differs most, of all that were compared.
struct Worst {
  double difference = 0;  ///< relative
  double scale = 1, generated = 0, measured = 0;
  int row = 0, column = 0;
  std::int64_t compared = 0;

  void compare(double from_family, double from_differences, double largest, int i, int j) {
    ++compared;
    const double by = std::abs(from_family - from_differences), relative = by == 0 ? 0 : by / largest;
    if (relative <= difference || std::isnan(difference)) return;  // not a number is the worst
    difference = relative, scale = largest, generated = from_family, measured = from_differences;
    row = i, column = j;
  }
};

double largest_absolute(std::span<const double> values) {
  double largest = 0;
  for (const double x : values) largest = std::max(largest, std::abs(x));
  return largest;
}

/// y + s e_j
std::vector<double> moved(const std::vector<double>& y, int j, double s) {
  std::vector<double> to = y;
  to[j] += s;
  return to;
}

/// rⁱ against ∂L/∂yⁱ
void compare_gradient(const StencilFamily& family, const StencilJet& at, Worst& worst) {
  const std::vector<double> r = residual(family, at.cell, at.y);
  const double largest = largest_absolute(r);
  for (int i = 0; i < family.size(); ++i) {
    const auto L = [&](double s) { return *family.lagrangian(at.cell, moved(at.y, i, s)); };
    worst.compare(r[i], slope(L, good * largest), largest, i, i);
  }
}

/// Jⁱʲ against ∂rⁱ/∂yʲ
void compare_jacobian(const StencilFamily& family, const StencilJet& at, Worst& worst) {
  const std::vector<double> J = jacobian(family, at);
  const double largest = largest_absolute(J);
  for (int j = 0; j < family.size(); ++j) {
    // All entries of a column ask for the residual at the same few places.
    std::map<double, std::vector<double>> residuals;
    for (int i = 0; i < family.size(); ++i) {
      const auto r = [&](double s) {
        const auto [where, fresh] = residuals.try_emplace(s);
        if (fresh) where->second = residual(family, at.cell, moved(at.y, j, s));
        return where->second[i];
      };
      worst.compare(J[i * family.size() + j], slope(r, good * largest), largest, i, j);
    }
  }
}

/// "value 3 (vertex {1, 0}, component phi2)"
std::string name_of(const LatticeSystem& system, const StencilFamily& family, int i) {
  const Site site = family.site(i);
  const int component = family.values()[i].component;
  return fmt::format("value {} (vertex {{{}, {}}}, component {})", i, site.time, site.space,
                     system.component(component).name);
}

/// "generated 0.5, measured -0.5: the generated and the measured derivative differ by a factor -1"
std::string disagreement(const Worst& worst) {
  if (std::isnan(worst.difference)) return "one of the two is not a number";
  const std::string both = fmt::format("generated {:.6g}, measured {:.6g}", worst.generated, worst.measured);
  const double factor = worst.generated / worst.measured;
  // A factor of something that is nearly zero, or nearly one, says nothing.
  if (std::abs(worst.measured) < 1e-6 * worst.scale || std::abs(factor - 1) < 1e-3) return both;
  return fmt::format("{}: the generated and the measured derivative differ by a factor {:.4g}", both, factor);
}

Check check_of(const Worst& worst, const std::string& name, const std::string& region, double tolerance) {
  Check check{name, region, worst.difference, tolerance};
  check.normaliser = worst.scale, check.count = worst.compared, check.samples = jets;
  return check;
}

Check gradient_check(const LatticeSystem& system, const StencilFamily& family, const Worst& worst,
                     const std::string& which, double tolerance) {
  const std::string value = name_of(system, family, worst.row);
  Check check = check_of(worst, "derivatives: gradient", fmt::format("{}, worst at {}", which, value), tolerance);
  check.failure = fmt::format("∂L/∂y of {} is not the derivative of L: {}", value, disagreement(worst));
  return check;
}

Check jacobian_check(const LatticeSystem& system, const StencilFamily& family, const Worst& worst,
                     const std::string& which, double tolerance) {
  const std::string row = name_of(system, family, worst.row), column = name_of(system, family, worst.column);
  Check check =
      check_of(worst, "derivatives: Jacobian", fmt::format("{}, worst at {} by {}", which, row, column), tolerance);
  check.failure =
      fmt::format("∂r/∂y of {} by {} is not the derivative of the residual: {}", row, column, disagreement(worst));
  return check;
}

}  // namespace

std::vector<Check> check_derivatives(const LatticeSystem& system, std::uint64_t seed, double tolerance) {
  std::vector<Check> checks;
  Random random(seed);
  const auto families = system.families();
  for (std::size_t f = 0; f < families.size(); ++f) {
    const StencilFamily& family = *families[f];
    Worst gradient, second;
    for (int n = 0; n < jets; ++n) {
      const StencilJet at = random_jet(system, family, random);
      if (family.lagrangian(at.cell, at.y)) compare_gradient(family, at, gradient);
      compare_jacobian(family, at, second);
    }
    const std::string which = fmt::format("family {} of {}, {} values", f + 1, families.size(), family.size());
    if (gradient.compared > 0) checks.push_back(gradient_check(system, family, gradient, which, tolerance));
    checks.push_back(jacobian_check(system, family, second, which, tolerance));
  }
  return checks;
}

}  // namespace delf

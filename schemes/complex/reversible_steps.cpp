// SPDX-License-Identifier: MIT
#include "schemes/complex/reversible_steps.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "lattice/error.hpp"
#include "schemes/complex/assembled_equations.hpp"

namespace delf {

namespace {

/// The equations of all nodes of a row, without unknowns.
std::unique_ptr<const AssembledEquations> all_equations(const ComplexSystem& system) {
  return std::make_unique<const AssembledEquations>(
      system, system.all_stencils(), static_cast<int>(system.nodes()),
      [](std::size_t node) { return static_cast<int>(node); }, [](std::size_t) { return -1; });
}

}  // namespace

ReversibleSteps::ReversibleSteps(const CellSpace& space, double longest, double strength)
    : space_(space), still_(space), force_(all_equations(still_.system())), density_(longest), strength_(strength) {
  if (space.constraint)
    throw BadInput("lattice.time_steps",
                   "lattice.time_steps: reversible steps are for theories without a constraint; give a list of steps");
  for (const double A : space.masses) area_ += A;
  const BatchDensity& density = *space.density;
  const int d = density.components();
  Eigen::MatrixXd mass(d, d);
  bool constant = true;
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b) {
      constant = constant && density.is_constant(d + a, d + b);
      mass(a, b) = density.constant_hessian()[static_cast<std::size_t>((d + a) * density.variables() + d + b)];
    }
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(mass);
  if (!constant || !lu.isInvertible())
    throw BadInput("lattice.time_steps",
                   "lattice.time_steps: reversible steps need a density quadratic in phi_t; give a list of steps");
  const Eigen::MatrixXd inverse = lu.inverse();
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b) inverse_mass_.push_back(inverse(a, b));
}

RowDensity ReversibleSteps::look(std::span<const double> values, std::vector<double> rates, double share) const {
  AssembledEquations::Vector y;
  force_->read(values, y);
  const AssembledEquations::Vector force = force_->residual(y);
  const auto d = static_cast<std::size_t>(space_.density->components());
  double square = 0, product = 0;  // Σ A φ_t², Σ A φ_t·φ_tt
  for (std::size_t i = 0; i < space_.masses.size(); ++i) {
    if (space_.fixed[i]) continue;
    for (std::size_t a = 0; a < d; ++a) {
      double acceleration = 0;  // φ_tt = (∂²T)⁻¹ ∂V/∂φ
      for (std::size_t b = 0; b < d; ++b)
        acceleration += inverse_mass_[a * d + b] * force[static_cast<Eigen::Index>(i * d + b)] / space_.masses[i];
      const double rate = rates[i * d + a] + share * acceleration;
      square += space_.masses[i] * rate * rate;
      product += space_.masses[i] * rate * acceleration;
    }
  }
  const double s2 = strength_ * strength_, of_path = 1 + s2 * square / area_;
  return {std::sqrt(of_path), s2 * product / area_ / of_path};
}

RowDensity ReversibleSteps::look(const SpaceEvolution& evolution) const {
  const double below = evolution.last_step();
  std::vector<double> rates(evolution.row().begin(), evolution.row().end());
  for (std::size_t n = 0; n < rates.size(); ++n) rates[n] = (rates[n] - evolution.row(1)[n]) / below;
  return look(evolution.row(), std::move(rates), 0.5 * below);
}

double ReversibleSteps::first(std::span<const double> values, std::span<const double> rates) {
  return density_.first(look(values, {rates.begin(), rates.end()}, 0));
}

double ReversibleSteps::next(const SpaceEvolution& evolution) { return density_.next(look(evolution)); }

ReversibleSteps::~ReversibleSteps() = default;

double ReversibleSteps::plain(const SpaceEvolution& evolution) const { return density_.plain(look(evolution)); }

}  // namespace delf

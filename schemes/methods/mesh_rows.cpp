// SPDX-License-Identifier: MIT
#include "schemes/methods/mesh_rows.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "jets/tables/cell_points.hpp"
#include "lattice/error.hpp"
#include "schemes/families/mesh_families.hpp"
#include "schemes/problem.hpp"
#include "schemes/stepping/asynchronous_stepper.hpp"
#include "schemes/stepping/step_density.hpp"
#include "schemes/system/constant_mass.hpp"
#include "schemes/system/momenta.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_on_space.hpp"

namespace delf {
namespace {

/// (∂²T/∂φ_t∂φ_t)⁻¹
Eigen::MatrixXd inverse_mass(const BatchDensity& density) {
  if (const auto mass = constant_mass(density))
    if (const Eigen::FullPivLU<Eigen::MatrixXd> lu(*mass); lu.isInvertible()) return lu.inverse();
  throw BadInput("lattice.time_steps",
                 "lattice.time_steps: reversible steps need a density quadratic in phi_t; give a list of steps");
}

}  // namespace

const StencilTable& time_of_mesh_rows() {
  static const StencilTable table = [] {
    TablePoint lower{.weight = 0.5, .time = 0, .slots = {}}, upper{.weight = 0.5, .time = 1, .slots = {}},
        middle{.weight = 1, .time = 0.5, .slots = {}};
    lower.set(JetSlot::phi, {1, 0}), upper.set(JetSlot::phi, {0, 1}), middle.set(JetSlot::phi_t, {-1, 1});
    return StencilTable{.pattern = StencilPattern({{0, 0}, {1, 0}}), .points = {lower, upper, middle}};
  }();
  return table;
}

SchemeParts rows_on_mesh(const FieldTheory& theory, const Problem& p) {
  SchemeParts parts{mesh_families(time_of_mesh_rows(), theory.shared_density(), *p.lattice.mesh()), theory.fields(),
                    theory.symmetries()};
  if (auto constraint = theory.constraint()) {
    parts.families.push_back(std::move(constraint));
    for (Component& multiplier : multipliers_of(theory)) parts.components.push_back(std::move(multiplier));
  }
  if (p.cell_courant == 0) return parts;
  if (theory.constraint())
    throw BadInput("theory.name",
                   "theory.name: cells with steps of their own have no constraints; choose lattice.time = rows");
  parts.stepper = [steps = cell_steps(p.lattice.mesh()->mesh, p.cell_courant)](const LatticeSystem& system) {
    return std::make_unique<AsynchronousStepper>(system, steps);
  };
  return parts;
}

std::vector<double> cell_steps(const Mesh& mesh, double courant) {
  std::vector<double> steps;
  for (int cell = 0; cell < mesh.cells(); ++cell) steps.push_back(courant * shortest_edge(mesh, cell));
  return steps;
}

RowDensity density_of_mesh_rows(const RowsInTime& rows, std::span<const double> momenta, double strength) {
  if (rows.theory.constraint())
    throw BadInput("lattice.time_steps",
                   "lattice.time_steps: reversible steps are for theories without a constraint; give a list of steps");
  const LatticeSystem& system = rows.system;
  const int d = rows.theory.components();
  const Eigen::MatrixXd inverse = inverse_mass(rows.theory.density());
  const std::vector<double> masses = lumped_masses(system.lattice().mesh()->mesh);
  // −½ h ∂V/∂φ is the momentum that a row has from the slab above it, if the field rests there.
  const std::vector<double>& row = rows.rows.rows.back();
  const std::vector<double> above =
      half_equations(system, system.window(rows.newest, {row, row}, 0), rows.newest, Side::above);
  const double h = system.times()->step(rows.newest);
  double square = 0, product = 0, area = 0;  // Σ A φ_t², Σ A φ_t·φ_tt, Σ A
  for (int i = 0; i < system.lattice().sites(); ++i) {
    const double A = masses[i];
    area += A;
    if (system.lattice().is_fixed(i)) continue;
    const Eigen::Map<const Eigen::VectorXd> p(momenta.data() + i * d, d), of_force(above.data() + i * d, d);
    const Eigen::VectorXd rate = inverse * p / A, acceleration = inverse * of_force * (-2 / (h * A));
    square += A * rate.squaredNorm();
    product += A * rate.dot(acceleration);
  }
  const double s2 = strength * strength, of_path = 1 + s2 * square / area;
  return {std::sqrt(of_path), s2 * product / area / of_path};
}

}  // namespace delf

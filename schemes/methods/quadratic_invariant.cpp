// SPDX-License-Identifier: MIT
#include <Eigen/SparseCore>
#include <algorithm>
#include <memory>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/methods/energies.hpp"
#include "schemes/problem.hpp"
#include "schemes/system/assembly.hpp"

namespace delf {
namespace {

using Vector = Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

/// The equations of a row, A y₊ + B y + Aᵀ y₋ + c.
struct LinearRow {
  Sparse A, B;
  Vector c;
};

bool is_linear(const LatticeSystem& system) {
  return std::ranges::all_of(system.families(), [&](const auto& family) {
    const auto part = family->constant_part({system.time_step(), system.lattice().space_step(), 0, 0});
    return part && part->is_all && !family->is_placed();
  });
}

std::optional<LinearRow> linear_row(const LatticeSystem& system) {
  const int size = system.lattice().sites() * system.components();
  Assembly::Parts parts{.equations = {}, .parity = 0, .past = 1, .future = 1};
  for (int dt : {0, 1})
    for (int i = 0; i < system.lattice().sites(); ++i)
      for (int c = 0; c < system.components(); ++c) {
        if (dt == 0) parts.equations.push_back({{0, i}, c});
        parts.unknowns.push_back({{dt, i}, c});
      }
  const Assembly assembly(system, parts);
  std::vector<double> values;
  if (!assembly.constant_jacobian(values)) return std::nullopt;
  std::vector<Eigen::Triplet<double>> above, here;
  for (std::size_t n = 0; n < values.size(); ++n) {
    const auto [equation, unknown] = assembly.places()[n];
    if (unknown < size) here.emplace_back(equation, unknown, values[n]);
    else above.emplace_back(equation, unknown - size, values[n]);
  }
  LinearRow row{Sparse(size, size), Sparse(size, size), {}};
  row.A.setFromTriplets(above.begin(), above.end());
  row.B.setFromTriplets(here.begin(), here.end());
  std::vector<double> at_zero;
  assembly.residual(SectionRing(3, at(size)), 0, at_zero);
  row.c = Eigen::Map<const Vector>(at_zero.data(), size);
  return row;
}

/// Of linear variational equations over two rows, A y₊ + B y + Aᵀ y₋ + c = 0, the difference of the products of the
/// equation with y₊ and with y₋ telescopes: I = y₊ᵀA y₊ + yᵀB y₊ + yᵀA y + cᵀ(y + y₊) is kept, and so is E = −I/2h. With
/// v = y₊ − y, m = ½(y + y₊) and Aₛ = ½(A + Aᵀ),
///
///     E = vᵀ (B − 2Aₛ)/(8h) v − mᵀ (B + 2Aₛ)/(2h) m − cᵀm/h
///
/// A, B and c are the constant parts of the equations. It is kinetic energy plus potential, but for a constant; for (5.12)
/// it is the energy of Marsden–Patrick–Shkoller's footnote 4. Nothing if the equations are not linear, depend on t or x, are
/// of more than two rows, or of more than fields.
EnergyOfRows quadratic_invariant_of(const FieldTheory&, const LatticeSystem& system, const Problem& problem) {
  const auto is_field = [](const Component& c) { return c.role == Role::field && !c.position; };
  if (problem.winding != 0 || system.height() != 1 || system.placement() != Placement::every_site ||
      !is_variational(system) || !std::ranges::all_of(system.all_components(), is_field) || !is_linear(system))
    return nullptr;
  const auto row = linear_row(system);
  if (!row) return nullptr;
  const double h = system.time_step();
  const Sparse twice = row->A + Sparse(row->A.transpose());  // 2Aₛ
  const auto of_steps = std::make_shared<const Sparse>((row->B - twice) / (8 * h)),
             of_means = std::make_shared<const Sparse>((row->B + twice) / (-2 * h));
  const auto force = std::make_shared<const Vector>(row->c / -h);
  return [=](const RowsInTime& rows) {
    const std::vector<double>&before = rows.rows.rows.front(), &newest = rows.rows.rows.back();
    const auto size = static_cast<Eigen::Index>(newest.size());
    const Eigen::Map<const Vector> below(before.data(), size), above(newest.data(), size);
    const Vector v = above - below, mean = 0.5 * (above + below);
    return EnergyMomentum{v.dot(*of_steps * v) + mean.dot(*of_means * mean) + force->dot(mean)};
  };
}

}  // namespace

extern const EnergyEntry quadratic_invariant;
const EnergyEntry quadratic_invariant{
    "quadratic invariant",
    "E = v'(B - 2A)v/8h - m'(B + 2A)m/2h with v = y+ - y, m = (y + y+)/2, A y+ + B y + A'y- the linear equations of "
    "the scheme itself; kept to round-off",
    "Marsden-Patrick-Shkoller, footnote 4, for (5.12)", "linear theories on two rows", quadratic_invariant_of};

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/families/wall_families.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "jets/shifted_density.hpp"
#include "jets/tables/mirror_table.hpp"
#include "jets/tables/wall_tables.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"

namespace delf {
namespace {

/// ∂ℓ/∂(slot) = 0 is proved where that slot is 0: ℓ is even in it, or ∂ℓ/∂(slot) a function of it alone that is 0 there.
bool is_level(const BatchDensity& density, JetSlot slot) {
  if (density.is_even(static_cast<Reflection>(slot))) return true;
  const int d = density.components(), t = density.variables(), first = static_cast<int>(slot) * d;
  for (int a = first; a < first + d; ++a) {
    if (density.constant_gradient()[a] != 0) return false;
    for (int b = 0; b < t + 2; ++b)
      if ((b < first || b >= first + d) && !density.is_zero(a, b)) return false;
  }
  return true;
}

/// A natural wall has ∂ℓ/∂φ_x = 0: there φ_x = 0 is right if it holds where φ_x is 0.
bool has_level_walls(const BatchDensity& density) { return is_level(density, JetSlot::phi_x); }

/// A hinged or free end has ∂ℓ/∂φ_xx = 0. Half a cell with φ_xx = 0 is right if that is where it holds, or if nothing else feels
/// φ_xx.
bool has_level_moments(const BatchDensity& density) {
  if (density.slots() < jet_slots || is_level(density, JetSlot::phi_xx)) return true;
  const int first = static_cast<int>(JetSlot::phi_xx) * density.components();
  for (int a = first; a < density.variables(); ++a)
    for (int b = 0; b < first; ++b)
      if (!density.is_zero(a, b)) return false;
  return true;
}

std::pair<int, int> columns(const StencilTable& table) {
  const auto [left, right] = std::ranges::minmax(table.pattern.vertices, {}, &Site::space);
  return {left.space, right.space};
}
bool has_three_columns(const StencilTable& table) {
  const auto [left, right] = columns(table);
  return right - left == 2 && table.nodes.size() == 1 && table.tests.empty() &&
         table.pattern.placement == Placement::every_site;
}

/// The term of a wall whose slope is not 0: each point reads the density at a jet of its own.
void add_sloping(const MirrorTable& mirror, const std::shared_ptr<const BatchDensity>& density, const Lattice& lattice,
                 const std::vector<double>& slopes, std::vector<std::shared_ptr<const StencilFamily>>& families) {
  const std::size_t d = density->components();
  for (std::size_t q = 0; q < mirror.table.points.size(); ++q) {
    std::vector<double> by(density->variables(), 0.0);
    for (std::size_t s = 0; s < at(density->slots()); ++s)
      for (std::size_t a = 0; a < d; ++a)
        by[s * d + a] = mirror.of_slope[q][s] * slopes[a] * std::pow(lattice.space_step(), 1 - slot_powers[s].space);
    StencilTable one = mirror.table;
    one.points = {mirror.table.points[q]};
    families.push_back(
        std::make_shared<JetFamily>(std::move(one), std::make_shared<ShiftedDensity>(density, std::move(by))));
  }
}

/// The term of a table of three columns, anchored at its middle, at one wall.
void add_mirror(const StencilTable& table, const std::shared_ptr<const BatchDensity>& density, const Lattice& lattice,
                Placement placement, const WallSlopes& slopes,
                std::vector<std::shared_ptr<const StencilFamily>>& families) {
  const bool left = placement == Placement::left_wall;
  const char* const key = left ? "boundary.left" : "boundary.right";
  const bool clamped = (left ? lattice.left() : lattice.right()) == Wall::clamped;
  if (clamped && density->slots() < jet_slots)
    throw BadInput(key, std::string(key) +
                            " = clamped: keeps phi_x too, which is for densities with second derivatives; use fixed "
                            "or natural");
  if (!clamped && !has_level_moments(*density))
    throw BadInput(key,
                   std::string(key) +
                       ": at an end that is not clamped this stencil needs phi_xx = 0, and the density has another "
                       "natural condition; use clamped");
  MirrorTable mirror = mirror_table(table, placement, clamped ? Mirror::even : Mirror::odd);
  const std::vector<double>& given = left ? slopes.left : slopes.right;
  if (clamped && std::ranges::any_of(given, [](double s) { return s != 0; }))
    return add_sloping(mirror, density, lattice, given, families);
  families.push_back(std::make_shared<JetFamily>(std::move(mirror.table), density));
}

}  // namespace

bool fits_between_walls(const StencilTable& table) {
  const auto [left, right] = columns(table);
  if (right - left < 2) return true;
  double middle = 0;
  for (const TablePoint& p : table.points) middle += p.weight * p.space;
  return has_three_columns(table) && std::abs(middle - (left + 1)) < 1e-9;
}

std::vector<std::shared_ptr<const StencilFamily>> wall_families(const StencilTable& table,
                                                                const std::shared_ptr<const BatchDensity>& density,
                                                                const Lattice& lattice, const WallSlopes& slopes) {
  std::vector<std::shared_ptr<const StencilFamily>> families;
  if (lattice.space() != Space::interval) return families;
  if (has_three_columns(table) && fits_between_walls(table)) {
    StencilTable centred = table;
    const int middle = columns(table).first + 1;
    for (Site& v : centred.pattern.vertices) v.space -= middle;
    for (TablePoint& p : centred.points) p.space -= middle;
    for (const Placement placement : {Placement::left_wall, Placement::right_wall})
      add_mirror(centred, density, lattice, placement, slopes, families);
    return families;
  }
  for (StencilTable& term : wall_tables(table))
    if ((term.pattern.placement == Placement::left_wall ? lattice.left() : lattice.right()) == Wall::natural)
      families.push_back(std::make_shared<JetFamily>(std::move(term), density));
  if (!families.empty() && !has_level_walls(*density))
    throw BadInput("lattice.stencil",
                   "lattice.stencil: at natural walls this stencil needs phi_x = 0, and the density has another "
                   "natural condition; use rectangle or rectangle-symmetric, or fixed walls");
  return families;
}

}  // namespace delf

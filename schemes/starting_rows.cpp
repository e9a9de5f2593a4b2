// SPDX-License-Identifier: MIT
#include "schemes/starting_rows.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>

#include "jets/fibre.hpp"
#include "lattice/error.hpp"
#include "schemes/families/mirror_check.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/system/end_work.hpp"
#include "schemes/system/legendre.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {

std::vector<std::vector<double>> StartingRows::lifted(std::vector<std::vector<double>> rows) const {
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t i = 0; i < rows[r].size(); ++i) {
      if (r == 0 && i == 0) continue;
      const double near = r == 0 ? rows[0][i - 1] : rows[r - 1][i];
      const double difference = wrap(rows[r][i] - near);
      if (!(std::abs(difference) <= largest_wrapped_difference))
        throw NotFinite(
            fmt::format("row {}, site {}: on the fibre S1 the starting values jump by {:.3g}, above 0.9 pi; "
                        "refine the lattice or use theory.fibre = R",
                        r, i, difference));
      rows[r][i] = near + difference;
    }
  if (!problem_.lattice.is_circle()) return rows;
  const double gained = rows[0].back() + wrap(rows[0].front() - rows[0].back()) - rows[0].front();
  if (const int turns = static_cast<int>(std::lround(gained / (2 * std::numbers::pi))); turns != problem_.winding)
    throw BadInput("boundary.winding",
                   fmt::format("boundary.winding = {}: the starting rows wind {} times around the circle; set "
                               "boundary.winding = {}",
                               problem_.winding, turns, turns));
  return rows;
}

void StartingRows::hold_walls(std::vector<double>& row, bool velocity) const {
  const int C = system_.components();
  for (int c = 0; c < C; ++c) {
    const Component& component = system_.component(c);
    const bool inner = component.role == Role::inner || component.role == Role::trace;
    if (!inner && !(velocity && component.role == Role::field)) continue;
    for (int i = 0; i < system_.lattice().sites(); ++i)
      if (system_.is_held(i, c)) row[i * C + c] = velocity ? 0 : row[i * C + system_.field_component(component.field)];
  }
  for (const auto& [column, end] : driven_ends(system_))
    for (int c = 0; c < C && velocity; ++c)
      if (const Component& component = system_.component(c); is_given(system_, column, c, *end))
        row[column * C + c] = end->rate(component.field, 0, system_.time_step(), component.at.time);
}

void StartingRows::check_mirrors(const std::vector<double>& row) const {
  const int C = system_.components();
  for (const auto& family : system_.families()) {
    const Placement at = family->pattern().placement;
    if (at != Placement::left_mirror && at != Placement::right_mirror) continue;
    const bool left = at == Placement::left_mirror;
    const int site = left ? 0 : system_.lattice().sites() - 1;
    const bool fixed = system_.lattice().is_fixed(site);
    std::vector<double> wall;
    for (int a = 0; a < theory_.components(); ++a) wall.push_back(row[site * C + system_.field_component(a)]);
    if (has_mirror_images(theory_.density(), fixed ? Mirror::odd : Mirror::even, wall)) continue;
    throw BadInput(
        left ? "boundary.left" : "boundary.right",
        fmt::format("boundary.{0} = {1}: beyond this wall wide stencils go on by mirror images, and the "
                    "density is not even {2}; use lattice.space = circle or scheme.method = multisymplectic",
                    left ? "left" : "right", fixed ? "fixed" : "natural",
                    fixed ? fmt::format("about the wall's value {:.6g}", fmt::join(wall, ", ")) : "in phi_x"));
  }
}

std::optional<std::vector<double>> StartingRows::momenta(std::span<const double> row0,
                                                         std::span<const double> velocity) const {
  const Window window = system_.window(0, {{row0.begin(), row0.end()}}, monodromy_of(problem_));
  const LegendreTransform row(system_, window, 0);
  if (!row.has_row()) return std::nullopt;
  std::vector<double> momenta = row.momenta(velocity);
  const std::size_t C = system_.components();
  for (std::size_t n = 0; n < momenta.size(); ++n)
    if (system_.component(static_cast<int>(n % C)).role == Role::slaved) momenta[n] = 0;
  return momenta;
}

}  // namespace delf

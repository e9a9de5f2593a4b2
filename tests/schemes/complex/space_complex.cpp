// SPDX-License-Identifier: MIT
#include "tests/schemes/complex/space_complex.hpp"

#include <map>

namespace delf::testing {

PotentialRows::PotentialRows(const CellSpace& space, ComplexSystem& system)
    : space_(space),
      system_(system),
      per_point_(space.constraint ? space.fields() : 1),
      per_row_(space.sites() * (per_point_ + space.constraints())),
      site_(system.add_family(space.tables.site())) {
  std::map<int, int> families;  // by the number of corners
  for (int c = 0; c < space.mesh.cells(); ++c) {
    const auto corners = static_cast<int>(space.mesh.cell(c).size());
    if (!families.contains(corners)) families[corners] = system.add_family(space.tables.gradient(corners));
    gradient_.push_back(families[corners]);
    gradient_tables_.push_back(system.add_table(families[corners], space.tables.gradient_table(space.mesh, c)));
  }
  if (space.constraint) constraint_ = system.add_family(ComplexSystem::Family(space.constraint));
}

void PotentialRows::append_sites(int row, std::span<const std::int32_t> points, std::vector<int>& sites) const {
  for (const auto p : points)
    for (int a = 0; a < per_point_; ++a) sites.push_back(row * per_row_ + p * per_point_ + a);
}

int PotentialRows::point_of(int site) const {
  const int fields = space_.sites() * per_point_;
  return site < fields ? site / per_point_ : (site - fields) / space_.constraints();
}

void PotentialRows::add(double t, double measure) {
  const int n = space_.sites(), row = rows_++;
  for (int s = 0; s < per_row_; ++s) {
    const int i = point_of(s);
    const Mesh::Point& p = space_.mesh.points[i];
    system_.add_site({t, p[0], p[1], p[2]}, space_.fixed[i] ? SiteRole::given : SiteRole::free);
  }
  std::vector<int> sites;
  const auto of = [&](std::span<const std::int32_t> points) -> std::vector<int>& {
    sites.clear();
    append_sites(row, points, sites);
    return sites;
  };
  for (std::int32_t i = 0; i < n; ++i) system_.add_stencil(site_, of({&i, 1}), 0, space_.masses[i] * measure);
  for (int c = 0; c < space_.mesh.cells(); ++c)
    system_.add_stencil(gradient_[c], of(space_.mesh.cell(c)), gradient_tables_[c], measure);
  for (std::int32_t i = 0; i < n && space_.constraint; ++i) {
    if (space_.fixed[i]) continue;
    of({&i, 1});
    const int m = space_.constraints();
    for (int b = 0; b < m; ++b) sites.push_back(row * per_row_ + n * per_point_ + i * m + b);
    system_.add_stencil(constraint_, sites, 0, space_.masses[i] * measure);
  }
}

SpaceRows::SpaceRows(const CellSpace& space, std::span<const double> times)
    : system_(PotentialRows::make_complex(space)) {
  PotentialRows rows(space, system_);
  const int motion = system_.add_family(space.tables.motion()), last = static_cast<int>(times.size()) - 1;
  std::vector<int> pair;
  for (int j = 0; j <= last; ++j) {
    const double below = j == 0 ? 0 : times[j] - times[j - 1], above = j == last ? 0 : times[j + 1] - times[j];
    rows.add(times[j], 0.5 * (below + above));
    for (std::int32_t i = 0; i < space.sites() && j > 0; ++i) {
      pair.clear();
      rows.append_sites(j - 1, {&i, 1}, pair), rows.append_sites(j, {&i, 1}, pair);
      system_.add_stencil(motion, pair, 0, space.masses[i] * below, below);
    }
  }
  const int fields = space.sites() * rows.per_point();
  for (int j = 0; j <= last; ++j)
    for (int s = 0; s < rows.per_row(); ++s) {
      const bool multiplier = s >= fields;
      if (space.fixed[rows.point_of(s)]) continue;
      // λ of the last row is in no equation, and G there is one for its fields; G of row 1 is in the data.
      system_.set_role(j * rows.per_row() + s, j == 0      ? SiteRole::given
                                               : j == last ? multiplier ? SiteRole::initial : SiteRole::final
                                               : j == 1    ? multiplier ? SiteRole::final : SiteRole::initial
                                                           : SiteRole::free);
    }
}

}  // namespace delf::testing

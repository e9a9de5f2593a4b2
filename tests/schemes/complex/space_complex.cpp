// SPDX-License-Identifier: MIT
#include "tests/schemes/complex/space_complex.hpp"

namespace delf::testing {

SpaceRows::SpaceRows(const CellSpace& space, std::span<const double> times)
    : system_(PotentialRows::make_complex(space)) {
  PotentialRows rows(space, system_, true);
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

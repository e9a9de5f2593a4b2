// SPDX-License-Identifier: MIT
#include "schemes/complex/asynchronous_window.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace delf {

AsynchronousWindow::AsynchronousWindow(const CellSpace& space, const AsynchronousStepper& stepper)
    : system(space.fields()) {
  using SiteEvent = AsynchronousStepper::SiteEvent;
  const std::vector<std::vector<SiteEvent>>& all = stepper.kept_events();
  const int motion = system.add_family(space.tables.motion());
  std::vector<int> first(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Mesh::Point& p = space.mesh.points[i];
    const std::vector<SiteEvent>& events = all[i];
    for (std::size_t m = 0; m < events.size(); ++m) {
      const SiteRole role = space.fixed[i] || m == 0 ? SiteRole::given
                            : m + 1 == events.size() ? m == 1 ? SiteRole::given : SiteRole::final
                            : m == 1                 ? SiteRole::initial
                                                     : SiteRole::free;
      const int site = system.add_site({events[m].time, p[0], p[1], p[2]}, role);
      if (m == 0) first[i] = site;
      values.insert(values.end(), events[m].values.begin(), events[m].values.end());
      const double passed = m == 0 ? 0 : events[m].time - events[m - 1].time;
      if (m > 0) system.add_stencil(motion, std::array{site - 1, site}, 0, space.masses[i] * passed, passed);
    }
  }
  std::map<int, int> families;  // by number of corners
  for (const auto& [cell, time] : stepper.kept_updates()) {
    const auto corners = space.mesh.cell(cell);
    std::vector<int> sites;
    for (const auto corner : corners) {
      const auto later = std::ranges::upper_bound(all[corner], time, {}, &SiteEvent::time);
      sites.push_back(first[corner] + static_cast<int>(later - all[corner].begin()) - 1);
    }
    const auto count = static_cast<int>(corners.size());
    if (!families.contains(count)) families[count] = system.add_family(space.tables.cell(count));
    const int family = families[count];
    system.add_stencil(family, sites, system.add_table(family, space.tables.cell_table(space.mesh, cell)),
                       stepper.steps()[cell]);
  }
}

}  // namespace delf

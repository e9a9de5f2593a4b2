// SPDX-License-Identifier: MIT
#include "tools/workprecision/entry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "jets/tables/named_tables.hpp"
#include "tools/scene/suggestion.hpp"

namespace delf {

Lattice lattice_of(const Scene& scene, int sites) {
  const Lattice& given = scene.problem.lattice;
  if (given.space() == Space::point) return Lattice::point();
  if (given.is_circle()) return Lattice::circle(sites, given.length());
  return Lattice::interval(sites, given.length(), given.left(), given.right());
}

std::vector<WorkPrecisionEntry> entries(const Scene& scene, const WorkPrecisionRequest& request) {
  std::vector<WorkPrecisionEntry> all = engine_entries(scene);
  if (request.peers)
    for (WorkPrecisionEntry& peer : peer_entries(scene)) all.push_back(std::move(peer));
  if (request.schemes.empty()) return all;
  std::vector<bool> named(all.size());
  const auto name_all = [&](const std::string& given) {
    const std::string name = stencil_name(given, scene.problem.lattice.space() == Space::point);
    bool any = false;
    for (std::size_t i = 0; i < all.size(); ++i)
      // "spacetime" names all of its degrees, "peers" all of the other programs
      if (all[i].name == name || all[i].name.starts_with(name + " ") || (name == "peers" && all[i].peer))
        named[i] = any = true;
    return any || name == "peers";
  };
  // Names of peers hold commas themselves: the longest list of pieces that is a name together is one.
  const std::vector<std::string>& pieces = request.schemes;
  for (auto at = pieces.begin(); at != pieces.end();) {
    auto end = pieces.end();
    while (end != at && !name_all(fmt::format("{}", fmt::join(at, end, ", ")))) --end;
    if (end == at) {
      std::vector<std::string> names = stencil_names_and_aliases();
      for (const WorkPrecisionEntry& one : all) names.push_back(one.name);
      throw scene.settings.error("workprecision.schemes",
                                 fmt::format("{} is no scheme here{}", *at, suggestion(*at, names)));
    }
    at = end;
  }
  std::vector<WorkPrecisionEntry> chosen;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (named[i]) chosen.push_back(std::move(all[i]));
  return chosen;
}

}  // namespace delf

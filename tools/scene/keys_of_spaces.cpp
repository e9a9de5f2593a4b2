// SPDX-License-Identifier: MIT
#include "tools/scene/keys_of_spaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "schemes/monodromy.hpp"
#include "tools/scene/keys.hpp"

namespace delf {
namespace {

/// Keys with the kinds of space that read them.
struct KeysOfSpaces {
  std::vector<SpaceKind> read_by;
  std::vector<std::string_view> keys;
  std::string_view otherwise = {};  ///< what a lattice says that does not; {}: "a circle"

  bool are_read_by(SpaceKind kind) const { return std::ranges::find(read_by, kind) != read_by.end(); }
};

/// A key that is not in the table is read by every lattice, and by nothing else.
const std::vector<KeysOfSpaces>& keys_of_spaces() {
  using enum SpaceKind;
  static constexpr std::string_view of_meshes = "only lattice.space = complex has a mesh";
  static const std::vector<KeysOfSpaces> all{
      {{circle, interval}, {"lattice.sites", "lattice.length"}, "{} has neither length nor sites"},
      {{circle}, {"boundary.winding"}, "{} has no winding"},
      {{circle}, {gain_key}, "only a circle is gone around"},
      {{circle}, {"figures.spectrum"}, "only a circle has waves of all its wave numbers"},
      {{interval}, {"boundary.left", "boundary.right", "boundary.left.flux", "boundary.right.flux"}, "{} has no walls"},
      {{circle, interval, mesh, still, spacetime}, {"output.xdmf"}, "{} has no space to show"},
      {{circle, point},
       {"output.modified"},
       "{} has walls, where sums over sites are no integrals; its columns are left out"},
      {{point}, {"output.section"}, "sections are of mechanics, lattice.space = point"},
      {{mesh, still, spacetime}, {"lattice.mesh", "lattice.merge"}, of_meshes},
      {{mesh, still}, {"lattice.time", "boundary.mesh"}, of_meshes},
      {{mesh}, {"lattice.time_steps", "lattice.step_control"}, of_meshes},
      {{circle, interval, point, spacetime}, {"run.threads"}},
      {{circle, interval, point, mesh},
       {"output.film", "film.seconds", "lattice.courant", "lattice.time_step", "run.until", "run.steps",
        "output.every"}},
      {{circle, interval, point, mesh, still, spacetime},
       {"theory.name",           "theory.fibre",     "lattice.space",      "scheme.method",     "scheme.tolerance",
        "scheme.max_iterations", "initial.state",    "run.seed",           "output.checkpoint", "output.fields",
        "output.figures",        "output.format",    "output.titles",      "output.report",     "verify.variations",
        "verify.moments",        "verify.tolerance", "verify.fault",       "verify.generator",  "verify.force",
        "cite.format",           "cite.sources",     "convergence.levels", "convergence.order", "convergence.agreement",
        "stability.agreement",   "stability.steps",  "stability.fault"}},
  };
  return all;
}

/// "a circle"; empty where the space is none of a lattice.
std::string_view lattice_in_words(SpaceKind kind) {
  return kind == SpaceKind::circle     ? "a circle"
         : kind == SpaceKind::interval ? "an interval"
         : kind == SpaceKind::point    ? "a point"
                                       : "";
}

}  // namespace

std::string why_without_time(SpaceKind kind) {
  return kind == SpaceKind::still       ? "has no effect with lattice.time = none"
         : kind == SpaceKind::spacetime ? "has no effect where sites have times of their own"
                                        : "";
}

std::string why_unread(SpaceKind kind, std::string_view key) {
  // a part of the mesh, which is asked for it
  if ((kind == SpaceKind::mesh || kind == SpaceKind::still) && section_of(key) == "boundary") return {};
  const auto known = std::ranges::find_if(keys_of_spaces(), [&](const KeysOfSpaces& group) {
    return std::ranges::find(group.keys, key) != group.keys.end();
  });
  const KeysOfSpaces* const group = known == keys_of_spaces().end() ? nullptr : &*known;
  if (group && group->are_read_by(kind)) return {};
  if (const std::string_view lattice = lattice_in_words(kind); !lattice.empty())
    return group ? fmt::format(fmt::runtime(group->otherwise), lattice) : "";
  if (group && group->are_read_by(SpaceKind::mesh)) return why_without_time(kind);
  const std::string_view section = section_of(key);
  if (section == "sweep") return {};  // of the command
  if (section == "exact" || section == "initial") return "has no effect on a mesh, where fields start from formulas";
  return "needs a regular lattice (not applicable to lattice.space = complex)";
}

}  // namespace delf

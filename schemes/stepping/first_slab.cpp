// SPDX-License-Identifier: MIT
#include "schemes/stepping/first_slab.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace delf {
namespace {

/// A value of row 0 that a start gives.
bool is_data(const LatticeSystem& system, const Node& value) {
  const Role role = system.component(value.component).role;
  return value.site.time == 0 && (role == Role::field || role == Role::trace);
}

/// The values that an equation reads. Equations of one component are alike, but near walls.
class Reads {
 public:
  explicit Reads(const LatticeSystem& system) : system_(system) {}

  std::vector<Node> of(const Node& equation) {
    const Lattice& lattice = system_.lattice();
    if (lattice.space() == Space::mesh) return nodes_of(equation, system_.linearised(equation.site, equation.component));
    const int i = equation.site.space, far = 2 * system_.width() + 1;
    const bool circle = lattice.is_circle();
    const auto [found, fresh] =
        known_.try_emplace({equation.component, (equation.site.time + i) % 2, circle ? far : std::min(i, far),
                            circle ? far : std::min(lattice.sites() - 1 - i, far)});
    if (fresh) found->second = system_.linearised(equation.site, equation.component);
    return nodes_of(equation, found->second);
  }

 private:
  std::vector<Node> nodes_of(const Node& equation, const std::vector<Coefficient>& coefficients) const {
    std::vector<Node> nodes;
    for (const Coefficient& c : coefficients) {
      Site site = equation.site + c.offset;
      site.space = system_.lattice().home(site.space), site.node = 0;  // components tell nodes apart
      nodes.push_back({site, c.component});
    }
    return nodes;
  }

  const LatticeSystem& system_;
  std::map<std::tuple<int, int, int, int>, std::vector<Coefficient>> known_;
};

/// Leaves out the equations that contain what lies before row 0, or what is found there by other equations than these,
/// and the unknowns that they are solved for.
void leave_out_earlier_rows(const LatticeSystem& system, Assembly::Parts& parts) {
  const auto key = [](const Node& n) { return std::tuple{n.site.time, n.site.space, n.component}; };
  std::set<std::tuple<int, int, int>> found;
  for (const Node& unknown : parts.unknowns) found.insert(key(unknown));
  Reads reads(system);
  std::vector<std::vector<Node>> read;
  for (const Node& equation : parts.equations) read.push_back(reads.of(equation));
  std::vector<char> kept(parts.equations.size(), 1);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t n = 0; n < kept.size(); ++n) {
      const auto is_known = [&](const Node& value) { return is_data(system, value) || found.contains(key(value)); };
      if (kept[n] == 0 || std::ranges::all_of(read[n], is_known)) continue;
      kept[n] = 0, changed = true;
      found.erase(key(parts.unknowns[n]));
    }
  }
  std::size_t left = 0;
  for (std::size_t n = 0; n < kept.size(); ++n)
    if (kept[n] != 0) parts.equations[left] = parts.equations[n], parts.unknowns[left++] = parts.unknowns[n];
  parts.equations.resize(left), parts.unknowns.resize(left);
}

}  // namespace

Assembly::Parts first_slab(const LatticeSystem& system, const Assembly::Parts& whole, bool from_momenta) {
  Assembly::Parts parts = whole;
  parts.equations.clear(), parts.unknowns.clear();
  if (!whole.matched) return parts;
  Reads reads(system);
  for (std::size_t n = 0; n < whole.equations.size(); ++n) {
    const Node &equation = whole.equations[n], &unknown = whole.unknowns[n];
    if (equation.site.time < 0 || unknown.site.time < 0 || is_data(system, unknown)) continue;
    // Unknowns that are slaved to the row before keep what the start gave.
    if (from_momenta && system.component(unknown.component).role == Role::slaved &&
        std::ranges::any_of(reads.of(equation), [](const Node& value) { return value.site.time < 0; }))
      continue;
    parts.equations.push_back(equation), parts.unknowns.push_back(unknown);
  }
  if (!from_momenta) leave_out_earlier_rows(system, parts);
  return parts;
}

}  // namespace delf

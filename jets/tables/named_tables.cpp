// SPDX-License-Identifier: MIT
#include "jets/tables/named_tables.hpp"

#include <algorithm>

#include "jets/tables/hexagon_jet.hpp"
#include "jets/tables/point_jets.hpp"
#include "jets/tables/rectangle_jet.hpp"
#include "jets/tables/triangle_jet.hpp"
#include "jets/tables/tuple_jets.hpp"

namespace delf {
namespace {

/// A map whose weights are wrong does not compile.
template <JetMap Map>
NamedTable named(const char* name, const char* description, Map, const char* words, std::vector<std::string> sources,
                 std::vector<std::string> aliases = {}) {
  return {name, description, stencil_table(Map::table), std::move(aliases), words, std::move(sources)};
}

}  // namespace

const std::vector<NamedTable>& named_tables() {
  static const std::vector<NamedTable> tables{
      named("triangle", "3 sites, φ at the centroid: (5.8)", triangle, "the triangle, with the field at its centroid",
            {"marsden-patrick-shkoller-1998"}),
      named("triangle-vertex", "3 sites, φ at the first vertex (footnote 3): explicit", triangle_vertex,
            "the triangle, with the field at its first vertex (leapfrog)", {"marsden-patrick-shkoller-1998"},
            {"leapfrog", "yee", "stormer-verlet", "stormer", "verlet"}),
      named("rectangle", "4 sites, (5.9) with φ_t on both vertical edges: (5.10)", rectangle,
            "the rectangle, with $\\varphi_t$ on both vertical edges", {"marsden-patrick-shkoller-1998"}),
      named("rectangle-symmetric", "4 sites, space and time alike: (5.12)", rectangle_symmetric,
            "the symmetric rectangle", {"marsden-patrick-shkoller-1998"}),
      named("hexagon", "6 sites of a brick wall (Fig. 5.4); circle, N even", hexagon, "the hexagon of a brick wall",
            {"marsden-patrick-shkoller-1998"}),
      named("six-tuple", "6 sites, φ on the middle edge, φ_x left and right of it, φ_xx", six_tuple,
            "the six-tuple, with $\\varphi_{xx}$", {"kouranbaeva-shkoller-2000"}),
      named("nine-tuple", "9 sites, the symmetric rectangle in each of four cells, φ_xx", nine_tuple,
            "the nine-tuple, with $\\varphi_{xx}$", {"kouranbaeva-shkoller-2000"}),
      named("midpoint", "2 sites of a time lattice, q in the middle; lattice.space = point", midpoint,
            "the midpoint rule", {"wendlandt-marsden-1997"}),
      named("trapezoidal",
            "2 sites of a time lattice, half at either end: Störmer–Verlet, explicit, not the trapezoidal rule; "
            "lattice.space = point",
            trapezoidal, "the trapezoidal discrete Lagrangian (the Störmer–Verlet method)",
            {"verlet-1967", "hairer-lubich-wanner-2003"}, {"stormer-verlet", "stormer", "verlet", "leapfrog"}),
      named("vertex", "2 sites of a time lattice, q at the first (symplectic Euler); lattice.space = point", vertex,
            "the discrete Lagrangian with the field at the first of two sites (symplectic Euler)",
            {"hairer-lubich-wanner-2006"}),
  };
  return tables;
}

bool NamedTable::is_for_point() const {
  const auto [least, most] = std::ranges::minmax(table.pattern.vertices, {}, &Site::space);
  return least.space == most.space;
}

std::string stencil_name(const std::string& name_or_alias, bool on_point) {
  const auto& tables = named_tables();
  if (std::ranges::find(tables, name_or_alias, &NamedTable::name) != tables.end()) return name_or_alias;
  const NamedTable* found = nullptr;
  for (const NamedTable& table : tables)
    if (std::ranges::count(table.aliases, name_or_alias) > 0 && (!found || table.is_for_point() == on_point))
      found = &table;
  return found ? found->name : name_or_alias;
}

std::vector<std::string> stencil_names_and_aliases() {
  std::vector<std::string> names;
  for (const NamedTable& table : named_tables()) names.push_back(table.name);
  for (const NamedTable& table : named_tables())
    for (const std::string& alias : table.aliases)
      if (std::ranges::count(names, alias) == 0) names.push_back(alias);
  return names;
}

}  // namespace delf

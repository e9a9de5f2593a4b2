// SPDX-License-Identifier: MIT
#include "schemes/families/mesh_families.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>

#include "jets/tables/cell_points.hpp"
#include "jets/tables/table_product.hpp"
#include "lattice/index.hpp"
#include "schemes/families/boundary_flux.hpp"
#include "schemes/families/jet_family.hpp"

namespace delf {

bool couples_gradient(const BatchDensity& density) {
  const int d = density.components();
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b)
      if (!density.is_zero(2 * d + a, b)) return true;
  return false;
}

namespace {

/// One site: its mass and its place are its own.
StencilTable site_space() {
  TablePoint point{.slots = {}};
  point.set(JetSlot::phi, {1.0});
  point.own = {.weight = 0, .place = 1, .slots = {}};
  return {.pattern = StencilPattern({{0, 0}}), .points = {point}};
}

std::shared_ptr<const StencilFamily> on_sites(const StencilTable& time,
                                              const std::shared_ptr<const BatchDensity>& density, const Mesh& mesh,
                                              bool values_are_sources) {
  const auto sites = static_cast<int>(mesh.points.size());
  std::vector<std::int32_t> all(mesh.points.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<double> places;
  for (const Mesh::Point& p : mesh.points) places.push_back(p[0]);
  return std::make_shared<JetFamily>(
      product(time, site_space()), density, values_are_sources,
      OwnWeights{std::make_shared<ListedStencils>(1, std::move(all), sites), {lumped_masses(mesh), std::move(places)}});
}

/// The cells of so many corners; null if there are none. The numbers of a cell are, point after point, its measure and its
/// place, then for each direction the slopes, and where φ and ∇φ are coupled the values before them.
std::shared_ptr<const StencilFamily> on_cells(const StencilTable& time,
                                              const std::shared_ptr<const BatchDensity>& density, const Mesh& mesh,
                                              int corners) {
  const bool coupled = couples_gradient(*density);
  std::vector<std::int32_t> sites;
  OwnWeights own;
  StencilTable space{.pattern = {}, .points = {}};
  for (int l = 0; l < corners; ++l) space.pattern.vertices.push_back({.time = 0, .space = l});
  const auto entries = [corners](TablePoint& point, JetSlot slot, int first) {
    for (int l = 0; l < corners; ++l) {
      point.slots[at(slot)].push_back({l, 1.0});
      point.own.slots[at(slot)].push_back(first + l);
    }
  };
  for (int c = 0; c < mesh.cells(); ++c) {
    const auto cell = mesh.cell(c);
    if (static_cast<int>(cell.size()) != corners) continue;
    const bool first = sites.empty();
    sites.insert(sites.end(), cell.begin(), cell.end());
    std::vector<double> numbers;
    for (const CellPoint& q : cell_points(mesh, c)) {
      const auto measure = static_cast<int>(numbers.size());
      double place = 0;
      for (int l = 0; l < corners; ++l) place += q.value[l] * mesh.corner(c, at(l))[0];
      numbers.insert(numbers.end(), {q.weight, place});
      numbers.insert(numbers.end(), q.value.begin(), q.value.end());
      for (const std::vector<double>& slope : q.slopes) {
        const auto slopes = static_cast<int>(numbers.size());
        numbers.insert(numbers.end(), slope.begin(), slope.end());
        if (!first) continue;
        TablePoint point{.slots = {}};
        point.own = {.weight = measure, .place = measure + 1, .slots = {}};
        if (coupled) entries(point, JetSlot::phi, measure + 2);
        TablePoint without = point;
        entries(point, JetSlot::phi_x, slopes);
        space.points.push_back(std::move(point));
        without.weight = -1;
        if (coupled) space.points.push_back(std::move(without));
      }
    }
    own.numbers.resize(numbers.size());
    for (std::size_t n = 0; n < numbers.size(); ++n) own.numbers[n].push_back(numbers[n]);
  }
  if (sites.empty()) return nullptr;
  own.stencils = std::make_shared<ListedStencils>(corners, std::move(sites), static_cast<int>(mesh.points.size()));
  StencilTable table = product(time, space);
  table.lower_side.clear();  // momenta are those of the sites
  for (auto* points : {&table.points, &table.tests})
    for (TablePoint& point : *points)
      point.slots[at(JetSlot::phi_t)].clear(), point.own.slots[at(JetSlot::phi_t)].clear();
  return std::make_shared<JetFamily>(std::move(table), density, false, std::move(own));
}

}  // namespace

std::vector<std::shared_ptr<const StencilFamily>> mesh_families(const StencilTable& time,
                                                                const std::shared_ptr<const BatchDensity>& density,
                                                                const MeshSpace& space, bool values_are_sources) {
  std::vector<std::shared_ptr<const StencilFamily>> families{on_sites(time, density, space.mesh, values_are_sources)};
  for (const int corners : {2, 3, 4})
    if (auto family = on_cells(time, density, space.mesh, corners)) families.push_back(std::move(family));
  if (auto flux = boundary_flux(time, density->components(), static_cast<int>(space.mesh.points.size()), space.fluxes))
    families.push_back(std::move(flux));
  return families;
}

}  // namespace delf

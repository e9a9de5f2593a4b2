// SPDX-License-Identifier: MIT
#include "schemes/complex/spacetime_complex.hpp"

#include <map>
#include <optional>

#include "jets/tables/slot_places.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/complex/space_tables.hpp"

namespace delf {
namespace {

/// Families by shape and by the entries that their tables have.
class Families {
 public:
  Families(ComplexSystem& system, const StencilList& list, std::shared_ptr<const BatchDensity> density)
      : system_(system), list_(list), density_(std::move(density)) {}

  void add(const StencilList::Entry& e) {
    const StencilShapeKind kind = *stencil_shape(e.shape);
    if (kind.table) add_table(e, *kind.table);
    else add_part(e);
  }

 private:
  void add_table(const StencilList::Entry& e, const StencilTable& table) {
    if (with_slot_places(table, *density_).points.size() != table.points.size())
      throw BadInput("theory.name",
                     "theory.name: a density whose phi_t or phi_x goes with a function of t or x needs "
                     "stencils whose derivatives lie at one place, and those of " +
                         e.shape + " do not; use rectangles or six-tuples");
    const std::vector<TablePoint> points = placed_points(table, list_.positions(e));
    std::vector<int> form;
    for (const TablePoint& p : points)
      for (std::size_t slot = 0; slot < at(density_->slots()); ++slot) {
        for (const auto& entry : p.slots[slot]) form.push_back(entry.vertex);
        form.push_back(-1);
      }
    auto& family = families_[{e.shape, form}];
    if (!family) family = system_.add_family(ComplexSystem::Family(density_, static_cast<int>(e.sites.size()), points));
    system_.add_stencil(*family, e.sites, system_.add_table(*family, points), e.share.value_or(table.measure));
  }

  void add_part(const StencilList::Entry& e) {
    if (!space_) space_.emplace(density_);
    const int size = static_cast<int>(e.sites.size());
    auto& family = families_[{e.shape, {size}}];
    const Complex::Position& p = list_.sites[e.sites.front()].position;
    if (e.shape == "motion") {
      if (!family) family = system_.add_family(space_->motion());
      const double h = list_.sites[e.sites[1]].position[0] - p[0];
      system_.add_stencil(*family, e.sites, 0, *e.share * h, h);
    } else if (e.shape == "site") {
      if (!family) family = system_.add_family(space_->site());
      system_.add_stencil(*family, e.sites, 0, *e.share);
    } else {
      if (!family) family = system_.add_family(space_->gradient(size));
      Mesh cell{.points = {}, .vertices = {}};
      std::vector<std::int32_t> corners;
      for (const Complex::Position& corner : list_.positions(e)) {
        corners.push_back(static_cast<std::int32_t>(cell.points.size()));
        cell.points.push_back({corner[1], corner[2], corner[3]});
      }
      cell.add_cell(corners);
      system_.add_stencil(*family, e.sites, system_.add_table(*family, space_->gradient_table(cell, 0)), *e.share);
    }
  }

  ComplexSystem& system_;
  const StencilList& list_;
  std::shared_ptr<const BatchDensity> density_;
  std::optional<SpaceTables> space_;
  std::map<std::pair<std::string, std::vector<int>>, std::optional<int>> families_;
};

}  // namespace

ComplexSystem spacetime_complex(const StencilList& list, const std::shared_ptr<const BatchDensity>& density) {
  if (const auto fault = find_fault(list, *density))
    throw BadInput(
        "lattice.mesh",
        "lattice.mesh: " + (fault->line > 0 ? "line " + std::to_string(fault->line) + ": " : "") + fault->what);
  // A stencil across the seam of a circle has sites on both of its sides, and no mean place.
  for (int v = 0; v < density->variables() && list.circumference > 0; ++v)
    if (density->is_placed() && !density->is_zero(v, density->variables() + 1))
      throw BadInput("theory.name",
                     "theory.name: on a finite complex around a circle a density may read t and not x; leave out the "
                     "circle of lattice.mesh, or choose lattice.space = circle");
  ComplexSystem system(density->components());
  for (const StencilList::Site& s : list.sites) system.add_site(s.position, s.role);
  Families families(system, list, density);
  for (const StencilList::Entry& e : list.stencils) families.add(e);
  return system;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/system/end_work.hpp"

#include <algorithm>

#include "jets/tables/density_on_table.hpp"
#include "jets/tables/rectangle_jet.hpp"
#include "jets/tables/table_product.hpp"
#include "lattice/index.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/families/mesh_constraint.hpp"
#include "schemes/system/legendre.hpp"

namespace delf {

DrivenEnds driven_ends(const LatticeSystem& system) {
  DrivenEnds ends;
  for (const auto& family : system.families())
    if (const DrivenEnd* const end = family->driven_end())
      ends.emplace_back(end->is_left() ? 0 : system.lattice().sites() - 1, end);
  return ends;
}

bool is_given(const LatticeSystem& system, int column, int component, const DrivenEnd& end) {
  const Component& c = system.component(component);
  const bool of_field = c.role == Role::field || c.role == Role::inner || c.role == Role::trace;
  return of_field && c.field < end.size() && system.is_held(column, component);
}

namespace {

/// The density on an element that is tested by other functions, with its own.
std::shared_ptr<const StencilFamily> tested_by_itself(const DensityOnTable& jets) {
  StencilTable table = jets.table;
  table.tests.clear();
  return std::make_shared<JetFamily>(std::move(table), jets.density);
}

}  // namespace

EndWork::EndWork(const LatticeSystem& system, const std::shared_ptr<const BatchDensity>& density,
                 std::vector<EndFlux> fluxes)
    : system_(system), fluxes_(std::move(fluxes)), ends_(driven_ends(system)) {
  std::shared_ptr<const StencilFamily> observed;
  for (const auto& family : system.families())
    if (const DensityOnTable* jets = family->made_of(); jets && !jets->table.lower_side.empty() && !element_) {
      element_ = at_one_site(jets->table);
      if (!jets->table.tests.empty()) observed = tested_by_itself(*jets);
    }
  if (!element_ && find_mesh(system.families())) element_.emplace();
  if (!element_ && density->slots() < jet_slots)
    observed = std::make_shared<JetFamily>(stencil_table(rectangle_symmetric.table), density);
  if (observed) {
    observed_.emplace(system.lattice(), std::vector{observed}, system.time_step(), system.all_components());
    observed_->share_times(system);
  }
  const LatticeSystem& of_walls = observed_ ? *observed_ : system;
  Assembly::Parts parts{.equations = {}, .past = of_walls.height(), .future = of_walls.height()};
  for (const auto& [column, end] : ends_)
    for (int c = 0; c < system.components(); ++c)
      if (is_given(system, column, c, *end)) parts.equations.push_back({{0, column}, c});
  if (!parts.equations.empty()) walls_ = std::make_unique<const Assembly>(of_walls, std::move(parts));
  if (!element_ || !walls_) return;
  below_ = std::make_unique<const HalfEquations>(system, Side::below, 0.0);
  if (observed_) below_walls_ = std::make_unique<const HalfEquations>(*observed_, Side::below, 0.0);
}

void EndWork::add(const Window& rows) {
  if (element_) return add_step(rows);
  const std::int64_t newest = rows.last_row(), row = newest - 1;
  const RowTimes& times = *system_.times();
  const auto moved = [&](int column, int component) {
    return 0.5 * (rows(newest, column, component) - rows(row - 1, column, component));
  };
  if (walls_) {
    const int reach = observed_ ? observed_->height() : system_.height();
    std::vector<double> E;
    walls_->residual(SectionRing(rows, row - reach, row + reach), row, E);
    for (int n = 0; n < walls_->size(); ++n) {
      const auto& [site, c] = walls_->equation(n);
      sum_ -= E[at(n)] / times.step(row) * moved(site.space, c);
    }
  }
  for (const EndFlux& end : fluxes_)
    for (std::size_t a = 0; a < end.flux.size(); ++a)
      sum_ += end.flux[a](times.time(row)) * moved(end.column, system_.field_component(static_cast<int>(a)));
}

/// ∫ f φ_t dt over the newest step, by the quadrature of its element.
double EndWork::flowed_in(const Window& rows) const {
  const std::int64_t row = rows.last_row() - 1;
  const RowTimes& times = *system_.times();
  double sum = 0;
  for (const EndFlux& end : fluxes_)
    for (const TablePoint& point : element_->points)
      for (std::size_t a = 0; a < end.flux.size(); ++a) {
        double step = 0;  // h φ_t
        for (const auto& [vertex, weight] : point[JetSlot::phi_t]) {
          const Site& v = element_->pattern.vertices[at(vertex)];
          step +=
              weight * rows(row + v.time, end.column, v.node * static_cast<int>(end.flux.size()) + static_cast<int>(a));
        }
        sum += point.weight * end.flux[a](times.time(row) + point.time * times.step(row)) * step;
      }
  return sum;
}

void EndWork::add_step(const Window& rows) {
  const std::int64_t newest = rows.last_row(), row = newest - 1;
  const RowTimes& times = *system_.times();
  const double last = at_row_;
  if (below_) {
    const Window with_low = with_low_parts(rows);
    std::vector<double> p = (*below_)(with_low, newest);
    if (below_walls_) {
      const std::vector<double> own = (*below_walls_)(with_low, newest);
      for (int n = 0; n < walls_->size(); ++n) {
        const auto& [site, c] = walls_->equation(n);
        const std::size_t place = at(site.space * system_.components() + c);
        p[place] = own[place];
      }
    }
    at_row_ = LegendreTransform(system_, rows, newest).work_in_row(p);
  }
  if (begun_ == 0) {
    begun_ = 1;
    return;
  }
  sum_ += at_row_ - last + flowed_in(rows);
  if (walls_) {
    std::vector<double> E;
    walls_->residual(SectionRing(rows, row - system_.height(), row + system_.height()), row, E);
    for (int n = 0; n < walls_->size(); ++n) {
      const auto& [site, c] = walls_->equation(n);
      const auto end = std::ranges::find(ends_, site.space, &DrivenEnds::value_type::first);
      const Component& component = system_.component(c);
      sum_ -= E[at(n)] * end->second->rate(component.field, times.time(row), times.step(row), component.at.time);
    }
  }
}

}  // namespace delf

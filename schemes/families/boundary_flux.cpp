// SPDX-License-Identifier: MIT
#include "schemes/families/boundary_flux.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "jets/numbers/structure.hpp"
#include "jets/tables/table_product.hpp"
#include "lattice/index.hpp"
#include "schemes/families/jet_family.hpp"

namespace delf {

FluxDensity::FluxDensity(std::vector<std::shared_ptr<const GivenInTime>> fluxes, int components)
    : fluxes_(std::move(fluxes)) {
  components_ = components;
  placed_ = true;
  const int m = variables();
  Abstract flux = Abstract::variable(m, std::nullopt) * Abstract::variable(m + 1, std::nullopt), sum(0.0);
  for (int a = 0; a < components; ++a) sum = sum + Abstract::variable(a, 0) * flux;
  structure_ = structure_of(sum, m, components);
  find_constants();
}

const GivenInTime& FluxDensity::at_place(const JetBatch& jets, int i) const {
  const double x = fluxes_.size() == 1 || jets.x == nullptr ? 0 : jets.x[i];
  const double last = static_cast<double>(fluxes_.size() - 1);
  return *fluxes_[at(std::lround(std::clamp(x, 0.0, last)))];
}

void FluxDensity::value(const JetBatch& jets, double* l) const {
  for (int i = 0; i < jets.count; ++i) {
    l[i] = 0;
    for (int a = 0; a < components_; ++a) l[i] += at_place(jets, i).value(a, jets.t) * jets.slots[a][i];
  }
}

void FluxDensity::gradient(const JetBatch& jets, double* const* g, double* l) const {
  for (int v = components_; v < variables(); ++v) std::fill_n(g[v], jets.count, 0.0);
  slope(jets, g);
  if (l != nullptr) value(jets, l);
}

void FluxDensity::hessian(const JetBatch& jets, double* const* H) const {
  for (int n = 0; n < variables() * variables(); ++n) std::fill_n(H[n], jets.count, 0.0);
}

void FluxDensity::slope(const JetBatch& phi, double* const* g) const {
  for (int a = 0; a < components_; ++a)
    for (int i = 0; i < phi.count; ++i) g[a][i] = at_place(phi, i).value(a, phi.t);
}

void FluxDensity::curvature(const JetBatch& phi, double* const* d) const {
  for (int n = 0; n < components_ * components_; ++n) std::fill_n(d[n], phi.count, 0.0);
}

void FluxDensity::place_gradient(const JetBatch& jets, double* l_t, double* l_x) const {
  for (int i = 0; i < jets.count; ++i) {
    l_t[i] = l_x[i] = 0;
    for (int a = 0; a < components_; ++a) l_t[i] += at_place(jets, i).rate(a, jets.t) * jets.slots[a][i];
  }
}

std::shared_ptr<const StencilFamily> boundary_flux(const StencilTable& time, int components, int sites,
                                                   std::span<const MeshSpace::AtPoint> fluxes) {
  if (fluxes.empty()) return nullptr;
  std::vector<std::int32_t> points;
  std::vector<std::shared_ptr<const GivenInTime>> given;
  std::vector<double> numbers;
  for (const auto& [point, flux] : fluxes) {
    numbers.push_back(static_cast<double>(points.size()));
    points.push_back(point), given.push_back(flux);
  }
  TablePoint site{.slots = {}};
  site.set(JetSlot::phi, {1.0});
  site.own = {.weight = -1, .place = 0, .slots = {}};
  StencilTable table = product(time, {.pattern = StencilPattern({{0, 0}}), .points = {site}});
  table.lower_side.clear();  // momenta are those of the sites
  for (auto* list : {&table.points, &table.tests})
    for (TablePoint& point : *list)
      point.slots[at(JetSlot::phi_t)].clear(), point.own.slots[at(JetSlot::phi_t)].clear();
  return std::make_shared<JetFamily>(
      std::move(table), std::make_shared<FluxDensity>(std::move(given), components), false,
      OwnWeights{std::make_shared<ListedStencils>(1, std::move(points), sites), {std::move(numbers)}});
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/verify/flux_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "jets/one_jet.hpp"
#include "jets/tables/density_on_table.hpp"
#include "lattice/index.hpp"

namespace delf {
namespace {

/// It reads traces, and perhaps the field between them: no multipliers, no coefficients.
bool joins_traces(const LatticeSystem& system, const StencilFamily& family) {
  bool any = false;
  for (const VertexValue& value : family.values()) {
    const Role role = system.component(value.component).role;
    if (role == Role::trace) any = true;
    else if (role != Role::field) return false;
  }
  return any;
}

/// The fields of the site where they are largest: in the tail of a pulse rounding would be judged.
std::span<const double> largest(std::span<const double> fields, std::size_t d) {
  std::size_t best = 0;
  double most = -1;
  for (std::size_t at = 0; at + d <= fields.size(); at += d) {
    double size = 0;
    for (const double q : fields.subspan(at, d)) size += std::abs(q);
    if (size > most) most = size, best = at;
  }
  return fields.subspan(best, d);
}

/// ∂ℓ/∂q̇ at (q, 0)
std::vector<double> momenta_of(const BatchDensity& density, std::span<const double> q, const Cell& cell) {
  const int d = density.components();
  std::vector<double> jet(q.begin(), q.end());
  jet.resize(density.variables(), 0.0);
  const std::vector<double> g = gradient_at(density, jet, cell.t, cell.x);
  const auto by_rates = g.begin() + static_cast<int>(JetSlot::phi_t) * d;
  return {by_rates, by_rates + d};
}

}  // namespace

std::vector<Check> check_fluxes(const LatticeSystem& system, std::span<const double> fields, double tolerance) {
  std::vector<Check> checks;
  for (const auto& family : system.families()) {
    const DensityOnTable* jets = family->made_of();
    if (!jets || !joins_traces(system, *family)) continue;
    const Cell cell{system.time_step(), system.lattice().space_step(), 0, system.lattice().position(0)};
    const std::span<const double> q = largest(fields, delf::at(jets->density->components()));
    std::vector<double> y, r(delf::at(family->size()));
    for (const VertexValue& value : family->values()) y.push_back(q[system.component(value.component).field]);
    family->residual(cell, y, r);
    std::vector<double> p = momenta_of(*jets->density, q, cell);
    for (double& x : p) x *= cell.space_step;  // a site's share of space
    double scale = 0;
    for (const double x : p) scale = std::max(scale, std::abs(x));
    Check check{.name = "flux consistency", .region = {}, .value = 0, .tolerance = tolerance};
    check.normaliser = scale, check.count = family->size(), check.samples = family->size();
    for (std::size_t n = 0; n < r.size(); ++n) {
      const Component& c = system.component(family->values()[n].component);
      const double of_density = p[c.field];
      double off = std::min(std::abs(r[n] - of_density), std::abs(r[n] + of_density));
      if (c.role == Role::field) off = std::abs(r[n]);
      off /= scale;
      if (n > 0 && off <= check.value) continue;
      check.value = off;
      check.region = fmt::format("a jump that closes at row 0, worst at {}", c.name);
      check.failure = fmt::format(
          "where q- = q+ the momentum of {} is {:.6g}, and that of the density {:.6g} or its negative, or 0 between: "
          "cells and jumps are in different gauges; set scheme.nu = 0",
          c.name, r[n], of_density);
    }
    checks.push_back(std::move(check));
  }
  return checks;
}

}  // namespace delf

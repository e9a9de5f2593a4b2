// SPDX-License-Identifier: MIT
#include "schemes/without_value.hpp"

#include <fmt/format.h>

#include <cmath>

#include "jets/expressions/expression.hpp"
#include "jets/tables/density_on_table.hpp"

namespace delf {
namespace {

/// The jet at a quadrature point of the stencil at (row, cell), in the order of a JetBatch.
std::vector<double> jet_at(const DensityOnTable& jets, const TablePoint& point, const Window& rows, std::int64_t row,
                           int cell, double h, double k) {
  const int d = jets.density->components();
  std::vector<double> jet(jets.density->variables(), 0.0);
  for (int slot = 0; slot < jets.density->slots(); ++slot) {
    const std::size_t s = slot;
    const double scale = std::pow(h, slot_powers[s].time) * std::pow(k, slot_powers[s].space);
    for (const TablePoint::Entry& entry : point.slots[s]) {
      const Site v = jets.table.pattern.vertices[entry.vertex];
      for (int a = 0; a < d; ++a)
        jet[slot * d + a] += entry.weight / scale * rows(row + v.time, cell + v.space, v.node * d + a);
    }
  }
  return jet;
}

}  // namespace

std::string without_value(const LatticeSystem& system, Window rows) {
  if (rows.rows.size() < 2) return {};
  const std::int64_t last = rows.last_row();
  // The row that failed is not held: y + (y − y′) is near it.
  std::vector<double> next = rows.rows.back();
  const std::vector<double>& before = rows.rows[rows.rows.size() - 2];
  for (std::size_t i = 0; i < next.size(); ++i) next[i] += next[i] - before[i];
  rows.rows.push_back(std::move(next));

  const double h = system.time_step(), k = system.lattice().space_step();
  for (std::int64_t row = last - 1; row <= last; ++row)
    for (const auto& family : system.families()) {
      const DensityOnTable* jets = family->made_of();
      const SymbolicDensity* density = jets ? jets->density->formula() : nullptr;
      if (!density) continue;
      for (int cell = 0; cell < system.lattice().sites(); ++cell) {
        if (!system.has_stencil(*family, row, cell)) continue;
        for (const TablePoint& point : jets->table.points) {
          const double t = (static_cast<double>(row) + point.time) * h,
                       x = system.lattice().position(cell) + point.space * k;
          const std::string part = density->without_value(jet_at(*jets, point, rows, row, cell, h, k), t, x);
          if (!part.empty()) return fmt::format("near site {} at t = {:.6g} {}", cell, t, part);
        }
      }
    }
  return {};
}

}  // namespace delf

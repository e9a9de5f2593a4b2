// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "tools/compare/field_error.hpp"

namespace delf {

/// The fields of a row, [i·d + a], and where its sites are; no positions where they rest on the lattice.
struct PlacedRow {
  std::vector<double> fields, positions;
};
/// The newest row, or the one so many rows back, as it is observed.
PlacedRow placed_row(const Simulation&, int back = 0);

/// L∞ and √(Σ δ e²), half of each cell with either end, from a solution at the sites, wherever they are.
FieldError field_error(const PlacedRow&, const State& exact, double t);

/// The fields as piecewise linear functions, at other places.
std::vector<double> linearly_at(const PlacedRow&, const std::vector<double>& places);

}  // namespace delf

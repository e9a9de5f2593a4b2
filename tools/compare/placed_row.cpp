// SPDX-License-Identifier: MIT
#include "tools/compare/placed_row.hpp"

#include <algorithm>
#include <cmath>

#include "lattice/index.hpp"
#include "schemes/stepping/evolution.hpp"
#include "tools/files/row_names.hpp"

namespace delf {

PlacedRow placed_row(const Simulation& simulation, int back) {
  const std::size_t sites = simulation.evolution().system().lattice().sites();
  const std::size_t width = simulation.count(Role::field);
  PlacedRow row;
  row.fields.resize(sites * width);
  simulation.observe(back, row.fields);
  const RowNames names(simulation);
  if (!names.mesh) return row;
  const std::size_t of_role = simulation.count(names.mesh->role);
  std::vector<double> all(sites * of_role);
  simulation.copy_row(back, all, names.mesh->role);
  for (std::size_t i = 0; i < sites; ++i) row.positions.push_back(all[i * of_role + names.mesh->index]);
  if (names.mesh->role != Role::field) return row;
  std::vector<double> fields;  // without the positions, which are one of them
  for (std::size_t n = 0; n < row.fields.size(); ++n)
    if (n % width != names.mesh->index) fields.push_back(row.fields[n]);
  row.fields = std::move(fields);
  return row;
}

FieldError field_error(const PlacedRow& row, const State& exact, double t) {
  const std::size_t d = exact.components();
  std::vector<FieldPoint> there(d);
  FieldError error{0, 0};
  double before = 0;
  for (std::size_t i = 0; i < row.positions.size(); ++i) {
    const double X = row.positions[i];
    exact.at(t, X, there);
    double squares = 0;
    for (std::size_t a = 0; a < d; ++a) {
      const double e = std::abs(row.fields[i * d + a] - there[a].phi);
      if (e > error.linf || std::isnan(e)) error.linf = e;  // a NaN stays
      squares += e * e;
    }
    if (i > 0) error.l2 += 0.5 * (X - row.positions[i - 1]) * (squares + before);
    before = squares;
  }
  error.l2 = std::sqrt(error.l2);
  return error;
}

std::vector<double> linearly_at(const PlacedRow& row, const std::vector<double>& places) {
  const std::size_t n = row.positions.size(), d = row.fields.size() / n;
  std::vector<double> values;
  for (const double x : places) {
    const auto above = std::ranges::upper_bound(row.positions, x) - row.positions.begin();
    const auto right = std::clamp<std::size_t>(at(above), 1, n - 1), left = right - 1;
    const double part = (x - row.positions[left]) / (row.positions[right] - row.positions[left]);
    for (std::size_t a = 0; a < d; ++a)
      values.push_back((1 - part) * row.fields[left * d + a] + part * row.fields[right * d + a]);
  }
  return values;
}

}  // namespace delf

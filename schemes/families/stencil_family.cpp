// SPDX-License-Identifier: MIT
#include "schemes/families/stencil_family.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "lattice/index.hpp"

namespace delf {
namespace {

/// One stencil as a batch: it stands in every lane.
struct Alone {
  std::vector<Pack> y, low;
  Pack x;
  std::array<int, lanes> numbers;
  StencilBatch batch;

  Alone(const Cell& cell, std::span<const double> values, std::span<const double> low_parts = {}) : x(cell.x) {
    for (const double value : values) y.emplace_back(value);
    for (const double part : low_parts) low.emplace_back(part);
    batch = {cell, lanes, reinterpret_cast<const double*>(&x), reinterpret_cast<const double*>(y.data())};
    numbers.fill(cell.stencil);
    batch.numbers = numbers.data();
    if (!low.empty()) batch.low = reinterpret_cast<const double*>(low.data());
  }
};

std::vector<int> numbers_to(int n) {
  std::vector<int> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

}  // namespace

int SourceTerms::Group::latest_time() const {
  int latest = std::numeric_limits<int>::min();
  for (const QuadratureValue& value : inputs)
    for (const Part& part : value) latest = std::max(latest, part.vertex.time);
  return latest;
}

void StencilFamily::residual(const Cell& cell, std::span<const double> y, std::span<double> r) const {
  const Alone one(cell, y);
  std::vector<Pack> out(y.size());
  residual(one.batch, reinterpret_cast<double*>(out.data()));
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = out[i][0];
}

void StencilFamily::residual(const Cell& cell, std::span<const double> y, std::span<const double> low,
                             std::span<double> r) const {
  if (low.empty() || !reads_low()) return residual(cell, y, r);
  const Alone one(cell, y, low);
  std::vector<Pack> out(y.size());
  residual(one.batch, reinterpret_cast<double*>(out.data()));
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = out[i][0];
}

void StencilFamily::jacobian(const Cell& cell, std::span<const double> y, std::span<double> J) const {
  rows_of_jacobian(numbers_to(size()), cell, y, J);
}

void StencilFamily::jacobian_row(int equation, const Cell& cell, std::span<const double> y, std::span<double> J) const {
  rows_of_jacobian({&equation, 1}, cell, y, J);
}

void StencilFamily::rows_of_jacobian(std::span<const int> equations, const Cell& cell, std::span<const double> y,
                                     std::span<double> J) const {
  const Alone one(cell, y);
  std::vector<Pack> out(equations.size() * y.size());
  jacobian(one.batch, equations, numbers_to(size()), reinterpret_cast<double*>(out.data()));
  for (std::size_t i = 0; i < J.size(); ++i) J[i] = out[i][0];
}

std::optional<double> StencilFamily::lagrangian(const Cell& cell, std::span<const double> y) const {
  const Alone one(cell, y);
  Pack L;
  if (!lagrangian(one.batch, reinterpret_cast<double*>(&L))) return std::nullopt;
  return L[0];
}

void StencilFamily::residual(const StencilBatch& batch, double* r) const { residual(batch, numbers_to(size()), r); }

void StencilFamily::residual(const StencilBatch& batch, std::span<const int> equations, double* r) const {
  const std::size_t size = this->size(), count = at(batch.count);
  std::vector<double> y(size), out(size);
  for (std::size_t s = 0; s < count; ++s) {
    Cell cell = batch.cell;
    cell.x = batch.x[s];
    if (batch.numbers != nullptr) cell.stencil = batch.numbers[s];
    for (std::size_t i = 0; i < size; ++i) y[i] = batch.y[i * count + s];
    residual(cell, y, out);
    for (std::size_t e = 0; e < equations.size(); ++e) r[e * count + s] = out[equations[e]];
  }
}

void StencilFamily::jacobian(const StencilBatch& batch, std::span<const int> equations, std::span<const int> unknowns,
                             double* J) const {
  const std::size_t size = this->size(), count = at(batch.count);
  std::vector<double> y(size), all(size * size);
  for (std::size_t s = 0; s < count; ++s) {
    Cell cell = batch.cell;
    cell.x = batch.x[s];
    if (batch.numbers != nullptr) cell.stencil = batch.numbers[s];
    for (std::size_t i = 0; i < size; ++i) y[i] = batch.y[i * count + s];
    jacobian(cell, y, all);
    for (std::size_t e = 0; e < equations.size(); ++e)
      for (std::size_t u = 0; u < unknowns.size(); ++u)
        J[(e * unknowns.size() + u) * count + s] = all[at(equations[e]) * size + at(unknowns[u])];
  }
}

std::optional<ConstantPart> StencilFamily::constant_part(const Cell&) const { return std::nullopt; }

}  // namespace delf

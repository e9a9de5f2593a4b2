// SPDX-License-Identifier: MIT
#include "schemes/families/stencil_family.hpp"

#include <algorithm>
#include <cmath>

namespace delf {

void StencilFamily::residual(const StencilBatch& batch, double* r) const {
  const auto size = static_cast<std::size_t>(this->size()), count = static_cast<std::size_t>(batch.count);
  std::vector<double> y(size), out(size);
  for (std::size_t s = 0; s < count; ++s) {
    Cell cell = batch.cell;
    cell.x = batch.x[s];
    for (std::size_t i = 0; i < size; ++i) y[i] = batch.y[i * count + s];
    residual(cell, y, out);
    for (std::size_t i = 0; i < size; ++i) r[i * count + s] = out[i];
  }
}

void StencilFamily::jacobian(const StencilBatch& batch, std::span<const int> equations, std::span<const int> unknowns,
                             double* J) const {
  const auto size = static_cast<std::size_t>(this->size()), count = static_cast<std::size_t>(batch.count);
  std::vector<double> y(size), all(size * size);
  for (std::size_t s = 0; s < count; ++s) {
    Cell cell = batch.cell;
    cell.x = batch.x[s];
    for (std::size_t i = 0; i < size; ++i) y[i] = batch.y[i * count + s];
    jacobian(cell, y, all);
    for (std::size_t e = 0; e < equations.size(); ++e)
      for (std::size_t u = 0; u < unknowns.size(); ++u)
        J[(e * unknowns.size() + u) * count + s] =
            all[static_cast<std::size_t>(equations[e]) * size + static_cast<std::size_t>(unknowns[u])];
  }
}

std::optional<ConstantPart> StencilFamily::constant_part(const Cell& cell) const {
  const auto size = static_cast<std::size_t>(this->size());
  ConstantPart part{std::vector<double>(size * size), std::vector<double>(size)};
  if (!constant_jacobian(cell, part.J)) return std::nullopt;
  const std::vector<double> zero(size, 0.0);
  residual(cell, zero, part.r0);
  return part;
}

}  // namespace delf

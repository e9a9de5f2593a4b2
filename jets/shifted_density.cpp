// SPDX-License-Identifier: MIT
#include "jets/shifted_density.hpp"

#include <utility>

#include "jets/simd/scratch_rows.hpp"

namespace delf {

/// The batch moved by c, with zeros where only its first `given` variables are given.
struct ShiftedDensity::Inner {
  Inner(const ShiftedDensity& density, const JetBatch& batch, int given)
      : jet(density.variables(), batch.count), slots(jet.data()) {
    for (int v = 0; v < density.variables(); ++v)
      for (int i = 0; i < batch.count; ++i) jet[v][i] = density.by_[v] + (v < given ? batch.slots[v][i] : 0);
    inner = {batch.count, slots, batch.t, batch.x};
  }
  ScratchRows jet;
  double* const* slots;
  JetBatch inner{};
};

ShiftedDensity::ShiftedDensity(std::shared_ptr<const BatchDensity> of, std::vector<double> by)
    : BatchDensity(*of), of_(std::move(of)), by_(std::move(by)) {
  has_difference_quotient_ = false;
  symmetries_.clear();
  structure_.of_density.even = 0;  // a reflection is one about another jet
  find_constants();
}

void ShiftedDensity::value(const JetBatch& batch, double* l) const {
  of_->value(Inner(*this, batch, variables()).inner, l);
}
void ShiftedDensity::gradient(const JetBatch& batch, double* const* g, double* l) const {
  of_->gradient(Inner(*this, batch, variables()).inner, g, l);
}
void ShiftedDensity::hessian(const JetBatch& batch, double* const* H) const {
  of_->hessian(Inner(*this, batch, variables()).inner, H);
}
void ShiftedDensity::slope(const JetBatch& phi, double* const* g) const {
  const ScratchRows all(variables(), phi.count);
  of_->gradient(Inner(*this, phi, components_).inner, all.data());
  for (int a = 0; a < components_; ++a)
    for (int i = 0; i < phi.count; ++i) g[a][i] = all[a][i];
}
void ShiftedDensity::curvature(const JetBatch& phi, double* const* d) const {
  const int m = variables();
  const ScratchRows H(m * m, phi.count);
  of_->hessian(Inner(*this, phi, components_).inner, H.data());
  for (int a = 0; a < components_; ++a)
    for (int b = 0; b < components_; ++b)
      for (int i = 0; i < phi.count; ++i) d[a * components_ + b][i] = H[a * m + b][i];
}
void ShiftedDensity::place_gradient(const JetBatch& batch, double* l_t, double* l_x) const {
  of_->place_gradient(Inner(*this, batch, variables()).inner, l_t, l_x);
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/complex/constraint_density.hpp"

#include <algorithm>

#include "jets/simd/scratch_rows.hpp"

namespace delf {
namespace {

/// The values of a batch in one block, as families read them.
class Values {
 public:
  Values(const JetBatch& batch, int size)
      : values_(1, size * batch.count), places_(1, batch.count), count_(batch.count) {
    for (int i = 0; i < size; ++i) std::copy_n(batch.slots[i], count_, values_[0] + i * count_);
    std::fill_n(places_[0], count_, 0.0);
  }
  StencilBatch batch() const { return {Cell{1, 1, 0, 0}, count_, places_[0], values_[0]}; }

 private:
  ScratchRows values_, places_;
  int count_;
};

}  // namespace

ConstraintDensity::ConstraintDensity(std::shared_ptr<const StencilFamily> family) : family_(std::move(family)) {
  components_ = family_->size();
  const int m = variables(), multiplier = components_ - 1;
  // ∂²(λG)/∂λ∂λ = 0; of G nothing is known but that it depends on the fields.
  structure_.of_density.depends = (std::uint64_t{1} << components_) - 1;
  for (int a = 0; a < m; ++a) {
    const std::uint64_t fields = (std::uint64_t{1} << multiplier) - 1;
    const std::uint64_t bits = a < multiplier ? structure_.of_density.depends : a == multiplier ? fields : 0;
    structure_.of_density.nonzero[a] = structure_.of_density.varying[a] = bits;
  }
  structure_.nonlinearity = Nonlinearity::values;
  find_constants();
}

void ConstraintDensity::value(const JetBatch& batch, double* l) const {
  const Values values(batch, components_);
  family_->lagrangian(values.batch(), l);
}

void ConstraintDensity::gradient(const JetBatch& batch, double* const* g, double* l) const {
  const Values values(batch, components_);
  const ScratchRows r(1, components_ * batch.count);
  family_->residual(values.batch(), r[0]);
  for (int i = 0; i < components_; ++i) std::copy_n(r[0] + i * batch.count, batch.count, g[i]);
  for (int i = components_; i < variables(); ++i) std::fill_n(g[i], batch.count, 0.0);
  if (l) family_->lagrangian(values.batch(), l);
}

void ConstraintDensity::hessian(const JetBatch& batch, double* const* H) const {
  const Values values(batch, components_);
  const ScratchRows J(1, components_ * components_ * batch.count);
  std::vector<int> all(static_cast<std::size_t>(components_));
  for (int i = 0; i < components_; ++i) all[static_cast<std::size_t>(i)] = i;
  family_->jacobian(values.batch(), all, all, J[0]);
  for (int i = 0; i < variables(); ++i)
    for (int m = 0; m < variables(); ++m) {
      double* const to = H[i * variables() + m];
      if (i < components_ && m < components_) std::copy_n(J[0] + (i * components_ + m) * batch.count, batch.count, to);
      else std::fill_n(to, batch.count, 0.0);
    }
}

void ConstraintDensity::slope(const JetBatch& phi, double* const* g) const {
  const Values values(phi, components_);
  const ScratchRows r(1, components_ * phi.count);
  family_->residual(values.batch(), r[0]);
  for (int i = 0; i < components_; ++i) std::copy_n(r[0] + i * phi.count, phi.count, g[i]);
}

void ConstraintDensity::curvature(const JetBatch& phi, double* const* d) const {
  const Values values(phi, components_);
  const ScratchRows J(1, components_ * components_ * phi.count);
  std::vector<int> all(static_cast<std::size_t>(components_));
  for (int i = 0; i < components_; ++i) all[static_cast<std::size_t>(i)] = i;
  family_->jacobian(values.batch(), all, all, J[0]);
  for (int i = 0; i < components_ * components_; ++i) std::copy_n(J[0] + i * phi.count, phi.count, d[i]);
}

void ConstraintDensity::each(std::span<const double> fields, const Use& use) const {
  constexpr int most = 64;
  const auto d = static_cast<std::size_t>(components_ - 1);
  const ScratchRows y(components_, most), g(variables(), most);
  std::vector<double> slopes(d);
  const std::size_t sites = fields.size() / d;
  for (std::size_t first = 0; first < sites; first += most) {
    const std::size_t count = std::min<std::size_t>(most, sites - first);
    for (std::size_t s = 0; s < most; ++s) {
      const std::size_t site = first + std::min(s, count - 1);
      for (std::size_t a = 0; a < d; ++a) y[static_cast<int>(a)][s] = fields[site * d + a];
      y[components_ - 1][s] = 1;  // ∂(λG)/∂φ is ∂G/∂φ then
    }
    gradient({most, y.data(), 0, nullptr}, g.data());
    for (std::size_t s = 0; s < count; ++s) {
      for (std::size_t a = 0; a < d; ++a) slopes[a] = g[static_cast<int>(a)][s];
      use(first + s, g[components_ - 1][s], slopes);
    }
  }
}

void ConstraintDensity::place_gradient(const JetBatch& batch, double* l_t, double* l_x) const {
  std::fill_n(l_t, batch.count, 0.0);
  std::fill_n(l_x, batch.count, 0.0);
}

}  // namespace delf

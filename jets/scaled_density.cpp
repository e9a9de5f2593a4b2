// SPDX-License-Identifier: MIT
#include "jets/scaled_density.hpp"

#include <utility>
#include <vector>

#include "jets/simd/pack.hpp"
#include "jets/simd/scratch_rows.hpp"
#include "lattice/error.hpp"

namespace delf {

ScaledDensity::ScaledDensity(std::shared_ptr<const BatchDensity> of, double c, double s)
    : of_(std::move(of)), scale_(s), factors_{1 / s, 1 / s, c / s, 1 / s, c / s, c * c / s} {
  if (of_->is_placed())
    throw BadInput(
        "theory.speed",
        "theory.speed, theory.scale: the density depends on t or x, whose units it has; write other ones into "
        "theory.density");
  components_ = of_->components(), slots_ = of_->slots();
  has_difference_quotient_ = of_->has_difference_quotient();
  structure_.nonlinearity = of_->nonlinearity();
  Abstract& known = structure_.of_density;
  known.constant.reset();
  for (int r = 0; r <= static_cast<int>(Reflection::in_time); ++r)
    if (of_->is_even(static_cast<Reflection>(r))) known.even |= static_cast<std::uint8_t>(1u << r);
  for (int a = 0; a < variables(); ++a) {
    if (of_->depends_on(a)) known.depends |= std::uint64_t{1} << a;
    for (int b = 0; b < variables(); ++b) {
      if (!of_->is_zero(a, b)) known.nonzero[a] |= std::uint64_t{1} << b;
      if (!of_->is_constant(a, b)) known.varying[a] |= std::uint64_t{1} << b;
    }
  }
  // ξ(y) = A y + b of y is s ξ(φ/s) of φ = s y
  symmetries_ = of_->symmetries();
  for (LinearSymmetry& symmetry : symmetries_)
    for (double& b : symmetry.shift) b *= s;
  find_constants();
}

/// The batch in the units of ℓ: the first `rows` variables.
struct ScaledDensity::Inner {
  Inner(const ScaledDensity& density, const JetBatch& batch, int rows) : jet(rows, batch.count), slots(jet.data()) {
    for (int v = 0; v < rows; ++v)
      for (int i = 0; i < batch.count; ++i) jet[v][i] = density.factor(v) * batch.slots[v][i];
    inner = {batch.count, slots, batch.t, batch.x};
  }
  ScratchRows jet;
  double* const* slots;
  JetBatch inner{};
};

namespace {

void multiply(double* values, int count, double by) {
  for (int i = 0; i < count; ++i) values[i] *= by;
}

}  // namespace

void ScaledDensity::value(const JetBatch& batch, double* l) const {
  of_->value(Inner(*this, batch, variables()).inner, l);
  multiply(l, batch.count, scale_ * scale_);
}

void ScaledDensity::gradient(const JetBatch& batch, double* const* g, double* l) const {
  of_->gradient(Inner(*this, batch, variables()).inner, g, l);
  for (int v = 0; v < variables(); ++v) multiply(g[v], batch.count, scale_ * scale_ * factor(v));
  if (l) multiply(l, batch.count, scale_ * scale_);
}

void ScaledDensity::hessian(const JetBatch& batch, double* const* H) const {
  const int m = variables();
  of_->hessian(Inner(*this, batch, m).inner, H);
  for (int a = 0; a < m; ++a)
    for (int b = 0; b < m; ++b) multiply(H[a * m + b], batch.count, scale_ * scale_ * factor(a) * factor(b));
}

// φ alone: s² · 1/s and s² · 1/s².
void ScaledDensity::slope(const JetBatch& phi, double* const* g) const {
  of_->slope(Inner(*this, phi, components_).inner, g);
  for (int a = 0; a < components_; ++a) multiply(g[a], phi.count, scale_);
}
void ScaledDensity::curvature(const JetBatch& phi, double* const* d) const {
  of_->curvature(Inner(*this, phi, components_).inner, d);
}

void ScaledDensity::place_gradient(const JetBatch& batch, double* l_t, double* l_x) const {
  of_->place_gradient(Inner(*this, batch, variables()).inner, l_t, l_x);
  for (double* l : {l_t, l_x}) multiply(l, batch.count, scale_ * scale_);
}

// (s²N(a/s) − s²N(b/s))/(a − b) is s times that of N at a/s and b/s; a and b are 2d values, all scaled as φ.
void ScaledDensity::difference_quotient(const JetBatch& ab, double* const* q) const {
  ScratchRows values(2 * components_, ab.count);
  for (int v = 0; v < 2 * components_; ++v)
    for (int i = 0; i < ab.count; ++i) values[v][i] = ab.slots[v][i] / scale_;
  of_->difference_quotient({ab.count, values.data(), ab.t, ab.x}, q);
  for (int a = 0; a < components_; ++a) multiply(q[a], ab.count, scale_);
}
void ScaledDensity::differentiate_quotient(const JetBatch& ab, double* const* d) const {
  ScratchRows values(2 * components_, ab.count);
  for (int v = 0; v < 2 * components_; ++v)
    for (int i = 0; i < ab.count; ++i) values[v][i] = ab.slots[v][i] / scale_;
  of_->differentiate_quotient({ab.count, values.data(), ab.t, ab.x}, d);
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/families/residual_family.hpp"

#include <algorithm>

#include "jets/simd/scratch_rows.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"

namespace delf {
ResidualFamily::ResidualFamily(DirectResidual stencil, std::shared_ptr<const BatchDensity> density)
    : StencilFamily(stencil.pattern, values_at_every_vertex(stencil.pattern, density->components()), false),
      stencil_(std::move(stencil)),
      density_(std::move(density)),
      d_(density_->components()) {
  if (!density_->has_difference_quotient())
    throw BadInput("theory.name", "a comparator needs a density that declares a difference quotient of its potential");
  if (is_linear()) return;
  const auto vertex = [this](int l) { return pattern_.vertices[l]; };
  // Q of the first pair; the others are that of the stencil that is anchored where they have moved to.
  const DirectResidual::Quotient& first = stencil_.quotients[0];
  SourceTerms::Group group;
  for (const int l : {first.above, first.below})
    for (int a = 0; a < d_; ++a) group.inputs.push_back({{vertex(l), a, 1.0}});
  sources_.groups = {std::move(group)};
  sources_.outputs_per_group = d_;
  sources_.weights.assign(d_ * size(), 0.0);
  for (const DirectResidual::Quotient& q : stencil_.quotients) {
    const Site of = vertex(stencil_.centre) - (vertex(q.above) - vertex(first.above));
    const auto l = std::ranges::find(pattern_.vertices, of) - pattern_.vertices.begin();
    for (int a = 0; a < d_; ++a) sources_.weights[at(a * size()) + at(static_cast<int>(l) * d_ + a)] += q.weight;
  }
}

double ResidualFamily::linear(const Cell& cell, int l) const {
  const double h = cell.time_step, k = cell.space_step;
  const double by_t = stencil_.by_t.empty() ? 0 : stencil_.by_t[l];
  return stencil_.by_xx[l] * h / k - stencil_.by_tt[l] * k / h + by_t * k;
}

void ResidualFamily::residual(const StencilBatch& batch, std::span<const int> equations, double* r) const {
  const int n = batch.count;
  const double hk = batch.cell.time_step * batch.cell.space_step;
  const ScratchRows q(d_, n), sums(d_, n);
  std::vector<const double*> inputs(2 * d_);
  double* const E = sums[0];
  std::fill_n(E, d_ * n, 0.0);
  for (int l = 0; l < pattern_.size(); ++l)
    if (const double w = linear(batch.cell, l); w != 0)
      for (int i = 0; i < d_ * n; ++i) E[i] += w * batch.y[static_cast<std::ptrdiff_t>(l * d_) * n + i];
  for (const DirectResidual::Quotient& quotient : stencil_.quotients) {
    for (int a = 0; a < d_; ++a) {
      inputs[a] = batch.y + static_cast<std::ptrdiff_t>(quotient.above * d_ + a) * n;
      inputs[d_ + a] = batch.y + static_cast<std::ptrdiff_t>(quotient.below * d_ + a) * n;
    }
    density_->difference_quotient({n, inputs.data()}, q.data());
    for (int a = 0; a < d_; ++a)
      for (int i = 0; i < n; ++i) E[a * n + i] += hk * quotient.weight * q[a][i];
  }
  for (std::size_t e = 0; e < equations.size(); ++e, r += n) {
    if (equations[e] / d_ == stencil_.centre) std::copy_n(sums[equations[e] % d_], n, r);
    else std::fill_n(r, n, 0.0);
  }
}

void ResidualFamily::jacobian(const StencilBatch& batch, std::span<const int> equations, std::span<const int> unknowns,
                              double* J) const {
  const int n = batch.count;
  const double hk = batch.cell.time_step * batch.cell.space_step;
  const ScratchRows slopes(d_ * 2 * d_, n);
  std::vector<const double*> inputs(2 * d_);
  const auto columns = static_cast<std::ptrdiff_t>(unknowns.size());
  std::fill_n(J, static_cast<std::ptrdiff_t>(equations.size()) * columns * n, 0.0);
  // The entries of J that are asked for, as E of component a has them for value l·d + b.
  const auto for_each_entry = [&](const auto& visit) {
    for (std::size_t e = 0; e < equations.size(); ++e)
      for (std::size_t u = 0; u < unknowns.size(); ++u)
        if (equations[e] / d_ == stencil_.centre)
          visit(J + (static_cast<std::ptrdiff_t>(e) * columns + static_cast<std::ptrdiff_t>(u)) * n, equations[e] % d_,
                unknowns[u] / d_, unknowns[u] % d_);
  };
  for_each_entry([&](double* to, int a, int l, int b) {
    if (a == b) std::fill_n(to, n, linear(batch.cell, l));
  });
  for (const DirectResidual::Quotient& quotient : stencil_.quotients) {
    for (int a = 0; a < d_; ++a) {
      inputs[a] = batch.y + static_cast<std::ptrdiff_t>(quotient.above * d_ + a) * n;
      inputs[d_ + a] = batch.y + static_cast<std::ptrdiff_t>(quotient.below * d_ + a) * n;
    }
    density_->differentiate_quotient({n, inputs.data()}, slopes.data());
    for_each_entry([&](double* to, int a, int l, int b) {
      for (const auto& [vertex, input] : {std::pair{quotient.above, b}, {quotient.below, d_ + b}})
        if (l == vertex)
          for (int i = 0; i < n; ++i) to[i] += hk * quotient.weight * slopes[a * 2 * d_ + input][i];
    });
  }
}

/// Difference quotients of a quadratic ℓ are linear.
std::optional<ConstantPart> ResidualFamily::constant_part(const Cell& cell) const {
  ConstantPart part{std::vector<double>(size() * size(), 0.0), std::vector<double>(size(), 0.0), is_linear()};
  if (is_linear()) {
    const std::vector<double> zero(size(), 0.0);
    residual(cell, zero, part.r0);
    jacobian(cell, zero, part.J);
    return part;
  }
  for (int l = 0; l < pattern_.size(); ++l)
    for (int a = 0; a < d_; ++a) part.J[(stencil_.centre * d_ + a) * size() + l * d_ + a] = linear(cell, l);
  return part;
}

void ResidualFamily::evaluate_sources(int, const JetBatch& inputs, double* const* g) const {
  density_->difference_quotient(inputs, g);
}
void ResidualFamily::differentiate_sources(int, const JetBatch& inputs, double* const* d) const {
  density_->differentiate_quotient(inputs, d);
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "jets/reparametrised.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include "jets/simd/pack.hpp"
#include "jets/simd/scratch_rows.hpp"
#include "lattice/error.hpp"

namespace delf {
namespace {

/// The jet of ℓ, from that of ℓ̃: (φ, φ_t − φ_x X_t/X_x, φ_x/X_x).
template <class T>
void inner_jet(int d, const auto& outer, std::vector<T>& jet) {
  const int D = d + 1;
  const T &mesh_t = outer(D + d), &mesh_x = outer(2 * D + d);
  for (int a = 0; a < d; ++a) {
    const T slope = outer(2 * D + a) / mesh_x;
    jet[a] = outer(a), jet[d + a] = outer(D + a) - slope * mesh_t, jet[2 * d + a] = slope;
  }
}

}  // namespace

Reparametrised::Reparametrised(std::shared_ptr<const BatchDensity> of, Part part)
    : of_(std::move(of)), part_(part), inner_(of_->variables()) {
  const auto refuse = [](const char* why) {
    throw BadInput("theory.name",
                   std::string("theory.name: sites that move take densities of phi, phi_t and phi_x, and "
                               "this one ") +
                       why + "; use another theory, or scheme.method = multisymplectic");
  };
  if (of_->slots() != 3) refuse("has second derivatives");
  if (of_->is_placed()) refuse("depends on t or x");
  const int d = of_->components(), D = d + 1, m = inner_;
  if (3 * D + 2 > Abstract::most_variables) refuse("has too many fields");
  if (part != Part::whole && !has_parts(*of_)) throw std::logic_error("the density has no parts");
  components_ = D, slots_ = 3;
  if (part == Part::quadratic) {
    form_ = of_->constant_hessian(), g0_ = of_->constant_gradient();
    for (int a = 0; a < d; ++a) {
      g0_[a] = 0;
      for (int b = 0; b < d; ++b) form_[a * m + b] = 0;
    }
  }

  std::vector<Abstract> jet(m);
  inner_jet(
      d, [](int v) { return Abstract::variable(v); }, jet);
  Abstract inner, read;
  for (int v = 0; v < m; ++v)
    if (of_->depends_on(v) && (part == Part::whole || v < d)) read = read + jet[v];
  if (part == Part::quadratic)
    for (int a = 0; a < m; ++a) {
      if (g0_[a] != 0) inner = inner + jet[a];
      for (int b = 0; b < m; ++b)
        if (form_[a * m + b] != 0) inner = inner + jet[a] * jet[b];
    }
  else inner = unknown_function(read);
  structure_ = structure_of(inner * Abstract::variable(2 * D + d), 3 * D, d + 1);
  structure_.nonlinearity = Nonlinearity::all;  // X_x divides, or multiplies
  find_constants();
}

/// ℓ, or its part, at the inner jets of a batch.
struct Reparametrised::Inner {
  Inner(const Reparametrised& density, const JetBatch& batch)
      : of(density), m(density.inner_), jet(m, batch.count), g(m, batch.count), l(1, batch.count) {
    const int d = of.of_->components();
    thread_local std::vector<Pack> one;
    one.resize(m);
    for (int i = 0; i < batch.count; i += lanes) {
      inner_jet(
          d, [&](int v) { return Pack::load(batch.slots[v] + i); }, one);
      for (int v = 0; v < m; ++v) {
        // N(φ) is ℓ at rest
        if (of.part_ == Part::potential && v >= d) one[v] = Pack(0.0);
        one[v].store(jet[v] + i);
      }
    }
    jets = {batch.count, jet.data(), batch.t, batch.x};
  }
  /// ℓ and its gradient.
  void evaluate() {
    const int d = of.of_->components();
    if (of.part_ != Part::quadratic) {
      of.of_->gradient(jets, g.data(), l[0]);
      for (int v = d; v < m && of.part_ == Part::potential; ++v) std::fill_n(g[v], jets.count, 0.0);
      return;
    }
    for (int i = 0; i < jets.count; i += lanes) {
      Pack sum(0.0);
      for (int a = 0; a < m; ++a) {
        Pack row(0.0);
        for (int b = 0; b < m; ++b)
          if (const double w = of.form_[a * m + b]; w != 0) row += w * Pack::load(jet[b] + i);
        const Pack y = Pack::load(jet[a] + i), constant(of.g0_[a]);
        sum += y * (0.5 * row + constant);
        (row + constant).store(g[a] + i);
      }
      sum.store(l[0] + i);
    }
  }
  void hessian(double* const* H) const {
    if (of.part_ == Part::quadratic) {
      for (int v = 0; v < m * m; ++v) std::fill_n(H[v], jets.count, of.form_[v]);
      return;
    }
    of.of_->hessian(jets, H);
    const int d = of.of_->components();
    for (int a = 0; a < m && of.part_ == Part::potential; ++a)
      for (int b = 0; b < m; ++b)
        if (a >= d || b >= d) std::fill_n(H[a * m + b], jets.count, 0.0);
  }

  const Reparametrised& of;
  int m;
  ScratchRows jet, g, l;
  JetBatch jets{};
};

void Reparametrised::value(const JetBatch& batch, double* l) const {
  Inner inner(*this, batch);
  inner.evaluate();
  const int J = 3 * components_ - 1;
  for (int i = 0; i < batch.count; i += lanes)
    (Pack::load(inner.l[0] + i) * Pack::load(batch.slots[J] + i)).store(l + i);
}

/// The chain rule, with g the gradient of ℓ and its jet (φ, τ, χ):
///
///     ∂ℓ̃/∂φ = X_x g_φ,   ∂ℓ̃/∂φ_t = X_x g_τ,   ∂ℓ̃/∂φ_x = g_χ − X_t g_τ,
///     ∂ℓ̃/∂X_t = −Σ φ_x g_τ,   ∂ℓ̃/∂X_x = ℓ − Σ χ (g_χ − X_t g_τ)
void Reparametrised::gradient(const JetBatch& batch, double* const* g, double* l) const {
  Inner inner(*this, batch);
  inner.evaluate();
  const int D = components_, d = D - 1;
  for (int i = 0; i < batch.count; i += lanes) {
    const Pack mesh_t = Pack::load(batch.slots[D + d] + i), mesh_x = Pack::load(batch.slots[2 * D + d] + i);
    const Pack value = Pack::load(inner.l[0] + i);
    Pack by_mesh_t(0.0), by_mesh_x = value;
    for (int a = 0; a < d; ++a) {
      const Pack of_rate = Pack::load(inner.g[d + a] + i);
      const Pack along = Pack::load(inner.g[2 * d + a] + i) - mesh_t * of_rate;
      (mesh_x * Pack::load(inner.g[a] + i)).store(g[a] + i);
      (mesh_x * of_rate).store(g[D + a] + i);
      along.store(g[2 * D + a] + i);
      by_mesh_t = by_mesh_t - Pack::load(batch.slots[2 * D + a] + i) * of_rate;
      by_mesh_x = by_mesh_x - Pack::load(inner.jet[2 * d + a] + i) * along;
    }
    if (part_ == Part::potential) by_mesh_t = Pack(0.0), by_mesh_x = value;
    Pack(0.0).store(g[d] + i), by_mesh_t.store(g[D + d] + i), by_mesh_x.store(g[2 * D + d] + i);
    if (l) (value * mesh_x).store(l + i);
  }
}

/// ∂²ℓ̃/∂u∂v = X_x (z_uᵀ H z_v + g·z_uv) + δ_{u,X_x} g·z_v + δ_{v,X_x} g·z_u, with z(u) the jet of ℓ.
void Reparametrised::hessian(const JetBatch& batch, double* const* H) const {
  Inner inner(*this, batch);
  inner.evaluate();
  const int D = components_, d = D - 1, m = inner_, M = 3 * D, T = D + d, J = 2 * D + d;
  const ScratchRows of_inner(m * m, batch.count);
  inner.hessian(of_inner.data());
  const bool moving = part_ != Part::potential;
  thread_local std::vector<Pack> Z, HZ, out;
  for (int i = 0; i < batch.count; i += lanes) {
    const Pack mesh_t = Pack::load(batch.slots[T] + i), mesh_x = Pack::load(batch.slots[J] + i), per_x = 1.0 / mesh_x;
    const Pack ratio = mesh_t * per_x;
    Z.assign(m * M, Pack(0.0)), HZ.assign(m * M, Pack(0.0)), out.assign(M * M, Pack(0.0));
    const auto entry = [&](int u, int v) -> Pack& { return out[u * M + v]; };
    const auto add = [&](int u, int v, const Pack& x) {
      entry(u, v) = entry(u, v) + x;
      if (u != v) entry(v, u) = entry(v, u) + x;
    };
    for (int a = 0; a < d; ++a) {
      Z[a * M + a] = Pack(1.0);
      if (!moving) continue;
      const Pack slope = Pack::load(inner.jet[2 * d + a] + i);  // φ_x/X_x
      Pack* const rate = &Z[(d + a) * M];
      rate[D + a] = Pack(1.0), rate[2 * D + a] = -ratio, rate[T] = -slope, rate[J] = slope * ratio;
      Pack* const along = &Z[(2 * d + a) * M];
      along[2 * D + a] = per_x, along[J] = -slope * per_x;
      // X_x g·z_uv
      const Pack of_rate = Pack::load(inner.g[d + a] + i), of_slope = Pack::load(inner.g[2 * d + a] + i);
      add(2 * D + a, T, -of_rate);
      add(2 * D + a, J, (of_rate * mesh_t - of_slope) * per_x);
      add(T, J, of_rate * slope);
      add(J, J, 2.0 * slope * (of_slope - of_rate * mesh_t) * per_x);
    }
    for (int a = 0; a < m; ++a)
      for (int b = 0; b < m; ++b) {
        const Pack h = Pack::load(of_inner[a * m + b] + i);
        for (int v = 0; v < M; ++v) HZ[a * M + v] = HZ[a * M + v] + h * Z[b * M + v];
      }
    for (int v = 0; v < M; ++v) {
      Pack along(0.0);  // g·z_v
      for (int a = 0; a < m; ++a) along += Pack::load(inner.g[a] + i) * Z[a * M + v];
      entry(J, v) = entry(J, v) + along, entry(v, J) = entry(v, J) + along;
      for (int u = 0; u < M; ++u) {
        Pack sum(0.0);
        for (int a = 0; a < m; ++a) sum += Z[a * M + u] * HZ[a * M + v];
        entry(u, v) = entry(u, v) + mesh_x * sum;
      }
    }
    for (int v = 0; v < M * M; ++v) out[v].store(H[v] + i);
  }
}

void Reparametrised::slope(const JetBatch&, double* const*) const {
  throw std::logic_error("delf: a density on sites that move has no source terms");
}
void Reparametrised::curvature(const JetBatch&, double* const*) const {
  throw std::logic_error("delf: a density on sites that move has no source terms");
}
void Reparametrised::place_gradient(const JetBatch&, double*, double*) const {
  throw std::logic_error("delf: a density on sites that move does not depend on the place");
}

}  // namespace delf

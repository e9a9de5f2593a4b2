// SPDX-License-Identifier: MIT
#include "jets/force_squared.hpp"

#include <algorithm>
#include <array>

#include "jets/simd/scratch_rows.hpp"
#include "lattice/error.hpp"

namespace delf {
namespace {

constexpr int second = 5;  // the slot of φ_xx

/// The structure of ∂ℓ/∂φᵃ: a function of the values that it depends on, affine where their entries are constant.
Abstract slope_of(const BatchDensity& density, int a) {
  const int d = density.components();
  Abstract slope;
  for (int b = 0; b < d; ++b) {
    if (density.is_zero(a, b)) continue;
    slope = slope + (density.is_constant(a, b) ? Abstract::variable(b) : unknown_function(Abstract::variable(b)));
  }
  // It may be no sum of functions of one value each: nothing proves it.
  if (std::uint64_t all = slope.depends; all != 0)
    for (int b = 0; b < d; ++b)
      if (!density.is_zero(a, b) && !density.is_constant(a, b))
        for (int c = 0; c < d; ++c)
          if (all >> c & 1) {
            slope.nonzero[b] |= std::uint64_t{1} << c, slope.varying[b] |= std::uint64_t{1} << c;
            slope.nonzero[c] |= std::uint64_t{1} << b, slope.varying[c] |= std::uint64_t{1} << b;
          }
  // At another place it may be another one.
  if (density.is_placed()) slope = slope + unknown_function(Abstract::variable(6 * d) + Abstract::variable(6 * d + 1));
  return slope;
}

}  // namespace

ForceSquared::ForceSquared(std::shared_ptr<const BatchDensity> of, double scale)
    : of_(std::move(of)), derivatives_(of_->value_derivatives()), scale_(scale) {
  const int d = of_->components(), m = of_->variables();
  const auto refuse = [](const char* why) {
    throw BadInput("theory.name", std::string("theory.name: a force gradient takes densities that are nonlinear in phi "
                                              "alone, and this one ") +
                                      why + "; use scheme.kernel = b6 or scheme.method = multisymplectic");
  };
  if (of_->slots() != 3) refuse("has second derivatives");
  if (of_->nonlinearity() == Nonlinearity::all) refuse("is nonlinear in its derivatives");
  for (int a = 0; a < d; ++a)
    for (int b = d; b < m; ++b)
      if (!of_->is_zero(a, b)) refuse("has products of phi and its derivatives");
  if (!derivatives_) refuse("does not know its third derivatives");
  components_ = d, slots_ = 6, placed_ = of_->is_placed();
  if (6 * d + 2 > Abstract::most_variables) refuse("has too many fields");
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b) stiffness_.push_back(-of_->constant_hessian()[(2 * d + a) * m + 2 * d + b]);
  Abstract squares;
  for (int a = 0; a < d; ++a) {
    Abstract force = slope_of(*of_, a);
    for (int b = 0; b < d; ++b)
      if (stiffness(a, b) != 0) force = force + Abstract::variable(second * d + b);
    squares = squares + force * force;
  }
  structure_ = structure_of(squares, 6 * d, d);
  symmetries_ = of_->symmetries();
  find_constants();
}

namespace {

/// g from the slopes in g[2d + a] and the curvatures c, for d fields, or for one where that is known when it is compiled: the
/// force of one field stays in a register.
template <int known>
void squares_at_rest(int fields, int count, double twice, const double* stiffness, const double* const* c,
                     const double* const* phi_xx, double* const* g) {
  const int d = known > 0 ? known : fields;
  constexpr std::size_t most = known > 0 ? known : Abstract::most_variables / 6;
  std::array<Pack, most> force;
  for (int at = 0; at < count; at += lanes) {
    for (int a = 0; a < d; ++a) {
      Pack sum = Pack::load(g[2 * d + a] + at);
      for (int b = 0; b < d; ++b) sum += stiffness[a * d + b] * Pack::load(phi_xx[b] + at);
      force[a] = twice * sum;
    }
    for (int a = 0; a < d; ++a) {
      Pack by_phi(0.0), by_phi_xx(0.0);
      for (int b = 0; b < d; ++b) {
        by_phi += Pack::load(c[a * d + b] + at) * force[b];
        by_phi_xx += stiffness[b * d + a] * force[b];
      }
      by_phi.store(g[a] + at), by_phi_xx.store(g[d + a] + at);
    }
  }
}

}  // namespace

void ForceSquared::gradient_at_rest(const JetBatch& phi, const double* const* phi_xx, double* const* g) const {
  const int d = components_;
  const ScratchRows c(d * d, phi.count);
  derivatives_->slope_and_curvature(phi, g + 2 * d, c.data());
  const auto squares = d == 1 ? squares_at_rest<1> : squares_at_rest<0>;
  squares(d, phi.count, 2 * scale_, stiffness_.data(), c.data(), phi_xx, g);
}

void ForceSquared::value(const JetBatch& jets, double* l) const {
  const int d = components_;
  const ScratchRows s(d, jets.count);
  of_->slope(jets, s.data());
  for (int at = 0; at < jets.count; at += lanes) {
    Pack sum(0.0);
    for (int a = 0; a < d; ++a) {
      Pack force = Pack::load(s[a] + at);
      for (int b = 0; b < d; ++b) force += stiffness(a, b) * Pack::load(jets.slots[second * d + b] + at);
      sum += force * force;
    }
    (scale_ * sum).store(l + at);
  }
}

void ForceSquared::gradient(const JetBatch& jets, double* const* g, double* l) const {
  const int d = components_;
  const ScratchRows own(3 * d, jets.count);
  gradient_at_rest(jets, jets.slots + second * d, own.data());
  for (int v = d; v < second * d; ++v) std::fill_n(g[v], jets.count, 0.0);
  for (int a = 0; a < d; ++a) {
    std::copy_n(own[a], jets.count, g[a]);
    std::copy_n(own[d + a], jets.count, g[second * d + a]);
  }
  if (l) value(jets, l);
}

/// ∂²ℓ̃/∂φᵃ∂φᵇ = 2κ Σ_c (F_c,a F_c,b + F_c F_c,ab), and likewise with φ_xx, which F is linear in.
void ForceSquared::hessian(const JetBatch& jets, double* const* H) const {
  const int d = components_, m = variables();
  const ScratchRows s(d, jets.count), c(d * d, jets.count), third(d * d, jets.count);
  derivatives_->slope_and_curvature(jets, s.data(), c.data());
  for (int at = 0; at < jets.count; at += lanes)
    for (int a = 0; a < d; ++a) {
      Pack force = Pack::load(s[a] + at);
      for (int b = 0; b < d; ++b) force += stiffness(a, b) * Pack::load(jets.slots[second * d + b] + at);
      force.store(s[a] + at);
    }
  derivatives_->curvature_along(jets, s.data(), third.data());
  for (int v = 0; v < m * m; ++v) std::fill_n(H[v], jets.count, 0.0);
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b)
      for (int at = 0; at < jets.count; at += lanes) {
        const int xa = second * d + a, xb = second * d + b;
        Pack values = Pack::load(third[a * d + b] + at), mixed(0.0), seconds(0.0);
        for (int e = 0; e < d; ++e) {
          values += Pack::load(c[e * d + a] + at) * Pack::load(c[e * d + b] + at);
          mixed += Pack::load(c[e * d + a] + at) * stiffness(e, b);
          seconds += Pack(stiffness(e, a) * stiffness(e, b));
        }
        (2 * scale_ * values).store(H[a * m + b] + at);
        (2 * scale_ * mixed).store(H[a * m + xb] + at);
        (2 * scale_ * mixed).store(H[xb * m + a] + at);
        (2 * scale_ * seconds).store(H[xa * m + xb] + at);
      }
}

/// At φ_xx = 0.
void ForceSquared::slope(const JetBatch& phi, double* const* g) const {
  const int d = components_;
  const ScratchRows own(3 * d, phi.count), zero(d, phi.count);
  for (int a = 0; a < d; ++a) std::fill_n(zero[a], phi.count, 0.0);
  gradient_at_rest(phi, zero.data(), own.data());
  for (int a = 0; a < d; ++a) std::copy_n(own[a], phi.count, g[a]);
}
void ForceSquared::curvature(const JetBatch& phi, double* const* c) const {
  const int d = components_, m = variables();
  const ScratchRows H(m * m, phi.count), zero(1, phi.count);
  std::fill_n(zero[0], phi.count, 0.0);
  std::vector<const double*> slots(m, zero[0]);
  std::copy_n(phi.slots, d, slots.begin());
  hessian({phi.count, slots.data(), phi.t, phi.x}, H.data());
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b) std::copy_n(H[a * m + b], phi.count, c[a * d + b]);
}

/// Balance laws are those of the theory's own density.
void ForceSquared::place_gradient(const JetBatch&, double*, double*) const {
  throw BadInput("theory.name",
                 "theory.name: how a force gradient depends on the place is not known; use scheme.kernel = b6");
}

}  // namespace delf

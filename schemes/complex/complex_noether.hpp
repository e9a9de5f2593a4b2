// SPDX-License-Identifier: MIT
#pragma once
#include <random>
#include <span>
#include <string>
#include <vector>

#include "jets/symmetry.hpp"
#include "schemes/complex/complex_form.hpp"
#include "schemes/verify/check.hpp"

namespace delf {

/// Noether's theorem on a complex, for symmetries ξ of the fields: they act at every site alike, and not on multipliers.
/// Where the field equations hold in int U,
///
///     Σ_{Δ ⊂ U, Δ ∩ ∂U ≠ ∅} Σ_{l: Δˡ ∈ ∂U} ∂L/∂yˡ · ξ(yˡ) = 0                    Marsden–Patrick–Shkoller (5.7)
///
/// Each ξ is first tried on single stencils at random values: Noether's theorem owes nothing for one that changes L.
class ComplexNoether {
 public:
  /// `forced`: the sums are taken even for what is no symmetry. `wrong_sign`: see ComplexForm.
  ComplexNoether(std::vector<LinearSymmetry>, double tolerance, bool forced, bool wrong_sign = false);

  void look_at(const ComplexSystem&, const ComplexRegion&, std::span<const double> y, const std::string& where,
               std::mt19937_64&);
  std::vector<Check> checks() const;

 private:
  double r_of(const Assembly::Local&, std::size_t i) const;
  Balance invariance(const ComplexSystem&, const LinearSymmetry&, int family, std::mt19937_64&) const;
  Balance sum(const ComplexSystem&, const ComplexRegion&, std::span<const double> y, const LinearSymmetry&) const;
  double rounding(const ComplexSystem&, const ComplexRegion&, std::span<const double> y, const LinearSymmetry&) const;

  std::vector<LinearSymmetry> symmetries_;
  std::vector<Check> invariant_, sums_;
  double tolerance_;
  bool forced_, wrong_sign_;
};

/// ξ_a(φ) = Σ_b A_ab φ_b + b_a at the d values of one site.
inline double generator_at(const LinearSymmetry& symmetry, std::size_t a, const double* phi) {
  const std::size_t d = symmetry.shift.size();
  double xi = symmetry.shift[a];
  for (std::size_t b = 0; b < d; ++b) xi += symmetry.matrix[a * d + b] * phi[b];
  return xi;
}
/// ξ at the values of a stencil of the family, vertex by vertex.
void generator(const ComplexSystem::Family&, const LinearSymmetry&, std::span<const double> y, std::vector<double>& xi);

}  // namespace delf

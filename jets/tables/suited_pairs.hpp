// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

namespace delf {

/// S(θ) = Σ_m m² β_m (2/m²)(1 − cos mθ): what pairs make of θ² = (wave number · k)².
double pair_symbol(const std::vector<double>& pairs, double theta);

/// Weights m² β_m, m = 1 … p, that sum to 1 and suit fields that are analytic in a strip of half-width ρ about the real
/// axis, whose Fourier coefficients fall like e^{−ρθ/k}. With decay = ρ/k they minimise
///
///     max over 0 < θ ≤ π of |S(θ) − θ²| e^{−decay θ}/θ
///
/// by Lawson's reweighted least squares: C. L. Lawson, thesis, UCLA (1961).
std::vector<double> suited_pairs(int p, double decay);
/// The largest weighted defect of these pairs.
double weighted_defect(const std::vector<double>& pairs, double decay);

}  // namespace delf

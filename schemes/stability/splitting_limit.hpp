// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "jets/tables/splitting.hpp"

namespace delf {

/// The trace of one step of a splitting on y″ = −λ y, h = 1, whose squared force is that of y″ = −μ y.
double step_trace(const Splitting&, double lambda, double mu);

/// The largest ωh up to which |trace| ≤ 2 for all that are less.
double frequency_limit(const Splitting&);

/// The limit of h/k for the wave equation, over pairs of these weights, and those of the squared force.
double courant_limit(const Splitting&, const std::vector<double>& pairs, const std::vector<double>& force_pairs,
                     double mass_k = 0);

}  // namespace delf

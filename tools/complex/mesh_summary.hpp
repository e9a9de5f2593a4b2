// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "schemes/complex/complex_solver.hpp"
#include "tools/complex/complex_scene.hpp"
#include "tools/outcome/outcome.hpp"

namespace delf {

/// A mesh, as summary.json and the report name it.
Subject subject_of(const ComplexScene&);

/// From the solution, if there is one: the largest error, and √(Σ A_i e_i²); of sites without masses √(Σ e²/sites).
void measure_error(const ComplexScene&, std::span<const double> values, double t, Outcome&);

/// How many levels of a complex threads share, and why not more; empty if one is asked for.
std::string threads_in_words(const ComplexSolver&, int asked);

/// Σ_i A_i.
double area_of(const CellSpace&);

}  // namespace delf

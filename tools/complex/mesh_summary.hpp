// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "schemes/complex/complex_solver.hpp"
#include "tools/compare/field_error.hpp"
#include "tools/complex/complex_scene.hpp"
#include "tools/outcome/outcome.hpp"

namespace delf {

/// A mesh, as summary.json and the report name it.
Subject subject_of(const ComplexScene&);
/// The scheme of a verification; k is the shortest edge.
std::string scheme_in_words(const ComplexScene&);

/// The largest difference of fields at the same sites, and √(Σ A_i e_i²); of sites without masses √(Σ e²/sites). There may be
/// further sites behind them, of a finer mesh.
FieldError error_on(const ComplexScene&, std::span<const double> values, std::span<const double> others);
/// The error of the fields at a time, if there is a solution.
void measure_error(const ComplexScene&, std::span<const double> values, double t, Outcome&);

/// How many levels of a complex threads share, and why not more; empty if one is asked for.
std::string threads_in_words(const ComplexSolver&, int asked);

/// Σ_i A_i.
double area_of(const CellSpace&);

}  // namespace delf

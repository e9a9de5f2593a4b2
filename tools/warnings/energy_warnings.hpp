// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>

#include "tools/figures/trace.hpp"
#include "tools/outcome/outcome.hpp"

namespace delf {

/// Why a run on a lattice or on a mesh may be wrong, from what is recorded of it: one line, with `remedy`; or nothing.
using Found = std::optional<std::string>;

/// The work of a density that reads t on the field, as far as records show it.
struct KnownWork {
  double work = 0, uncertainty = 0;
};
/// The energy of row 0, or of the last row less that work, is off that of the initial state by more than such a share of
/// it and the uncertainty of the work.
Found energy_off_start(const Outcome&, double energy_of_start, double allowed, const std::string& remedy,
                       const KnownWork& = {});
/// The energy of the last tenth of the run is a fifth of itself away from row 0, all along; or it leaves the band of the
/// first tenth. Other rows may be off its middle by five widths, though not
/// by more than 2.5 % of the energy unless that is within two widths: a run may drift from the beginning. One percent is
/// no reason to warn.
Found energy_off_band(const Trace& energy_errors, const std::string& remedy);
/// The error of the last row is larger than the range of the solution.
Found error_beyond_range(const Outcome&, double range, const std::string& remedy);
/// Where the boundary moves by formulas, fields leave the surface of a constraint by more than rounding; `terms`: Σ |∂G/∂φ φ|.
Found off_constraint(double largest, double terms, double tolerance);
/// A field without a solution to compare with is a hundred times as large as its data.
Found field_beyond_data(double found, double data, const std::string& reason);

}  // namespace delf

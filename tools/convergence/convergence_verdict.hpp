// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>

#include "tools/compare/convergence_table.hpp"
#include "tools/rows/at_the_ends.hpp"

namespace delf {

/// The orders that are asked for.
struct OrderRequest {
  int levels;
  std::optional<double> order;   ///< that must be met
  std::optional<int> of_scheme;  ///< that must not be missed, where no order is given
  double agreement;

  /// An order that is not known, since errors are rounding, misses none but one that is asked for.
  bool met(double measured) const;
};

/// The verdict of a table on the scheme. Errors of the last lines may be those of rounding, of the ends of the lattice,
/// of a formula that is no solution, or of steps that are not stable: then it tells nothing of the scheme's order.
struct ConvergenceVerdict {
  enum Kind { passed, missed, not_measured, unstable };
  Kind kind = passed;
  double order = ConvergenceLevel::unknown;  ///< that was judged
  std::string reason;                        ///< in words; empty if the last two lines speak for themselves
  /// An order that is asked for must be seen.
  bool accepted(const OrderRequest& request) const {
    return kind == passed || (kind == not_measured && !request.order);
  }
};
const char* to_string(ConvergenceVerdict::Kind);

/// `scene` is null for a mesh, of which rounding alone is known.
ConvergenceVerdict judge(const ConvergenceTable&, const OrderRequest&, const Scene* scene);

/// The effect of the ends of the lattice on the state of a scene; nothing where its rows are of a file.
EndChange off_at_ends(const Scene&);

}  // namespace delf

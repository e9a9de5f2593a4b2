// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "schemes/verify/equation_check.hpp"
#include "tools/rows/recorded_section.hpp"

namespace delf {

/// The rows of a solution near another one, read beside it row by row. It must be a solution too: its equations are
/// checked as the rows come.
class NearbyRows {
 public:
  /// Holds `held` rows at once. `equations`: if its equations are to be checked.
  NearbyRows(const std::filesystem::path&, const LatticeSystem&, const std::vector<int>& behind, double time_step,
             double monodromy, int held, std::optional<EquationCheck> equations);

  int rows() const { return section_.rows(); }
  /// Reads row j, which comes after row j − 1.
  void take(std::int64_t j);
  /// Its difference to the rows of a window that ends with the row read last.
  Window difference(const Window&) const;
  /// "field equations of nearby-a.h5"
  std::vector<Check> checks() const;

 private:
  const LatticeSystem& system_;
  std::string name_;
  RecordedSection section_;
  Window held_;
  std::size_t most_;
  std::optional<EquationCheck> equations_;
};

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "schemes/system/lattice_system.hpp"
#include "schemes/verify/check.hpp"

namespace delf {

/// |E| of rows beside the force there: what the equations give of a row that stands still, which for N′ and D² alike is
/// E without its time differences. The terms of E grow as 1/h², and hide a wrong force; this scale does not.
///
///     F(j, i) = E(j, i) of the section that is row j in every row
///
class ForceShare {
 public:
  explicit ForceShare(const LatticeSystem&);

  /// One row of a window that holds the rows that its equations read: E there, and whether |E| relative to its terms is
  /// above a tolerance ([i·C + c]; not a number where there is no equation). Fields alone are looked at.
  void at(const Window&, std::int64_t row, const std::vector<LatticeSystem::Value>& E,
          const std::vector<double>& relative, double tolerance);

  /// max|E| / max|F| over all rows and sites; and, where equations fail, the largest max_j|E| / max_j|F| of one site. Of
  /// fields that rest, nothing.
  std::vector<Measured> measured() const;

 private:
  struct Largest {
    double error = 0, force = 0;
    double failed = 0;  ///< of errors above the tolerance
    std::int64_t row = 0;
  };
  const LatticeSystem* system_;
  std::vector<Largest> at_;  ///< [i·C + c]
  std::vector<LatticeSystem::Value> forces_;
  std::int64_t equations_ = 0;
};

}  // namespace delf

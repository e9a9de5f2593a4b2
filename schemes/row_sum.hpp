// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstddef>

#include "schemes/row_layout.hpp"

namespace delf {

/// out += constant + Σ coefficient · row(shifted): many rows summed in one pass, a pack of sites at a time.
class RowSum {
 public:
  void clear() { plain_ = differences_ = alternating_ = 0; }
  /// `shift` in doubles; `alternating` multiplies the signs of sites; `difference`: the row's own site is subtracted.
  void add(const double* row, std::ptrdiff_t shift, double coefficient, double alternating, bool difference);
  /// With `absolute`, also absolute += Σ |coefficient · row|.
  void evaluate(const RowLayout&, double constant, double constant_alternating, const double* signs, double* out,
                double* absolute) const;

 private:
  static constexpr std::size_t most = 96;
  struct Entry {
    const double* row;
    std::ptrdiff_t shift;
    double coefficient, alternating;
    bool difference;
  };
  template <int count>
  static void plain_pass(const RowLayout&, const Entry*, double constant, double* out);
  template <int count>
  static void difference_pass(const RowLayout&, const Entry*, double* out);

  std::array<Entry, most> plain_entries_, difference_entries_, alternating_entries_;
  std::size_t plain_ = 0, differences_ = 0, alternating_ = 0;
};

}  // namespace delf

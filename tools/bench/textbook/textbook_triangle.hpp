// SPDX-License-Identifier: MIT
#pragma once
#include "tools/bench/textbook/textbook.hpp"
#include "tools/bench/textbook/textbook_fixed_point.hpp"
#include "tools/bench/textbook/textbook_rows.hpp"

namespace delf::bench {

/// Marsden–Patrick–Shkoller (5.8): ∂²_h y/h² − ∂²_k y/k² + ⅓ Σ sin(mean of the three corners) over the three triangles
/// (i, j), (i, j+1), (i+1, j+1) that meet in a site. One of them reaches the unknown row; the matrix is diagonal.
class TextbookTriangle final : public Textbook {
 public:
  TextbookTriangle(int sites, double length, double time_step, double tolerance);
  void start(std::span<const double> row0, std::span<const double> row1) override;
  void step() override;
  std::span<const double> row() const override { return rows_.newest(); }
  long iterations() const override { return fixed_point_.passes(); }

 private:
  double squared_ratio_, third_;  ///< (h/k)², h²/3
  PastRows rows_;
  FixedPoint fixed_point_;
  CircleRow below_, above_;  ///< sines of the triangles anchored in the row before the newest, and in the newest
  std::vector<double> known_;
};

}  // namespace delf::bench

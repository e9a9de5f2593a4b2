// SPDX-License-Identifier: MIT
#pragma once
#include "tools/bench/textbook/textbook.hpp"
#include "tools/bench/textbook/textbook_cyclic_thomas.hpp"
#include "tools/bench/textbook/textbook_fixed_point.hpp"
#include "tools/bench/textbook/textbook_rows.hpp"
#include "tools/bench/textbook/textbook_wave_part.hpp"

namespace delf::bench {

/// The brick wall of jets/tables/hexagon_jet.hpp: every vertical edge has weight 1 in the sum of its bricks, and so has
/// every pair of horizontal ones, which is the wave part of (5.10); and ⅓ Σ sin(mean of six) over the three bricks that
/// meet in a site. With bricks anchored where i + j is even these are, for (j, i) even, i and i−2 of row j and i−1 of
/// row j−1; for (j, i) odd, i−1 of row j and i, i−2 of row j−1. N even.
class TextbookHexagon final : public Textbook {
 public:
  TextbookHexagon(int sites, double length, double time_step, double tolerance);
  void start(std::span<const double> row0, std::span<const double> row1) override;
  void step() override;
  std::span<const double> row() const override { return rows_.newest(); }
  long iterations() const override { return fixed_point_.passes(); }

 private:
  /// Sines of the bricks anchored at first, first + 2, … of the row `lower`.
  static void find_sines(const double* lower, const double* upper, int first, int sites, CircleRow& sines);

  WavePart wave_;
  PastRows rows_;
  CyclicThomas matrix_;
  FixedPoint fixed_point_;
  CircleRow below_, above_;
  std::vector<double> known_, x_;
  int parity_ = 1;  ///< of the newest row
};

}  // namespace delf::bench

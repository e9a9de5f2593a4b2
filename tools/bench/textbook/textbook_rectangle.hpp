// SPDX-License-Identifier: MIT
#pragma once
#include "tools/bench/textbook/textbook.hpp"
#include "tools/bench/textbook/textbook_cyclic_thomas.hpp"
#include "tools/bench/textbook/textbook_fixed_point.hpp"
#include "tools/bench/textbook/textbook_rows.hpp"
#include "tools/bench/textbook/textbook_wave_part.hpp"

namespace delf::bench {

/// Marsden–Patrick–Shkoller (5.12) and (5.10): the wave part, and ¼ Σ sin(mean of the four corners) over the four cells
/// that meet in a site.
class TextbookRectangle : public Textbook {
 public:
  TextbookRectangle(int sites, WavePart, double tolerance);
  void start(std::span<const double> row0, std::span<const double> row1) override;
  void step() override;
  std::span<const double> row() const override { return rows_.newest(); }
  long iterations() const override { return fixed_point_.passes(); }

 private:
  static void find_sines(const double* lower, const double* upper, int sites, CircleRow& sines);

  WavePart wave_;
  PastRows rows_;
  CyclicThomas matrix_;
  FixedPoint fixed_point_;
  CircleRow below_, above_;  ///< sines of the cells (i, i+1) below and above the newest row
  std::vector<double> known_, x_;
};

struct TextbookSymmetricRectangle final : TextbookRectangle {
  TextbookSymmetricRectangle(int N, double L, double h, double tolerance)
      : TextbookRectangle(N, WavePart::symmetric(h, L / N), tolerance) {}
};
struct TextbookPlainRectangle final : TextbookRectangle {
  TextbookPlainRectangle(int N, double L, double h, double tolerance)
      : TextbookRectangle(N, WavePart::rectangle(h, L / N), tolerance) {}
};

}  // namespace delf::bench

// SPDX-License-Identifier: MIT
#pragma once
#include "tools/bench/textbook/textbook.hpp"
#include "tools/bench/textbook/textbook_cyclic_thomas.hpp"
#include "tools/bench/textbook/textbook_fixed_point.hpp"
#include "tools/bench/textbook/textbook_rows.hpp"
#include "tools/bench/textbook/textbook_wave_part.hpp"

namespace delf::bench {

/// Marsden–Patrick–Shkoller (5.14), the scheme of Vu-Quoc and Li: the wave part of (5.10), and
/// ½(q(y_{n+1}, y_n) + q(y_n, y_{n−1})) with the quotient q of textbook_quotient.hpp.
class TextbookVuQuocLi final : public Textbook {
 public:
  TextbookVuQuocLi(int sites, double length, double time_step, double tolerance);
  void start(std::span<const double> row0, std::span<const double> row1) override;
  void step() override;
  std::span<const double> row() const override { return rows_.newest(); }
  long iterations() const override { return fixed_point_.passes(); }

 private:
  WavePart wave_;
  PastRows rows_;
  CyclicThomas matrix_;
  FixedPoint fixed_point_;
  std::vector<double> quotients_;  ///< q(y_n, y_{n−1}), then q(y_{n+1}, y_n)
  std::vector<double> known_, x_;
};

}  // namespace delf::bench

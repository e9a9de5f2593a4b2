// SPDX-License-Identifier: MIT
#pragma once
#include "tools/bench/textbook/textbook.hpp"
#include "tools/bench/textbook/textbook_fixed_point.hpp"
#include "tools/bench/textbook/textbook_rows.hpp"

namespace delf::bench {

/// Marsden–Patrick–Shkoller (5.15), the scheme of Guo, Pascual, Rodriguez and Vázquez, with the quotient q of
/// textbook_quotient.hpp; nothing of it can be kept for the next step:
///
///     ∂²_h y/h² − ∂²_k y/k² + q(y_{n+1}, y_{n−1}) = 0
class TextbookGuo final : public Textbook {
 public:
  TextbookGuo(int sites, double length, double time_step, double tolerance);
  void start(std::span<const double> row0, std::span<const double> row1) override;
  void step() override;
  std::span<const double> row() const override { return rows_.newest(); }
  long iterations() const override { return fixed_point_.passes(); }

 private:
  double squared_ratio_, squared_step_;  ///< (h/k)², h²
  PastRows rows_;
  FixedPoint fixed_point_;
  std::vector<double> known_;
};

}  // namespace delf::bench

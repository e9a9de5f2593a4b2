// SPDX-License-Identifier: MIT
#pragma once
#include "lattice/index.hpp"
#include "tools/bench/textbook/textbook.hpp"
#include "tools/bench/textbook/textbook_rows.hpp"

namespace delf::bench {

/// Footnote 3 of Marsden–Patrick–Shkoller, φ at the first vertex of the triangle, which is leapfrog:
///
///     y_{n+1} = 2y_n − y_{n−1} + (h/k)² ∂²_k y_n − h² sin y_n
class TextbookExplicit final : public Textbook {
 public:
  TextbookExplicit(int sites, double length, double time_step, double tolerance);
  void start(std::span<const double> row0, std::span<const double> row1) override;
  void step() override;
  std::span<const double> row() const override { return {newest_.data(), at(sites_)}; }

 private:
  int sites_;
  double squared_ratio_, squared_step_;  ///< (h/k)², h²
  CircleRow newest_, older_;
};

}  // namespace delf::bench

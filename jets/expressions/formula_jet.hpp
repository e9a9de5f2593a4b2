// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace delf {

/// A formula of t and x with all its derivatives up to an order.
class FormulaJet {
 public:
  /// Throws BadInput for `key`, and TooLarge.
  FormulaJet(std::string_view text, const std::vector<std::pair<std::string, double>>& parameters,
             const std::string& key, int order);
  ~FormulaJet();
  FormulaJet(FormulaJet&&) noexcept;

  /// f, f_t, f_x, f_tt, f_tx, f_xx, … up to the order.
  std::vector<double> operator()(double t, double x) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace delf

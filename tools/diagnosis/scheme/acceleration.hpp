// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "schemes/simulation.hpp"

namespace delf {

/// φ_tt as a function of φ alone, of an explicit scheme that has no term of φ_t but the kinetic one,
///
///     M (y₊ − 2y + y₋)/h² = M a(y).
///
/// A step from two rows that are alike gives it: y₊ = y + h² a(y), with h = 1 here. With it the steps in (φ, φ_t) of other
/// programs are tried.
class Acceleration {
 public:
  /// Nothing for what cannot be built, or has equations of another form.
  static std::optional<Acceleration> of(Problem);

  /// a[i·C + c]; zero at fixed walls.
  std::vector<double> operator()(const std::vector<double>& y) const;
  /// M, [i·C + c]: the momentum ∂L/∂φ_t is M φ_t. At fixed walls that of the sites inside.
  const std::vector<double>& masses() const { return masses_; }

 private:
  explicit Acceleration(const Problem& p) : simulation_(std::make_unique<Simulation>(p)) {}

  std::unique_ptr<Simulation> simulation_;
  std::vector<double> masses_;
};

}  // namespace delf

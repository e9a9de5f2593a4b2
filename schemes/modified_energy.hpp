// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "jets/expressions/modified/modified_lagrangian.hpp"
#include "jets/expressions/tape.hpp"
#include "lattice/lattice.hpp"

namespace delf {

/// Energy and momentum of a modified Lagrangian over two rows of a circle or a point: what a scheme conserves, up to what is
/// beyond the Lagrangian's order. Derivatives in x are central differences of order 16, or less where sites are few.
class ModifiedEnergy {
 public:
  /// φ(x + L) = φ(x) + gain.
  ModifiedEnergy(ModifiedLagrangian, const StencilTable&, int fields, double time_step, const Lattice&, double gain);

  struct Sums {
    double energy, momentum;
  };
  /// Of the fields of a row and the next, [i·d + a], the first at time t.
  Sums of(std::span<const double> earlier, std::span<const double> later, double t) const;

 private:
  void differentiate(const std::vector<double>& row, double gain, std::vector<double>& out) const;
  void take_mean_of_kinds(std::vector<double>& row, double gain) const;

  std::vector<ModifiedLagrangian::OfRows::Input> inputs_;
  expressions::Tape tape_;
  int fields_, sites_, derivatives_ = 0;
  double time_step_, space_step_, gain_;
  bool has_kinds_;
  std::vector<double> slope_, between_;  ///< weights of y_{i+m} − y_{i−m} and of y_{i+2m−1} + y_{i−2m+1}
  std::vector<double> places_;
};

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "tools/compare/field_error.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The solution that last rows are compared with: the state's exact solution, or a row of a much finer run.
class ComparedSolution {
 public:
  /// The exact solution; throws std::logic_error unless has_exact().
  static ComparedSolution exact(const Scene&, double until);
  /// `row` of d fields at the time `until` on a fine lattice, whose fields gain `monodromy` around a circle.
  static ComparedSolution reference(const Lattice& fine, int d, double monodromy, std::vector<double> row);

  bool is_exact() const { return scene_ != nullptr; }
  int components() const { return components_; }
  /// All fields at time t, out[i·d + a]; a reference knows its own time only.
  std::vector<double> at(const Lattice&, double t) const;

 private:
  const Scene* scene_ = nullptr;
  int components_ = 1;
  std::optional<Lattice> fine_;
  double monodromy_ = 0;
  std::vector<double> row_;
};

/// True if the scene's state knows the solution up to that time. Throws BadScene for states that cannot be.
bool has_exact(const Scene&, double until);

/// The centre of the first field's φ_x²; around a circle, the angle of its first Fourier coefficient. Not a number
/// where there is no centre: φ_x² is constant, or zero.
double gradient_centre(const Lattice&, std::span<const double> field, int components, double monodromy);
/// a − b, the shorter way around a circle.
double separation(const Lattice&, double a, double b);

}  // namespace delf

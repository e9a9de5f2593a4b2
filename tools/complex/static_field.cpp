// SPDX-License-Identifier: MIT
#include "tools/complex/static_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lattice/index.hpp"
#include "schemes/complex/spacetime_complex.hpp"
#include "tools/report/interrupt.hpp"

namespace delf {

namespace {

ComplexSystem system_of(const ComplexScene& scene) {
  if (scene.stencils) return spacetime_complex(*scene.stencils, scene.theory->shared_density());
  return mesh_complex(*scene.space);
}

double largest_magnitude(const std::vector<double>& values) {
  double most = 0;
  for (const double y : values) most = std::max(most, std::abs(y));
  return most;
}

}  // namespace

StaticField::StaticField(const ComplexScene& scene)
    : system_(system_of(scene)),
      solver_(system_, {.tolerance = scene.scene.problem.tolerance,
                        .max_iterations = scene.scene.problem.max_iterations,
                        .threads = scene.scene.problem.threads,
                        .is_to_end = Interrupt::asked}),
      y_(scene.values()) {
  const std::size_t d = scene.fields.size();
  const Complex& complex = system_.complex();
  fields_ = y_.size();
  y_.resize(system_.nodes(), 0.0);
  for (std::size_t n = 0; n < fields_; ++n) {
    const auto site = static_cast<int>(n / at(system_.components()));
    if (const auto& f = scene.fields[n % d]; complex.is_unknown(site) && f.exact) {
      const auto& [t, x, y, z] = complex.position(site);
      y_[n] = f.value ? (*f.value)(t, {x, y, z}) : 0.0;
    }
  }
  start_ = y_;
}

double StaticField::energy() const {
  double sum = 0;
  // ℓ(0, 0, 0) is in the gradients too, where it is no energy
  const std::vector<double> zero(y_.size(), 0.0), L = system().lagrangians(y_), L0 = system().lagrangians(zero);
  for (std::size_t s = 0; s < L.size(); ++s)
    sum -= L[s] - (system().family_of(static_cast<int>(s)).vertices() > 1 ? L0[s] : 0);
  return sum;
}

double StaticField::residual() const {
  const double relative = largest_residual(system(), y_);
  constexpr double few = 64 * std::numeric_limits<double>::epsilon();
  if (!(largest_magnitude(y_) <= few * largest_magnitude(start_))) return relative;
  double sum = 0;
  for (const Balance& E : system().residual(y_)) sum = std::max(sum, std::abs(E.sum));
  return std::min(relative, sum / std::ranges::max(system().sizes(start_)));
}

}  // namespace delf

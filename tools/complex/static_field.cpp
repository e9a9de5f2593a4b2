// SPDX-License-Identifier: MIT
#include "tools/complex/static_field.hpp"

namespace delf {

StaticField::StaticField(const ComplexScene& scene)
    : rows_(*scene.space),
      solver_(rows_.system(), {scene.scene.problem.tolerance, scene.scene.problem.max_iterations}),
      y_(scene.values()) {
  const std::size_t d = scene.fields.size();
  const std::vector<Mesh::Point>& points = scene.space->mesh.points;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t a = 0; a < d; ++a)
      if (const auto& f = scene.fields[a]; !scene.space->fixed[i] && f.exact)
        y_[i * d + a] = f.value ? (*f.value)(0, points[i]) : 0.0;
}

double StaticField::energy() const {
  double sum = 0;
  const auto add = [&](double sign) {
    return [&, sign](ComplexSystem::Stencils batch, const double* L) {
      for (std::size_t s = 0; s < batch.size(); ++s)
        if (sign > 0 || system().family_of(batch[s]).vertices() > 1) sum -= sign * L[s];
    };
  };
  const std::vector<double> zero(y_.size(), 0.0);  // ℓ(0, 0, 0) is in the gradients too, where it is no energy
  system().each_lagrangian(system().all_stencils(), y_, add(1));
  system().each_lagrangian(system().all_stencils(), zero, add(-1));
  return sum;
}

double StaticField::residual() const { return largest_residual(system(), y_); }

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/system/conserved.hpp"

#include <algorithm>
#include <cmath>

#include "lattice/error.hpp"
#include "schemes/system/assembly.hpp"

namespace delf {

namespace {

bool is_value_of_field(const Component& c) {
  return c.role == Role::field || c.role == Role::inner || c.role == Role::trace;
}

}  // namespace

void generator(const LatticeSystem& system, const StencilFamily& family, const LinearSymmetry& symmetry,
               std::span<const double> y, std::vector<double>& xi) {
  const auto& values = family.values();
  const std::size_t d = symmetry.shift.size();
  xi.assign(values.size(), 0.0);
  for (std::size_t n = 0; n < values.size(); ++n) {
    const Component& here = system.component(values[n].component);
    const std::size_t a = here.field;
    if (!(is_value_of_field(here) || here.momentum) || a >= d) continue;
    // ξ_a = Σ_b A_ab y_b + b_a; of a momentum −Σ_b A_ba p_b, so that p·(q − q′) stays as it is
    const auto coefficient = [&](std::size_t b) {
      return here.momentum ? -symmetry.matrix[b * d + a] : symmetry.matrix[a * d + b];
    };
    if (!here.momentum) xi[n] = symmetry.shift[a];
    for (std::size_t b = 0; b < d; ++b) {
      if (coefficient(b) == 0) continue;
      // the same node of field b
      const auto found = std::ranges::find_if(values, [&](const VertexValue& value) {
        const Component& there = system.component(value.component);
        return value.vertex == values[n].vertex && there.role == here.role && there.momentum == here.momentum &&
               there.at.time == here.at.time && there.at.space == here.at.space && there.field == static_cast<int>(b) &&
               // q⁻ and q⁺ have the same place
               (here.role != Role::trace || value.component - there.field == values[n].component - here.field);
      });
      if (found == values.end())
        throw BadInput("verify.generator", "a stencil does not read field " + std::to_string(b + 1) + " where " +
                                               here.name + " is and the generator needs it; leave it out");
      xi[n] += coefficient(b) * y[found - values.begin()];
    }
  }
}

double noether_charge(const LatticeSystem& system, const Window& window, std::int64_t cut,
                      const LinearSymmetry& symmetry, double* absolute) {
  const Assembly stencils(system, Assembly::across(system, static_cast<int>(cut & 1), window.monodromy));
  double sum = 0, size = 0;
  std::vector<double> xi;
  stencils.each_residual(SectionRing(window, cut - system.height(), cut + system.height()), cut,
                         [&](const Assembly::Local& at) {
                           generator(system, at.family, symmetry, at.y, xi);
                           for (int n = 0; n < at.family.size(); ++n) {
                             if (at.anchor.site.time + at.family.site(n).time < 0) continue;
                             const double term = at.derivatives[n] * xi[n];
                             sum += term, size += std::abs(term);
                           }
                         });
  if (absolute) *absolute = size;
  return sum;
}

}  // namespace delf

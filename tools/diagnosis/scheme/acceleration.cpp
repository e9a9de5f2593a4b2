// SPDX-License-Identifier: MIT
#include "tools/diagnosis/scheme/acceleration.hpp"

#include <algorithm>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/stepping/evolution.hpp"

namespace delf {

std::optional<Acceleration> Acceleration::of(Problem p) {
  p.time_step = 1;
  try {
    Acceleration a(p);
    const LatticeSystem& system = a.simulation_->evolution().system();
    if (system.height() != 1 || system.placement() != Placement::every_site || system.moves()) return std::nullopt;
    const auto is_field = [](const Component& c) { return c.role == Role::field; };
    if (!std::ranges::all_of(system.all_components(), is_field)) return std::nullopt;
    const int C = system.components(), N = system.lattice().sites();
    a.masses_.resize(N * C);
    const auto at = [&](int i, int c) -> double& { return a.masses_[i * C + c]; };
    // Sites inside are alike.
    for (const int i : {N / 2, 0, N - 1})
      for (int c = 0; c < C; ++c) {
        double M = 0;
        if (system.is_held(i, c)) M = at(N / 2, c);
        else
          // ∂E/∂y₊ = −M/h at the site itself, and nothing else of the rows around
          for (const Coefficient& entry : system.linearised({0, i}, c)) {
            if (entry.offset.time == 0) continue;
            if (entry.offset.space != 0 || entry.component != c || entry.dependence != Dependence::linear)
              return std::nullopt;
            if (entry.offset.time == 1) M = -entry.value;
          }
        if (M == 0) return std::nullopt;
        for (int site = i == N / 2 ? 0 : i; site <= (i == N / 2 ? N - 1 : i); ++site) at(site, c) = M;
      }
    return a;
  } catch (const BadInput&) {
    return std::nullopt;
  }
}

std::vector<double> Acceleration::operator()(const std::vector<double>& y) const {
  simulation_->start({y, y});
  simulation_->step();
  std::vector<double> result(y.size());
  simulation_->copy_row(0, result);
  for (std::size_t n = 0; n < y.size(); ++n) result[n] -= y[n];
  return result;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/verify/first_and_last_step.hpp"

#include <utility>

#include "lattice/index.hpp"
#include "schemes/verify/form_check.hpp"
#include "schemes/verify/tangent.hpp"

namespace delf {

Balance form_of_first_step(const LatticeSystem& given, std::span<const double> times,
                           std::vector<std::vector<double>> y, std::mt19937_64& random, bool fault) {
  const auto system_of_rows = [&] {
    return LatticeSystem(given.lattice(), {given.families().begin(), given.families().end()}, times[1] - times[0],
                         given.all_components());
  };
  const LatticeSystem system = system_of_rows(), first_step = system_of_rows();  // all of its steps are L_1
  system.times()->set({times.begin(), times.end()});
  const Window section = system.window(0, std::move(y), 0);
  Tangent tangent(system, make_plan(system.lattice(), system.pattern()), static_cast<int>(times.size()), 0);
  std::vector<Window> V = tangent.evolve(section, 2, random);
  int free = 0;
  while (system.lattice().is_fixed(free)) ++free;
  if (fault) V[0].rows.back()[at(free * system.components())] += 1e-2;

  const auto on_two_rows = [](Window window, std::size_t first) {
    window.rows = {window.rows[first], window.rows[first + 1]};
    return window;
  };
  Balance change;
  for (const std::size_t first : {times.size() - 2, std::size_t{0}}) {
    // dθ⁺_1 at rows (first, first + 1), as if they were rows 0 and 1
    const Balance here = symplectic_form(first_step, on_two_rows(section, first),
                                         {on_two_rows(V[0], first), on_two_rows(V[1], first)}, 1)
                             .front();
    change.sum += first == 0 ? -here.sum : here.sum;
    change.absolute += here.absolute, change.count += here.count;
  }
  return change;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/complex/first_and_last_step.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/families/mesh_families.hpp"
#include "schemes/methods/mesh_rows.hpp"
#include "schemes/verify/form_check.hpp"
#include "schemes/verify/tangent.hpp"

namespace delf {

Balance form_of_first_step(const CellSpace& space, std::span<const double> times, std::span<const double> y,
                           std::mt19937_64& random, bool fault) {
  const auto mesh = std::make_shared<MeshSpace>(space);
  const auto families = mesh_families(time_of_mesh_rows(), space.density, *mesh);
  const auto system_of_rows = [&] {
    return LatticeSystem(Lattice::on(mesh), families, times[1] - times[0], fields(space.fields()));
  };
  const LatticeSystem system = system_of_rows(), first_step = system_of_rows();  // all of its steps are L_1
  system.times()->set({times.begin(), times.end()});
  std::vector<std::vector<double>> rows;
  const std::size_t of_row = space.fields_of_row();
  for (std::size_t j = 0; j < times.size(); ++j)
    rows.emplace_back(y.begin() + static_cast<std::ptrdiff_t>(j * of_row),
                      y.begin() + static_cast<std::ptrdiff_t>((j + 1) * of_row));
  const Window section = system.window(0, std::move(rows), 0);
  Tangent tangent(system, make_plan(system.lattice(), system.pattern()), static_cast<int>(times.size()), 0);
  std::vector<Window> V = tangent.evolve(section, 2, random);
  if (fault) V[0].rows.back()[at(std::ranges::find(space.fixed, 0) - space.fixed.begin()) * at(space.fields())] += 1e-2;

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

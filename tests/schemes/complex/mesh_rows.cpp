// SPDX-License-Identifier: MIT
#include "tests/schemes/complex/mesh_rows.hpp"

#include <algorithm>

#include "jets/simd/scratch_rows.hpp"
#include "lattice/index.hpp"
#include "schemes/families/mesh_families.hpp"
#include "schemes/methods/mesh_rows.hpp"
#include "schemes/system/conserved.hpp"

namespace delf::testing {
namespace {

std::vector<std::shared_ptr<const StencilFamily>> families_of(const CellSpace& space,
                                                              std::shared_ptr<const StencilFamily> constraint) {
  auto families = mesh_families(time_of_mesh_rows(), space.density, space);
  if (constraint) families.push_back(std::move(constraint));
  return families;
}
std::vector<Component> components_of(const CellSpace& space, bool constrained) {
  std::vector<Component> components = fields(space.fields());
  if (constrained) components.push_back({"lambda", Role::multiplier, {}});
  return components;
}

}  // namespace

MeshRows::MeshRows(const CellSpace& space, double time_step, std::shared_ptr<const StencilFamily> constraint)
    : space_(space),
      h_(time_step),
      evolution_(Lattice::on(std::shared_ptr<const MeshSpace>(std::shared_ptr<const MeshSpace>(), &space)),
                 families_of(space, constraint), time_step, {.steps_vary = true},
                 components_of(space, constraint != nullptr)),
      energy_(space.density, space) {}

void MeshRows::start(std::span<const double> values, std::span<const double> rates, std::optional<double> time_step) {
  const std::size_t C = evolution_.system().components(), d = at(space_.fields());
  std::vector<double> row0(space_.mesh.points.size() * C, 0.0), momenta(row0);
  const ScratchRows jet(space_.density->variables(), lanes), slope(space_.density->variables(), lanes), x(1, lanes);
  for (std::size_t i = 0; i < space_.mesh.points.size(); ++i) {
    for (int v = 0; v < space_.density->variables(); ++v) std::fill_n(jet[v], lanes, 0.0);
    std::fill_n(x[0], lanes, space_.mesh.points[i][0]);
    for (std::size_t a = 0; a < d; ++a) {
      std::fill_n(jet[static_cast<int>(a)], lanes, row0[i * C + a] = values[i * d + a]);
      std::fill_n(jet[static_cast<int>(d + a)], lanes, space_.fixed[i] ? 0 : rates[i * d + a]);
    }
    space_.density->gradient({lanes, jet.data(), 0, x[0]}, slope.data());
    for (std::size_t a = 0; a < d; ++a) momenta[i * C + a] = space_.masses[i] * slope[static_cast<int>(d + a)][0];
  }
  evolution_.system().times()->begin(time_step.value_or(h_));
  evolution_.stepper().start_legendre(row0, momenta);
  read();
}

void MeshRows::step(std::optional<double> time_step) {
  evolution_.system().times()->add(time_step.value_or(h_));
  evolution_.stepper().step(true);
  read();
}

void MeshRows::read() {
  const std::size_t C = evolution_.system().components(), d = at(space_.fields());
  for (const int back : {0, 1}) {
    std::vector<double>& to = back == 0 ? row_ : before_;
    to.clear();
    const std::vector<double> all = evolution_.stepper().row(back);
    for (std::size_t n = 0; n < all.size(); ++n)
      if (n % C < d) to.push_back(all[n]);
  }
}

Balance MeshRows::momentum(const LinearSymmetry& symmetry) const {
  Balance balance;
  balance.sum =
      noether_charge(evolution_.system(), evolution_.stepper().window(2), newest(), symmetry, &balance.absolute);
  return balance;
}

Balance MeshCells::momentum(const LinearSymmetry& symmetry, double t) const {
  const std::vector<double> values = stepper.values(t), momenta = stepper.momenta(t);
  const std::size_t d = symmetry.shift.size();
  Balance balance;
  for (std::size_t n = 0; n < values.size(); ++n)
    balance.add(momenta[n] * generator_at(symmetry, n % d, values.data() + n - n % d));
  return balance;
}

}  // namespace delf::testing

// SPDX-License-Identifier: MIT
#include "schemes/complex/slab_energy.hpp"

#include "jets/tables/named_tables.hpp"
#include "tests/schemes/complex/lattice_complex.hpp"
#include "schemes/complex/refined_piece.hpp"
#include "schemes/stepping/energy.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/complex/stencil_lists.hpp"
#include "tests/schemes/support.hpp"

namespace {

using namespace delf;
using namespace delf::testing;

TEST_CASE("rows of a lattice written as a finite complex have the lattice's energies, whatever the stencil") {
  Problem problem;
  problem.theory = "sine-gordon";
  const auto theory = theory_named(problem);
  const auto density = theory->shared_density();
  for (const NamedTable& named : named_tables()) {
    if (named.is_for_point()) continue;
    for (const bool circle : {true, false}) {
      if (!circle && (named.name == "hexagon" || named.name == "six-tuple" || named.name == "nine-tuple")) continue;
      CAPTURE(named.name, circle);
      const int N = 14, rows = 5;
      const Lattice lattice =
          circle ? Lattice::circle(N, 0.5 * N) : Lattice::interval(N, 0.5 * (N - 1), Wall::fixed, Wall::fixed);
      const double h = 0.4 * lattice.space_step();
      const Evolution evolution(lattice, {theory->variational(named.name)}, h);
      const LatticeComplex whole(lattice, evolution.plan(), named.table, density, h, rows);
      const StencilList list = list_of(whole.system.complex(), named.name, circle ? lattice.length() : 0);
      Random random(3);
      const std::vector<Row> y = random_rows(random, rows + 2 * whole.outer, N, 1.0);
      std::vector<double> values;
      for (const Row& row : y) values.insert(values.end(), row.begin(), row.end());

      const std::vector<SlabEnergy> slabs = slab_energies(list, density, values);
      REQUIRE(slabs.size() + 1 == y.size());
      CellJets jets(*density, lattice, h, 0);
      for (std::size_t j = 0; j < slabs.size(); ++j) {
        const double energy = energy_momentum(*density, lattice, jets, y[j], y[j + 1], 0).energy;
        CHECK(std::abs(slabs[j].energy - energy) < 1e-13 * energy);
        CHECK(slabs[j].time == Approx((static_cast<double>(j) + 1 - whole.outer) * h).margin(1e-13));
      }
    }
  }
}

TEST_CASE("the energy of rows of unequal steps and cells is that of their jets, and other complexes have none") {
  Problem problem;
  problem.theory = "wave";
  const auto density = theory_named(problem)->shared_density();
  const auto energies = [&](const StencilList& list, double a, double b) {
    std::vector<double> y;
    for (const auto& s : list.sites) y.push_back(0.3 + a * s.position[0] - b * s.position[1]);
    return slab_energies(list, density, y);
  };
  StencilList list = bent_rows(7, 4, 0);
  for (auto& site : list.sites) {  // x ↦ x + 0.02 x², later rows farther apart, and the middle site of each moved
    auto& [t, x, y, z] = site.position;
    x += 0.02 * x * x + (x == 1.5 ? 0.1 * t : 0), t += 0.3 * t * t;
  }
  REQUIRE_FALSE(find_fault(list));
  const auto slabs = energies(list, 0.7, 0.4);
  REQUIRE(slabs.size() == 3);
  // (φ_t² + φ_x²)/2 over the length 3 + 0.02·9
  for (const SlabEnergy& slab : slabs) CHECK(slab.energy == Approx(3.18 * (0.49 + 0.16) / 2).epsilon(1e-13));

  CHECK(energies(bent_rows(7, 4), 1, 1).empty());  // bent lines are no rows
  CHECK(energies(refined_piece(6, 1, 9, 3), 1, 1).empty());
  std::ranges::swap(list.sites[8].position, list.sites[9].position);
  CHECK(energies(list, 1, 1).size() == 3);  // rows are sorted by x
  list.sites[9].position[0] += 1e-3;
  CHECK(energies(list, 1, 1).empty());
}

}  // namespace

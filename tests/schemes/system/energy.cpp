// SPDX-License-Identifier: MIT
#include "schemes/system/energy.hpp"

#include "schemes/theories/complex_klein_gordon.hpp"
#include "schemes/theories/phi4.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "schemes/theories/sine_gordon_impurity.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// k times the sum of footnote 4 over the cells, and −k Σ φ_x φ_t on the same jets.
EnergyMomentum footnote_4(const Problem& p, const Row& y0, const Row& y1) {
  const int N = p.lattice.sites(), cells = p.lattice.is_circle() ? N : N - 1;
  const double h = p.time_step, k = p.lattice.space_step();
  const auto potential = [&](double y, double x) {
    const double m2 = p.mass * p.mass, q = (x - p.impurity_position) / p.impurity_width;
    if (p.theory == "klein-gordon") return m2 * y * y / 2;
    if (p.theory == "sine-gordon") return m2 * (1 - std::cos(y));
    if (p.theory == "phi4") return p.lambda * (y * y - 1) * (y * y - 1) / 4;
    if (p.theory == "double-sine-gordon") return m2 * (1 - std::cos(y)) + p.lambda * (1 - std::cos(2 * y)) / 2;
    if (p.theory == "sine-gordon-impurity")
      return m2 * (1 + p.impurity_strength * std::exp(-q * q)) * (1 - std::cos(y));
    return 0.0;
  };
  EnergyMomentum sums;
  for (int i = 0; i < cells; ++i) {
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>((i + 1) % N);
    const double phi_t = (y1[a] - y0[a] + y1[b] - y0[b]) / (2 * h), phi_x = (y0[b] - y0[a] + y1[b] - y1[a]) / (2 * k);
    const double mean = (y0[a] + y0[b] + y1[a] + y1[b]) / 4;
    sums.energy += k * ((phi_t * phi_t + phi_x * phi_x) / 2 + potential(mean, p.lattice.position(i) + k / 2));
    sums.momentum -= k * phi_x * phi_t;
  }
  return sums;
}

}  // namespace

TEST_CASE("energy and momentum of every theory are the sums of footnote 4 over every cell") {
  Random random(81);
  for (const std::string& theory : theory_names())
    for (const Lattice& lattice :
         {Lattice::circle(3, 1), Lattice::circle(37, 10), Lattice::interval(37, 10), Lattice::interval(64, 10)}) {
      CAPTURE(theory, lattice.sites(), lattice.is_circle());
      Problem p = problem_of(theory);
      p.lattice = lattice, p.time_step = 0.1, p.stencil = "triangle";
      Simulation simulation(p);
      const std::vector<Row> rows = random_rows(random, 2, lattice.sites(), 1);
      simulation.start(rows);
      const auto found = simulation.monitors();
      const EnergyMomentum expected = footnote_4(p, rows[0], rows[1]);
      CHECK(std::abs(found.energy - expected.energy) < 1e-13 * expected.energy);
      CHECK(std::abs(found.momentum - expected.momentum) < 1e-13 * expected.energy);
    }
}

TEST_CASE("the sums can be seen to differ: another potential, one cell too few") {
  Random random(82);
  Problem p = problem_of("phi4");
  p.lattice = Lattice::circle(37, 10), p.time_step = 0.1, p.stencil = "triangle";
  Simulation simulation(p);
  const std::vector<Row> rows = random_rows(random, 2, 37, 1);
  simulation.start(rows);
  const double energy = simulation.monitors().energy;
  Problem other = p;
  other.theory = "sine-gordon";
  CHECK(std::abs(energy - footnote_4(other, rows[0], rows[1]).energy) > 1e-3 * energy);
  other = p;
  other.lattice = Lattice::interval(37, 10 * 36. / 37);
  CHECK(std::abs(energy - footnote_4(other, rows[0], rows[1]).energy) > 1e-3 * energy);
}

namespace {

/// Energy and momentum of random rows by the wave form and by differentiation; `wrong` is added to one coefficient.
template <class D>
double difference_of_ways(const D& density, int N, double wrong = 0) {
  constexpr int d = components_of<D>();
  const Lattice ring = Lattice::circle(N, 10);
  const RowLayout layout(ring, 1);
  Random random(5);
  RowBuffer rows(layout, 3 * d), marks(layout, 2);
  std::vector<const double*> values;
  for (int r = 0; r < 3 * d; ++r) values.push_back(rows.row(r));
  for (int a = 0; a < d; ++a) {
    const Row y = random_row(random, N, 2), v = random_row(random, N, 0.1);
    Row y_next;
    for (int i = 0; i < N; ++i) y_next.push_back(y[i] + v[i]);
    layout.scatter(y, rows.row(a)), layout.scatter(y_next, rows.row(d + a)), layout.scatter(v, rows.row(2 * d + a));
  }
  Row x;
  for (int i = 0; i < N; ++i) x.push_back(ring.position(i)), marks.row(0)[layout.slot(i)] = 1;
  layout.scatter(x, marks.row(1));
  const SlabRows slab{&layout, values.data(), marks.row(1), 0.7, 0.05, ring.space_step()};
  auto form = wave_form(density);
  REQUIRE(form);
  form->tension[0] += wrong;
  // Arcs overlap in their last packs: before these every slot is counted.
  const CellWeights weights{marks.row(0), N / lanes > 2 ? N / lanes - 2 : 0};
  const EnergyMomentum plain = energy_momentum<Pack>(density, *form, slab, weights),
                       differentiated = energy_momentum(density, slab, weights);
  const EnergyMomentum near = energy_momentum<ReducedPack>(density, *form, slab, weights);
  CHECK(near.energy == plain.energy);
  CHECK(near.momentum == plain.momentum);
  return (std::abs(plain.energy - differentiated.energy) + std::abs(plain.momentum - differentiated.momentum)) /
         (std::abs(differentiated.energy) + std::abs(differentiated.momentum));
}

/// ½φ_t² − ½φ_x² and one term more.
template <class Term>
struct Waves {
  Term term;
  auto operator()(const auto& j) const { return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) + term(j); }
};
template <class Term>
bool has_wave_form(Term term) {
  return wave_form(Waves<Term>{term}).has_value();
}

}  // namespace

TEST_CASE("energy and momentum are the same by a density's wave form as by differentiation") {
  for (const int N : {3, 8, 17, 25, 37, 64}) {
    CAPTURE(N);
    CHECK(difference_of_ways(SineGordon{1.3}, N) < 1e-14);
    CHECK(difference_of_ways(PhiFour{}, N) < 1e-14);
    CHECK(difference_of_ways(SineGordonImpurity{}, N) < 1e-14);
    CHECK(difference_of_ways(ComplexKleinGordon{}, N) < 1e-14);
    CHECK(difference_of_ways(SineGordon{1.3}, N, 1e-6) > 1e-9);
  }
}

TEST_CASE("a density has a wave form only if its derivatives enter as squares with constant coefficients") {
  CHECK(has_wave_form([](const auto& j) { return sin(j.phi); }));
  CHECK(has_wave_form([](const auto& j) { return -2.0 * j.phi_x * j.phi_x; }));
  CHECK_FALSE(has_wave_form([](const auto& j) { return j.phi_t * j.phi_x; }));
  CHECK_FALSE(has_wave_form([](const auto& j) { return j.phi * j.phi_t; }));
  CHECK_FALSE(has_wave_form([](const auto& j) { return 0.5 * j.phi_x; }));
  CHECK_FALSE(has_wave_form([](const auto& j) { return j.phi_t * j.phi_t * j.phi_t; }));
  CHECK_FALSE(has_wave_form([](const auto& j) { return j.phi * j.phi_t * j.phi_t; }));
}

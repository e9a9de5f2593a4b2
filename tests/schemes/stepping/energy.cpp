// SPDX-License-Identifier: MIT
#include "schemes/stepping/energy.hpp"

#include "lattice/index.hpp"
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
    const auto of = [&](const char* key) { return p.parameters.get<double>(key); };
    const double m2 = of("theory.mass") * of("theory.mass"), lambda = of("theory.lambda");
    const double q = (x - of("theory.position")) / of("theory.width");
    if (p.theory == "klein-gordon") return m2 * y * y / 2;
    if (p.theory == "sine-gordon") return m2 * (1 - std::cos(y));
    if (p.theory == "phi4") return lambda * (y * y - 1) * (y * y - 1) / 4;
    if (p.theory == "double-sine-gordon") return m2 * (1 - std::cos(y)) + lambda * (1 - std::cos(2 * y)) / 2;
    if (p.theory == "sine-gordon-impurity")
      return m2 * (1 + of("theory.strength") * std::exp(-q * q)) * (1 - std::cos(y));
    return 0.0;
  };
  EnergyMomentum sums;
  for (int i = 0; i < cells; ++i) {
    const std::size_t a = i, b = at((i + 1) % N);
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

TEST_CASE("the energy that is observed is of order 2 in h and k, of exact rows too") {
  // a breather ω = 0.6 at rest: E = 16 √(1 − ω²); at t = h/2, away from its turning points
  const auto off_by = [](int sites, double h) {
    Problem p = problem_of("sine-gordon");
    p.parameters["theory.mass"] = 1.0;
    p.lattice = Lattice::circle(sites, 40), p.time_step = h, p.stencil = "triangle-vertex";
    const auto row = [&](double t) {
      Row values;
      for (int i = 0; i < sites; ++i)
        values.push_back(
            4 * std::atan(0.8 / 0.6 * std::sin(0.6 * t + 0.7) / std::cosh(0.8 * (p.lattice.position(i) - 20))));
      return values;
    };
    Simulation simulation(p);
    simulation.start({row(0), row(h)});
    return simulation.monitors().energy - 16 * 0.8;
  };
  CHECK(std::abs(off_by(200, 0.1)) > 1e-4);
  CHECK(std::abs(std::log2(off_by(200, 0.1) / off_by(400, 0.05)) - 2) < 0.1);
}

namespace {

/// H = k Σ (φ_t ∂ℓ/∂φ_t − ℓ) and P = −k Σ φ_x ∂ℓ/∂φ_t of random rows, cell by cell with dual numbers: the largest
/// difference, relative. Cells lie `moved` further.
template <class D>
double difference_of_ways(const D& density, int N, double moved = 0) {
  constexpr int d = components_of<D>();
  const Lattice ring = Lattice::circle(N, 10);
  const RowLayout layout(ring, 1);
  const double t = 0.7, h = 0.05, k = ring.space_step();
  Random random(5);
  RowBuffer rows(layout, 3 * d), marks(layout, 2);
  std::vector<const double*> values;
  for (int r = 0; r < 3 * d; ++r) values.push_back(rows.row(r));
  std::vector<Row> y0, y1;
  for (int a = 0; a < d; ++a) {
    y0.push_back(random_row(random, N, 2)), y1.push_back(y0.back());
    const Row v = random_row(random, N, 0.1);
    for (std::size_t i = 0; i < v.size(); ++i) y1.back()[i] += v[i];
    layout.scatter(y0.back(), rows.row(a)), layout.scatter(y1.back(), rows.row(d + a)),
        layout.scatter(v, rows.row(2 * d + a));
  }
  Row x;
  for (int i = 0; i < N; ++i) x.push_back(ring.position(i)), marks.row(0)[layout.slot(i)] = 1;
  layout.scatter(x, marks.row(1));
  const BatchOf<D> batches(density);
  const EnergyMomentum found = energy_momentum(batches, {&layout, values.data(), marks.row(1), t, h, k}, marks.row(0));
  EnergyMomentum exact;
  for (int i = 0; i < N; ++i) {
    using Number = Dual<double, 3 * d>;
    JetFor<Number, D> j;
    for (int a = 0; a < d; ++a) {
      const auto y = [&](const std::vector<Row>& row, int site) { return row[a][site % N]; };
      const double a00 = y(y0, i), a01 = y(y0, i + 1), a10 = y(y1, i), a11 = y(y1, i + 1);
      component(j.phi, a) = Number::variable((a00 + a01 + a10 + a11) / 4, a);
      component(j.phi_t, a) = Number::variable((a10 - a00 + a11 - a01) / (2 * h), d + a);
      component(j.phi_x, a) = Number::variable((a01 - a00 + a11 - a10) / (2 * k), 2 * d + a);
    }
    if constexpr (is_placed<D>()) j.t = Number(t + h / 2), j.x = Number(ring.position(i) + k / 2 + moved);
    const Number l = density(j);
    exact.energy -= k * l.value;
    for (int a = 0; a < d; ++a) {
      exact.energy += k * component(j.phi_t, a).value * l.d[d + a];
      exact.momentum -= k * component(j.phi_x, a).value * l.d[d + a];
    }
  }
  return (std::abs(found.energy - exact.energy) + std::abs(found.momentum - exact.momentum)) /
         (std::abs(exact.energy) + std::abs(exact.momentum));
}

/// φ_t enters in more than a square, and with φ_x and φ.
struct Mixed {
  auto operator()(const auto& j) const {
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) + 0.1 * (j.phi_t * j.phi_x) +
           0.2 * (j.phi * j.phi_t * j.phi_t) + 0.3 * (j.phi * j.phi_x);
  }
};

}  // namespace

TEST_CASE("energy and momentum of any density are those of its derivatives, cell by cell") {
  for (const int N : {3, 8, 17, 25, 37, 64, 600}) {
    CAPTURE(N);
    CHECK(difference_of_ways(SineGordon{1.3}, N) < 1e-13);
    CHECK(difference_of_ways(PhiFour{}, N) < 1e-13);
    CHECK(difference_of_ways(SineGordonImpurity{}, N) < 1e-13);
    CHECK(difference_of_ways(ComplexKleinGordon{}, N) < 1e-13);
    CHECK(difference_of_ways(Mixed{}, N) < 1e-13);
    CHECK(difference_of_ways(SineGordonImpurity{}, N, 0.1) > 1e-9);
  }
}

// Without a mass matrix there are no velocities to be found: H = p·v − L does not depend on them.
TEST_CASE("the energy of elements for a density linear in velocities is H of the fields") {
  const int N = 30;
  const std::size_t count = N;
  Problem p;
  p.theory = "text", p.lattice = Lattice::circle(N, 15), p.time_step = 0.1;
  p.parameters["theory.fields"] = std::string("a, b");
  p.parameters["theory.density"] = std::string("b*a_t - 0.5*(a^2 + 2*b^2)");
  const auto started = [&](const char* method, Row& row) {
    p.method = method;
    Simulation simulation(p);
    const std::size_t components = simulation.components().size();
    Row row0(count * components, 0.0);
    for (std::size_t i = 0; i < count; ++i)
      row0[i * components] = std::sin(0.3 * static_cast<double>(i)), row0[i * components + 1] = 0.4;
    simulation.start_legendre(row0, Row(row0.size(), 0.0));
    simulation.copy_row(0, row);
    return simulation.monitors().energy;
  };
  Row row(2 * count);
  const double energy = started("radau-iia", row), k = p.lattice.space_step();
  double H = 0;
  for (std::size_t i = 0; i < count; ++i) H += k * (row[2 * i] * row[2 * i] + 2 * row[2 * i + 1] * row[2 * i + 1]) / 2;
  CHECK(std::abs(energy - H) < 1e-13 * H);
  CHECK(std::isfinite(started("spacetime", row)));
}

// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/argument_rows.hpp"

#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double h = 0.2, k = 0.3, t = 1.4;
constexpr int N = 43, halo = 2;

std::optional<Mixture> mixture_of(const std::string& theory, const std::string& scheme, const Lattice& lattice) {
  return Mixture::of(evolution_of(problem_of(theory), scheme, lattice, h).system());
}
std::optional<Mixture> mixture_of(const std::string& scheme) {
  return mixture_of("sine-gordon", scheme, Lattice::circle(N, N * k));
}

/// Rows that are polynomials in time, another at each site, all of them whole numbers.
struct Polynomials {
  Lattice lattice = Lattice::circle(N, N * k);
  RowLayout layout{lattice, halo};
  ArgumentRows rows;
  RowBuffer known{layout, 1}, out{layout, 1};
  std::shared_ptr<const StencilFamily> family = family_of(problem_of("sine-gordon"), "rectangle", h, k);
  int degree;
  std::int64_t newest;

  /// Known are half the numbers 0, 1, 2 in turn, one site further.
  Polynomials(int of_degree, std::int64_t last, int most)
      : rows(layout, {1, {1}, false, 1, 0.5}, most), degree(of_degree), newest(last) {
    for (std::int64_t n = -1; n <= newest; ++n) {
      rows.begin(n);
      if (n < newest) scatter(rows.row(0), [&](int i) { return value(n + 1, i); });
    }
    scatter(known.row(0), [](int i) { return i % 3; });
  }
  double value(std::int64_t n, int i) const {
    double sum = 0, power = 1;
    for (int p = 0; p <= degree; ++p, power *= static_cast<double>(n)) sum += power * (1 + (i + p) % 3);
    return sum;
  }
  void scatter(double* row, const std::function<double(int)>& at) const {
    Row sites;
    for (int i = 0; i < N; ++i) sites.push_back(at(i));
    layout.scatter(sites, row);
  }
  /// The largest difference between the row that an extrapolation of this order finds and the next one.
  double miss(int order) {
    const ArgumentRow& row = rows.argument(known.row(0), t);
    rows.extrapolate(order, 1);
    family->row_kernel()->evaluate_arguments(row, out.row(0), layout.all());
    double worst = 0;
    for (int i = 0; i < N; ++i)
      worst = std::max(worst, std::abs(rows.row(0)[layout.slot(i)] - value(newest + 1, i)));
    return worst;
  }
};

}  // namespace

TEST_CASE("what a stencil looks at in the unknown row, and what is known of it") {
  const auto weights = [](const Mixture& m) { return std::vector<double>(m.weights, m.weights + m.parts); };
  const Lattice even = Lattice::circle(44, 44 * k);
  const std::vector<std::pair<std::string, std::vector<double>>> expected{{"rectangle", {.25, .25}},
                                                                          {"rectangle-symmetric", {.25, .25}},
                                                                          {"triangle", {1. / 3, 1. / 3}},
                                                                          {"hexagon", {1. / 6, 1. / 6, 1. / 6}}};
  for (const auto& [scheme, of_row] : expected) {
    CAPTURE(scheme);
    const auto mixture = mixture_of("sine-gordon", scheme, even);
    REQUIRE(mixture);
    CHECK(weights(*mixture) == of_row);
    CHECK(mixture->is_known_alike == (scheme != "triangle"));
    if (scheme != "triangle") continue;
    CHECK(mixture->known_site == 0);
    CHECK(mixture->known_weight == 1. / 3);
  }
  for (const std::string scheme : {"guo", "vu-quoc-li"}) {  // a pair of values
    CAPTURE(scheme);
    const auto pair = mixture_of(scheme);
    REQUIRE(pair);
    CHECK(weights(*pair) == std::vector<double>{1});
    CHECK_FALSE(pair->is_known_alike);
    CHECK(pair->known_site == 0);
    CHECK(pair->known_row == (scheme == "guo" ? 2 : 1));
  }
  CHECK_FALSE(mixture_of("klein-gordon", "rectangle", even));  // linear
  CHECK_FALSE(mixture_of("coupled-sine-gordon", "rectangle", even));
  CHECK_FALSE(mixture_of("sine-gordon", "rectangle", Lattice::interval(N, N * k)));
  CHECK_FALSE(mixture_of("sine-gordon", "rectangle", Lattice::circle(RowLook::most_parts * lanes - 1, 4)));
  CHECK(mixture_of("sine-gordon", "rectangle", Lattice::circle(RowLook::most_parts * lanes, 4)));
}

TEST_CASE("arguments of order p foretell polynomials of degree p and none above, and the density is taken there") {
  const double m2 = problem_of("sine-gordon").mass * problem_of("sine-gordon").mass;
  for (int degree = 1; degree <= 8; ++degree)
    for (int order = 1; order <= 11; ++order) {
      CAPTURE(degree, order);
      Polynomials rows(degree, 12, 11);
      const double miss = rows.miss(order);
      if (order >= degree) CHECK(miss == 0);
      else CHECK(miss >= 1);
      double worst = 0;
      for (int i = 0; i < N; ++i) {
        const int slot = rows.layout.slot(i);
        const double m = rows.rows.row(0)[slot] + 0.5 * ((i + 1) % N % 3);
        worst = std::max(worst, std::abs(rows.out.row(0)[slot] + m2 * std::sin(m)));
      }
      CHECK(worst < 1e-14);
    }
}

TEST_CASE("near the start the order of an extrapolation is what there are rows for") {
  for (int newest : {1, 2, 3, 6}) {
    CAPTURE(newest);
    CHECK(Polynomials(newest, newest, 7).miss(7) == 0);
    CHECK(Polynomials(newest + 1, newest, 7).miss(7) >= 1);
  }
}

TEST_CASE("arguments found from rows give the outputs that the rows themselves give, for every theory and stencil") {
  int seen = 0;
  std::vector<std::string> schemes = stencil_names();
  for (const std::string comparator : {"guo", "vu-quoc-li"}) schemes.push_back(comparator);
  for (const std::string& theory : theory_names())
    for (const std::string& scheme : schemes) {
      const auto family = family_of(problem_of(theory), scheme, h, k);
      const Lattice ring = Lattice::circle(44, 44 * k);
      const auto mixture = family ? mixture_of(theory, scheme, ring) : std::nullopt;
      // Where nothing is read of the unknown row, steps hold no arguments.
      if (!mixture || family->row_kernel()->outputs_read_until() == 0) continue;
      CAPTURE(theory, scheme);
      ++seen;
      const bool bricks = family->pattern().placement == Placement::brick_wall;
      const RowLayout layout(ring, halo, bricks ? 2 : 1);
      Random random(5);
      const int first_time = std::ranges::min(family->pattern().vertices, {}, &Site::time).time;
      const int unknown = family->row_kernel()->outputs_read_until() - first_time;
      const std::vector<Row> y = random_rows(random, unknown + 1, ring.sites(), 2);
      RowBuffer rows(layout, unknown + 1), positions(layout, 1), expected(layout, 1), found(layout, 1);
      for (int r = 0; r <= unknown; ++r) layout.scatter(y[static_cast<std::size_t>(r)], rows.row(r));
      Row x;
      for (int i = 0; i < ring.sites(); ++i) x.push_back(ring.position(i));
      layout.scatter(x, positions.row(0));
      std::vector<const double*> slab;
      for (int r = 0; r <= unknown; ++r) slab.push_back(rows.row(r));
      double* const out[] = {expected.row(0)};
      ArgumentRows arguments(layout, *mixture, 3);
      for (int r = 0; r <= unknown; ++r) {
        arguments.begin(r - 1);
        CHECK(arguments.find(rows.row(r), layout.all()) > 0.1);
        CHECK(arguments.find(rows.row(r), layout.all()) == 0);
      }
      arguments.begin(unknown - 1);
      arguments.put(positions.row(0), h, k);
      const ArgumentRow& row = arguments.argument(rows.row(unknown - mixture->known_row), t);
      for (int first : {0, 1}) {
        if (first == 1 && !bricks) continue;
        const PackRange packs{first, layout.packs(), bricks ? 2 : 1};
        const RowKernel& kernel = *family->row_kernel();
        kernel.evaluate({&layout, slab.data(), positions.row(0), t, h, k}, out, packs);
        kernel.evaluate_arguments(row, found.row(0), packs);
        double worst = 0, most = 0;
        for (int v = packs.first; v < packs.last; v += packs.stride)
          for (int l = 0; l < lanes; ++l) {
            const auto slot = layout.at(v) + l;
            worst = std::max(worst, std::abs(found.row(0)[slot] - expected.row(0)[slot]));
            most = std::max(most, std::abs(expected.row(0)[slot]));
          }
        CHECK(worst <= 4e-15 * most);
        if (theory != "wave") CHECK(most > 0.1);  // whose quotient is zero
      }
    }
  CHECK(seen > 10);
}

TEST_CASE("steps that extrapolate arguments take one iteration where the field is smooth, bricks or not") {
  for (const std::string scheme : {"rectangle", "triangle", "hexagon"})
    for (int sites : {62, 64, 254}) {
      CAPTURE(scheme, sites);
      Problem p = problem_of("sine-gordon");
      p.stencil = scheme, p.lattice = Lattice::circle(sites, 20), p.time_step = 20. / sites / 16, p.tolerance = 1e-7;
      std::vector<Row> rows(2);
      for (int n = 0; n < 2; ++n)
        for (int i = 0; i < sites; ++i)
          rows[static_cast<std::size_t>(n)].push_back(
              0.3 * std::sin(2 * M_PI * i / sites - 1.24 * n * p.time_step));
      Simulation simulation(p);
      simulation.start(rows);
      int iterations = 0;
      for (int n = 0; n < 120; ++n) {
        simulation.step();
        if (n >= 20) iterations += simulation.iterations();
      }
      CHECK(iterations <= 105);
      CHECK(simulation.residual() < 1e-6);
    }
}

TEST_CASE("steps of arguments solve the equations, in one loop and in several, whatever the order of the seed") {
  for (const std::string scheme : {"triangle", "guo", "vu-quoc-li"})
    for (int packs : {63, 64, 65, 66, 300})
      for (int more : {0, 1, lanes - 1})
        for (const bool smooth : {false, true}) {
          const int sites = (packs - 1) * lanes + 1 + more;
          CAPTURE(scheme, packs, sites, smooth);
          Problem p = problem_of("sine-gordon");
          p.seed_order = 12;  // orders rise from step to step
          Evolution evolution = evolution_of(p, scheme, Lattice::circle(sites, sites * k), 0.1);
          REQUIRE(Mixture::of(evolution.system()));
          Stepper& stepper = evolution.stepper();
          Random random(41);
          std::vector<Row> rows = random_rows(random, 2, sites, 1);
          for (int n = 0; n < 2 && smooth; ++n)
            for (int i = 0; i < sites; ++i)
              rows[static_cast<std::size_t>(n)][static_cast<std::size_t>(i)] = std::sin(2 * M_PI * i / sites - 0.1 * n);
          stepper.start(rows);
          for (int n = 0; n < (smooth ? 14 : 3); ++n) {
            stepper.step();
            CHECK(equation_defect(evolution, window_of(evolution)) < 1e-14);
            CHECK(stepper.residual() < 1e-14);
          }
        }
}

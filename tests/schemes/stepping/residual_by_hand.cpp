// SPDX-License-Identifier: MIT
#include <array>

#include "schemes/scheme.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double k = 0.1, h = 0.05;

/// Two fields, the second four times as heavy: equations of different sizes.
struct Uneven {
  static constexpr int components = 2;
  auto operator()(const auto& j) const {
    return 0.5 * (j.phi_t[0] * j.phi_t[0] - j.phi_x[0] * j.phi_x[0]) +
           2.0 * (j.phi_t[1] * j.phi_t[1] - j.phi_x[1] * j.phi_x[1]) + cos(j.phi[0] + j.phi[1]);
  }
};

/// A scheme with masses m_a and slopes s_a of the potential, which may be sums, by hand:
///     E_a = m_a ((h/k)² (y_{i+1} − 2y_i + y_{i−1}) − (v_{j+1} − v_j)) − h² Σ s_a,        max |E| / max Σ |terms|
double by_hand(const std::vector<double>& mass, const auto& slope, const Row& y, const Row& v, const Row& v_before) {
  const int d = static_cast<int>(mass.size()), N = static_cast<int>(y.size()) / d;
  double worst = 0, size = 0;
  for (int i = 0; i < N; ++i)
    for (int a = 0; a < d; ++a) {
      const auto at = [&](int site) { return static_cast<std::size_t>((site + N) % N * d + a); };
      const double m = mass[static_cast<std::size_t>(a)], courant = h * h / (k * k);
      const double after = m * courant * (y[at(i + 1)] - y[at(i)]), before = m * courant * (y[at(i - 1)] - y[at(i)]),
                   w = m * (v[at(i)] - v_before[at(i)]);
      double sum = after + before - w, absolute = std::abs(after) + std::abs(before) + std::abs(w);
      for (const double s : slope(i, a)) sum -= h * h * s, absolute += std::abs(h * h * s);
      worst = std::max(worst, std::abs(sum));
      size = std::max(size, absolute);
    }
  return worst / size;
}

Row difference(const Row& a, const Row& b) {
  Row result = a;
  for (std::size_t i = 0; i < a.size(); ++i) result[i] -= b[i];
  return result;
}

/// Adds to the newest increment at one site, and to all copies of it.
void plant(const Stepper& stepper, int d, int site, int a, double error) {
  std::vector<const double*> pair(static_cast<std::size_t>(3 * d));
  stepper.newest_pair(pair.data());
  double* const v = const_cast<double*>(pair[static_cast<std::size_t>(2 * d + a)]);
  for (int slot : stepper.layout()->slots_of(site)) v[slot] += error;
}

/// A planted error of the newest increment, as residual() sees it and by hand: at sites and components of all kinds.
template <class D>
void compare(const D& density, const std::vector<double>& mass, const auto& slope_at) {
  const int d = components_of<D>();
  Random random(90);
  for (const int N : {3, 8, 9, 17, 37, 200})
    for (const int site : {0, N / 2, N - 1})
      for (int a = 0; a < d; ++a) {
        CAPTURE(N, site, a);
        Evolution evolution = Scheme{triangle_vertex, density}.on(Lattice::circle(N, N * k), h);
        Stepper& stepper = evolution.stepper();
        stepper.start(random_rows(random, 2, d * N, 1));
        for (int n = 0; n < 3; ++n) stepper.step();
        CHECK(stepper.residual() < 4e-15);
        const Row y = stepper.row(1), v_before = difference(y, stepper.row(2));
        Row v = difference(stepper.row(0), y);
        plant(stepper, d, site, a, 1e-3);
        v[static_cast<std::size_t>(site * d + a)] += 1e-3;
        const auto slope = [&](int i, int b) { return std::array{slope_at(&y[static_cast<std::size_t>(i * d)], b)}; };
        const double found = stepper.residual(), expected = by_hand(mass, slope, y, v, v_before);
        CHECK(found > 1e-6);
        CHECK(std::abs(found - expected) < 1e-9 * expected);
        plant(stepper, d, site, a, std::numeric_limits<double>::quiet_NaN());
        CHECK(std::isnan(stepper.residual()));
      }
}

/// One field of mass 1.3 in rows 0, 1 and 2 (the newest): sin φ at the means of the triangles that touch site i of row 1,
/// one with two vertices in row 2, the others with one; and what (5.15) has in the place of sin φ.
auto slopes_of(const std::string& scheme, const std::array<Row, 3>& rows) {
  return [&, scheme](int i, int) {
    const int N = static_cast<int>(rows[0].size());
    const auto y = [&](int row, int site) {
      return rows[static_cast<std::size_t>(row)][static_cast<std::size_t>((site + N) % N)];
    };
    const double m = 1.69;
    if (scheme == "guo")
      return std::vector{m * (std::cos(y(0, i)) - std::cos(y(2, i))) / (y(2, i) - y(0, i))};
    std::vector<double> thirds;
    for (const double mean : {y(1, i) + y(2, i) + y(2, i + 1), y(0, i) + y(1, i) + y(1, i + 1),
                              y(0, i - 1) + y(1, i - 1) + y(1, i)})
      thirds.push_back(m * std::sin(mean / 3) / 3);
    return thirds;
  };
}

}  // namespace

TEST_CASE("the residual of a step that divides by a number is the scheme's by hand, wherever an error is planted") {
  Random random(91);
  for (const std::string scheme : {"triangle", "guo"})
    for (const double height : {0.0, 4e6})  // beyond which sines are asked how far they are
      for (const int N : {9, 24, 25, 37, 200, 1003})
        for (const int site : {0, N / 2, N - 1}) {
          CAPTURE(scheme, height, N, site);
          Problem p = problem_of("sine-gordon");
          p.mass = 1.3;
          StepOptions options;
          options.tolerance = 1e-13;
          Evolution evolution = evolution_of(p, scheme, Lattice::circle(N, N * k), h, options);
          Stepper& stepper = evolution.stepper();
          std::vector<Row> start = random_rows(random, 2, N, 1);
          for (Row& row : start)
            for (double& y : row) y += height;
          stepper.start(start);
          for (int n = 0; n < 3; ++n) stepper.step();
          CHECK(stepper.residual() < (height > 0 ? 1e-6 : 1e-12));
          const std::array<Row, 3> rows{stepper.row(2), stepper.row(1), stepper.row(0)};
          Row v = difference(rows[2], rows[1]);
          plant(stepper, 1, site, 0, 1e-3);
          v[static_cast<std::size_t>(site)] += 1e-3;
          const double found = stepper.residual(),
                       expected = by_hand({1}, slopes_of(scheme, rows), rows[1], v, difference(rows[1], rows[0]));
          CHECK(found > 1e-4);
          CHECK(std::abs(found - expected) < (height > 0 ? 1e-4 : 1e-9) * expected);
          plant(stepper, 1, site, 0, std::numeric_limits<double>::quiet_NaN());
          CHECK(std::isnan(stepper.residual()));
        }
}

TEST_CASE("the residual of an explicit step is the scheme's by hand, wherever an error is planted") {
  compare(SineGordon{1.3}, {1}, [](const double* y, int) { return 1.69 * std::sin(y[0]); });
}

TEST_CASE("slopes that steps keep for a residual at every step are those that it finds by itself") {
  for (const int N : {9, 37, 200}) {
    CAPTURE(N);
    Random random(7);
    const std::vector<Row> start = random_rows(random, 2, N, 1);
    const auto evolution = [&] {
      Evolution made = Scheme{triangle_vertex, SineGordon{1.3}}.on(Lattice::circle(N, N * k), h);
      made.stepper().start(start);
      return made;
    };
    Evolution watched = evolution();
    watched.stepper().step();
    CHECK(watched.stepper().residual() < 4e-15);
    const std::size_t bytes = watched.stepper().bytes(), row = RowBuffer::bytes_of(watched.stepper().layout()->doubles());
    bool every_step = false;
    for (const int unseen : {1, 0, 0, 1, 5, 0}) {
      every_step = every_step || unseen == 0;
      for (int n = 0; n < unseen; ++n) watched.stepper().step(false);
      watched.stepper().step();
      const double kept = watched.stepper().residual();
      Evolution other = evolution();
      while (other.stepper().newest() < watched.stepper().newest()) other.stepper().step();
      CHECK(kept == other.stepper().residual());
      CHECK(watched.stepper().row(0) == other.stepper().row(0));
      CHECK(watched.stepper().residual() == kept);
      CHECK(watched.stepper().bytes() == bytes + (every_step ? row : 0));
    }
    // Those of other rows are not: a start forgets them.
    watched.stepper().start({start[1], start[0]});
    watched.stepper().step();
    CHECK(watched.stepper().residual() < 4e-15);
  }
}

TEST_CASE("and of two components whose equations are of different size") {
  compare(Uneven{}, {1, 4}, [](const double* y, int) { return std::sin(y[0] + y[1]); });
}

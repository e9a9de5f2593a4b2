// SPDX-License-Identifier: MIT
#include "jets/batch_of.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/theories/complex_klein_gordon.hpp"
#include "schemes/theories/coupled_sine_gordon.hpp"
#include "schemes/theories/mechanics/kepler.hpp"
#include "schemes/theories/mechanics/pendulum.hpp"
#include "schemes/theories/wave_map.hpp"
#include "tests/catch.hpp"
#include "tests/jets/catalogue.hpp"
#include "tests/jets/random.hpp"

using namespace delf;
using delf::testing::for_each_theory;
using delf::testing::Random;

namespace {

/// Rows of random numbers, aligned to packs.
struct Rows {
  std::vector<std::vector<Pack>> memory;
  std::vector<double*> rows;
  std::vector<const double*> constant;

  Rows(std::size_t n, int count) : memory(n, std::vector<Pack>(count / lanes, Pack(0.0))) {
    for (auto& row : memory) {
      rows.push_back(reinterpret_cast<double*>(row.data()));
      constant.push_back(rows.back());
    }
  }
  double at(std::size_t row, int i) const { return rows[row][i]; }
};

/// The largest difference of a call's numbers from what is expected, relative to the largest expected.
struct Comparison {
  double worst = 0, largest = 0;
  void operator()(double found, double expected) {
    if (!(std::abs(found - expected) <= worst)) worst = std::abs(found - expected);
    largest = std::max(largest, std::abs(expected));
  }
  double relative() const { return largest > 0 ? worst / largest : worst; }
};

template <class D>
void check_density(const D& density, double low = -1.5, double high = 1.5) {
  constexpr int d = components_of<D>(), slots = slots_of<D>(), m = slots * d;
  constexpr std::size_t size = m;
  constexpr int count = 3 * lanes;
  const BatchOf<D> batches(density);
  REQUIRE((batches.components() == d && batches.slots() == slots && batches.variables() == m));
  CHECK(batches.is_placed() == is_placed<D>());
  Random random(31);
  Rows jets(size, count), x(1, count), l(1, count), g(size, count), H(size * size, count), slope(d, count),
      curvature(delf::at(d * d), count), place(2, count), by_gradient(1, count);
  for (double* row : jets.rows)
    for (int i = 0; i < count; ++i) row[i] = random(low, high);
  for (int i = 0; i < count; ++i) x.rows[0][i] = random(-2, 2);
  const JetBatch batch{count, jets.constant.data(), 0.7, x.constant[0]};
  batches.value(batch, l.rows[0]);
  batches.gradient(batch, g.rows.data(), by_gradient.rows[0]);
  batches.hessian(batch, H.rows.data());
  batches.slope(batch, slope.rows.data());
  batches.curvature(batch, curvature.rows.data());
  batches.place_gradient(batch, place.rows[0], place.rows[1]);

  using Inner = Dual<double, m + 2>;
  using Outer = Dual<Inner, m + 2>;
  const auto at = [&](int i, bool phi_alone) {
    const auto number = [&](double value, int a) { return Outer::variable(Inner::variable(value, a), a); };
    JetFor<Outer, D> j;
    for (int s = 0; s < slots; ++s)
      for (int a = 0; a < d; ++a)
        jet_slot(j, s, a) = phi_alone && s > 0 ? Outer(Inner(0.0)) : number(jets.at(delf::at(s * d + a), i), s * d + a);
    if constexpr (is_placed<D>()) j.t = number(0.7, m), j.x = number(x.at(0, i), m + 1);
    return Outer(density(j));
  };
  Comparison value, first, second, of_slope, of_curvature, of_place, again;
  for (int i = 0; i < count; ++i) {
    const Outer r = at(i, false), still = at(i, true);
    value(l.at(0, i), r.value.value), again(by_gradient.at(0, i), r.value.value);
    for (std::size_t a = 0; a < size; ++a) {
      first(g.at(a, i), r.d[a].value);
      for (std::size_t b = 0; b < size; ++b) second(H.at(a * size + b, i), r.d[a].d[b]);
    }
    for (std::size_t a = 0; a < delf::at(d); ++a) {
      of_slope(slope.at(a, i), still.d[a].value);
      for (std::size_t b = 0; b < delf::at(d); ++b) of_curvature(curvature.at(a * delf::at(d) + b, i), still.d[a].d[b]);
    }
    of_place(place.at(0, i), r.d[size].value), of_place(place.at(1, i), r.d[size + 1].value);
    // Entries that are proved constant, or zero, are what they are at each jet.
    for (std::size_t a = 0; a < size; ++a) {
      for (std::size_t b = 0; b < size; ++b) {
        const double entry = batches.constant_hessian()[a * size + b];
        if (batches.is_constant(static_cast<int>(a), static_cast<int>(b))) CHECK(std::abs(entry - r.d[a].d[b]) < 1e-13);
        else CHECK(entry == 0);
        if (batches.is_zero(static_cast<int>(a), static_cast<int>(b))) CHECK(r.d[a].d[b] == 0);
      }
    }
    // The gradient of what is linear is its constant Hessian and its value at zero.
    if (batches.nonlinearity() == Nonlinearity::all) continue;
    for (std::size_t a = batches.nonlinearity() == Nonlinearity::values ? delf::at(d) : 0; a < size; ++a) {
      double linear = batches.constant_gradient()[a];
      for (std::size_t b = 0; b < size; ++b) linear += batches.constant_hessian()[a * size + b] * jets.at(b, i);
      CHECK(std::abs(linear - r.d[a].value) < 1e-13);
    }
  }
  for (const Comparison* c : {&value, &first, &second, &of_slope, &of_curvature, &of_place, &again})
    CHECK(c->relative() < 1e-14);
  if (is_placed<D>()) CHECK(of_place.largest > 0);
}

/// Nonlinear in everything, and in the place.
struct Everything {
  static constexpr bool placed = true;
  auto operator()(const auto& j) const {
    return sin(j.phi * j.phi_t) * exp(0.3 * j.phi_x) + j.t * j.x * j.phi * j.phi_x + j.phi_t * sqrt(3.0 + j.phi);
  }
};
struct Second {
  static constexpr int jet_order = 2;
  auto operator()(const auto& j) const {
    return j.phi_tt * cos(j.phi) + 0.5 * (j.phi_xx * j.phi_xx) - j.phi_tx * j.phi_t * j.phi_x;
  }
};
struct Forced {
  auto operator()(const auto& j) const {
    return 0.5 * (j.phi_t * j.phi_t) + 2.0 * j.phi - 0.7 * j.phi_x + j.phi * j.phi_t;
  }
};
/// No number at φ = 0, nor its constant Hessian there.
struct OnlyAway {
  auto operator()(const auto& j) const { return 0.5 * (j.phi_t * j.phi_t) + 3.0 * (j.phi * j.phi_t) + log(j.phi); }
};

}  // namespace

TEST_CASE("a theory in batches has ℓ and all derivatives of its functor, by dual numbers") {
  for_each_theory([](const auto& theory) { check_density(theory); });
  check_density(CoupledSineGordon{1.2, 0.4});
  check_density(ComplexKleinGordon{});
  check_density(WaveMap{});
  check_density(Kepler{});
  check_density(Pendulum{});
}

TEST_CASE("so have densities of a user: nonlinear in everything, of second order, with forces, singular at zero") {
  check_density(Everything{});
  check_density(Second{});
  check_density(Forced{});
  check_density(OnlyAway{}, 0.5, 2);
}

TEST_CASE("difference quotients and their derivatives are those of the functor, also where both values are equal") {
  const auto check = [](const auto& density) {
    using D = std::decay_t<decltype(density)>;
    const BatchOf<D> batches(density);
    REQUIRE(batches.has_difference_quotient());
    Random random(32);
    Rows ab(2, 2 * lanes), q(1, 2 * lanes), slopes(2, 2 * lanes);
    for (int i = 0; i < 2 * lanes; ++i) {
      ab.rows[0][i] = random(-2, 2);
      ab.rows[1][i] = i % 2 == 0 ? random(-2, 2) : ab.rows[0][i];
    }
    batches.difference_quotient({2 * lanes, ab.constant.data()}, q.rows.data());
    batches.differentiate_quotient({2 * lanes, ab.constant.data()}, slopes.rows.data());
    const auto potential = [&](double phi) {
      return Dual<double, 1>(density(Jet<Dual<double, 1>>{Dual<double, 1>::variable(phi, 0), 0.0, 0.0}));
    };
    for (int i = 0; i < 2 * lanes; ++i) {
      const double a = ab.at(0, i), b = ab.at(1, i);
      const double exact = a == b ? potential(a).d[0] : (potential(a).value - potential(b).value) / (a - b);
      CHECK(std::abs(q.at(0, i) - exact) < 1e-12);
      const double e = 1e-4;
      const auto quotient = [&](double u, double v) { return density.difference_quotient(u, v); };
      CHECK(std::abs(slopes.at(0, i) - (quotient(a + e, b) - quotient(a - e, b)) / (2 * e)) < 1e-6);
      CHECK(std::abs(slopes.at(1, i) - (quotient(a, b + e) - quotient(a, b - e)) / (2 * e)) < 1e-6);
    }
  };
  check(SineGordon{1.2});
  check(PhiFour{0.7});
  check(KleinGordon{1.3});
  CHECK_FALSE(BatchOf<SineGordonImpurity>(SineGordonImpurity{}).has_difference_quotient());
}

TEST_CASE("what a density is nonlinear in, as a batch says it") {
  CHECK(BatchOf<Wave>(Wave{}).nonlinearity() == Nonlinearity::none);
  CHECK(BatchOf<SineGordon>(SineGordon{}).nonlinearity() == Nonlinearity::values);
  CHECK(BatchOf<Everything>(Everything{}).nonlinearity() == Nonlinearity::all);
  const BatchOf<Forced> forced(Forced{});
  CHECK(forced.constant_gradient() == std::vector<double>{2, 0, -0.7});
  CHECK(forced.constant_hessian() == std::vector<double>{0, 1, 0, 1, 1, 0, 0, 0, 0});
  const BatchOf<OnlyAway> away(OnlyAway{});
  CHECK(std::abs(away.constant_hessian()[1] - 3) < 1e-14);
}

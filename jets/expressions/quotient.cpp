// SPDX-License-Identifier: MIT
#include "jets/expressions/quotient.hpp"

#include <array>
#include <cmath>

#include "jets/simd/pack.hpp"

namespace delf::expressions {

namespace {
constexpr int orders = 8;
}

Quotient::Quotient(Graph& graph, int potential, int variables) : variables_(variables) {
  std::vector<int> derivatives;
  for (int n = 0, node = potential; n < orders; ++n) derivatives.push_back(node = graph.differentiate(node, 0));
  ends_ = Tape(graph, {potential, derivatives[0]}, variables);
  middle_ = Tape(graph, derivatives, variables);
}

/// One value of a and of b, with what the tapes give there.
struct Quotient::Lanes {
  double delta;
  std::array<double, 2> at_a, at_b;  ///< N, N′
  std::array<double, orders> N;      ///< [n − 1]: the n-th derivative at m

  bool is_near() const {
    const double d2 = delta * delta, last = d2 * d2 * d2 / 322560 * N[6];
    return std::abs(last) <= 1e-14 * (std::abs(N[0]) + std::abs(d2 / 24 * N[2]));
  }
  double value() const {
    const double d2 = delta * delta;
    if (is_near()) return N[0] + d2 * (N[2] / 24 + d2 * (N[4] / 1920 + d2 * (N[6] / 322560)));
    return (at_a[0] - at_b[0]) / delta;
  }
  /// The derivatives by a and by b: ½∂/∂m ± ∂/∂δ of the series.
  std::array<double, 2> slopes() const {
    const double d2 = delta * delta;
    if (is_near()) {
      const double by_m = N[1] + d2 * (N[3] / 24 + d2 * (N[5] / 1920 + d2 * (N[7] / 322560)));
      const double by_delta = delta * (N[2] / 12 + d2 * (N[4] / 480 + d2 * (N[6] / 53760)));
      return {0.5 * by_m + by_delta, 0.5 * by_m - by_delta};
    }
    const double q = value();
    return {(at_a[1] - q) / delta, (q - at_b[1]) / delta};
  }
};

void Quotient::each(const JetBatch& ab, const auto& put) const {
  std::vector<const double*> in(variables_, nullptr);
  std::array<Pack, 2> at_a, at_b;
  std::array<Pack, orders> at_m;
  const auto run = [&](const Tape& tape, Pack phi, auto& results) {
    std::array<double*, orders> out{};
    for (std::size_t n = 0; n < results.size(); ++n) out[n] = reinterpret_cast<double*>(&results[n]);
    in[0] = reinterpret_cast<const double*>(&phi);
    tape.run(lanes, in.data(), 0, out.data());
  };
  for (int i = 0; i < ab.count; i += lanes) {
    const Pack a = Pack::load(ab.slots[0] + i), b = Pack::load(ab.slots[1] + i);
    run(ends_, a, at_a), run(ends_, b, at_b), run(middle_, Pack(0.5) * (a + b), at_m);
    for (int l = 0; l < lanes; ++l) {
      Lanes here{a[l] - b[l], {at_a[0][l], at_a[1][l]}, {at_b[0][l], at_b[1][l]}, {}};
      for (std::size_t n = 0; n < orders; ++n) here.N[n] = at_m[n][l];
      put(i + l, here);
    }
  }
}

void Quotient::value(const JetBatch& ab, double* q) const {
  each(ab, [&](int i, const Lanes& here) { q[i] = here.value(); });
}
void Quotient::derivatives(const JetBatch& ab, double* by_a, double* by_b) const {
  each(ab, [&](int i, const Lanes& here) {
    const auto slopes = here.slopes();
    by_a[i] = slopes[0], by_b[i] = slopes[1];
  });
}

}  // namespace delf::expressions

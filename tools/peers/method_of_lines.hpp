// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <stdexcept>

#include "lattice/index.hpp"
#include "tools/peers/differences.hpp"
#include "tools/peers/force.hpp"
#include "tools/peers/row.hpp"

namespace delf::peers {

/// The memory of a circle's sites in a row: φ_i at halo + i, copies of its neighbours before and after, so that a loop
/// over whole packs needs no modulo. The copies are no part of the state: acceleration() refreshes them.
struct CircleRow {
  explicit CircleRow(int number) : sites(delf::at(number)) {}

  static constexpr std::size_t halo = (6 + lanes - 1) / lanes * lanes;  ///< 6 sites at least
  std::size_t sites;

  std::size_t end() const { return halo + whole_packs(sites); }
  std::size_t size() const { return end() + halo; }

  void scatter(std::span<const double> values, double* row, double monodromy) const {
    if (values.size() != sites) throw std::invalid_argument("a row has the wrong length");
    std::copy(values.begin(), values.end(), row + halo);
    fill(row, halo, monodromy);
  }
  void gather(const double* row, std::span<double> values) const {
    if (values.size() != sites) throw std::invalid_argument("a row has the wrong length");
    std::copy_n(row + halo, sites, values.begin());
  }
  /// φ_{i+N} = φ_i + monodromy, at `reach` sites before the first, and from the last to as many after the last pack.
  void fill(double* row, std::size_t reach, double monodromy) const {
    double* const first = row + halo;
    for (std::size_t j = 1; j <= reach; ++j) first[-static_cast<std::ptrdiff_t>(j)] = first[sites - j] - monodromy;
    for (double* y = first + sites; y != row + end() + reach; ++y) *y = *(y - sites) + monodromy;
  }
};

/// φ_tt by central differences of order 2p in space.
template <int p, class Force>
class MethodOfLines {
 public:
  explicit MethodOfLines(const WaveEquation& equation)
      : circle(equation.sites), monodromy_(equation.monodromy), strength_(Force::strength(equation)) {
    const double k = equation.length / equation.sites;
    weights_ = second_difference<p>();
    for (double& c : weights_) c /= k * k;
  }

  void acceleration(double* phi, double* phi_tt) const {
    circle.fill(phi, p, monodromy_);
    const std::array<double, p + 1> c = weights_;
    const double strength = strength_;
    for (std::size_t i = CircleRow::halo; i != circle.end(); i += lanes) {
      const Pack here = Pack::load(phi + i);
      Pack sum = c[0] * here + strength * Force::shape(here);
      for (int m = 1; m <= p; ++m) sum += c[m] * (unaligned(phi + i + m) + unaligned(phi + i - m));
      sum.store(phi_tt + i);
    }
  }

  CircleRow circle;

 private:
  static Pack unaligned(const double* at) {
    Pack pack;
    std::memcpy(&pack, at, sizeof pack);
    return pack;
  }

  double monodromy_, strength_;
  std::array<double, p + 1> weights_;
};

}  // namespace delf::peers

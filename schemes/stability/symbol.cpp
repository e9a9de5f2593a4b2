// SPDX-License-Identifier: MIT
#include "schemes/stability/symbol.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <tuple>

#include "lattice/error.hpp"
#include "lattice/plan/sigma_method.hpp"

namespace delf {
namespace {

using Complex = Symbol::Complex;
using Eigen::Index;
using Eigen::MatrixXcd;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Entries this much smaller than the largest of their equation are rounding of a sum that cancels.
constexpr double cancelled = 4e-15;
/// A matrix nearer to singular than this, relative to the terms of P, loses the digits that decide stability, or all.
constexpr double regular = 1e-4, solvable = 1e-13;

/// About the smallest change that makes it singular.
double distance_to_singular(const Eigen::PartialPivLU<MatrixXcd>& lu, const MatrixXcd& matrix) {
  return lu.rcond() * matrix.cwiseAbs().colwise().sum().maxCoeff();
}

/// The families' stencils that touch the site of a parity, as terms of its equation, added up.
struct Sum {
  double value = 0, absolute = 0;
};
using Place = std::tuple<int, int, int, int>;  // equation, unknown, time, space

/// About a constant state the multipliers are zero, and it must keep the constraints: both hold without a word where they
/// are linear in the fields. Elsewhere another state gives another J.
void require_linear_constraints(const StencilFamily& family, const LatticeSystem& system, std::vector<double> y,
                                const std::vector<double>& J) {
  const auto multiplier = std::ranges::find_if(
      family.values(), [&](const auto& value) { return system.component(value.component).role == Role::multiplier; });
  if (multiplier == family.values().end()) return;
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += 0.3 + 0.1 * static_cast<double>(i);
  std::vector<double> other(J.size());
  family.jacobian({system.time_step(), system.lattice().space_step(), 0, 0}, y, other);
  if (other == J) return;
  throw BadInput("scheme.method",
                 "scheme.method: the constraint of the multiplier " + system.component((*multiplier).component).name +
                     " is not linear in the fields, and has no linear stability about a constant state; use a scheme "
                     "without it");
}

double power_of_two(double x) { return std::ldexp(1.0, std::ilogb(x)); }

}  // namespace

struct Symbol::Powers {
  int low = 0;
  std::vector<MatrixXcd> of;  ///< of[t − low]
};

struct Symbol::Scaled {
  MatrixXcd P;
};

Symbol::Symbol(const LatticeSystem& system, double constant)
    : components_(system.components()),
      fields_(system.fields()),
      brick_(system.placement() == Placement::brick_wall),
      time_step_(system.time_step()),
      space_step_(system.lattice().space_step()) {
  for (const Component& component : system.all_components()) positions_.push_back(component.at);
  const int parities = brick_ ? 2 : 1;
  size_ = parities * components_;

  std::map<Place, Sum> sums;
  for (const auto& family : system.families()) {
    if (family->is_placed())
      throw BadInput("theory.name",
                     "theory.name: a density that depends on t or x has no symbol, since its equations "
                     "differ from site to site; use a theory that is the same everywhere");
    if (family->pattern().is_of_wall()) continue;  // there are no walls here
    const std::size_t n = index(family->size());
    std::vector<double> y(n, constant), J(n * n);
    family->jacobian({time_step_, space_step_, 0, 0}, y, J);
    if (!std::ranges::all_of(J, [](double x) { return std::isfinite(x); }))
      throw BadInput("theory.name",
                     "theory.name: the density has no finite second derivatives at the constant state; "
                     "choose another constant");
    require_linear_constraints(*family, system, y, J);
    for (int parity = 0; parity < parities; ++parity)
      for (int e = 0; e < family->size(); ++e) {
        const Site at = family->site(e), anchor{-at.time, parity - at.space};  // so that `at` is the site (0, parity)
        if (!family->pattern().placed_at(anchor)) continue;
        const int equation = parity * components_ + family->values()[index(e)].component;
        for (int u = 0; u < family->size(); ++u) {
          const Site to = family->site(u);
          const int t = to.time - at.time, s = to.space - at.space;
          const int sort = brick_ ? (parity + t + s) & 1 : 0;
          Sum& sum = sums[{equation, sort * components_ + family->values()[index(u)].component, t, s}];
          sum.value += J[index(e) * n + index(u)], sum.absolute += std::abs(J[index(e) * n + index(u)]);
        }
      }
  }

  std::vector<double> largest(index(size_), 0.0), own(index(size_), 0.0);
  for (const auto& [place, sum] : sums) {
    const auto [equation, unknown, time, space] = place;
    largest[index(equation)] = std::max(largest[index(equation)], sum.absolute);
    if (equation == unknown) own[index(equation)] = std::max(own[index(equation)], std::abs(sum.value));
  }
  scale_.assign(index(size_), 1.0);
  for (int a = 0; a < size_; ++a) {
    const double size = own[index(a)] > 0 ? own[index(a)] : largest[index(a)];
    if (size > 0) scale_[index(a)] = power_of_two(1 / std::sqrt(size));
  }
  for (const auto& [place, sum] : sums) {
    const auto [equation, unknown, time, space] = place;
    if (std::abs(sum.value) <= cancelled * largest[index(equation)]) continue;
    terms_.push_back({equation, unknown, time, space, scale_[index(equation)] * sum.value * scale_[index(unknown)]});
    low_ = std::min(low_, time), high_ = std::max(high_, time), width_ = std::max(width_, std::abs(space));
  }
  std::vector<double> rows(index(size_), 0.0);
  for (const Term& term : terms_) rows[index(term.equation)] += std::abs(term.value);
  norm_ = *std::ranges::max_element(rows);
  zone_ = width_ == 0 ? 0 : brick_ ? std::numbers::pi / 2 : std::numbers::pi;

  order_ = order_of(size_, terms_);
  if (order_.c.empty())
    throw BadInput("lattice.stencil",
                   "lattice.stencil: the equations, linearised at the constant state, leave a "
                   "component undetermined; choose another state or stencil");
  find_inner();
}

Symbol::Order Symbol::order_of(int size, const std::vector<Term>& terms) {
  std::vector<Occurrence> later, earlier;
  for (const Term& term : terms) {
    later.push_back({term.equation, term.unknown, term.time, 0});
    earlier.push_back({term.equation, term.unknown, -term.time, 0});
  }
  const StructuralAnalysis last = analyse(size, later), first = analyse(size, earlier);
  Order order;
  if (!last.solvable() || !first.solvable()) return order;
  order.c = last.c, order.d = last.d;
  order.depth.assign(index(size), 0);
  for (const Term& term : terms) {
    int& depth = order.depth[index(term.unknown)];
    depth = std::max(depth, last.d[index(term.unknown)] - last.c[index(term.equation)] - term.time);
  }
  // The highest and the lowest power of z in det P
  for (const StructuralAnalysis* end : {&last, &first})
    order.roots += std::accumulate(end->d.begin(), end->d.end(), 0) - std::accumulate(end->c.begin(), end->c.end(), 0);
  return order;
}

/// Nodes between the rows whose equations read one another in their own cell's row only: there P has no power of z.
void Symbol::find_inner() {
  std::vector<char> inside(index(size_), 0);
  for (int v = 0; v < size_; ++v) inside[index(v)] = position(v).time != 0;
  for (const Term& term : terms_)
    if (inside[index(term.equation)] && inside[index(term.unknown)] && term.time != 0) return;
  std::vector<int> place(index(size_));
  for (int v = 0; v < size_; ++v) {
    std::vector<int>& list = inside[index(v)] ? inner_ : outer_;
    place[index(v)] = static_cast<int>(list.size());
    list.push_back(v);
  }
  if (inner_.empty()) return;

  // Times at which P_bb − P_bi P_ii⁻¹ P_ib may have entries: any inner node passes on what it reads to any other.
  std::set<std::tuple<int, int, int>> entries;
  std::vector<Term> reads, read;
  for (const Term& term : terms_) {
    const bool from = inside[index(term.equation)], to = inside[index(term.unknown)];
    if (!from && !to) entries.insert({place[index(term.equation)], place[index(term.unknown)], term.time});
    else if (from && !to) reads.push_back(term);
    else if (to && !from) read.push_back(term);
  }
  for (const Term& a : read)
    for (const Term& b : reads) entries.insert({place[index(a.equation)], place[index(b.unknown)], a.time + b.time});
  std::vector<Term> pattern;
  for (const auto& [equation, unknown, time] : entries) pattern.push_back({equation, unknown, time, 0, 1});
  outer_order_ = order_of(static_cast<int>(outer_.size()), pattern);
  if (outer_order_.c.empty()) inner_.clear();
}

/// e^{iθs} at s + width; exact where that is ±1 or ±i.
std::vector<Complex> Symbol::phases(double theta) const {
  const double quarters = theta / (std::numbers::pi / 2);
  Complex step = std::polar(1.0, theta);
  if (quarters == std::round(quarters)) {
    constexpr std::array<Complex, 4> exact{Complex{1, 0}, Complex{0, 1}, Complex{-1, 0}, Complex{0, -1}};
    step = exact[static_cast<long long>(quarters) & 3];
  }
  std::vector<Complex> result(index(2 * width_ + 1), 1.0);
  for (int s = 1; s <= width_; ++s) {
    result[index(width_ + s)] = result[index(width_ + s - 1)] * step;
    result[index(width_ - s)] = std::conj(result[index(width_ + s)]);
  }
  return result;
}

/// One equation: a polynomial, of degree two as a rule.
std::vector<Complex> Symbol::scalar_roots(double theta) const {
  const std::vector<Complex> phase = phases(theta);
  std::vector<Complex> a(index(high_ - low_ + 1));
  for (const Term& term : terms_) a[index(term.time - low_)] += term.value * phase[index(width_ + term.space)];
  if (std::abs(a.back()) <= solvable * norm_) return {infinity};
  const std::size_t n = a.size() - 1;
  std::vector<Complex> z;
  if (n == 1) z = {-a[0] / a[1]};
  if (n == 2) {
    // The root of larger modulus without cancellation, the other by their product.
    const Complex half = -0.5 * a[1], root = std::sqrt(half * half - a[0] * a[2]);
    const Complex sum = std::real(std::conj(half) * root) >= 0 ? half + root : half - root;
    z = {sum / a[2], std::abs(sum) > 0 ? a[0] / sum : Complex(0)};
  }
  if (n > 2) {
    MatrixXcd companion = MatrixXcd::Zero(static_cast<Index>(n), static_cast<Index>(n));
    for (std::size_t i = 0; i < n; ++i) {
      companion(0, static_cast<Index>(i)) = -a[n - 1 - i] / a[n];
      if (i > 0) companion(static_cast<Index>(i), static_cast<Index>(i) - 1) = 1;
    }
    const auto values = Eigen::ComplexEigenSolver<MatrixXcd>(companion, false).eigenvalues();
    z.assign(values.begin(), values.end());
  }
  return z;
}

/// P_bb − P_bi P_ii⁻¹ P_ib, power by power. False where P_ii is too near to singular.
bool Symbol::eliminate(Powers& P) const {
  const MatrixXcd centre = P.of[index(-P.low)](inner_, inner_);
  const Eigen::PartialPivLU<MatrixXcd> lu(centre);
  if (!(distance_to_singular(lu, centre) > regular * norm_)) return false;
  const int powers = static_cast<int>(P.of.size());
  const auto n = static_cast<Index>(outer_.size());
  std::vector<MatrixXcd> solved, S(index(2 * powers - 1), MatrixXcd::Zero(n, n));
  for (const MatrixXcd& A : P.of) solved.push_back(lu.solve(MatrixXcd(A(inner_, outer_))));
  for (int i = 0; i < powers; ++i) {
    S[index(i - P.low)] += P.of[index(i)](outer_, outer_);
    for (int j = 0; j < powers; ++j) S[index(i + j)] -= P.of[index(i)](outer_, inner_) * solved[index(j)];
  }
  P = {2 * P.low, std::move(S)};
  return true;
}

/// Slab J holds the unknowns b at the rows J + d_b, the equations a at J + c_a:  Σ_k A_k u_{J−k} = 0. The unknowns of
/// the slabs before, as far back as any equation reads them, are a vector that a step multiplies by a matrix.
std::vector<Complex> Symbol::roots_of(const Powers& P, const Order& order) const {
  const auto n = static_cast<Index>(order.c.size());
  const int states = std::accumulate(order.depth.begin(), order.depth.end(), 0);
  MatrixXcd newest = MatrixXcd::Zero(n, n), past = MatrixXcd::Zero(n, states);
  std::vector<int> first(order.depth.size(), 0);
  std::exclusive_scan(order.depth.begin(), order.depth.end(), first.begin(), 0);
  for (std::size_t power = 0; power < P.of.size(); ++power)
    for (Index b = 0; b < n; ++b)
      for (Index a = 0; a < n; ++a) {
        const Complex value = P.of[power](a, b);
        if (value == 0.0) continue;
        const std::size_t B = b;
        const int k = order.d[B] - order.c[a] - (static_cast<int>(power) + P.low);
        if (k == 0) newest(a, b) = value;
        // Past the depth lie products that cancel.
        else if (k > 0 && k <= order.depth[B]) past(a, first[B] + k - 1) = value;
      }
  const Eigen::PartialPivLU<MatrixXcd> lu(newest);
  if (!(distance_to_singular(lu, newest) > solvable * norm_)) return {infinity};
  const MatrixXcd next = -lu.solve(past);
  MatrixXcd step = MatrixXcd::Zero(states, states);
  for (Index b = 0; b < n; ++b)
    for (int k = 0; k < order.depth[b]; ++k) {
      const int row = first[b] + k;
      if (k == 0) step.row(row) = next.row(b);
      else step(row, row - 1) = 1;
    }
  const auto values = Eigen::ComplexEigenSolver<MatrixXcd>(step, false).eigenvalues();
  return {values.begin(), values.end()};
}

std::vector<Complex> Symbol::roots(double theta) const {
  const auto sorted = [](std::vector<Complex> z, int count) {
    std::ranges::sort(z, std::greater{}, [](const Complex& x) { return std::norm(x); });
    if (static_cast<int>(z.size()) > count && std::isfinite(z[0].real())) z.resize(index(count));
    return z;
  };
  if (size_ == 1) return sorted(scalar_roots(theta), order_.roots);
  const std::vector<Complex> phase = phases(theta);
  Powers P{low_, std::vector<MatrixXcd>(index(high_ - low_ + 1), MatrixXcd::Zero(size_, size_))};
  for (const Term& term : terms_)
    P.of[index(term.time - low_)](term.equation, term.unknown) += term.value * phase[index(width_ + term.space)];
  if (!inner_.empty())
    if (Powers reduced = P; eliminate(reduced)) {
      std::vector<Complex> z = roots_of(reduced, outer_order_);
      if (z.empty() || std::isfinite(z[0].real())) return sorted(std::move(z), outer_order_.roots);
    }
  return sorted(roots_of(P, order_), order_.roots);
}

std::vector<Complex> Symbol::matrix(Complex z, double theta) const {
  const MatrixXcd P = scaled(z, theta).P * norm_;
  std::vector<Complex> result;
  for (int a = 0; a < size_; ++a)
    for (int b = 0; b < size_; ++b) result.push_back(P(a, b) / (scale_[index(a)] * scale_[index(b)]));
  return result;
}

Symbol::Scaled Symbol::scaled(Complex z, double theta) const {
  const std::vector<Complex> phase = phases(theta);
  std::vector<Complex> powers;
  for (int t = low_; t <= high_; ++t) powers.push_back(std::pow(z, t));
  MatrixXcd P = MatrixXcd::Zero(size_, size_);
  for (const Term& term : terms_)
    P(term.equation, term.unknown) +=
        term.value / norm_ * powers[index(term.time - low_)] * phase[index(width_ + term.space)];
  return {std::move(P)};
}

std::vector<double> Symbol::singular_values(Complex z, double theta) const {
  const MatrixXcd P = scaled(z, theta).P;
  if (size_ == 1) return {std::abs(P(0, 0))};
  const Eigen::VectorXd values = Eigen::JacobiSVD<MatrixXcd>(P).singularValues();
  return {values.begin(), values.end()};
}

/// The smallest singular value by inverse iteration: 1/‖P⁻¹‖, from above.
bool Symbol::is_root(Complex z, double theta) const {
  const double rounding = 1e-13 * size_ * size_;
  const MatrixXcd P = scaled(z, theta).P;
  if (size_ == 1) return std::abs(P(0, 0)) <= rounding;
  const Eigen::PartialPivLU<MatrixXcd> lu(P), adjoint(P.adjoint());
  Eigen::VectorXcd x(size_);
  for (int a = 0; a < size_; ++a) x(a) = std::polar(1.0, static_cast<double>(a * a));
  for (int iteration = 0; iteration < 4; ++iteration) {
    x.normalize();
    const Eigen::VectorXcd y = adjoint.solve(x);
    const double inverse = y.norm();
    if (!std::isfinite(inverse) || inverse * rounding >= 1) return true;
    x = lu.solve(y / inverse);
  }
  return false;
}

double Symbol::amplification(double theta) const { return amplification(theta, roots(theta)); }

double Symbol::amplification(double theta, const std::vector<Complex>& roots) const {
  double largest = 0;
  for (const Complex& z : roots) {
    double size = std::abs(z);
    // A double root is accurate to the square root of the accuracy of P only, so test whether one lies on the circle.
    if (size > 1 && (size < 1 + 1e-12 || (size < 1.1 && is_root(z / size, theta)))) size = 1;
    largest = std::max(largest, size);
  }
  return largest;
}

std::vector<Complex> Symbol::mode(Complex z, double theta) const {
  const Eigen::JacobiSVD<MatrixXcd> svd(scaled(z, theta).P, Eigen::ComputeFullV);
  Eigen::VectorXcd v = svd.matrixV().col(size_ - 1);
  for (int b = 0; b < size_; ++b) v(b) *= scale_[index(b)];
  v.normalize();
  return {v.begin(), v.end()};
}

int Symbol::constant_solutions() const {
  const MatrixXcd P = scaled(1, 0).P;
  MatrixXcd U = MatrixXcd::Zero(size_, fields_);
  // Nodes inside the cells have the fields in the order of the vertices.
  for (int v = 0; v < size_; ++v)
    U(v, v % components_ % fields_) = scale_[index(v % components_ % fields_)] / scale_[index(v)];
  const Eigen::VectorXd values = Eigen::JacobiSVD<MatrixXcd>(P * U).singularValues();
  return static_cast<int>(std::ranges::count_if(values, [&](double x) { return x <= 1e-13 * size_; }));
}

}  // namespace delf

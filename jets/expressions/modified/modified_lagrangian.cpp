// SPDX-License-Identifier: MIT
#include "jets/expressions/modified/modified_lagrangian.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>

#include "jets/expressions/euler_lagrange.hpp"
#include "jets/expressions/modified/divergences.hpp"
#include "jets/expressions/modified/jet_algebra.hpp"
#include "jets/expressions/modified/modified_jets.hpp"
#include "jets/expressions/parse.hpp"
#include "jets/expressions/sums.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"

namespace delf {
namespace {

using namespace expressions;
using Derivative = ModifiedJets::Derivative;

/// Coefficients of (hD)^2, (hD)^4, … in hD/2 / sinh(hD/2).
constexpr std::array meshed{-1. / 24, 7. / 5760, -31. / 967680};

constexpr double nothing = 1e-13;  ///< of sums of weights

[[noreturn]] void refuse_density(const std::string& reason) {
  throw BadInput("theory.density", "no modified Lagrangian: " + reason);
}
[[noreturn]] void refuse_table(const std::string& reason) {
  throw BadInput("lattice.stencil", "no modified Lagrangian: " + reason);
}

double factorial(int n) { return std::tgamma(n + 1.0); }

/// The place of a vertex from the middle of a step and of the stencil, in steps, and the unknown that it is: 0 for the field
/// itself, or what it differs from it by, with its sign.
struct VertexPlace {
  double time, space;
  int kind = 0;
  double sign = 0;
  bool in_row = true;  ///< else it has a time of its own inside the step
};

}  // namespace

struct ModifiedLagrangian::Impl {
  Impl(const SymbolicDensity& density, const StencilTable& given, int order)
      : jets(density.names()), table(given), algebra(order, [this](int v) {
          return v <= ModifiedJets::k ? 1.0 : jets.is_difference(v) ? 2.0 : 0.0;
        }) {
    read(density);
    find_places();
    solve_for_acceleration();
    // An error of order p in φ_tt is one of order 2 + 2p in ℓ̃, which does not change to first order; where nodes in rows are
    // eliminated, by equations that read φ_tt, it is one of order p + 2.
    for (int known = 1; known <= (differ_in_rows ? order - 2 : order / 2 - 1); ++known) {
      algebra.set_highest_order(known);
      correct_acceleration(modified());
    }
    algebra.set_highest_order(order);
    lagrangian = without_null_parts(without_divergences(algebra, jets, modified()));
  }

  // ---- the density and its solutions

  void read(const SymbolicDensity& density) {
    if (!density.constraint().empty())
      refuse_density("a constraint has multipliers, which have no rows of their own; leave it out");
    const JetVariables names(density.names());
    Graph graph;
    const int root = parse(graph, density.text(), names.names, "theory.density");
    l = algebra.of(graph, root, [&](int v) {
      if (v == names.x()) return algebra.variable(ModifiedJets::x);
      if (v == names.t()) return algebra.variable(ModifiedJets::t);
      if (!names.is_derivative(v)) return algebra.variable(ModifiedJets::parameters + v - names.parameter(0));
      const auto [a, in_t, in_x] = names.of(v);
      if (in_t == 2 || (in_t == 1 && in_x == 1))
        refuse_density("a density of " + density.names().fields[at(a)] + (in_t == 2 ? "_tt" : "_tx") +
                       " has no phi_tt to solve for; it is for densities of phi, phi_t, phi_x, phi_xx");
      return field(a, in_t, in_x);
    });
  }
  JetSum field(int a, int in_t, int in_x) { return algebra.variable(jets.number({0, in_t, a, in_x})); }
  JetSum by(const JetSum& sum, const Derivative& jet) { return algebra.by(sum, jets.number(jet)); }

  JetSum in_space(const JetSum& sum, int times = 1) {
    JetSum result = sum;
    for (; times > 0; --times) result = algebra.derive(result, along_x);
    return result;
  }
  JetSum in_time(const JetSum& sum, int times = 1) {
    JetSum result = sum;
    for (; times > 0; --times) result = algebra.derive(result, along_t);
    return result;
  }

  /// The inverse of a square matrix, by cofactors unless it is diagonal, or numbers times one sum.
  std::optional<std::vector<JetSum>> inverse(const std::vector<JetSum>& m, int n) {
    const auto entry = [&](int i, int j) -> const JetSum& { return m[at(i * n + j)]; };
    std::vector<JetSum> result(at(n * n));
    const JetSum* scale = nullptr;
    for (const JetSum& one : m)
      if (!one.empty() && !scale) scale = &one;
    if (!scale) return std::nullopt;
    // numbers c_ij times one sum
    std::vector<double> c(at(n * n), 0);
    bool alike = true;
    for (std::size_t i = 0; i < m.size() && alike; ++i) {
      if (m[i].empty()) continue;
      const auto& [monomial, first] = *scale->begin();
      const auto here = m[i].find(monomial);
      if (here == m[i].end()) alike = false;
      else {
        c[i] = here->second.value / first.value;
        JetSum rest = m[i];
        algebra.add(rest, *scale, -c[i]);
        alike = rest.empty();
      }
    }
    if (alike) {
      if (!invert(c, n)) return std::nullopt;
      const JetSum over = algebra.power(*scale, -1);
      for (std::size_t i = 0; i < c.size(); ++i) result[i] = algebra.times(over, c[i]);
      return result;
    }
    bool diagonal = true;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) diagonal = diagonal && (entry(i, j).empty() == (i != j));
    if (diagonal) {
      for (int i = 0; i < n; ++i) result[at(i * n + i)] = algebra.power(entry(i, i), -1);
      return result;
    }
    if (n > 3) return std::nullopt;
    const auto minor = [&](int row, int column) {
      std::vector<JetSum> rest;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
          if (i != row && j != column) rest.push_back(entry(i, j));
      return determinant(rest, n - 1);
    };
    const JetSum det = determinant(m, n);
    if (det.empty()) return std::nullopt;
    const JetSum over = algebra.power(det, -1);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        result[at(i * n + j)] = algebra.times(algebra.times(minor(j, i), over), (i + j) % 2 ? -1 : 1);
    return result;
  }
  JetSum determinant(const std::vector<JetSum>& m, int n) {
    if (n == 0) return JetAlgebra::constant(1);
    if (n == 1) return m[0];
    JetSum sum;
    for (int j = 0; j < n; ++j) {
      std::vector<JetSum> rest;
      for (int i = 1; i < n; ++i)
        for (int other = 0; other < n; ++other)
          if (other != j) rest.push_back(m[at(i * n + other)]);
      algebra.add(sum, algebra.times(m[at(j)], determinant(rest, n - 1)), j % 2 ? -1 : 1);
    }
    return sum;
  }
  static bool invert(std::vector<double>& m, int n) {
    std::vector<double> inverse(m.size(), 0);
    for (int i = 0; i < n; ++i) inverse[at(i * n + i)] = 1;
    for (int column = 0; column < n; ++column) {
      int pivot = column;
      for (int i = column; i < n; ++i)
        if (std::abs(m[at(i * n + column)]) > std::abs(m[at(pivot * n + column)])) pivot = i;
      if (std::abs(m[at(pivot * n + column)]) < 1e-10) return false;
      for (int j = 0; j < n; ++j) {
        std::swap(m[at(pivot * n + j)], m[at(column * n + j)]);
        std::swap(inverse[at(pivot * n + j)], inverse[at(column * n + j)]);
      }
      const double over = 1 / m[at(column * n + column)];
      for (int j = 0; j < n; ++j) m[at(column * n + j)] *= over, inverse[at(column * n + j)] *= over;
      for (int i = 0; i < n; ++i) {
        const double factor = m[at(i * n + column)];
        if (i == column || factor == 0) continue;
        for (int j = 0; j < n; ++j) {
          m[at(i * n + j)] -= factor * m[at(column * n + j)];
          inverse[at(i * n + j)] -= factor * inverse[at(column * n + j)];
        }
      }
    }
    m = inverse;
    return true;
  }

  /// φ_tt = (∂²ℓ/∂φ_t²)⁻¹ (∂ℓ/∂φ − D_x ∂ℓ/∂φ_x + D_x² ∂ℓ/∂φ_xx − the rest of D_t ∂ℓ/∂φ_t)
  void solve_for_acceleration() {
    const int d = jets.fields();
    std::vector<JetSum> mass;
    for (int a = 0; a < d; ++a)
      for (int b = 0; b < d; ++b) mass.push_back(by(by(l, {0, 1, a, 0}), {0, 1, b, 0}));
    std::optional<std::vector<JetSum>> over;
    try {
      over = inverse(mass, d);
    } catch (const std::domain_error&) {
    }
    if (!over)
      refuse_density(
          "the density is not of second order in the time derivatives of all its fields, so that phi_tt does "
          "not follow from phi and phi_t");
    over_mass = *over;
    acceleration.assign(at(d), {});
    const std::vector<JetSum> residual = residuals(l);
    for (int a = 0; a < d; ++a) acceleration[at(a)] = solved(residual, a);
    forget_derivatives();
  }
  JetSum solved(const std::vector<JetSum>& residual, int a) {
    JetSum sum;
    for (int b = 0; b < jets.fields(); ++b)
      algebra.add(sum, algebra.times(over_mass[at(a * jets.fields() + b)], residual[at(b)]));
    return sum;
  }
  /// δL/δφ_a − D_t δL/δφ_a,t with φ_tt as it is known, for all a.
  std::vector<JetSum> residuals(const JetSum& L) {
    forget_derivatives();
    std::vector<JetSum> result;
    for (int a = 0; a < jets.fields(); ++a) {
      JetSum sum = euler(L, 0, 0, a);
      algebra.add(sum, in_time(euler(L, 0, 1, a)), -1);
      result.push_back(sum);
    }
    return result;
  }
  /// Σ (−D_x)ⁿ ∂L/∂(∂ⁿ)
  JetSum euler(const JetSum& L, int kind, int in_t, int a) {
    JetSum sum;
    for (int n = 0; n <= highest_in_x(L); ++n) algebra.add(sum, in_space(by(L, {kind, in_t, a, n}), n), n % 2 ? -1 : 1);
    return sum;
  }
  int highest_in_x(const JetSum& L) {
    int highest = 0;
    algebra.depends(L, [&](int v) {
      if (jets.is_jet(v)) highest = std::max(highest, jets.jet(v).in_x);
      return false;
    });
    return highest;
  }
  /// One more order of φ_tt from the terms of ℓ̃ that are known.
  void correct_acceleration(const JetSum& L) {
    const std::vector<JetSum> residual = residuals(L);
    for (int a = 0; a < jets.fields(); ++a) algebra.add(acceleration[at(a)], solved(residual, a));
    forget_derivatives();
  }
  void forget_derivatives() {
    along_x = {[this](int v) {
      if (v == ModifiedJets::x) return JetAlgebra::constant(1);
      if (!jets.is_jet(v)) return JetSum{};
      Derivative jet = jets.jet(v);
      ++jet.in_x;
      return algebra.variable(jets.number(jet));
    }};
    along_t = {[this](int v) {
      if (v == ModifiedJets::t) return JetAlgebra::constant(1);
      if (!jets.is_jet(v)) return JetSum{};
      Derivative jet = jets.jet(v);
      if (jet.kind == 0 && jet.in_t == 1) return in_space(acceleration[at(jet.field)], jet.in_x);
      ++jet.in_t;
      return algebra.variable(jets.number(jet));
    }};
    on_solutions.clear();
  }
  /// ∂ₜᵐ∂ₓⁿ of field a on solutions.
  const JetSum& solution(int a, int m, int n) {
    const auto known = on_solutions.find({a, m, n});
    if (known != on_solutions.end()) return known->second;
    JetSum sum = m < 2    ? field(a, m, n)
                 : n == 0 ? (m == 2 ? acceleration[at(a)] : in_time(solution(a, m - 1, 0)))
                          : in_space(solution(a, m, n - 1));
    return on_solutions.emplace(std::array{a, m, n}, std::move(sum)).first->second;
  }

  // ---- the table

  void find_places() {
    const auto& vertices = table.pattern.vertices;
    const bool bricks = table.pattern.placement == Placement::brick_wall;
    if (!table.tests.empty())
      refuse_table(
          "the method's equations are no derivatives of an action, and it has no modified Lagrangian; use a "
          "variational method");
    if (bricks && table.nodes.size() > 1)
      refuse_table("a brick wall with nodes inside its cells has too many unknowns");
    int first = vertices[0].time, last = first, left = vertices[0].space, right = left;
    for (const Site& v : vertices) {
      first = std::min(first, v.time), last = std::max(last, v.time);
      left = std::min(left, v.space), right = std::max(right, v.space);
    }
    if (last - first != 1)
      refuse_table(
          "the stencil reads " + std::to_string(last - first + 1) +
          " rows: its equations have solutions that are not smooth in time, and the smooth ones need no Lagrangian "
          "of first order in time; use a stencil of two rows");
    middle_time = first + 0.5;
    middle_space = 0.5 * (left + right);
    kinds = bricks ? 1 : static_cast<int>(table.nodes.size()) - 1;
    for (const Site& v : vertices) {
      const NodePosition node = table.nodes[at(v.node)];
      VertexPlace place{v.time + node.time - middle_time, v.space + node.space - middle_space};
      if (bricks) place.kind = 1, place.sign = (v.time + v.space) % 2 == 0 ? 1 : -1;
      else if (v.node > 0) place.kind = v.node, place.sign = 1, place.in_row = node.time == 0;
      if (!place.in_row && v.time != first) refuse_table("a node inside a step is read by two steps");
      differ_in_rows = differ_in_rows || (place.kind > 0 && place.in_row);
      places.push_back(place);
    }
    const bool inside = std::ranges::any_of(places, [](const VertexPlace& v) { return !v.in_row; });
    if (inside && differ_in_rows)
      refuse_table(
          "nodes inside a cell in time and in space both are not eliminated here; use an element of degree 1 in one of them");
  }

  /// What slot s of field a has at a point beyond ∂φ itself, as a series on solutions.
  JetSum increment(const TablePoint& point, int s, int a) {
    const auto [in_h, in_k] = slot_powers[at(s)];
    JetSum sum;
    const int highest = algebra.highest_order() + in_h + in_k;
    for (int m = 0; m <= highest; ++m)
      for (int n = 0; m + n <= highest; ++n) {
        const Monomial scale = steps(m - in_h, n - in_k);
        double moment = 0;
        std::map<int, double> of_kind;
        for (const auto& [vertex, weight] : point.slots[at(s)]) {
          const VertexPlace& place = places[at(vertex)];
          const double along = std::pow(place.space, n) / factorial(n);
          const double both = std::pow(place.time, m) / factorial(m) * along;
          moment += weight * both;
          if (place.kind == 0) continue;
          if (place.in_row) of_kind[place.kind] += weight * place.sign * both;
          else if (m == 0) of_kind[place.kind] += weight * place.sign * along;
        }
        if (m == in_h && n == in_k) moment -= 1;
        if (std::abs(moment) > nothing) algebra.add(sum, scaled(solution(a, m, n), scale), moment);
        for (const auto& [kind, weight] : of_kind)
          if (std::abs(weight) > nothing)
            algebra.add(sum, scaled(algebra.variable(jets.number({kind, m, a, n})), scale), weight);
      }
    return sum;
  }
  Monomial steps(int in_h, int in_k) {
    Monomial m;
    if (in_h != 0) m.emplace_back(algebra.atom_of(ModifiedJets::h), in_h);
    if (in_k != 0) m.emplace_back(algebra.atom_of(ModifiedJets::k), in_k);
    std::ranges::sort(m);
    return m;
  }
  JetSum scaled(const JetSum& sum, const Monomial& by) { return algebra.times(sum, JetSum{{by, {1, 1}}}); }

  /// Σ_q w_q ℓ(j_q) on solutions.
  JetSum discrete() {
    JetSum sum;
    for (const TablePoint& point : table.points) {
      JetAlgebra::Shift shift{[&](int v) -> JetSum {
        if (v == ModifiedJets::x) return algebra.times(algebra.variable(ModifiedJets::k), point.space - middle_space);
        if (v == ModifiedJets::t) return algebra.times(algebra.variable(ModifiedJets::h), point.time - middle_time);
        if (!jets.is_jet(v)) return {};
        const Derivative jet = jets.jet(v);
        const int order = jet.in_t + jet.in_x;
        return increment(point, order * (order + 1) / 2 + jet.in_x, jet.field);
      }};
      algebra.add(sum, algebra.shifted(l, shift), point.weight);
    }
    return sum;
  }

  /// ℓ̃, divergences and all.
  JetSum modified() {
    JetSum L = discrete(), of_differences;
    if (kinds > 0) {
      const std::map<int, JetSum> differences = solved_differences(L);
      keep_differences(differences);
      of_differences = boundary_terms(L, differences);
      L = algebra.substituted(L, differences);
    }
    JetSum sum = L, derivative = L;
    for (std::size_t i = 0; 2 * static_cast<int>(i + 1) <= algebra.highest_order(); ++i) {
      derivative = in_time(scaled(derivative, steps(2, 0)), 2);
      algebra.add(sum, derivative, meshed[i]);
    }
    algebra.add(sum, of_differences, -1);
    return sum;
  }

  // ---- nodes inside cells

  /// The differences ψ that L has, with all their derivatives.
  std::set<Derivative> differences_of(const JetSum& L) {
    std::set<Derivative> found;
    algebra.depends(L, [&](int v) {
      if (jets.is_difference(v)) found.insert(jets.jet(v));
      return false;
    });
    return found;
  }

  /// ψ as series on solutions, of their own equations: Newton's method, with the terms ψψ/h² or ψψ/k² of L as the matrix.
  /// An error of order p is one of order 2p − 2 in L, and of order p in its divergences, which count where ψ is in rows.
  std::map<int, JetSum> solved_differences(const JetSum& L) {
    const int d = jets.fields(), n = kinds * d;
    const auto unknown = [&](int i) { return Derivative{1 + i / d, 0, i % d, 0}; };
    const std::set<Derivative> read = differences_of(L);
    std::map<int, JetSum> values;
    const auto put = [&](const std::vector<JetSum>& psi) {
      for (const Derivative& jet : read)
        values[jets.number(jet)] = in_space(in_time(psi[at((jet.kind - 1) * d + jet.field)], jet.in_t), jet.in_x);
    };
    std::vector<JetSum> psi(at(n)), matrix;
    put(psi);
    if (read.empty()) return values;
    const int highest = algebra.highest_order(), wanted = differ_in_rows ? highest : highest / 2 + 1;
    if (highest < 2) {  // ψ is of second order at least
      return values;
    }
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        JetSum entry = algebra.substituted(by(by(L, unknown(i)), unknown(j)), values);
        matrix.push_back(algebra.of_order(entry, -2));
      }
    std::optional<std::vector<JetSum>> over;
    try {
      over = inverse(matrix, n);
    } catch (const std::domain_error&) {
    }
    if (!over || std::ranges::any_of(*over, [&](const JetSum& one) { return mixes_steps(one); }))
      refuse_table(
          "the nodes inside a cell are not eliminated here, for their equations mix h and k or several fields; use a "
          "stencil of sites, or an element with nodes inside in time alone");
    std::vector<JetSum> slopes;  // ∂L/∂ψ of every jet
    for (const Derivative& jet : read) slopes.push_back(by(L, jet));
    for (int round = 0; round < wanted; ++round) {
      std::vector<JetSum> gradient(at(n));
      std::size_t next = 0;
      for (const Derivative& jet : read) {
        const JetSum here = algebra.substituted(slopes[next++], values);
        algebra.add(gradient[at((jet.kind - 1) * d + jet.field)], in_space(in_time(here, jet.in_t), jet.in_x),
                    (jet.in_t + jet.in_x) % 2 ? -1 : 1);
      }
      bool changed = false;
      for (int i = 0; i < n; ++i) {
        JetSum by;
        for (int j = 0; j < n; ++j) algebra.add(by, algebra.times((*over)[at(i * n + j)], gradient[at(j)]), -1);
        JetSum kept;
        for (int o = 0; o <= wanted; ++o) algebra.add(kept, algebra.of_order(by, o));
        changed = changed || !kept.empty();
        algebra.add(psi[at(i)], kept);
      }
      put(psi);
      if (!changed) break;
    }
    return values;
  }
  void keep_differences(const std::map<int, JetSum>& values) {
    if (table.pattern.placement != Placement::brick_wall) return;
    between_kinds.assign(at(jets.fields()), {});
    for (int a = 0; a < jets.fields(); ++a)
      if (const auto psi = values.find(jets.number({1, 0, a, 0})); psi != values.end())
        between_kinds[at(a)] = psi->second;
  }
  /// A negative power of a sum of different powers of h and k.
  bool mixes_steps(const JetSum& sum) {
    for (const auto& [m, c] : sum)
      for (const auto& [atom, e] : m)
        if (algebra.atom(atom).kind != JetAlgebra::Atom::variable &&
            std::ranges::any_of(algebra.variables_of(atom),
                                [](int v) { return v == ModifiedJets::h || v == ModifiedJets::k; }))
          return true;
    return false;
  }

  /// Where ψ belongs to rows, a step's action has p_ψ δψ at its ends beside p δφ, with p_ψ = δL/δψ_t. That is a momentum of φ
  /// where ψ depends on φ alone. Where p_ψ does, the term D_t(p_ψ ψ) is taken off, so that it becomes −ψ δp_ψ.
  JetSum boundary_terms(const JetSum& L, const std::map<int, JetSum>& differences) {
    const int highest = algebra.highest_order();
    JetSum sum;
    if (!differ_in_rows) return sum;
    const auto of_rate = [&](const JetSum& part) {
      return algebra.depends(part, [&](int v) { return jets.is_jet(v) && jets.jet(v).in_t > 0; });
    };
    for (int kind = 1; kind <= kinds; ++kind)
      for (int a = 0; a < jets.fields(); ++a) {
        const auto psi = differences.find(jets.number({kind, 0, a, 0}));
        if (psi == differences.end() || psi->second.empty()) continue;
        const JetSum rate = algebra.substituted(euler(L, kind, 1, a), differences);
        for (int s = 2; s <= highest; ++s) {
          const JetSum part = algebra.of_order(psi->second, s);
          if (!of_rate(part)) continue;
          for (int o = -1; o + s <= highest; ++o) {
            const JetSum p = algebra.of_order(rate, o);
            if (p.empty()) continue;
            if (of_rate(p) || o + s > 4)
              refuse_table("at order " + std::to_string(o + s) +
                           " the nodes of this stencil have no Lagrangian of first order in time that is found here; " +
                           (o + s > 2 ? "ask for order 2" : "use a stencil of sites"));
            algebra.add(sum, in_time(algebra.times(p, part)));
          }
        }
      }
    return sum;
  }

  // ---- what is made of it

  /// The sum without the terms of h^a k^b together, wherever these change no equation.
  JetSum without_null_parts(const JetSum& sum) {
    JetSum result;
    for (const auto& [steps, part] : by_steps(sum)) {
      JetAlgebra::Derivation free{[this](int v) {
        if (v == ModifiedJets::t) return JetAlgebra::constant(1);
        if (!jets.is_jet(v)) return JetSum{};
        Derivative jet = jets.jet(v);
        ++jet.in_t;
        return algebra.variable(jets.number(jet));
      }};
      bool null = true;
      for (int a = 0; a < jets.fields() && null; ++a) {
        JetSum equation = euler(part, 0, 0, a);
        algebra.add(equation, algebra.derive(euler(part, 0, 1, a), free), -1);
        null = equation.empty();
      }
      if (!null) algebra.add(result, scaled(part, this->steps(-steps[1], steps[2])));
    }
    return result;
  }
  /// The terms of each h^a k^b, divided by it, by (a + b, −a, b).
  std::map<std::array<int, 3>, JetSum> by_steps(const JetSum& sum) const {
    std::map<std::array<int, 3>, JetSum> parts;
    for (const auto& [m, c] : sum) {
      Monomial rest;
      int in_h = 0, in_k = 0;
      for (const auto& power : m) {
        const JetAlgebra::Atom& atom = algebra.atom(power.first);
        const bool variable = atom.kind == JetAlgebra::Atom::variable;
        if (variable && atom.number == ModifiedJets::h) in_h = static_cast<int>(std::lround(power.second));
        else if (variable && atom.number == ModifiedJets::k) in_k = static_cast<int>(std::lround(power.second));
        else rest.push_back(power);
      }
      parts[{in_h + in_k, -in_h, in_k}].emplace(std::move(rest), c);
    }
    return parts;
  }

  /// Energy and momentum of two rows y₀ and y₁: φ and φ_t in the middle between them are, on solutions, series in
  /// A = (y₀ + y₁)/2 and B = (y₁ − y₀)/h, which take the places of φ and φ_t here:
  ///
  ///     A = Σ (h/2)ᵐ ∂ₜᵐφ/m!, m even        B = Σ (h/2)ᵐ⁻¹ ∂ₜᵐφ/m!, m odd
  ///
  OfRows of_rows(double h, double k) {
    JetSum energy = algebra.times(lagrangian, -1), momentum;
    for (int a = 0; a < jets.fields(); ++a) {
      const JetSum p = euler(lagrangian, 0, 1, a);
      algebra.add(energy, algebra.times(p, field(a, 1, 0)));
      algebra.add(momentum, algebra.times(p, field(a, 0, 1)), -1);
    }
    const int order = algebra.highest_order();
    algebra.set_highest_order(order - 2);
    for (int round = 0; round < order - 2; ++round) correct_acceleration(lagrangian);
    algebra.set_highest_order(order);
    forget_derivatives();
    const int d = jets.fields();
    std::vector<JetSum> change(at(2 * d));  // of φ, then of φ_t
    const auto shifted = [&](const JetSum& sum) {
      JetAlgebra::Shift shift{[&](int v) {
        if (!jets.is_jet(v)) return JetSum{};
        const Derivative jet = jets.jet(v);
        return in_space(change[at(jet.in_t * d + jet.field)], jet.in_x);
      }};
      return algebra.shifted(sum, shift);
    };
    for (int round = 0; round < order / 2; ++round) {
      std::vector<JetSum> next(at(2 * d));
      for (int m = 2; m <= order + 1; ++m)
        for (int a = 0; a < d; ++a) {
          const int in_h = m - m % 2;
          const JetSum term = shifted(scaled(solution(a, m, 0), steps(in_h, 0)));
          algebra.add(next[at(m % 2 * d + a)], term, -std::pow(0.5, in_h) / factorial(m));
        }
      change = next;
    }
    OfRows found;
    std::map<int, int> inputs;  // their numbers, by variable
    Graph all;
    const int roots[] = {algebra.node(all, shifted(energy)), algebra.node(all, shifted(momentum))};
    const std::vector<bool> wanted = all.reachable({roots[0], roots[1]});
    for (int i = 0; i < all.size(); ++i) {
      if (!wanted[at(i)] || all[i].operation != Operation::variable || !jets.is_jet(all[i].a)) continue;
      inputs.emplace(all[i].a, static_cast<int>(found.inputs.size()));
      const Derivative& jet = jets.jet(all[i].a);
      found.inputs.push_back({jet.field, jet.in_t, jet.in_x});
    }
    const int count = static_cast<int>(found.inputs.size());
    const auto in_place_of = [&](int v) {
      Graph& graph = all;
      if (v == ModifiedJets::h || v == ModifiedJets::k) return graph.constant(v == ModifiedJets::h ? h : k);
      if (v == ModifiedJets::x || v == ModifiedJets::t) return graph.variable(v == ModifiedJets::x ? count : count + 1);
      if (!jets.is_jet(v)) return graph.constant(jets.names().parameters[at(v - ModifiedJets::parameters)].second);
      return graph.variable(inputs.at(v));
    };
    found.energy = all.substitute(roots[0], in_place_of);
    found.momentum = all.substitute(roots[1], in_place_of);
    found.graph = std::move(all);
    return found;
  }

  /// The least common denominator of the coefficients; 1 if some are no fractions with one below a million.
  static double denominator_of(const JetSum& sum) {
    constexpr double most = 1e6, near = 1e-11;
    double common = 1;
    for (const auto& [m, c] : sum) {
      const double value = std::abs(c.value) * common;
      double rest = value, before = 0, q = 1;  // by its continued fraction
      const auto is_whole = [&] {
        return std::abs(value * q - std::round(value * q)) <= near * std::max(1.0, value * q);
      };
      while (!is_whole() && q * common < most) {
        rest = 1 / (rest - std::floor(rest));
        const double next = std::floor(rest) * q + before;
        before = q, q = next;
      }
      if (!is_whole() || q * common > most) return 1;
      common *= q;
    }
    return common;
  }

  /// Sums of irrational weights have rounding errors in their last digits.
  static double to_ten_digits(double value) {
    const double scale = std::pow(10, 9 - std::floor(std::log10(std::abs(value))));
    return std::round(value * scale) / scale;
  }

  std::vector<Part> parts(const JetSum& of, Notation notation) const {
    std::vector<Part> result;
    const Naming naming{[&](int v) { return jets.name(v, notation); },
                        [&](int v) {
                          if (!jets.is_jet(v)) return 0;
                          const Derivative& jet = jets.jet(v);
                          return 10 * (jet.in_t + jet.in_x) + jet.in_t;
                        }};
    for (const auto& [steps, sum] : by_steps(of)) {
      const double denominator = steps[0] == 0 ? 1 : denominator_of(sum);
      JetSum whole;
      for (const auto& [m, c] : sum) {
        const double value = c.value * denominator;
        const bool near = std::abs(value - std::round(value)) <= 1e-8 * std::abs(value);
        const double shown = steps[0] == 0 ? value : near ? std::round(value) : to_ten_digits(value);
        whole.emplace(m, Coefficient{shown, 1});
      }
      Graph graph;
      for (int v = ModifiedJets::parameters; v < jets.first(); ++v) graph.variable(v);  // first in a product
      std::vector<int> nodes;
      for (const auto& [m, c] : whole) nodes.push_back(algebra.node(graph, JetSum{{m, c}}));
      Sums sums(graph, [](int) { return false; });
      result.push_back({-steps[1], steps[2], denominator, printed(sums, sums.of(nodes), naming, notation)});
    }
    return result;
  }

  ModifiedJets jets;
  StencilTable table;
  JetAlgebra algebra;
  JetSum l, lagrangian;
  std::vector<JetSum> over_mass, acceleration, between_kinds;
  JetAlgebra::Derivation along_x, along_t;
  std::map<std::array<int, 3>, JetSum> on_solutions;
  std::vector<VertexPlace> places;
  double middle_time = 0, middle_space = 0;
  int kinds = 0;
  bool differ_in_rows = false;
};

ModifiedLagrangian::ModifiedLagrangian(const SymbolicDensity& density, const StencilTable& table, int order)
    : impl_(std::make_unique<Impl>(density, table, order)) {}
ModifiedLagrangian::~ModifiedLagrangian() = default;
ModifiedLagrangian::ModifiedLagrangian(ModifiedLagrangian&&) noexcept = default;

std::vector<ModifiedLagrangian::Part> ModifiedLagrangian::parts(Notation notation) const {
  return impl_->parts(impl_->lagrangian, notation);
}
std::vector<ModifiedLagrangian::Part> ModifiedLagrangian::between_kinds(int field, Notation notation) const {
  return impl_->between_kinds.empty() ? std::vector<Part>{} : impl_->parts(impl_->between_kinds[at(field)], notation);
}
ModifiedLagrangian::OfRows ModifiedLagrangian::of_rows(double h, double k) { return impl_->of_rows(h, k); }

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "jets/expressions/modified/divergences.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lattice/index.hpp"

namespace delf::expressions {
namespace {

class Divergences {
 public:
  Divergences(JetAlgebra& algebra, ModifiedJets& jets) : algebra_(algebra), jets_(jets) {}

  JetSum removed(JetSum todo) {
    JetSum done;
    for (int steps = 0; !todo.empty(); ++steps) {
      if (steps > most_steps) throw TooLarge("the modified Lagrangian has too many terms");
      const auto [m, c] = *std::prev(todo.end());
      todo.erase(std::prev(todo.end()));
      JetSum by_parts;
      if (const auto parts = in_space(m)) by_parts = *parts;
      else if (const auto other = in_time(m)) by_parts = *other;
      else {
        algebra_.insert(done, m, c);
        continue;
      }
      for (const auto& [term, of] : by_parts) algebra_.insert(todo, term, {c.value * of.value, c.size * of.size});
    }
    return done;
  }

 private:
  static constexpr int most_steps = 200'000;
  using Derivative = ModifiedJets::Derivative;

  int rank(const Derivative& jet) const { return jet.in_t * jets_.fields() + jet.field; }
  bool is_variable(int atom) const { return algebra_.atom(atom).kind == JetAlgebra::Atom::variable; }
  /// The jet that an atom is; null for another.
  const Derivative* jet_of(int atom) const {
    if (!is_variable(atom)) return nullptr;
    const int v = algebra_.atom(atom).number;
    return jets_.is_jet(v) ? &jets_.jet(v) : nullptr;
  }
  bool any_dependence(int atom, const auto& holds) const {
    return std::ranges::any_of(algebra_.variables_of(atom),
                               [&](int v) { return v >= 0 && jets_.is_jet(v) && holds(jets_.jet(v)); });
  }
  int highest(const Monomial& m) const {
    int n = 0;
    for (const auto& [atom, e] : m)
      any_dependence(atom, [&](const Derivative& jet) { return n = std::max(n, jet.in_x), false; });
    return n;
  }
  JetSum one(const Monomial& m) {
    JetSum sum;
    algebra_.insert(sum, m, {1, 1});
    return sum;
  }
  Derivative next(Derivative jet, bool in_t) const {
    if (in_t) ++jet.in_t;
    else ++jet.in_x;
    return jet;
  }
  JetSum derivative(const JetSum& sum, bool in_t) {
    JetAlgebra::Derivation d{[&](int v) {
      if (v == (in_t ? ModifiedJets::t : ModifiedJets::x)) return JetAlgebra::constant(1);
      return jets_.is_jet(v) ? algebra_.variable(jets_.number(next(jets_.jet(v), in_t))) : JetSum{};
    }};
    return algebra_.derive(sum, d);
  }
  bool reads(const Monomial& m, int variable) const {
    return std::ranges::any_of(
        m, [&](const auto& p) { return std::ranges::count(algebra_.variables_of(p.first), variable) > 0; });
  }

  /// −uⁿ⁺¹ D s/(n + 1) in the place of s uⁿ Du, which is the monomial. Nothing if s depends on u in another way, or, beside
  /// u itself, on what would come back.
  std::optional<JetSum> by_parts(const Monomial& m, std::size_t top, const Derivative& u, bool in_t,
                                 const auto& hinders) {
    const int number = jets_.number(u);
    double power = 0;
    Monomial s;
    bool hindered = false, of_u_alone = true;
    for (std::size_t i = 0; i < m.size(); ++i) {
      if (i == top) continue;
      const auto& [atom, e] = m[i];
      if (const Derivative* jet = jet_of(atom); jet && *jet == u && e > 0 && e == std::round(e)) {
        power = e;
        continue;
      }
      of_u_alone = of_u_alone && !any_dependence(atom, [&](const Derivative& jet) { return jet != u; });
      hindered =
          hindered || any_dependence(atom, hinders) || std::ranges::count(algebra_.variables_of(atom), number) > 0;
      s.push_back(m[i]);
    }
    // f(u) Du is a derivative whatever f is
    if (of_u_alone && !reads(m, in_t ? ModifiedJets::t : ModifiedJets::x)) return JetSum{};
    if (hindered) return std::nullopt;
    const JetSum raised = algebra_.power(algebra_.variable(number), power + 1);
    return algebra_.times(algebra_.times(derivative(one(s), in_t), raised), -1 / (power + 1));
  }

  std::optional<JetSum> in_space(const Monomial& m) {
    const int n = highest(m);
    if (n == 0) return std::nullopt;
    std::optional<std::size_t> top;
    for (std::size_t i = 0; i < m.size(); ++i) {
      if (!any_dependence(m[i].first, [&](const Derivative& jet) { return jet.in_x == n; })) continue;
      if (top || !is_variable(m[i].first) || m[i].second != 1) return std::nullopt;
      top = i;
    }
    Derivative u = *jet_of(m[*top].first);
    --u.in_x;
    return by_parts(m, *top, u, false, [&](const Derivative& jet) { return jet.in_x == n - 1 && rank(jet) > rank(u); });
  }

  /// The only φ_t is one factor of the monomial.
  std::optional<JetSum> in_time(const Monomial& m) {
    std::optional<std::size_t> top;
    for (std::size_t i = 0; i < m.size(); ++i) {
      if (!any_dependence(m[i].first, [](const Derivative& jet) { return jet.in_t > 0; })) continue;
      if (top || !is_variable(m[i].first) || m[i].second != 1) return std::nullopt;
      top = i;
    }
    if (!top) return std::nullopt;
    Derivative u = *jet_of(m[*top].first);
    --u.in_t;
    return by_parts(m, *top, u, true, [&](const Derivative& jet) {
      return jet.in_x > u.in_x || (jet.in_x == u.in_x && jet.field > u.field);
    });
  }

  JetAlgebra& algebra_;
  ModifiedJets& jets_;
};

}  // namespace

JetSum without_divergences(JetAlgebra& algebra, ModifiedJets& jets, JetSum sum) {
  return Divergences(algebra, jets).removed(std::move(sum));
}

}  // namespace delf::expressions

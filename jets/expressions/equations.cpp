// SPDX-License-Identifier: MIT
#include "jets/expressions/equations.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "jets/expressions/constraints.hpp"
#include "jets/expressions/euler_lagrange.hpp"
#include "jets/expressions/evaluate.hpp"
#include "lattice/index.hpp"

namespace delf {
namespace {

using namespace expressions;

std::string too_large_in(Notation notation) {
  const std::string words = "too large to be written here";
  return notation == Notation::mathml ? "<mtext>" + words + "</mtext>" : words;
}

std::string name_of(const std::string& name, Notation notation) {
  return notation == Notation::latex ? latex_name(name) : notation == Notation::mathml ? mathml_name(name) : name;
}

/// λ, or of several λ₁, λ₂, …, unless something else is called that.
std::string multiplier_name(const ExpressionNames& names, int m, int count) {
  const auto taken = [&](const std::string& name) {
    return std::ranges::count(names.fields, name) > 0 ||
           std::ranges::count(names.parameters, name, &std::pair<std::string, double>::first) > 0;
  };
  std::string name = taken("lambda") ? "multiplier" : "lambda";
  if (count > 1) name += std::to_string(m + 1);
  return name;
}

/// `constraints`: how many there are.
std::string jet_name(int variable, const JetVariables& jets, const ExpressionNames& names, Notation notation,
                     int constraints = 0) {
  if (variable == jets.x()) return "x";
  if (variable == jets.t()) return "t";
  if (const int m = variable - jets.multiplier(0); m >= 0)
    return name_of(multiplier_name(names, m, constraints), notation);
  if (!jets.is_derivative(variable)) return name_of(names.parameters[variable - jets.parameter(0)].first, notation);
  const auto [a, in_t, in_x] = jets.of(variable);
  const std::string by = std::string(delf::at(in_t), 't') + std::string(delf::at(in_x), 'x');
  if (notation == Notation::mathml) {
    std::string letters;  // each by itself: a name of several is upright
    for (const char letter : by) letters.append("<mi>").append(1, letter).append("</mi>");
    return mathml_name(names.fields[a], letters);
  }
  const std::string field = name_of(names.fields[a], notation);
  if (by.empty()) return field;
  if (notation == Notation::plain) return field + "_" + by;
  // one subscript: u_1 and its derivative u_{1,tt}
  if (field.back() == '}' && field.find("_{") != std::string::npos)
    return field.substr(0, field.size() - 1) + "," + by + "}";
  return field + "_{" + by + "}";
}

/// The terms of ℓ and of its field equations come by derivatives: φ_tt before φ_xx before φ_t before φ.
int rank_of(int variable, const JetVariables& jets) {
  if (!jets.is_derivative(variable)) return 0;
  const auto [a, in_t, in_x] = jets.of(variable);
  return 10 * (in_t + in_x) + in_t;
}

Naming jet_naming(const JetVariables& jets, const ExpressionNames& names, Notation notation, int constraints = 0) {
  return {[&jets, &names, notation, constraints](int v) { return jet_name(v, jets, names, notation, constraints); },
          [&jets](int v) { return rank_of(v, jets); }};
}

bool none(int) { return false; }

/// Values of fields at sites, h, k, parameters, x and t of the site: variables of the discrete equations.
class SiteVariables {
 public:
  enum : int { h, k, x, t, parameters };
  SiteVariables(const ExpressionNames& names, int constraints) : names_(names), constraints_(constraints) {}
  int multiplier(int m) const { return parameters + static_cast<int>(names_.parameters.size()) + m; }

  int at(int field, int time, int space) {
    const auto [place, made] = known_.try_emplace({field, time, space}, first_site() + static_cast<int>(sites_.size()));
    if (made) sites_.push_back({field, time, space});
    return place->second;
  }
  bool is_site(int v) const { return v >= first_site(); }
  int rank(int v) const {  // later rows first, and in a row from left to right
    if (!is_site(v)) return 0;
    const auto& [field, time, space] = sites_[v - first_site()];
    return 1000 + 100 * time - space;
  }
  std::string name(int v, Notation notation) const {
    constexpr const char* letters[] = {"h", "k", "x", "t"};
    if (notation == Notation::mathml) {
      if (v < parameters) return mathml_name(letters[v], v == x ? "<mi>i</mi>" : v == t ? "<mi>j</mi>" : "");
      if (v >= multiplier(0) && !is_site(v))
        return mathml_name(multiplier_name(names_, v - multiplier(0), constraints_), "<mi>i</mi>", "<mi>j</mi>");
      if (!is_site(v)) return mathml_name(names_.parameters[v - parameters].first);
      const auto& [field, time, space] = sites_[v - first_site()];
      return mathml_name(names_.fields[field], index_in_mathml("i", space), index_in_mathml("j", time));
    }
    if (v >= multiplier(0) && !is_site(v)) {
      const std::string lambda = name_of(multiplier_name(names_, v - multiplier(0), constraints_), notation);
      return lambda + (notation == Notation::latex ? "_{i}^{j}" : "(j,i)");
    }
    if (v < parameters)
      return v == x   ? (notation == Notation::latex ? "x_i" : "x(i)")
             : v == t ? (notation == Notation::latex ? "t_j" : "t(j)")
                      : letters[v];
    if (!is_site(v)) return name_of(names_.parameters[v - parameters].first, notation);
    const auto& [field, time, space] = sites_[v - first_site()];
    const auto index = [](const char* letter, int offset) {
      std::string text(letter);
      if (offset > 0) text += '+';
      return offset == 0 ? text : text.append(std::to_string(offset));
    };
    const std::string u = name_of(names_.fields[field], notation);
    if (notation == Notation::plain) return u + "(" + index("j", time) + "," + index("i", space) + ")";
    const std::string sub = index("i", space);
    if (u.back() == '}' && u.find("_{") != std::string::npos)
      return u.substr(0, u.size() - 1) + ",\\," + sub + "}^{" + index("j", time) + "}";
    return u + "_{" + sub + "}^{" + index("j", time) + "}";
  }

 private:
  int first_site() const { return multiplier(constraints_); }
  static std::string index_in_mathml(const std::string& letter, int offset) {
    const std::string text = "<mi>" + letter + "</mi>";
    if (offset == 0) return text;
    return text + (offset > 0 ? "<mo>+</mo><mn>" : "<mo>\u2212</mo><mn>") + std::to_string(std::abs(offset)) + "</mn>";
  }

  const ExpressionNames& names_;
  int constraints_;
  std::map<std::tuple<int, int, int>, int> known_;
  std::vector<std::tuple<int, int, int>> sites_;
};

class DiscreteEquations {
 public:
  DiscreteEquations(const SymbolicDensity& density, const StencilTable& table)
      : table_(table),
        jets_(density.names()),
        sites_(density.names(), static_cast<int>(constraints_of(density.constraint()).size())) {
    l_ = parse(graph_, density.text(), jets_.names, "theory.density");
    for (const std::string& constraint : constraints_of(density.constraint()))
      G_.push_back(parse(graph_, constraint, jets_.names, "theory.constraint"));
  }

  std::string equation(int a, std::optional<int> parity, Notation notation) {
    std::vector<int> terms;
    const auto& vertices = table_.pattern.vertices;
    for (std::size_t l = 0; l < vertices.size(); ++l) {
      if (parity && (vertices[l].time + vertices[l].space - *parity) % 2 != 0) continue;
      for (const TablePoint& point : table_.points) add(a, static_cast<int>(l), point, terms);
    }
    for (std::size_t m = 0; m < G_.size(); ++m) {  // hk λ G at the site
      const int force = graph_.substitute(graph_.differentiate(G_[m], a), [&](int v) {
        return jets_.is_derivative(v) ? graph_.variable(sites_.at(v, 0, 0))
                                      : graph_.variable(SiteVariables::parameters + v - jets_.parameter(0));
      });
      terms.push_back(graph_.negate(graph_.multiply(graph_.variable(sites_.multiplier(static_cast<int>(m))), force)));
    }
    Sums sums(graph_, [](int v) { return v == SiteVariables::h || v == SiteVariables::k; });
    const Naming naming{[&](int v) { return sites_.name(v, notation); }, [&](int v) { return sites_.rank(v); }};
    return equals_zero(printed(sums, sums.of(terms), naming, notation, [&](int v) { return sites_.is_site(v); }),
                       notation);
  }

 private:
  // −measure · w_q Σ_slots ∂ℓ/∂(slot)(j_q) ∂(slot)/∂yˡ, where vertex l of the stencil is the site (j, i)
  void add(int a, int l, const TablePoint& point, std::vector<int>& terms) {
    for (int s = 0; s < jet_slots; ++s)
      for (const TablePoint::Entry& entry : point.slots[delf::at(s)]) {
        if (entry.vertex != l) continue;
        const int slope = graph_.differentiate(l_, s * jets_.d + a);
        if (graph_.is_constant(slope, 0)) continue;
        const int here = graph_.substitute(slope, [&](int v) { return at_point(v, l, point); });
        const int weight = graph_.constant(-table_.measure * point.weight * entry.weight);
        terms.push_back(graph_.multiply(weight, graph_.divide(here, scale(s))));
      }
  }
  /// A variable of the density at a quadrature point, by the values at sites.
  int at_point(int v, int l, const TablePoint& point) {
    const Site own = table_.pattern.vertices[l];
    const auto shifted = [&](int variable, double by, int step) {
      return graph_.add(graph_.variable(variable), graph_.multiply(graph_.constant(by), graph_.variable(step)));
    };
    if (v == jets_.x()) return shifted(SiteVariables::x, point.space - own.space, SiteVariables::k);
    if (v == jets_.t()) return shifted(SiteVariables::t, point.time - own.time, SiteVariables::h);
    if (!jets_.is_derivative(v)) return graph_.variable(SiteVariables::parameters + v - jets_.parameter(0));
    const int s = v / jets_.d;
    int sum = graph_.constant(0);
    for (const TablePoint::Entry& entry : point.slots[delf::at(s)]) {
      const Site site = table_.pattern.vertices[entry.vertex];
      const int y = graph_.variable(sites_.at(v % jets_.d, site.time - own.time, site.space - own.space));
      sum = graph_.add(sum, graph_.multiply(graph_.constant(entry.weight), y));
    }
    return graph_.divide(sum, scale(s));
  }
  int scale(int slot) {
    const auto [time, space] = slot_powers[delf::at(slot)];
    return graph_.multiply(graph_.power(graph_.variable(SiteVariables::h), static_cast<double>(time)),
                           graph_.power(graph_.variable(SiteVariables::k), static_cast<double>(space)));
  }

  const StencilTable& table_;
  JetVariables jets_;
  SiteVariables sites_;
  Graph graph_;
  int l_ = 0;
  std::vector<int> G_;  ///< of each constraint
};

std::string number(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6).ptr;
  return {text.data(), end};
}

}  // namespace

bool SymbolicDensity::has_values(std::span<const double> jet, double t, double x) const {
  const std::size_t m = jet.size();
  std::vector<Pack> in, out(m + 1);
  for (const double value : jet) in.emplace_back(value);
  in.emplace_back(x);
  std::vector<const double*> slots;
  std::vector<double*> gradient_rows;
  for (std::size_t a = 0; a < m; ++a) slots.push_back(reinterpret_cast<const double*>(&in[a]));
  for (std::size_t a = 0; a <= m; ++a) gradient_rows.push_back(reinterpret_cast<double*>(&out[a]));
  gradient({lanes, slots.data(), t, reinterpret_cast<const double*>(&in[m])}, gradient_rows.data(), gradient_rows[m]);
  return std::ranges::all_of(out, [](const Pack& p) { return std::isfinite(p[0]); });
}

std::string SymbolicDensity::without_value(std::span<const double> jet, double t, double x) const {
  if (has_values(jet, t, x)) return {};
  const JetVariables jets(names());
  Graph graph;
  try {
    std::vector<int> roots{parse(graph, text(), jets.names, "theory.density")};
    for (int v = 0; v < static_cast<int>(jet.size()); ++v) roots.push_back(graph.differentiate(roots[0], v));
    const auto value_of = [&](int v) {
      if (v == jets.t() || v == jets.x()) return v == jets.t() ? t : x;
      if (!jets.is_derivative(v)) return names().parameters[v - jets.parameter(0)].second;
      return v < static_cast<int>(jet.size()) ? jet[v] : 0.0;
    };
    const std::vector<bool> wanted = graph.reachable(roots);
    for (int i = 0; i < graph.size(); ++i) {  // operands come first: so does what has no value by itself
      if (!wanted[i]) continue;
      const Evaluation part(graph, i);
      if (std::isfinite(part.operator()<double>(value_of))) continue;
      std::string reason = formula_of(graph, i, jets, names()) + " has no value";
      const char* next = ", where ";
      for (int v = 0; v < jets.parameter(static_cast<int>(names().parameters.size())); ++v)
        if (part.reads(v))
          reason += next + jet_name(v, jets, names(), Notation::plain) + " = " + number(value_of(v)), next = ", ";
      return reason;
    }
  } catch (const TooLarge&) {
  }
  return {};
}

std::string formula_of(const Graph& graph, int node, const JetVariables& jets, const ExpressionNames& names) {
  Sums sums(graph, none);
  return printed(sums, sums.of({node}), jet_naming(jets, names, Notation::plain), Notation::plain);
}

std::string density_formula(const SymbolicDensity& density, Notation notation) {
  if (notation == Notation::plain) return density.text();
  const JetVariables jets(density.names());
  try {
    Graph graph;
    const int l = parse(graph, density.text(), jets.names, "theory.density");
    Sums sums(graph, none);
    return printed(sums, sums.of({l}), jet_naming(jets, density.names(), notation), notation);
  } catch (const TooLarge&) {
    return too_large_in(notation);
  }
}

namespace {

std::string constraint_formula(const SymbolicDensity& density, const std::string& constraint, Notation notation) {
  const JetVariables jets(density.names());
  Graph graph;
  Sums sums(graph, none);
  const int G = parse(graph, constraint, jets.names, "theory.constraint");
  return equals_zero(printed(sums, sums.of({G}), jet_naming(jets, density.names(), notation), notation), notation);
}

}  // namespace

std::vector<std::string> field_equations(const SymbolicDensity& density, Notation notation) {
  const JetVariables jets(density.names());
  const int constraints = static_cast<int>(constraints_of(density.constraint()).size());
  std::vector<std::string> equations;
  for (int a = 0; a < jets.d; ++a) try {
      Graph graph;
      const int l = parse(graph, density.text(), jets.names, "theory.density");
      Sums sums(graph, none);
      std::vector<int> terms = euler_lagrange(graph, l, a, jets);
      for (int m = 0; m < constraints; ++m) {  // of ℓ + Σ λ G
        const int G = parse(graph, constraints_of(density.constraint())[at(m)], jets.names, "theory.constraint");
        terms.push_back(graph.negate(graph.multiply(graph.variable(jets.multiplier(m)), graph.differentiate(G, a))));
      }
      equations.push_back(equals_zero(
          printed(sums, sums.of(terms), jet_naming(jets, density.names(), notation, constraints), notation), notation));
    } catch (const TooLarge&) {
      equations.emplace_back(too_large_in(notation));
    }
  for (const std::string& constraint : constraints_of(density.constraint()))
    equations.push_back(constraint_formula(density, constraint, notation));
  return equations;
}

std::vector<std::string> discrete_field_equations(const SymbolicDensity& density, const StencilTable& table,
                                                  Notation notation) {
  std::vector<std::string> equations;
  std::vector<std::optional<int>> parities{std::nullopt};
  if (table.pattern.placement == Placement::brick_wall) parities = {0, 1};
  for (int a = 0; a < density.components(); ++a)
    for (const auto& parity : parities) try {
        equations.push_back(DiscreteEquations(density, table).equation(a, parity, notation));
        const char* which = parity && *parity == 0 ? "even" : "odd";
        if (parity && notation == Notation::mathml)
          equations.back() += std::string("<mtext>  (i + j ") + which + ")</mtext>";
        else if (parity)
          equations.back() += std::string(notation == Notation::latex ? "\\quad (i + j \\text{ " : "  (i + j ") +
                              which + (notation == Notation::latex ? "})" : ")");
      } catch (const TooLarge&) {
        equations.emplace_back(too_large_in(notation));
      }
  return equations;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "jets/expressions/field_equation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "jets/expressions/constraints.hpp"
#include "jets/expressions/euler_lagrange.hpp"
#include "jets/expressions/evaluate.hpp"
#include "jets/expressions/expression.hpp"
#include "jets/expressions/parse.hpp"
#include "jets/one_jet.hpp"

namespace delf {

using namespace expressions;

class FieldEquations::Form {
 public:
  explicit Form(int order) : order_(order) {}
  virtual ~Form() = default;
  int order() const { return order_; }
  virtual std::vector<Value> values(std::span<const double> jet, double t, double x) const = 0;

 private:
  int order_;
};

namespace {

/// x −= (x·n/|n|²) n
void take_along(const std::vector<double>& n, std::vector<double>& x) {
  double along = 0, square = 0;
  for (std::size_t a = 0; a < n.size(); ++a) along += x[a] * n[a], square += n[a] * n[a];
  for (std::size_t a = 0; a < n.size() && square > 0; ++a) x[a] -= along / square * n[a];
}
void take_along(const std::vector<double>& n, std::vector<FieldEquations::Value>& E) {
  double along = 0, square = 0;
  for (std::size_t a = 0; a < n.size(); ++a) along += E[a].sum * n[a], square += n[a] * n[a];
  for (std::size_t a = 0; a < n.size() && square > 0; ++a) {
    const double force = along / square * n[a];
    E[a].sum -= force, E[a].absolute += std::abs(force);
  }
}

/// The equations of a density as text, by the rules of differentiation.
class OfText final : public FieldEquations::Form {
 public:
  explicit OfText(const SymbolicDensity& density)
      : Form(density.slots() > 3 ? 4 : 2), jets_(density.names()), parameters_(density.names().parameters) {
    Graph graph;
    const int l = parse(graph, density.text(), jets_.names, "theory.density");
    terms_.resize(jets_.d);
    for (int a = 0; a < jets_.d; ++a)
      for (const int term : euler_lagrange(graph, l, a, jets_)) terms_[a].emplace_back(graph, term);
    for (const std::string& constraint : constraints_of(density.constraint())) {
      const int G = parse(graph, constraint, jets_.names, "theory.constraint");
      std::vector<Evaluation>& of_G = constraints_.emplace_back();
      of_G.emplace_back(graph, G);
      for (int a = 0; a < jets_.d; ++a) of_G.emplace_back(graph, graph.differentiate(G, jets_.derivative(a, 0, 0)));
    }
  }

  std::vector<FieldEquations::Value> values(std::span<const double> jet, double t, double x) const override {
    const auto variable = [&](int v) {
      if (jets_.is_derivative(v)) return jet[v];
      if (v == jets_.t() || v == jets_.x()) return v == jets_.t() ? t : x;
      return parameters_[v - jets_.parameter(0)].second;
    };
    std::vector<FieldEquations::Value> E(jets_.d);
    for (std::size_t a = 0; a < E.size(); ++a)
      for (const Evaluation& term : terms_[a]) {
        const double value = term.operator()<double>(variable);
        E[a].sum += value, E[a].absolute += std::abs(value);
      }
    // E − Σ λ_m ∂G_m: what is left of E across all slopes, made orthogonal one after another
    std::vector<std::vector<double>> slopes;
    std::vector<FieldEquations::Value> G;
    for (const std::vector<Evaluation>& of_G : constraints_) {
      std::vector<double>& slope = slopes.emplace_back();
      FieldEquations::Value& value = G.emplace_back(of_G[0].operator()<double>(variable), 0);
      for (int a = 0; a < jets_.d; ++a) {
        slope.push_back(of_G[a + 1].operator()<double>(variable));
        value.absolute += std::abs(slope.back() * jet[jets_.derivative(a, 0, 0)]);
      }
      for (std::size_t m = 0; m + 1 < slopes.size(); ++m) take_along(slopes[m], slope);
      take_along(slope, E);
    }
    E.insert(E.end(), G.begin(), G.end());
    return E;
  }

 private:
  JetVariables jets_;
  std::vector<std::pair<std::string, double>> parameters_;
  std::vector<std::vector<Evaluation>> terms_;
  std::vector<std::vector<Evaluation>> constraints_;  ///< of each G, ∂G/∂φ_a
};

/// The equations of a compiled density of first order, by its Hessian.
class OfHessian final : public FieldEquations::Form {
 public:
  explicit OfHessian(const BatchDensity& density) : Form(2), density_(density) {}

  std::vector<FieldEquations::Value> values(std::span<const double> jet, double t, double x) const override {
    const int d = density_.components(), m = density_.variables();
    const std::vector<double> g = gradient_at(density_, jet, t, x), H = hessian_at(density_, jet, t, x);
    // D_t and D_x of φ, φ_t, φ_x are φ_t, φ_tt, φ_tx and φ_x, φ_tx, φ_xx
    constexpr int by_t[] = {1, 3, 4}, by_x[] = {2, 4, 5};
    std::vector<FieldEquations::Value> E(d);
    for (int a = 0; a < d; ++a) {
      const auto add = [&](double term) { E[a].sum += term, E[a].absolute += std::abs(term); };
      add(-g[a]);
      for (int s = 0; s < 3; ++s)
        for (int b = 0; b < d; ++b) {
          add(H[(d + a) * m + s * d + b] * jet[by_t[s] * d + b]);
          add(H[(2 * d + a) * m + s * d + b] * jet[by_x[s] * d + b]);
        }
    }
    if (!density_.is_placed()) return E;
    // what changes with t and x at a fixed jet, by differences
    constexpr double step = 1e-4;
    for (const bool in_t : {true, false}) {
      const double by = step * std::max(1.0, std::abs(in_t ? t : x));
      const auto above = gradient_at(density_, jet, in_t ? t + by : t, in_t ? x : x + by),
                 below = gradient_at(density_, jet, in_t ? t - by : t, in_t ? x : x - by);
      for (int a = 0; a < d; ++a) {
        const int v = (in_t ? d : 2 * d) + a;
        const double term = (above[v] - below[v]) / (2 * by);
        E[a].sum += term, E[a].absolute += std::abs(term);
      }
    }
    return E;
  }

 private:
  const BatchDensity& density_;
};

}  // namespace

std::optional<FieldEquations> FieldEquations::of(const BatchDensity& density) {
  if (const SymbolicDensity* text = density.formula()) try {
      return FieldEquations(std::make_shared<const OfText>(*text));
    } catch (const TooLarge&) {
      return std::nullopt;
    }
  if (density.slots() > 3) return std::nullopt;
  return FieldEquations(std::make_shared<const OfHessian>(density));
}

int FieldEquations::order() const { return form_->order(); }

std::vector<FieldEquations::Value> FieldEquations::operator()(std::span<const double> jet, double t, double x) const {
  return form_->values(jet, t, x);
}

std::vector<double> FieldEquations::rounding(std::span<const double> jet, double t, double x, double rounding) const {
  constexpr double change = 1e-7;
  const std::vector<Value> here = form_->values(jet, t, x);
  std::vector<double> changed(jet.begin(), jet.end()), sums(here.size(), 0.0);
  for (std::size_t n = 0; n < changed.size(); ++n) {
    if (jet[n] == 0) continue;
    changed[n] = jet[n] * (1 + change);
    const std::vector<Value> there = form_->values(changed, t, x);
    for (std::size_t a = 0; a < sums.size(); ++a) sums[a] += std::abs(there[a].sum - here[a].sum) * rounding / change;
    changed[n] = jet[n];
  }
  return sums;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "jets/tables/line_basis.hpp"
#include "jets/tables/line_rule.hpp"
#include "jets/tables/stencil_table.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/families/stencil_family.hpp"

namespace delf {

/// A formula of t for a field at an end of an interval, of the text that `key` of a scene gives.
struct FormulaOfTime {
  std::string key, text;
  std::shared_ptr<const Formula> formula;

  /// Throws BadInput where it has no finite value.
  double operator()(double t) const {
    const double value = (*formula)(t, 0);
    if (!std::isfinite(value))
      throw BadInput(key,
                     fmt::format("{} = {}: has no finite value at t = {:.6g}; write it so that it has one in every "
                                 "row, from the one before the start on",
                                 key, text, t));
    return value;
  }
  double by_t(double t) const { return formula->by_t(t, 0); }
};
/// One for each field.
using FormulasOfTime = std::vector<FormulaOfTime>;

/// A wall whose value is data for all times: φ_a(t) = f_a(t). The stencil is its site, of which it says the value and varies
/// nothing: as a fixed wall it has no equation. Steppers put the value into a row before they solve it (DrivenValues). Nodes
/// inside a step have the value at their time; in broken elements that of the polynomial through f at the points of Lobatto's
/// rule, so that both ends of a step are joined there too.
class DrivenEnd final : public StencilFamily {
 public:
  /// `functions` of a broken element; 0: steps share their ends, or have none.
  DrivenEnd(Placement wall, FormulasOfTime motion, int functions = 0)
      : StencilFamily(StencilPattern({{0, 0}}, wall), fields(motion.size()), true), motion_(std::move(motion)) {
    varied_.assign(motion_.size(), false);
    if (functions > 1) through_ = lobatto_rule(functions).points;
  }

  const DrivenEnd* driven_end() const override { return this; }
  bool is_left() const { return pattern().placement == Placement::left_wall; }
  /// Of a node at this part of the step h that begins at t.
  double value(int field, double t, double h, double part) const {
    return at_node(t, h, part, [&](double time) { return motion_[at(field)](time); });
  }
  double rate(int field, double t, double h, double part) const {
    return at_node(t, h, part, [&](double time) { return motion_[at(field)].by_t(time); });
  }

  using StencilFamily::jacobian, StencilFamily::lagrangian, StencilFamily::residual;
  void residual(const Cell&, std::span<const double>, std::span<double> r) const override { std::ranges::fill(r, 0.0); }
  void jacobian(const Cell&, std::span<const double>, std::span<double> J) const override { std::ranges::fill(J, 0.0); }
  std::optional<double> lagrangian(const Cell&, std::span<const double>) const override { return 0; }
  std::optional<ConstantPart> constant_part(const Cell&) const override {
    const std::size_t n = motion_.size();
    return ConstantPart{std::vector<double>(n * n, 0.0), std::vector<double>(n, 0.0), true};
  }

 private:
  static std::vector<VertexValue> fields(std::size_t count) {
    std::vector<VertexValue> list;
    for (std::size_t a = 0; a < count; ++a) list.push_back({0, static_cast<int>(a)});
    return list;
  }
  template <class F>
  double at_node(double t, double h, double part, const F& f) const {
    if (through_.empty() || part == 0) return f(t + part * h);
    const std::vector<double> functions = LagrangeBasis(through_).values(part);
    double sum = 0;
    for (std::size_t m = 0; m < functions.size(); ++m) sum += functions[m] * f(t + through_[m] * h);
    return sum;
  }
  FormulasOfTime motion_;
  std::vector<double> through_;  ///< parts of a step
};

/// The flux into a natural wall: the action has ∫ Σ_a f_a(t) φ_a dt there besides, by a quadrature of a step in time. Between
/// rows it is the trapezoidal rule; of elements and sub-steps it is their own, with their test functions,
///
///     L = h Σ_q w_q Σ_a f_a(t + c_q h) φ_a(c_q),      φ_a(c) = Σ_j ψ_j(c) y_ja
///
/// so that the wall has ±∂ℓ/∂φ_x = f, at the left and at the right: of ℓ = … − ½φ_x² f is the slope along the outer normal,
/// and the force on the field.
struct WallFlux {
  static constexpr bool placed = true, is_flux = true;

  Placement wall;
  FormulasOfTime flux;
  StencilTable time = trapezoidal();  ///< at the site of the wall

  static StencilTable trapezoidal() {
    StencilTable table{.pattern = {}, .points = {}};
    table.pattern.vertices = {{0, 0}, {1, 0}};
    for (const int row : {0, 1}) {
      TablePoint point{.weight = 0.5, .time = static_cast<double>(row), .slots = {}};
      point.set(JetSlot::phi, row == 0 ? std::vector{1.0, 0.0} : std::vector{0.0, 1.0});
      table.points.push_back(std::move(point));
    }
    return table;
  }
  StencilPattern pattern() const { return StencilPattern(time.pattern.vertices, wall); }
  std::vector<VertexValue> values() const {
    return values_at_every_vertex(time.pattern, static_cast<int>(flux.size()));
  }
  template <class T>
  T operator()(std::span<const T> y, const Cell& cell) const {
    T sum(0.0);
    for (std::size_t q = 0; q < time.points.size(); ++q) {
      const TablePoint& point = time.points[q];
      const double t = cell.t + point.time * cell.time_step;
      for (std::size_t a = 0; a < flux.size(); ++a) {
        const double force = point.weight * cell.time_step * flux[a](t);
        for (const auto& [vertex, psi] : time.test(q)[JetSlot::phi])
          sum += (force * psi) * y[at(vertex) * flux.size() + a];
      }
    }
    return sum;
  }
};

}  // namespace delf

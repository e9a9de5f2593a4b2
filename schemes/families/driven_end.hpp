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
/// nothing: as a fixed wall it has no equation. Steppers put the value into a row before they solve it (set_driven_ends).
class DrivenEnd final : public StencilFamily {
 public:
  DrivenEnd(Placement wall, FormulasOfTime motion)
      : StencilFamily(StencilPattern({{0, 0}}, wall), fields(motion.size()), true), motion_(std::move(motion)) {
    varied_.assign(motion_.size(), false);
  }

  const DrivenEnd* driven_end() const override { return this; }
  bool is_left() const { return pattern().placement == Placement::left_wall; }
  double value(int field, double t) const { return motion_[at(field)](t); }
  double rate(int field, double t) const { return motion_[at(field)].by_t(t); }

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
  FormulasOfTime motion_;
};

/// The flux into a natural wall: the action has ∫ Σ_a f_a(t) φ_a dt there besides, by the trapezoidal rule from row to row,
///
///     L = ½h Σ_a (f_a(t) y⁰_a + f_a(t + h) y¹_a),
///
/// so that the wall has ±∂ℓ/∂φ_x = f, at the left and at the right: of ℓ = … − ½φ_x² f is the slope along the outer normal,
/// and the force on the field.
struct WallFlux {
  static constexpr bool placed = true, is_flux = true;

  Placement wall;
  FormulasOfTime flux;

  StencilPattern pattern() const { return StencilPattern({{0, 0}, {1, 0}}, wall); }
  std::vector<VertexValue> values() const {
    std::vector<VertexValue> list;
    for (const int vertex : {0, 1})
      for (std::size_t a = 0; a < flux.size(); ++a) list.push_back({vertex, static_cast<int>(a)});
    return list;
  }
  template <class T>
  T operator()(std::span<const T> y, const Cell& cell) const {
    T sum(0.0);
    const double half = 0.5 * cell.time_step, above = cell.t + cell.time_step;
    for (std::size_t a = 0; a < flux.size(); ++a) {
      sum += (half * flux[a](cell.t)) * y[a];
      sum += (half * flux[a](above)) * y[flux.size() + a];
    }
    return sum;
  }
};

}  // namespace delf

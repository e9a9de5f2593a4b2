// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

#include "schemes/families/division_loop.hpp"
#include "schemes/families/row_kernel.hpp"
#include "schemes/families/stencil_family.hpp"

namespace delf {

/// What a direct residual stencil must offer: it comes from no Lagrangian, and gives one residual, at one vertex.
///
///     static constexpr Offsets<n> shape;          vertices; `centre` is the one whose equation this is
///     static constexpr int centre;
///     static constexpr std::array<double, n> by_tt, by_xx;     E = −φ_tt + φ_xx + nonlinear(y), with h = k = 1
///     static constexpr std::array<bool, n> nonlinear_in;       vertices that nonlinear() looks at
///     T nonlinear(const std::array<T, n>& y) const;
///
/// Where nonlinear() is a sum of the same part of several stencils, it may say so: rows of the part are then evaluated
/// once and kept from step to step.
///
///     static constexpr std::array<double, n> shares;      of a stencil's part in nonlinear() at its vertices
///     static constexpr std::array<bool, n> part_in;       vertices that part() looks at
///     T part(const std::array<T, n>& y) const;
template <class R>
concept ResidualStencil = requires(const R& r) {
  requires StencilShape<decltype(R::shape)>;
  { R::centre } -> std::convertible_to<int>;
  { r.nonlinear(std::array<double, decltype(R::shape)::size()>{}) } -> std::convertible_to<double>;
};

/// A residual stencil at every site. Multiplied by hk, so that its size is that of a discrete Lagrangian's gradient.
template <ResidualStencil R>
class ResidualFamily final : public StencilFamily, public RowKernel {
  static constexpr int n = decltype(R::shape)::size();
  static constexpr int first_time = [] {
    int t = R::shape.vertex(0).time;
    for (int l = 1; l < n; ++l) t = std::min(t, R::shape.vertex(l).time);
    return t;
  }();
  static constexpr bool is_shared = requires { R::shares; };
  static constexpr std::array<bool, n> looked_at = [] {
    if constexpr (is_shared) return R::part_in;
    else return R::nonlinear_in;
  }();
  static constexpr std::array<double, n> shares = [] {
    if constexpr (is_shared) return R::shares;
    std::array<double, n> all_at_the_centre{};
    all_at_the_centre[R::centre] = 1;
    return all_at_the_centre;
  }();
  static constexpr int newest_time = [] {
    int t = first_time;
    for (int l = 0; l < n; ++l)
      if (looked_at[l]) t = std::max(t, R::shape.vertex(l).time);
    return t;
  }();
  /// The latest vertex that is looked at, and the other one if there are two, at the same site.
  struct Pair {
    int latest = -1, other = -1;
  };
  static constexpr Pair pair = [] {
    Pair found;
    for (int l = 0; l < n; ++l) {
      if (!looked_at[l]) continue;
      int& place = R::shape.vertex(l).time == newest_time ? found.latest : found.other;
      if (place >= 0) return Pair{};
      place = l;
    }
    if (found.latest < 0 || found.other < 0) return Pair{};
    return R::shape.vertex(found.latest).space == R::shape.vertex(found.other).space ? found : Pair{};
  }();

  /// A part that is shared is kept from row to row: steps that divide take it in other loops.
  static constexpr bool divided = pair.latest >= 0 && !is_shared;

 public:
  ResidualFamily(R stencil, double time_step, double space_step)
      : StencilFamily(StencilPattern(R::shape), values_at_every_vertex(StencilPattern(R::shape), 1), false),
        RowKernel(n),
        stencil_(std::move(stencil)) {
    nonlinearity_ = Nonlinearity::values;
    outputs_ = 1;
    outputs_read_until_ = newest_time;
    // Those of the latest row first.
    for (const bool latest : {true, false})
      for (int l = 0; l < n; ++l)
        if (looked_at[l] && (R::shape.vertex(l).time == newest_time) == latest)
          arguments_.push_back({{{R::shape.vertex(l), 1.0}}});
    near_below_ = bound_in_reach([this](double bound) {
      std::array<Abstract, n> y;
      for (int l = 0; l < n; ++l) y[l] = Abstract::variable(l, bound);
      return part(stencil_, y);
    });
    weights_.assign(n, 0.0);
    for (int l = 0; l < n; ++l) weights_[static_cast<std::size_t>(l)] = shares[l] * time_step * space_step;
  }

  void residual(const Cell& cell, std::span<const double> y, std::span<double> r) const override {
    std::ranges::fill(r, 0.0);
    const double h = cell.time_step, k = cell.space_step;
    double sum = h * k * stencil_.nonlinear(array<double>(y));
    for (int l = 0; l < n; ++l) sum += (R::by_xx[l] * h / k - R::by_tt[l] * k / h) * y[l];
    r[R::centre] = sum;
  }
  void jacobian(const Cell& cell, std::span<const double> y, std::span<double> J) const override {
    linear(cell, J);
    std::array<Dual<double, n>, n> variables;
    for (int l = 0; l < n; ++l) variables[l] = Dual<double, n>::variable(y[l], l);
    const auto slope = stencil_.nonlinear(variables);
    for (int l = 0; l < n; ++l) J[R::centre * n + l] += cell.time_step * cell.space_step * slope.derivative(l);
  }
  const RowKernel* row_kernel() const override { return this; }
  void linear_part(const Cell& cell, std::span<double> J, std::span<double> r0) const override {
    linear(cell, J);
    std::ranges::fill(r0, 0.0);
  }

  using RowKernel::evaluate;
  void evaluate(const SlabRows& rows, double* const* out, const PackRange& packs) const override {
    if constexpr (pair.latest < 0) evaluate_any(rows, out[0], packs);
    else if (rows.near) evaluate_pair<NearPack>(rows, out[0], packs);
    else evaluate_pair<Pack>(rows, out[0], packs);
  }

  bool evaluates_arguments() const override { return pair.latest >= 0; }
  void evaluate_arguments(const ArgumentRow& row, double* out, const PackRange& packs) const override {
    if constexpr (pair.latest >= 0)
      argument_loop_for<1>([&]<class Value>() { return PartOfPair<Value>{stencil_}; }, row, out, packs);
  }
  bool divides(int old, int parts) const override { return divided && old == 0 && parts == 1; }
  RowChange divide(const DivisionRows& given, const RowIncrement& rows) const override {
    if constexpr (divided) return division_loop_for<0, 1>(PartOfPair<NearPack>{stencil_}, given, rows);
    else return {};
  }
  RowChange divide_straight(const DivisionRows& given, const RowIncrement& rows) const override {
    if constexpr (!divided) return {};
    else if (given.arguments.near) return straight_division_loop<0, 1>(PartOfPair<NearPack>{stencil_}, given, rows);
    else return straight_division_loop<0, 1>(PartOfPair<Pack>{stencil_}, given, rows);
  }
  LargestTerms measure_division(const DivisionRows& given, const RowIncrement& rows) const override {
    if constexpr (!divided) return {};
    else if (given.arguments.near) return measured_division_loop<0, 1>(PartOfPair<NearPack>{stencil_}, given, rows);
    else return measured_division_loop<0, 1>(PartOfPair<Pack>{stencil_}, given, rows);
  }

 private:
  static const double* row_of(const SlabRows& rows, int l) {
    constexpr auto& shape = R::shape;
    return rows.values[shape.vertex(l).time - first_time] + shape.vertex(l).space * lanes;
  }
  template <class Value>
  [[gnu::__flatten__, gnu::__noclone__]] void evaluate_pair(const SlabRows& rows, double* out,
                                                            const PackRange& packs) const {
    const PartOfPair<Value> output{stencil_};
    const FetchAhead<> ahead(rows);
    const double *const latest = row_of(rows, pair.latest), *const other = row_of(rows, pair.other);
    find_ahead(
        rows.layout->at(packs.first), rows.layout->at(packs.last), lanes,
        [&](std::ptrdiff_t at) __attribute__((always_inline)) {
          return output.argument(Pack::load(latest + at), Pack::load(other + at));
        },
        [&](std::ptrdiff_t at, const auto& values) __attribute__((always_inline)) {
          ahead.fetch(at);
          output(values, at).store(out + at);
        });
  }
  [[gnu::__flatten__, gnu::__noclone__]] void evaluate_any(const SlabRows& rows, double* out,
                                                           const PackRange& packs) const {
    for (int v = packs.first; v < packs.last; v += packs.stride) {
      const std::ptrdiff_t at = rows.layout->at(v);
      std::array<Pack, n> y{};
      for (int l = 0; l < n; ++l)
        if (looked_at[l]) y[l] = Pack::load(row_of(rows, l) + at);
      part(stencil_, y).store(out + at);
    }
  }

  template <class T>
  static T part(const R& stencil, const std::array<T, n>& y) {
    if constexpr (is_shared) return stencil.part(y);
    else return stencil.nonlinear(y);
  }
  template <class Value>
  struct PartOfPair {
    static constexpr bool near = std::is_same_v<Value, NearPack>;
    R stencil;
    template <class P>
    struct Values {
      P latest, other;
    };
    /// Member by member (division_loop() says why).
    [[gnu::always_inline]] PartOfPair copy() const { return {stencil}; }
    template <class P>
    [[gnu::always_inline]] Values<P> argument(const P& u, const P& known) const {
      return {u, known};
    }
    template <class P>
    [[gnu::always_inline]] P operator()(const Values<P>& values, std::ptrdiff_t) const {
      std::array<std::conditional_t<std::is_same_v<P, NearPacks>, NearPacks, Value>, n> y;
      y.fill(0.0);
      y[pair.latest] = values.latest, y[pair.other] = values.other;
      return part(stencil, y);
    }
  };
  template <class T>
  static std::array<T, n> array(std::span<const double> y) {
    std::array<T, n> values;
    std::copy_n(y.begin(), n, values.begin());
    return values;
  }
  static void linear(const Cell& cell, std::span<double> J) {
    std::ranges::fill(J, 0.0);
    const double h = cell.time_step, k = cell.space_step;
    for (int l = 0; l < n; ++l) J[R::centre * n + l] = R::by_xx[l] * h / k - R::by_tt[l] * k / h;
  }

  R stencil_;
};

}  // namespace delf

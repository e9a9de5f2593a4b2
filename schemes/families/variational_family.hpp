// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "schemes/families/division_loop.hpp"
#include "schemes/families/explicit_loop.hpp"
#include "schemes/families/row_kernel.hpp"
#include "schemes/families/stencil_family.hpp"

namespace delf {

/// The quadrature points of a jet map with different φ, and which of them each point shares its φ with: a density that
/// is nonlinear in φ alone is evaluated once for each.
template <int Q>
struct DistinctValues {
  int count = 0;
  std::array<int, Q> representative{};  ///< quadrature point that stands for group c
  std::array<int, Q> group{};
};
template <int n, int Q>
constexpr DistinctValues<Q> distinct_values(const JetTable<n, Q>& map) {
  DistinctValues<Q> result;
  for (int q = 0; q < Q; ++q) {
    int c = 0;
    while (c < result.count && map.point(result.representative[c]).phi != map.point(q).phi) ++c;
    if (c == result.count) result.representative[result.count++] = q;
    result.group[q] = c;
  }
  return result;
}

/// At every quadrature point φ is the value at one vertex: the nonlinear part meets no neighbours.
template <int n, int Q>
constexpr bool is_nodal(const JetTable<n, Q>& map) {
  for (int q = 0; q < Q; ++q) {
    int vertices = 0;
    for (int l = 0; l < n; ++l) vertices += map.point(q).phi[l] != 0;
    if (vertices != 1) return false;
  }
  return true;
}

/// The largest space offset between two sites of a stencil.
template <int n, int Q>
constexpr int reach_of(const JetTable<n, Q>& map) {
  int reach = 0;
  for (int l = 0; l < n; ++l)
    for (int m = 0; m < n; ++m) reach = std::max(reach, map.shape.vertex(m).space - map.shape.vertex(l).space);
  return reach;
}

/// A discrete Lagrangian on every stencil of the lattice. The jet map is known at compile time, so that a row of
/// stencils is a loop over packs with all weights constants.
template <JetMap Map, Density D>
class VariationalFamily final : public StencilFamily, public RowKernel {
  static constexpr const auto& map = Map::table;
  using Lagrangian = DiscreteLagrangian<Map, D>;
  static constexpr int n = map.vertices, d = components_of<D>();
  static constexpr int vertices_size = n * d;
  static constexpr auto distinct = distinct_values(map);
  static constexpr int reach = reach_of(map);
  static constexpr bool goes_in_one_loop = is_nodal(map) && reach > 0;
  static constexpr int first_time = [] {
    int t = map.shape.vertex(0).time;
    for (int l = 1; l < n; ++l) t = std::min(t, map.shape.vertex(l).time);
    return t;
  }();
  static constexpr int slab_rows = [] {
    int t = first_time;
    for (int l = 0; l < n; ++l) t = std::max(t, map.shape.vertex(l).time);
    return t - first_time + 1;
  }();

 public:
  explicit VariationalFamily(D density, double time_step, double space_step)
      : StencilFamily(StencilPattern(map.shape), values_at_every_vertex(StencilPattern(map.shape), d), true),
        RowKernel(vertices_size),
        lagrangian_{std::move(density)} {
    placed_ = delf::is_placed<D>();
    nonlinearity_ = structure_of(lagrangian_.density).nonlinearity;
    const double area = map.measure * time_step * space_step;
    outputs_read_until_ = first_time;
    for (int l = 0; l < n; ++l)
      for (int q = 0; q < map.points; ++q)
        if (nonlinearity_ == Nonlinearity::all || map.point(q).phi[l] != 0)
          outputs_read_until_ = std::max(outputs_read_until_, map.shape.vertex(l).time);
    if (nonlinearity_ == Nonlinearity::values) {
      // ∂L/∂y_l = Σ_q |Δ| w_q (∂ℓ/∂φ)(φ_q) ∂φ_q/∂y_l
      outputs_ = distinct.count * d;
      double most = 0;  // |φ| ≤ Σ |weights| max |y|
      for (const auto& point : map.quadrature) {
        double sum = 0;
        for (double weight : point.phi) sum += std::abs(weight);
        most = std::max(most, sum);
      }
      near_below_ = delf::near_below(lagrangian_.density) / most;
      for (int c = 0; c < distinct.count; ++c) {
        Argument argument;
        for (int l = 0; l < n; ++l)
          if (const double weight = map.point(distinct.representative[c]).phi[l]; weight != 0)
            argument.parts.push_back({map.shape.vertex(l), weight});
        arguments_.push_back(std::move(argument));
      }
      weights_.assign(static_cast<std::size_t>(outputs_ * size()), 0.0);
      for (int q = 0; q < map.points; ++q)
        for (int l = 0; l < n; ++l)
          for (int a = 0; a < d; ++a)
            weights_[static_cast<std::size_t>((distinct.group[q] * d + a) * size() + l * d + a)] +=
                area * map.point(q).weight * map.point(q).phi[l];
    } else if (nonlinearity_ == Nonlinearity::all) {
      outputs_ = size();
      weights_.assign(static_cast<std::size_t>(outputs_ * size()), 0.0);
      for (int i = 0; i < size(); ++i) weights_[static_cast<std::size_t>(i * size() + i)] = 1;
    }
  }

  void residual(const Cell& cell, std::span<const double> y, std::span<double> r) const override {
    std::ranges::copy(lagrangian_.gradient(array(y), cell), r.begin());
  }
  void jacobian(const Cell& cell, std::span<const double> y, std::span<double> J) const override {
    std::ranges::copy(lagrangian_.hessian(array(y), cell), J.begin());
  }
  const RowKernel* row_kernel() const override { return this; }
  std::optional<double> lagrangian(const Cell& cell, std::span<const double> y) const override {
    return lagrangian_(array(y), cell);
  }

  void linear_part(const Cell& cell, std::span<double> J, std::span<double> r0) const override {
    std::ranges::fill(J, 0.0);
    std::ranges::fill(r0, 0.0);
    if (nonlinearity_ == Nonlinearity::all) return;
    // J and r(0) are the same wherever they are taken: at zero, or where the density has a value if it has none there.
    typename Lagrangian::Values y{};
    if (!std::isfinite(lagrangian_.hessian(y, cell)[0]))
      for (std::size_t i = 0; i < y.size(); ++i) y[i] = 1 + 0.25 * static_cast<double>(i % d);
    std::ranges::copy(lagrangian_.hessian(y, cell), J.begin());
    std::ranges::copy(lagrangian_.gradient(y, cell), r0.begin());
    if (nonlinearity_ == Nonlinearity::values) {
      // Take away what `evaluate` adds: the part of ℓ that is seen with φ_t = φ_x = 0.
      const DiscreteLagrangian<Map, ValuesOnly> seen{{lagrangian_.density}};
      const auto h = seen.hessian(y, cell);
      const auto g = seen.gradient(y, cell);
      for (std::size_t i = 0; i < J.size(); ++i) J[i] -= h[i];
      for (std::size_t i = 0; i < r0.size(); ++i) r0[i] -= g[i];
    }
    for (std::size_t i = 0; i < r0.size(); ++i)
      for (std::size_t m = 0; m < y.size(); ++m)
        if (y[m] != 0) r0[i] -= J[i * y.size() + m] * y[m];
    // What cancels only up to rounding is nothing.
    const double scale = std::ranges::max(J, {}, [](double x) { return std::abs(x); });
    for (double& x : r0)
      if (y[0] != 0 && std::abs(x) < 1e-13 * std::abs(scale)) x = 0;
    for (double& x : J)
      if (y[0] != 0 && std::abs(x) < 1e-13 * std::abs(scale)) x = 0;
  }

  using RowKernel::evaluate;
  void evaluate(const SlabRows& rows, double* const* out, const PackRange& packs) const override {
    if (nonlinearity_ == Nonlinearity::values) {
      if constexpr (sees_one_value) evaluate_value<false>(rows, nullptr, out[0], packs);
      else evaluate_values(rows, out, packs);
    }
    if (nonlinearity_ == Nonlinearity::all) evaluate_all(rows, out, packs);
  }

  bool evaluates_straight() const override { return sees_one_value && nonlinearity_ == Nonlinearity::values; }
  void evaluate_straight(const SlabRows& rows, const double* v, double* const* out,
                         const PackRange& packs) const override {
    if constexpr (sees_one_value) evaluate_value<true>(rows, v, out[0], packs);
  }

  bool evaluates_arguments() const override { return d == 1 && outputs_ == 1 && nonlinearity_ == Nonlinearity::values; }
  void evaluate_arguments(const ArgumentRow& row, double* out, const PackRange& packs) const override {
    if constexpr (d == 1)
      argument_loop_for<stride>([&]<class Value>() { return slope<Value>(row); }, row, out, packs);
  }
  bool divides(int old, int parts) const override {
    return evaluates_arguments() && stride == 1 && old == 2 && parts == 2;
  }
  RowChange divide(const DivisionRows& given, const RowIncrement& rows) const override {
    if constexpr (d == 1 && stride == 1) return division_loop_for<2, 2>(slope<NearPack>(given.arguments), given, rows);
    else return {};
  }
  RowChange divide_straight(const DivisionRows& given, const RowIncrement& rows) const override {
    if constexpr (d != 1 || stride != 1) return {};
    else if (given.arguments.near) return straight_division_loop<2, 2>(slope<NearPack>(given.arguments), given, rows);
    else return straight_division_loop<2, 2>(slope<Pack>(given.arguments), given, rows);
  }
  LargestTerms measure_division(const DivisionRows& given, const RowIncrement& rows) const override {
    if constexpr (d != 1 || stride != 1) return {};
    else if (given.arguments.near) return measured_division_loop<2, 2>(slope<NearPack>(given.arguments), given, rows);
    else return measured_division_loop<2, 2>(slope<Pack>(given.arguments), given, rows);
  }

  std::span<const int> explicit_neighbours() const override {
    if constexpr (goes_in_one_loop) return neighbours_within<reach>;
    else return {};
  }
  double explicit_step(const ExplicitRows& rows, const PackRange& packs) const override {
    if constexpr (goes_in_one_loop) return explicit_loop_for<reach>(lagrangian_.density, rows, packs);
    else return 0;
  }
  void explicit_slopes(const SlabRows& now, double* const* slopes, const PackRange& packs) const override {
    if constexpr (goes_in_one_loop) slope_loop(lagrangian_.density, now, slopes, packs);
  }

 private:
  static constexpr int stride = map.shape.placement == Placement::every_site ? 1 : 2;
  static constexpr bool sees_one_value = d == 1 && distinct.count == 1;
  /// At rows of arguments, or of values.
  template <class Value, class Rows>
  MixtureSlope<D, Value> slope(const Rows& rows, double known_weight) const {
    constexpr auto& point = map.quadrature[distinct.representative[0]];
    return {lagrangian_.density, known_weight, rows.t + time_offset(map.shape, point) * rows.time_step,
            rows.positions, space_offset(map.shape, point) * rows.space_step};
  }
  template <class Value>
  MixtureSlope<D, Value> slope(const ArgumentRow& row) const {
    return slope<Value>(row, row.known_weight);
  }
  /// ℓ(φ, 0, 0)
  struct ValuesOnly {
    static constexpr int components = d;
    static constexpr bool placed = delf::is_placed<D>();
    D density;
    auto operator()(const auto& j) const {
      auto still = j;
      for (int a = 0; a < d; ++a) {
        component(still.phi_t, a) = 0.0;
        component(still.phi_x, a) = 0.0;
      }
      return density(still);
    }
  };

  static typename Lagrangian::Values array(std::span<const double> y) {
    typename Lagrangian::Values values;
    std::copy_n(y.begin(), values.size(), values.begin());
    return values;
  }

  /// A copy of pointers, of this function alone: what is stored through others cannot change them, so that they stay in
  /// registers.
  template <int count, class Pointer>
  [[gnu::always_inline]] static auto local(Pointer const* given) {
    std::array<Pointer, static_cast<std::size_t>(count)> copy;
    for (int i = 0; i < count; ++i) copy[i] = given[i];
    return copy;
  }
  /// The same of SlabRows.
  struct LocalRows {
    [[gnu::always_inline]] explicit LocalRows(const SlabRows& r)
        : positions(r.positions), t(r.t), time_step(r.time_step), space_step(r.space_step), origin(r.layout->at(0)) {
      for (int i = 0; i < slab_rows * d; ++i) values[i] = r.values[i];
    }
    std::ptrdiff_t at(int v) const { return origin + static_cast<std::ptrdiff_t>(v) * lanes; }
    [[gnu::always_inline]] Pack value(const Site& s, int a, std::ptrdiff_t at) const {
      return Pack::load(values[(s.time - first_time) * d + a] + at + s.space * lanes);
    }
    std::array<const double*, static_cast<std::size_t>(slab_rows* d)> values;
    const double* positions;
    double t, time_step, space_step;
    std::ptrdiff_t origin;
  };

  /// Σ_l weights[l] value(l). Equal weights, as those of means, are taken out of the sum: additions and products take
  /// turns.
  template <class Value>
  [[gnu::always_inline]] static Pack weighted(const std::array<double, n>& weights, const Value& value) {
    double weight = 0;
    bool equal = true, first = true;
    for (const double w : weights) {
      if (w == 0) continue;
      equal = equal && (weight == 0 || w == weight);
      weight = w;
    }
    Pack sum(0.0);
    for_each_index<n>([&]<int l>() __attribute__((always_inline)) {
      if (weights[l] == 0) return;
      const Pack term = equal ? value(l) : weights[l] * value(l);
      sum = first ? term : sum + term;
      first = false;
    });
    return equal ? weight * sum : sum;
  }
  /// Of component a of the stencils of the pack at `at`.
  [[gnu::always_inline]] static Pack weighted(const std::array<double, n>& weights, const LocalRows& rows, int a,
                                              std::ptrdiff_t at) {
    return weighted(weights, [&](int l) __attribute__((always_inline)) { return rows.value(map.shape.vertex(l), a, at); });
  }

  template <class Number>
  [[gnu::always_inline]] static void place(JetFor<Number, D>& jet, const LocalRows& rows, int q, std::ptrdiff_t at) {
    if constexpr (delf::is_placed<D>()) {
      jet.t = Number(rows.t + time_offset(map.shape, map.point(q)) * rows.time_step);
      jet.x = Number(Pack::load(rows.positions + at) + space_offset(map.shape, map.point(q)) * rows.space_step);
    }
  }

  /// out = ∂ℓ/∂φ at the one value of φ that a stencil sees; `straight`: its newest row is more by v than the one given.
  template <bool straight>
  void evaluate_value(const SlabRows& rows, const double* v, double* out, const PackRange& packs) const {
    if (rows.near) evaluate_value_on<straight, NearPack>(rows, v, out, packs);
    else evaluate_value_on<straight, Pack>(rows, v, out, packs);
  }
  template <bool straight, class Value>
  [[gnu::__flatten__, gnu::__noclone__]] void evaluate_value_on(const SlabRows& given, const double* v, double* out,
                                                                const PackRange& packs) const {
    const LocalRows rows(given);
    const auto output = slope<Value>(given, 0);
    const FetchAhead<stride> ahead(given);
    constexpr auto& weights = map.quadrature[distinct.representative[0]].phi;
    constexpr int newest = [] {
      int time = first_time;
      for (int l = 0; l < n; ++l)
        if (weights[l] != 0) time = std::max(time, map.shape.vertex(l).time);
      return time;
    }();
    const auto value = [&](int l, std::ptrdiff_t at) __attribute__((always_inline)) {
      const Site s = map.shape.vertex(l);
      const Pack y = rows.value(s, 0, at);
      return straight && s.time == newest ? y + Pack::load(v + at + s.space * lanes) : y;
    };
    // A loop whose stride is known takes a tenth less.
    find_ahead(
        rows.at(packs.first), rows.at(packs.last), (stride == 1 ? 1 : packs.stride) * lanes,
        [&](std::ptrdiff_t at) __attribute__((always_inline)) {
          return weighted(weights, [&](int l) __attribute__((always_inline)) { return value(l, at); });
        },
        [&](std::ptrdiff_t at, Pack phi) __attribute__((always_inline)) {
          ahead.fetch(at);
          output(phi, at).store(out + at);
        });
  }

  /// out_c = ∂ℓ/∂φ at the distinct values of φ
  [[gnu::__flatten__, gnu::__noclone__]] void evaluate_values(const SlabRows& given, double* const* given_out,
                                                              const PackRange& packs) const {
    using Number = Dual<Pack, d>;
    const LocalRows rows(given);
    const auto out = local<distinct.count * d>(given_out);
    const D density = lagrangian_.density;
    const auto pack = [&](int v) __attribute__((always_inline)) {
      const std::ptrdiff_t at = rows.at(v);
      for_each_index<distinct.count>([&]<int c>() __attribute__((always_inline, __flatten__)) {
        constexpr int q = distinct.representative[c];
        JetFor<Number, D> jet;
        for (int a = 0; a < d; ++a) {
          const Pack phi = weighted(map.quadrature[q].phi, rows, a, at);
          component(jet.phi, a) = Number::variable(phi, a);
          component(jet.phi_t, a) = Number(0.0);
          component(jet.phi_x, a) = Number(0.0);
        }
        place<Number>(jet, rows, q, at);
        const Number l = density(jet);
        for (int a = 0; a < d; ++a) l.derivative(a).store(out[c * d + a] + at);
      });
    };
    // A loop whose stride is known takes a tenth less.
    if constexpr (map.shape.placement == Placement::every_site)
      for (int v = packs.first; v < packs.last; ++v) pack(v);
    else
      for (int v = packs.first; v < packs.last; v += packs.stride) pack(v);
  }

  /// out_i = rⁱ = ∂L/∂yⁱ
  [[gnu::__flatten__, gnu::__noclone__]] void evaluate_all(const SlabRows& given, double* const* given_out,
                                                           const PackRange& packs) const {
    using Number = Dual<Pack, 3 * d>;
    const LocalRows rows(given);
    const auto out = local<vertices_size>(given_out);
    const D density = lagrangian_.density;
    const double per_h = 1 / rows.time_step, per_k = 1 / rows.space_step;
    const double area = map.measure * rows.time_step * rows.space_step;
    for (int v = packs.first; v < packs.last; v += packs.stride) {
      const std::ptrdiff_t at = rows.at(v);
      std::array<Pack, static_cast<std::size_t>(vertices_size)> r;
      r.fill(Pack(0.0));
      for_each_index<map.points>([&]<int q>() __attribute__((always_inline, __flatten__)) {
        constexpr auto& p = map.quadrature[q];
        JetFor<Number, D> jet;
        for (int a = 0; a < d; ++a) {
          component(jet.phi, a) = Number::variable(weighted(p.phi, rows, a, at), a);
          component(jet.phi_t, a) = Number::variable(per_h * weighted(p.phi_t, rows, a, at), d + a);
          component(jet.phi_x, a) = Number::variable(per_k * weighted(p.phi_x, rows, a, at), 2 * d + a);
        }
        place<Number>(jet, rows, q, at);
        const Number l = density(jet);
        for (int a = 0; a < d; ++a)
          for (int i = 0; i < n; ++i)
            r[i * d + a] +=
                (area * p.weight) * (p.phi[i] * l.derivative(a) + (per_h * p.phi_t[i]) * l.derivative(d + a) +
                                     (per_k * p.phi_x[i]) * l.derivative(2 * d + a));
      });
      for (int i = 0; i < vertices_size; ++i) r[i].store(out[i] + at);
    }
  }

  template <int count, class Body>
  [[gnu::always_inline]] static void for_each_index(const Body& body) {
    [&]<int... i>(std::integer_sequence<int, i...>) __attribute__((always_inline)) {
      (body.template operator()<i>(), ...);
    }
    (std::make_integer_sequence<int, count>{});
  }

  Lagrangian lagrangian_;
};

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "jets/tables/element.hpp"
#include "jets/simd/pack.hpp"
#include "jets/numbers/structure.hpp"
#include "schemes/families/nodal_kernel.hpp"
#include "schemes/families/stencil_family.hpp"

namespace delf {

/// The discrete Lagrangian of an element, L_Δ = hk Σ_q w_q ℓ(j_q), on every cell. The density is differentiated by its
/// jet j = (φ, φ_t, φ_x) alone, the table does the rest:
///
///     ∂L/∂y_l = hk Σ_q w_q Jᵀ_ql ∂ℓ/∂j(j_q),    J_ql = ∂j_q/∂y_l = (phi[l], phi_t[l]/h, phi_x[l]/k)
///
template <Density D>
class ElementFamily final : public StencilFamily, public NodalKernel {
  static constexpr int d = components_of<D>();
  static constexpr int m = 3 * d;  ///< numbers in a jet: φ¹ … φᵈ, φ_t¹ …, φ_x¹ …
  using Number = Dual<double, m>;
  using Twice = Dual<Number, m>;
  using Packed = Dual<Pack, m>;
  using Numbers = std::array<double, static_cast<std::size_t>(m)>;
  using Packs = std::array<Pack, static_cast<std::size_t>(m)>;

 public:
  ElementFamily(Element element, D density)
      : StencilFamily(element.pattern, values_of(element.pattern), true),
        element_(std::move(element)),
        density_(std::move(density)) {
    placed_ = delf::is_placed<D>();
    for (const Site& v : pattern_.vertices)
      bottom_ += v.time == 0 && element_.nodes[static_cast<std::size_t>(v.node)].time == 0;
    list_weights();
    find_nodal_weights();
  }

  const Element& element() const { return element_; }

  std::optional<double> lagrangian(const Cell& cell, std::span<const double> y) const override {
    double sum = 0;
    for (const ElementPoint& p : element_.points)
      sum += p.weight * density_(jet<double>(numbers(p, cell, y), cell, p.time, p.space));
    return cell.time_step * cell.space_step * sum;
  }

  void residual(const Cell& cell, std::span<const double> y, std::span<double> r) const override {
    std::ranges::fill(r, 0.0);
    const double h = cell.time_step, k = cell.space_step;
    for (const ElementPoint& p : element_.points) {
      const Number l = density_(jet<Number>(numbers(p, cell, y), cell, p.time, p.space));
      const double area = h * k * p.weight;
      for (int v = 0; v < pattern_.size(); ++v) {
        const auto [phi, phi_t, phi_x] = row(p, cell, v);
        for (int a = 0; a < d; ++a)
          r[index(v, a)] += area * (phi * l.d[index(a)] + phi_t * l.d[index(d + a)] + phi_x * l.d[index(2 * d + a)]);
      }
    }
  }

  bool residuals(const Cell& cell, const double* x, const double* y, double* r) const override {
    const double per_h = 1 / cell.time_step, per_k = 1 / cell.space_step;
    for (int i = 0; i < size(); ++i) Pack(0.0).store(r + i * lanes);
    for (const PointWeights& p : weights_) {
      Packs j;
      j.fill(Pack(0.0));
      for (const NodeWeight& w : p.values)
        for (int a = 0; a < d; ++a) {
          const Pack value = Pack::load(y + (w.node * d + a) * lanes);
          j[index(a)] += w.phi * value;
          j[index(d + a)] += w.derivative * value;
        }
      for (const NodeWeight& w : p.slopes)
        for (int a = 0; a < d; ++a) j[index(2 * d + a)] += w.derivative * Pack::load(y + (w.node * d + a) * lanes);
      for (int a = 0; a < d; ++a) j[index(d + a)] *= per_h, j[index(2 * d + a)] *= per_k;

      const Packed l = density_(packed_jet(j, cell, x, p.time, p.space));
      const double area = cell.time_step * cell.space_step * p.weight;
      for (int a = 0; a < d; ++a) {
        const Pack by_phi = area * l.d[index(a)], by_t = area * per_h * l.d[index(d + a)],
                   by_x = area * per_k * l.d[index(2 * d + a)];
        for (const NodeWeight& w : p.values) {
          double* const out = r + (w.node * d + a) * lanes;
          (Pack::load(out) + w.phi * by_phi + w.derivative * by_t).store(out);
        }
        for (const NodeWeight& w : p.slopes) {
          double* const out = r + (w.node * d + a) * lanes;
          (Pack::load(out) + w.derivative * by_x).store(out);
        }
      }
    }
    return true;
  }

  void jacobian(const Cell& cell, std::span<const double> y, std::span<double> J) const override {
    add_up(J, cell, [&](const ElementPoint& p) { return hessian(numbers(p, cell, y), cell, p); });
  }

  /// With the entries of ∂²ℓ/∂j∂j alone that are proved to be the same for every jet.
  bool constant_jacobian(const Cell& cell, std::span<double> J) const override {
    add_up_constant(J, cell, [](int, int) { return true; });
    return std::ranges::all_of(J, [](double x) { return std::isfinite(x); });
  }

  const NodalKernel* nodal_kernel() const override {
    return nodal_weights_.empty() || structure_of(density_).nonlinearity == Nonlinearity::all ? nullptr : this;
  }
  int reach() const override { return reach_; }
  double weight(const Cell& cell, int i) const override {
    return cell.time_step * cell.space_step * nodal_weights_[index(i / d)];
  }
  void linear_part(const Cell& cell, std::span<double> J) const override {
    add_up_constant(J, cell, [](int a, int b) { return a >= d || b >= d; });
  }
  double step(const SubStepRows& rows) const override { return sub_step_within<most_reach>(reach_, density_, rows); }

 private:
  using Hessian = std::array<Numbers, static_cast<std::size_t>(m)>;

  Hessian hessian(const Numbers& j, const Cell& cell, const ElementPoint& p) const {
    const Twice l = density_(jet<Twice>(j, cell, p.time, p.space));
    Hessian H;
    for (int a = 0; a < m; ++a) H[index(a)] = l.d[index(a)].d;
    return H;
  }

  /// Where at every point φ is the value at one vertex: what the points weigh there, in cells hk.
  void find_nodal_weights() {
    const auto [least, most] = std::ranges::minmax(pattern_.vertices, {}, &Site::space);
    reach_ = most.space - least.space;
    std::vector<double> weights(index(pattern_.size()), 0.0);
    for (const ElementPoint& p : element_.points) {
      const auto one = std::ranges::find(p.phi, 1.0);
      if (one == p.phi.end() || std::ranges::count(p.phi, 0.0) != pattern_.size() - 1) return;
      weights[static_cast<std::size_t>(one - p.phi.begin())] += p.weight;
    }
    if (reach_ >= 1 && reach_ <= most_reach) nodal_weights_ = std::move(weights);
  }

  /// With the entries of ∂²ℓ/∂jᵃ∂jᵇ that are proved to be the same for every jet, and are asked for.
  void add_up_constant(std::span<double> J, const Cell& cell, const auto& asked) const {
    const Abstract proved = structure_of(density_).of_density;
    Numbers j{};
    // Constant entries are the same wherever they are taken: at zero, or where the density has a value if not there.
    if (!std::isfinite(density_(jet<double>(j, cell, 0, 0))))
      for (int i = 0; i < m; ++i) j[index(i)] = 1 + 0.25 * i;
    add_up(J, cell, [&](const ElementPoint& p) {
      Hessian H = hessian(j, cell, p);
      for (int a = 0; a < m; ++a)
        for (int b = 0; b < m; ++b)
          if (proved.varying[index(a)] >> b & 1u || !asked(a, b)) H[index(a)][index(b)] = 0;
      return H;
    });
  }

  /// J = hk Σ_q w_q Jᵀ_q H_q J_q, with H_q = ∂²ℓ/∂j∂j at the point q
  template <class HessianAt>
  void add_up(std::span<double> J, const Cell& cell, const HessianAt& hessian_at) const {
    std::ranges::fill(J, 0.0);
    const double h = cell.time_step, k = cell.space_step;
    const std::size_t n = index(size());
    std::vector<int> read;  // the vertices that a point reads: few of those of a large element
    for (const ElementPoint& p : element_.points) {
      const Hessian H = hessian_at(p);
      const double area = h * k * p.weight;
      read.clear();
      for (int v = 0; v < pattern_.size(); ++v)
        if (p.phi[index(v)] != 0 || p.phi_t[index(v)] != 0 || p.phi_x[index(v)] != 0) read.push_back(v);
      for (const int v : read) {
        const auto [phi, phi_t, phi_x] = row(p, cell, v);
        for (int a = 0; a < d; ++a) {
          // hk w_q Jᵀ_qv ∂²ℓ/∂j∂j
          Numbers left;
          for (int c = 0; c < m; ++c)
            left[index(c)] = area * (phi * H[index(a)][index(c)] + phi_t * H[index(d + a)][index(c)] +
                                     phi_x * H[index(2 * d + a)][index(c)]);
          double* const out = J.data() + index(v, a) * n;
          for (const int u : read) {
            const auto [by_phi, by_t, by_x] = row(p, cell, u);
            for (int b = 0; b < d; ++b)
              out[index(u, b)] += left[index(b)] * by_phi + left[index(d + b)] * by_t + left[index(2 * d + b)] * by_x;
          }
        }
      }
    }
  }

 public:
  /// The number of nodes on the lower side of a cell, p_x + 1.
  int bottom_nodes() const { return bottom_; }

  /// One cell's part of the semi-discrete momenta at its lower side, from φ and φ_t at the nodes there:
  ///
  ///     p_b = k Σ_q w_q φ_q,b ∂ℓ/∂φ_t(j_q)     with φ_q = Σ_b φ_q,b y_b
  ///
  bool momentum(const Cell& cell, std::span<const double> bottom_phi, std::span<const double> bottom_velocity,
                std::span<double> p) const override {
    std::ranges::fill(p, 0.0);
    for (const ElementPoint& point : element_.lower_side) {
      Numbers j{};
      for (int b = 0; b < bottom_; ++b)
        for (int a = 0; a < d; ++a) {
          j[index(a)] += point.phi[index(b)] * bottom_phi[index(b, a)];
          j[index(d + a)] += point.phi[index(b)] * bottom_velocity[index(b, a)];
          j[index(2 * d + a)] += point.phi_x[index(b)] * bottom_phi[index(b, a)] / cell.space_step;
        }
      const Number l = density_(jet<Number>(j, cell, 0, point.space));
      for (int b = 0; b < bottom_; ++b)
        for (int a = 0; a < d; ++a)
          p[index(b, a)] += cell.space_step * point.weight * point.phi[index(b)] * l.d[index(d + a)];
    }
    return true;
  }

 private:
  static constexpr std::size_t index(int i) { return static_cast<std::size_t>(i); }
  static constexpr std::size_t index(int v, int a) { return static_cast<std::size_t>(v * d + a); }

  /// What one value weighs in a jet: in φ and φ_t, or in φ_x, but for 1/h and 1/k.
  struct NodeWeight {
    int node;
    double phi, derivative;
  };
  /// A point of the quadrature, with the values that its φ and φ_t read, and those that its φ_x reads.
  struct PointWeights {
    double weight, time, space;
    std::vector<NodeWeight> values, slopes;
  };
  void list_weights() {
    for (const ElementPoint& p : element_.points) {
      PointWeights point{p.weight, p.time, p.space, {}, {}};
      for (int v = 0; v < pattern_.size(); ++v) {
        if (p.phi[index(v)] != 0 || p.phi_t[index(v)] != 0)
          point.values.push_back({v, p.phi[index(v)], p.phi_t[index(v)]});
        if (p.phi_x[index(v)] != 0) point.slopes.push_back({v, 0, p.phi_x[index(v)]});
      }
      weights_.push_back(std::move(point));
    }
  }

  static JetFor<Packed, D> packed_jet(const Packs& j, const Cell& cell, [[maybe_unused]] const double* x,
                                      [[maybe_unused]] double time, [[maybe_unused]] double space) {
    JetFor<Packed, D> result;
    for (int a = 0; a < d; ++a) {
      component(result.phi, a) = Packed::variable(j[index(a)], a);
      component(result.phi_t, a) = Packed::variable(j[index(d + a)], d + a);
      component(result.phi_x, a) = Packed::variable(j[index(2 * d + a)], 2 * d + a);
    }
    if constexpr (delf::is_placed<D>()) {
      result.t = Packed(Pack(cell.t + time * cell.time_step));
      result.x = Packed(Pack::load(x) + space * cell.space_step);
    }
    return result;
  }

  /// Node `node` of the cell has the components node·d + a of the section.
  static std::vector<VertexValue> values_of(const StencilPattern& pattern) {
    std::vector<VertexValue> values;
    for (int l = 0; l < pattern.size(); ++l)
      for (int a = 0; a < d; ++a) values.push_back({l, pattern.vertices[index(l)].node * d + a});
    return values;
  }

  /// J_qv
  static std::array<double, 3> row(const ElementPoint& p, const Cell& cell, int v) {
    return {p.phi[index(v)], p.phi_t[index(v)] / cell.time_step, p.phi_x[index(v)] / cell.space_step};
  }

  /// j_q = Σ_v J_qv y_v
  static Numbers numbers(const ElementPoint& p, const Cell& cell, std::span<const double> y) {
    Numbers j{};
    for (int a = 0; a < d; ++a) {
      for (std::size_t v = 0; v < p.phi.size(); ++v) {
        const double value = y[v * index(d) + index(a)];
        j[index(a)] += p.phi[v] * value;
        j[index(d + a)] += p.phi_t[v] * value;
        j[index(2 * d + a)] += p.phi_x[v] * value;
      }
      j[index(d + a)] /= cell.time_step;
      j[index(2 * d + a)] /= cell.space_step;
    }
    return j;
  }

  /// The variable number i of a jet.
  template <class T>
  static T variable(double value, int i) {
    if constexpr (std::same_as<T, double>) return value;
    else if constexpr (std::same_as<T, Number>) return Number::variable(value, i);
    else return Twice::variable(Number::variable(value, i), i);
  }

  template <class T>
  static JetFor<T, D> jet(const Numbers& j, const Cell& cell, double time, double space) {
    JetFor<T, D> result;
    for (int a = 0; a < d; ++a) {
      component(result.phi, a) = variable<T>(j[index(a)], a);
      component(result.phi_t, a) = variable<T>(j[index(d + a)], d + a);
      component(result.phi_x, a) = variable<T>(j[index(2 * d + a)], 2 * d + a);
    }
    if constexpr (delf::is_placed<D>()) {
      result.t = T(cell.t + time * cell.time_step);
      result.x = T(cell.x + space * cell.space_step);
    }
    return result;
  }

  Element element_;
  D density_;
  std::vector<PointWeights> weights_;
  int bottom_ = 0, reach_ = 0;
  std::vector<double> nodal_weights_;  ///< of each vertex; none where points are not nodal
};

}  // namespace delf

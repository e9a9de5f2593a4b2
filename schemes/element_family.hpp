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

#include "jets/pack.hpp"
#include "jets/spacetime_element.hpp"
#include "jets/structure.hpp"
#include "schemes/stencil_family.hpp"

namespace delf {

/// The discrete Lagrangian of an element, L_Δ = hk Σ_q w_q ℓ(j_q), on every cell. The density is differentiated by its
/// jet j = (φ, φ_t, φ_x) alone, the table does the rest:
///
///     ∂L/∂y_l = hk Σ_q w_q Jᵀ_ql ∂ℓ/∂j(j_q),    J_ql = ∂j_q/∂y_l = (phi[l], phi_t[l]/h, phi_x[l]/k)
///
template <Density D>
class ElementFamily final : public StencilFamily {
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
    space_ = lobatto_rule(bottom_ - 1);
    const LagrangeBasis basis(space_.points);
    for (const double x : space_.points) std::ranges::copy(basis.slopes(x), std::back_inserter(space_slopes_));
    list_weights();
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
    const Abstract proved = structure_of(density_).of_density;
    Numbers j{};
    // Constant entries are the same wherever they are taken: at zero, or where the density has a value if not there.
    if (!std::isfinite(density_(jet<double>(j, cell, 0, 0))))
      for (int i = 0; i < m; ++i) j[index(i)] = 1 + 0.25 * i;
    add_up(J, cell, [&](const ElementPoint& p) {
      Hessian H = hessian(j, cell, p);
      for (int a = 0; a < m; ++a)
        for (int b = 0; b < m; ++b)
          if (proved.varying[index(a)] >> b & 1u) H[index(a)][index(b)] = 0;
      return H;
    });
    return std::ranges::all_of(J, [](double x) { return std::isfinite(x); });
  }

 private:
  using Hessian = std::array<Numbers, static_cast<std::size_t>(m)>;

  Hessian hessian(const Numbers& j, const Cell& cell, const ElementPoint& p) const {
    const Twice l = density_(jet<Twice>(j, cell, p.time, p.space));
    Hessian H;
    for (int a = 0; a < m; ++a) H[index(a)] = l.d[index(a)].d;
    return H;
  }

  /// J = hk Σ_q w_q Jᵀ_q H_q J_q, with H_q = ∂²ℓ/∂j∂j at the point q
  template <class HessianAt>
  void add_up(std::span<double> J, const Cell& cell, const HessianAt& hessian_at) const {
    std::ranges::fill(J, 0.0);
    const double h = cell.time_step, k = cell.space_step;
    const std::size_t n = index(size());
    for (const ElementPoint& p : element_.points) {
      const Hessian H = hessian_at(p);
      const double area = h * k * p.weight;
      for (int v = 0; v < pattern_.size(); ++v) {
        const auto [phi, phi_t, phi_x] = row(p, cell, v);
        if (phi == 0 && phi_t == 0 && phi_x == 0) continue;
        for (int a = 0; a < d; ++a) {
          // hk w_q Jᵀ_qv ∂²ℓ/∂j∂j
          Numbers left;
          for (int c = 0; c < m; ++c)
            left[index(c)] = area * (phi * H[index(a)][index(c)] + phi_t * H[index(d + a)][index(c)] +
                                     phi_x * H[index(2 * d + a)][index(c)]);
          double* const out = J.data() + index(v, a) * n;
          for (int u = 0; u < pattern_.size(); ++u) {
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
  ///     p_b = k Σ_q w_q ψ_b(x_q) ∂ℓ/∂φ_t(x_q)     with the Lobatto points x_q, where ψ_b(x_q) = δ_bq
  ///
  bool momentum(const Cell& cell, std::span<const double> bottom_phi, std::span<const double> bottom_velocity,
                std::span<double> p) const override {
    for (int q = 0; q < bottom_; ++q) {
      Numbers j{};
      for (int a = 0; a < d; ++a) {
        j[index(a)] = bottom_phi[index(q, a)];
        j[index(d + a)] = bottom_velocity[index(q, a)];
        for (int b = 0; b < bottom_; ++b)
          j[index(2 * d + a)] += space_slopes_[index(q * bottom_ + b)] * bottom_phi[index(b, a)] / cell.space_step;
      }
      const Number l = density_(jet<Number>(j, cell, 0, space_.points[index(q)]));
      for (int a = 0; a < d; ++a) p[index(q, a)] = cell.space_step * space_.weights[index(q)] * l.d[index(d + a)];
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
  int bottom_ = 0;
  LineRule space_;
  std::vector<double> space_slopes_;  ///< ψ′_b(x_q) at q (p_x + 1) + b
};

}  // namespace delf

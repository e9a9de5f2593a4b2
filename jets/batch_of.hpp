// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <concepts>
#include <utility>

#include "jets/batch_density.hpp"
#include "jets/value_derivatives.hpp"
#include "lattice/index.hpp"

namespace delf {

/// A functor as a density in batches: the one template that is compiled for each density.
template <Density D>
class BatchOf final : public BatchDensity, public ValueDerivatives {
  static constexpr int d = components_of<D>(), m = slots_of<D>() * d;

 public:
  explicit BatchOf(D density) : density_(std::move(density)) {
    components_ = d;
    slots_ = slots_of<D>();
    placed_ = delf::is_placed<D>();
    structure_ = structure_of(density_);
    if constexpr (requires { density_.symmetries(); }) symmetries_ = density_.symmetries();
    has_difference_quotient_ = has_quotient;
    find_constants();
  }
  const D& density() const { return density_; }
  const ValueDerivatives* value_derivatives() const override { return this; }

  void value(const JetBatch& batch, double* l) const override {
    for_each_pack(batch, [&](int at) {
      const auto jet = jet_at<Pack>(batch, at, [](Pack x, int) { return x; });
      density_(jet).store(l + at);
    });
  }
  void gradient(const JetBatch& batch, double* const* g, double* l) const override {
    using Number = Dual<Pack, m>;
    for_each_pack(batch, [&](int at) {
      const Number r = density_(jet_at<Number>(batch, at, [](Pack x, int a) { return Number::variable(x, a); }));
      for (int a = 0; a < m; ++a) r.derivative(a).store(g[a] + at);
      if (l) r.value.store(l + at);
    });
  }
  /// Row by row: the derivative in one variable of all derivatives. Where ℓ is nonlinear in φ alone, only ∂²ℓ/∂φ∂φ varies.
  void hessian(const JetBatch& batch, double* const* H) const override {
    if (nonlinearity() != Nonlinearity::all && !is_placed() && !constant_hessian().empty()) {
      for (int v = 0; v < m * m; ++v) std::fill_n(H[v], batch.count, constant_hessian()[v]);
      std::array<double*, delf::at(d * d)> c;
      for (int a = 0; a < d; ++a)
        for (int b = 0; b < d; ++b) c[a * d + b] = H[a * m + b];
      return curvature(batch, c.data());
    }
    using Inner = Dual<Pack, 1>;
    using Number = Dual<Inner, m>;
    for (int row = 0; row < m; ++row)
      for_each_pack(batch, [&](int at) {
        const Number r = density_(jet_at<Number>(batch, at, [row](Pack x, int a) {
          Inner value(x);
          value.d[0] = Pack(a == row ? 1.0 : 0.0);
          return Number::variable(value, a);
        }));
        for (int a = 0; a < m; ++a) r.derivative(a).derivative(0).store(H[row * m + a] + at);
      });
  }
  [[gnu::__flatten__]] void slope(const JetBatch& given, double* const* given_g) const override {
    using Number = Dual<Pack, d>;
    // Copies of this function alone: stores cannot change them.
    const D density = density_;
    const JetBatch batch = given;
    std::array<const double*, delf::at(d)> phi;
    std::array<double*, delf::at(d)> g;
    for (int a = 0; a < d; ++a) phi[a] = batch.slots[a], g[a] = given_g[a];
    const double* const x = batch.x;
    for (int at = 0; at < batch.count; at += lanes) {
      JetFor<Number, D> jet = still<Number>();
      for (int a = 0; a < d; ++a) jet_slot(jet, 0, a) = Number::variable(Pack::load(phi[a] + at), a);
      if constexpr (delf::is_placed<D>()) jet.t = Number(Pack(batch.t)), jet.x = Number(Pack::load(x + at));
      const Number r = density(jet);
      for (int a = 0; a < d; ++a) r.derivative(a).store(g[a] + at);
    }
  }
  void curvature(const JetBatch& batch, double* const* c) const override {
    differentiate_twice(density_, batch, [&](int row, int at, const auto& r) {
      for (int a = 0; a < d; ++a) r.derivative(a).derivative(0).store(c[row * d + a] + at);
    });
  }
  [[gnu::__flatten__]] void slope_and_curvature(const JetBatch& given, double* const* g,
                                                double* const* c) const override {
    const D density = density_;
    const JetBatch batch = given;
    differentiate_twice(density, batch, [&](int row, int at, const auto& r) {
      r.derivative(row).value.store(g[row] + at);
      for (int a = 0; a < d; ++a) r.derivative(a).derivative(0).store(c[row * d + a] + at);
    });
  }
  /// The outermost derivative is the one along v.
  void curvature_along(const JetBatch& batch, const double* const* v, double* const* c) const override {
    using Along = Dual<Pack, 1>;
    using Inner = Dual<Along, 1>;
    using Number = Dual<Inner, d>;
    for (int row = 0; row < d; ++row)
      for_each_pack(batch, [&](int at) {
        JetFor<Number, D> jet = still<Number>();
        for (int a = 0; a < d; ++a) {
          Along phi(Pack::load(batch.slots[a] + at));
          phi.d[0] = Pack::load(v[a] + at);
          Inner value(phi);
          value.d[0] = Along(Pack(a == row ? 1.0 : 0.0));
          jet_slot(jet, 0, a) = Number::variable(value, a);
        }
        if constexpr (delf::is_placed<D>())
          jet.t = Number(Inner(Along(Pack(batch.t)))), jet.x = Number(Inner(Along(Pack::load(batch.x + at))));
        const Number r = density_(jet);
        for (int a = 0; a < d; ++a) r.derivative(a).derivative(0).derivative(0).store(c[row * d + a] + at);
      });
  }
  void place_gradient(const JetBatch& batch, double* l_t, double* l_x) const override {
    using Number = Dual<Pack, 2>;
    for_each_pack(batch, [&](int at) {
      [[maybe_unused]] auto jet = jet_at<Number>(batch, at, [](Pack x, int) { return Number(x); });
      Number r(0.0);
      if constexpr (delf::is_placed<D>()) {
        jet.t.d[0] = Pack(1.0), jet.x.d[1] = Pack(1.0);
        r = density_(jet);
      }
      r.derivative(0).store(l_t + at), r.derivative(1).store(l_x + at);
    });
  }

  void difference_quotient(const JetBatch& ab, double* const* q) const override {
    if constexpr (has_quotient)
      for_each_pack(ab, [&](int at) {
        FibreValue<Pack, d> value = quotient<Pack>([&](int j) { return Pack::load(ab.slots[j] + at); });
        for (int c = 0; c < d; ++c) component(value, c).store(q[c] + at);
      });
  }
  void differentiate_quotient(const JetBatch& ab, double* const* out) const override {
    using Number = Dual<Pack, 2 * d>;
    if constexpr (has_quotient)
      for_each_pack(ab, [&](int at) {
        FibreValue<Number, d> value =
            quotient<Number>([&](int j) { return Number::variable(Pack::load(ab.slots[j] + at), j); });
        for (int c = 0; c < d; ++c)
          for (int j = 0; j < 2 * d; ++j) component(value, c).derivative(j).store(out[c * 2 * d + j] + at);
      });
  }

 private:
  static constexpr bool has_quotient = requires(const D& density, const FibreValue<double, d>& a) {
    density.difference_quotient(a, a);
  };
  template <class Number>
  FibreValue<Number, d> quotient(const auto& make) const {
    FibreValue<Number, d> a, b;
    for (int c = 0; c < d; ++c) component(a, c) = make(c), component(b, c) = make(d + c);
    return density_.difference_quotient(a, b);
  }
  static void for_each_pack(const JetBatch& batch, const auto& body) {
    for (int at = 0; at < batch.count; at += lanes) body(at);
  }
  /// `take(row, at, r)`: r has the derivatives of ℓ by all φᵃ at (φ, 0, …), and of these the derivatives by φ of `row`.
  static void differentiate_twice(const D& density, const JetBatch& batch, const auto& take) {
    using Inner = Dual<Pack, 1>;
    using Number = Dual<Inner, d>;
    for (int row = 0; row < d; ++row)
      for_each_pack(batch, [&](int at) {
        JetFor<Number, D> jet = still<Number>();
        for (int a = 0; a < d; ++a) {
          Inner value(Pack::load(batch.slots[a] + at));
          value.d[0] = Pack(a == row ? 1.0 : 0.0);
          jet_slot(jet, 0, a) = Number::variable(value, a);
        }
        place<Number>(jet, batch, at);
        take(row, at, density(jet));
      });
  }
  template <class Number>
  static JetFor<Number, D> still() {
    JetFor<Number, D> jet;
    for (int s = 0; s < slots_of<D>(); ++s)
      for (int a = 0; a < d; ++a) jet_slot(jet, s, a) = Number(0.0);
    return jet;
  }
  template <class Number>
  static Number number(Pack x) {
    if constexpr (std::same_as<Number, Pack>) return x;
    else return Number(decltype(Number::value)(x));
  }
  template <class Number>
  static void place([[maybe_unused]] JetFor<Number, D>& jet, [[maybe_unused]] const JetBatch& batch,
                    [[maybe_unused]] int at) {
    if constexpr (delf::is_placed<D>())
      jet.t = number<Number>(Pack(batch.t)), jet.x = number<Number>(Pack::load(batch.x + at));
  }
  /// `make(x, a)` is the number that stands for variable a.
  template <class Number, class Make>
  static JetFor<Number, D> jet_at(const JetBatch& batch, int at, const Make& make) {
    JetFor<Number, D> jet;
    for (int s = 0; s < slots_of<D>(); ++s)
      for (int a = 0; a < d; ++a) jet_slot(jet, s, a) = make(Pack::load(batch.slots[s * d + a] + at), s * d + a);
    place<Number>(jet, batch, at);
    return jet;
  }

  D density_;
};

}  // namespace delf

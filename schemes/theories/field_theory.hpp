// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "jets/tables/hexagon_jet.hpp"
#include "jets/tables/point_jets.hpp"
#include "jets/tables/rectangle_jet.hpp"
#include "jets/symmetry.hpp"
#include "jets/tables/triangle_jet.hpp"
#include "jets/tables/tuple_jets.hpp"
#include "schemes/families/damped_leapfrog.hpp"
#include "schemes/families/element_family.hpp"
#include "schemes/system/energy.hpp"
#include "schemes/families/guo.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/families/residual_family.hpp"
#include "schemes/families/variational_family.hpp"
#include "schemes/families/vertex_constraint.hpp"
#include "schemes/families/vu_quoc_li.hpp"

namespace delf {

/// A theory on every stencil that delf knows: what a registry hands out, with the density compiled in.
class FieldTheory {
 public:
  virtual ~FieldTheory() = default;
  virtual int components() const = 0;
  virtual bool is_placed() const = 0;
  /// The action on a stencil of `for_each_stencil`; null if there is none of that name.
  virtual std::shared_ptr<const StencilFamily> variational(const std::string& stencil, double h, double k) const = 0;
  /// The action on an element with nodes inside.
  virtual std::shared_ptr<const StencilFamily> on_element(const Element&) const = 0;
  /// The constraint that the theory declares, with its multiplier; null if it declares none.
  virtual std::shared_ptr<const StencilFamily> constraint() const = 0;
  /// What leaves the density as it is, as the theory declares it.
  virtual std::vector<LinearSymmetry> symmetries() const = 0;
  /// A comparator; null if there is none of that name for this theory.
  virtual std::shared_ptr<const StencilFamily> comparator(const std::string& method, double h, double k) const = 0;
  /// Up to this |φ| sums may be taken of `near` rows: near_below() of the density.
  virtual double near_below() const = 0;
  /// Sums over the symmetric rectangle's jets between two rows.
  virtual EnergyMomentum energy_momentum(const SlabRows&, const CellWeights&) const = 0;
  /// At one jet; components() numbers each.
  virtual StressEnergy stress_energy(const double* phi, const double* phi_t, const double* phi_x, double t,
                                     double x) const = 0;
};

/// Calls f(name, description, jet map) for every stencil that a scene can name: a new one adds one line here.
template <class Function>
void for_each_stencil(Function&& f) {
  f("triangle", "3 sites, φ at the centroid: (5.8)", triangle);
  f("triangle-vertex", "3 sites, φ at the first vertex (footnote 3): explicit", triangle_vertex);
  f("rectangle", "4 sites, (5.9) with φ_t on both vertical edges: (5.10)", rectangle);
  f("rectangle-symmetric", "4 sites, space and time alike: (5.12)", rectangle_symmetric);
  f("hexagon", "6 sites of a brick wall (Fig. 5.4); circle, N even", hexagon);
  f("six-tuple", "6 sites, φ on the middle edge, φ_x left and right of it; circle", six_tuple);
  f("nine-tuple", "9 sites, the symmetric rectangle in each of four cells; circle", nine_tuple);
  f("midpoint", "2 sites of a time lattice, q in the middle; lattice.space = point", midpoint);
  f("trapezoidal", "2 sites of a time lattice, half at either end (Störmer–Verlet); lattice.space = point",
    trapezoidal);
  f("vertex", "2 sites of a time lattice, q at the first (symplectic Euler); lattice.space = point", vertex);
}

template <Density D>
class TheoryOf final : public FieldTheory {
 public:
  explicit TheoryOf(D density)
      : density_(std::move(density)), wave_form_(wave_form(density_)), near_below_(delf::near_below(density_)) {}

  int components() const override { return components_of<D>(); }
  bool is_placed() const override { return delf::is_placed<D>(); }

  std::shared_ptr<const StencilFamily> variational(const std::string& stencil, double h, double k) const override {
    std::shared_ptr<const StencilFamily> family;
    for_each_stencil([&]<class Map>(const char* name, const char*, Map) {
      if (stencil == name) family = std::make_shared<VariationalFamily<Map, D>>(density_, h, k);
    });
    return family;
  }

  std::shared_ptr<const StencilFamily> on_element(const Element& element) const override {
    return std::make_shared<ElementFamily<D>>(element, density_);
  }

  std::shared_ptr<const StencilFamily> constraint() const override {
    if constexpr (Constrained<D>)
      return std::make_shared<LagrangianFamily<VertexConstraint<D>>>(VertexConstraint<D>{density_});
    else return nullptr;
  }

  std::vector<LinearSymmetry> symmetries() const override {
    if constexpr (requires { density_.symmetries(); }) return density_.symmetries();
    else return {};
  }

  std::shared_ptr<const StencilFamily> comparator(const std::string& method, double h, double k) const override {
    if constexpr (requires(double a) { density_.difference_quotient(a, a); }) {
      if (method == "vu-quoc-li") return std::make_shared<ResidualFamily<VuQuocLi<D>>>(VuQuocLi<D>{density_}, h, k);
      if (method == "damped")
        return std::make_shared<ResidualFamily<DampedLeapfrog<D>>>(DampedLeapfrog<D>{density_, h}, h, k);
      if (method == "guo") return std::make_shared<ResidualFamily<Guo<D>>>(Guo<D>{density_}, h, k);
    }
    return nullptr;
  }

  double near_below() const override { return near_below_; }
  EnergyMomentum energy_momentum(const SlabRows& rows, const CellWeights& weights) const override {
    if (wave_form_ && rows.near) return delf::energy_momentum<ReducedPack>(density_, *wave_form_, rows, weights);
    if (wave_form_) return delf::energy_momentum<Pack>(density_, *wave_form_, rows, weights);
    return delf::energy_momentum(density_, rows, weights);
  }

  StressEnergy stress_energy(const double* phi, const double* phi_t, const double* phi_x, double t,
                             double x) const override {
    return delf::stress_energy(density_, phi, phi_t, phi_x, t, x);
  }

 private:
  D density_;
  std::optional<WaveForm<components_of<D>()>> wave_form_;
  double near_below_;
};

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <string>

#include "jets/hexagon_jet.hpp"
#include "jets/rectangle_jet.hpp"
#include "jets/triangle_jet.hpp"
#include "jets/tuple_jets.hpp"
#include "schemes/energy.hpp"
#include "schemes/guo.hpp"
#include "schemes/residual_family.hpp"
#include "schemes/variational_family.hpp"
#include "schemes/vu_quoc_li.hpp"

namespace delf {

/// A theory on every stencil that delf knows: what a registry hands out, with the density compiled in.
class FieldTheory {
 public:
  virtual ~FieldTheory() = default;
  virtual int components() const = 0;
  virtual bool is_placed() const = 0;
  /// The scheme on a stencil of `stencil_names`; null if there is none of that name.
  virtual std::shared_ptr<const StencilFamily> variational(const std::string& stencil, double h, double k) const = 0;
  /// A comparator; null if there is none of that name for this theory.
  virtual std::shared_ptr<const StencilFamily> comparator(const std::string& method, double h, double k) const = 0;
  /// Sums over the symmetric rectangle's jets between two rows.
  virtual EnergyMomentum energy_momentum(const SlabRows&, const double* weights) const = 0;
};

/// Calls f(name, jet map) for every stencil that a scene can name: the one list of them.
template <class Function>
void for_each_stencil(Function&& f) {
  f("triangle", triangle);
  f("triangle-vertex", triangle_vertex);
  f("rectangle", rectangle);
  f("rectangle-symmetric", rectangle_symmetric);
  f("hexagon", hexagon);
  f("six-tuple", six_tuple);
  f("nine-tuple", nine_tuple);
}

template <Density D>
class TheoryOf final : public FieldTheory {
 public:
  explicit TheoryOf(D density) : density_(std::move(density)) {}

  int components() const override { return components_of<D>(); }
  bool is_placed() const override { return delf::is_placed<D>(); }

  std::shared_ptr<const StencilFamily> variational(const std::string& stencil, double h, double k) const override {
    std::shared_ptr<const StencilFamily> family;
    for_each_stencil([&]<class Map>(const char* name, Map) {
      if (stencil == name) family = std::make_shared<VariationalFamily<Map, D>>(density_, h, k);
    });
    return family;
  }

  std::shared_ptr<const StencilFamily> comparator(const std::string& method, double h, double k) const override {
    if constexpr (requires(double a) { density_.difference_quotient(a, a); }) {
      if (method == "vu-quoc-li") return std::make_shared<ResidualFamily<VuQuocLi<D>>>(VuQuocLi<D>{density_}, h, k);
      if (method == "guo") return std::make_shared<ResidualFamily<Guo<D>>>(Guo<D>{density_}, h, k);
    }
    return nullptr;
  }

  EnergyMomentum energy_momentum(const SlabRows& rows, const double* weights) const override {
    return delf::energy_momentum(density_, rows, weights);
  }

 private:
  D density_;
};

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "jets/simd/pack.hpp"
#include "lattice/index.hpp"
#include "schemes/families/stencil_family.hpp"

namespace delf {

/// A family on listed stencils whose vertices hold `components` of its values each, one after the other.
class FamilyOnSites final : public StencilFamily {
 public:
  /// Stencils of a lattice, whose L has a factor for each stencil here: in a cell of their own, with numbers there.
  struct Moved {
    Cell cell;
    std::vector<std::int32_t> numbers;
    std::vector<double> factors;
  };
  FamilyOnSites(std::shared_ptr<const StencilFamily> family, int components,
                std::shared_ptr<const ListedStencils> stencils, std::optional<Moved> moved)
      : StencilFamily(pattern_of(family->size() / components), {}, family->is_variational()),
        family_(std::move(family)),
        moved_(std::move(moved)) {
    for (int i = 0; i < family_->size(); ++i) values_.push_back({i / components, i % components});
    listed_ = std::move(stencils);
    placed_ = family_->is_placed();
  }

  using StencilFamily::jacobian;
  using StencilFamily::lagrangian;
  using StencilFamily::residual;
  void residual(const StencilBatch& batch, std::span<const int> equations, double* r) const override {
    call(batch, equations.size(), r, [&](const StencilBatch& own) { family_->residual(own, equations, r); });
  }
  void jacobian(const StencilBatch& batch, std::span<const int> equations, std::span<const int> unknowns,
                double* J) const override {
    call(batch, equations.size() * unknowns.size(), J,
         [&](const StencilBatch& own) { family_->jacobian(own, equations, unknowns, J); });
  }
  bool lagrangian(const StencilBatch& batch, double* L) const override {
    bool has = false;
    call(batch, 1, L, [&](const StencilBatch& own) { has = family_->lagrangian(own, L); });
    return has;
  }
  bool is_constant(int i, int m) const override { return family_->is_constant(i, m); }

 private:
  static StencilPattern pattern_of(int vertices) {
    StencilPattern pattern;
    for (int l = 0; l < vertices; ++l) pattern.vertices.push_back({.time = 0, .space = l});
    return pattern;
  }

  template <class Evaluate>
  void call(StencilBatch batch, std::size_t numbers, double* out, const Evaluate& evaluate) const {
    if (!moved_) return evaluate(batch);
    std::vector<int> there(batch.count);
    for (std::size_t s = 0; s < there.size(); ++s) there[s] = moved_->numbers[batch.numbers[s]];
    const int* const here = std::exchange(batch.numbers, there.data());
    batch.cell = moved_->cell;
    evaluate(batch);
    for (std::size_t n = 0; n < numbers; ++n)
      for (std::size_t s = 0; s < there.size(); ++s) *out++ *= moved_->factors[here[s]];
  }

  std::shared_ptr<const StencilFamily> family_;
  std::optional<Moved> moved_;
};

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/families/stencil_family.hpp"
#include "tests/jets/random.hpp"

namespace delf::testing {

/// Random stencils of a family, as a batch and one by one.
class FamilyBatch {
 public:
  FamilyBatch(const StencilFamily& of, const Cell& cell, int count, Random& random, double amplitude = 1)
      : family(of), size_(delf::at(of.size())), cell_(cell), count_(count) {
    x_.resize(packs(1)), y_.resize(packs(size_));
    for (int s = 0; s < count; ++s) {
      number(x_, 0, s) = random(-3, 3);
      for (std::size_t i = 0; i < size_; ++i) number(y_, i, s) = random(-amplitude, amplitude);
    }
  }
  StencilBatch batch() const { return {cell_, count_, data(x_), data(y_)}; }
  int count() const { return count_; }
  Cell cell(int s) const {
    Cell one = cell_;
    one.x = number(x_, 0, s);
    return one;
  }
  std::vector<double> y(int s) const {
    std::vector<double> values;
    for (std::size_t i = 0; i < size_; ++i) values.push_back(number(y_, i, s));
    return values;
  }
  /// A call with an array of so many rows of numbers, one for each stencil: row i of stencil s is result[i][s].
  std::vector<std::vector<double>> rows(std::size_t n, const auto& call) const {
    std::vector<Pack> out(packs(n));
    call(reinterpret_cast<double*>(out.data()));
    std::vector<std::vector<double>> result(n);
    for (std::size_t i = 0; i < n; ++i)
      for (int s = 0; s < count_; ++s) result[i].push_back(number(out, i, s));
    return result;
  }
  std::vector<std::vector<double>> residuals() const {
    return rows(size_, [&](double* r) { family.residual(batch(), r); });
  }
  /// ∂rᵉ/∂yᵘ: [e · unknowns + u][s]
  std::vector<std::vector<double>> jacobians(const std::vector<int>& equations,
                                             const std::vector<int>& unknowns) const {
    return rows(equations.size() * unknowns.size(),
                [&](double* J) { family.jacobian(batch(), equations, unknowns, J); });
  }

  /// The largest |r − r0 − J y − hk Σ_c weight(c, ·) g_c| over the stencils, relative to the largest |r|; g of source
  /// terms multiplied by `factor`.
  double split_defect(double factor = 1) const {
    const auto part = family.constant_part(cell_);
    if (!part) return std::nan("");
    const SourceTerms* const terms = family.sources();
    std::vector<std::vector<double>> sources;
    if (terms)
      for (std::size_t g = 0; g < terms->groups.size(); ++g)
        for (auto& row : source_rows(static_cast<int>(g))) sources.push_back(std::move(row));
    const auto r = residuals();
    double worst = 0, largest = 0;
    for (int s = 0; s < count_; ++s) {
      const auto values = y(s);
      for (std::size_t i = 0; i < size_; ++i) {
        double sum = part->r0[i];
        for (std::size_t j = 0; j < size_; ++j) sum += part->J[i * size_ + j] * values[j];
        for (std::size_t c = 0; c < sources.size(); ++c)
          sum += factor * cell_.time_step * cell_.space_step * terms->weight(static_cast<int>(c), static_cast<int>(i)) *
                 sources[c][s];
        const double exact = r[i][s];
        if (!(std::abs(sum - exact) <= worst)) worst = std::abs(sum - exact);
        largest = std::max(largest, std::abs(exact));
      }
    }
    return worst / largest;
  }
  /// The largest difference between the Jacobian and that of the split, J + hk Σ weight · ∂g/∂m · ∂m/∂y.
  double split_jacobian_defect() const {
    const auto part = family.constant_part(cell_);
    if (!part) return std::nan("");
    std::vector<int> all(size_);
    std::iota(all.begin(), all.end(), 0);
    const auto J = jacobians(all, all);
    std::vector<std::vector<double>> sum;
    for (double entry : part->J) sum.emplace_back(delf::at(count_), entry);
    if (const SourceTerms* const terms = family.sources())
      for (std::size_t g = 0; g < terms->groups.size(); ++g) {
        const std::vector<Pack> inputs = quadrature_values(static_cast<int>(g));
        const std::size_t n = terms->groups[g].inputs.size(), outputs = delf::at(terms->outputs_per_group);
        const auto slopes = rows(outputs * n, [&](double* out) {
          with_pointers(
              inputs, n, out, outputs * n,
              [&](const JetBatch& at, double* const* d) { family.differentiate_sources(static_cast<int>(g), at, d); },
              terms->groups[g]);
        });
        for (std::size_t c = 0; c < outputs; ++c)
          for (std::size_t j = 0; j < n; ++j)
            for (const SourceTerms::Part& part_of : terms->groups[g].inputs[j])
              for (std::size_t i = 0; i < size_; ++i)
                for (std::size_t s = 0; s < delf::at(count_); ++s)
                  sum[i * size_ + value_of(part_of)][s] +=
                      cell_.time_step * cell_.space_step *
                      terms->weight(static_cast<int>(g * outputs + c), static_cast<int>(i)) * slopes[c * n + j][s] *
                      part_of.weight;
      }
    double worst = 0, largest = 0;
    for (std::size_t e = 0; e < J.size(); ++e)
      for (std::size_t s = 0; s < J[e].size(); ++s) {
        if (!(std::abs(J[e][s] - sum[e][s]) <= worst)) worst = std::abs(J[e][s] - sum[e][s]);
        largest = std::max(largest, std::abs(J[e][s]));
      }
    return worst / largest;
  }

  const StencilFamily& family;

 private:
  std::size_t packs(std::size_t rows_of) const { return rows_of * delf::at(count_ / lanes); }
  static const double* data(const std::vector<Pack>& memory) { return reinterpret_cast<const double*>(memory.data()); }
  double& number(std::vector<Pack>& memory, std::size_t row, int s) const {
    return reinterpret_cast<double*>(memory.data())[row * delf::at(count_) + delf::at(s)];
  }
  double number(const std::vector<Pack>& memory, std::size_t row, int s) const {
    return data(memory)[row * delf::at(count_) + delf::at(s)];
  }
  std::size_t value_of(const SourceTerms::Part& part) const {
    for (std::size_t i = 0; i < size_; ++i)
      if (family.site(static_cast<int>(i)) == part.vertex && family.values()[i].component == part.component) return i;
    return size_;
  }
  /// m = Σ weight · y(vertex), for each input of a group.
  std::vector<Pack> quadrature_values(int group) const {
    const auto& inputs = family.sources()->groups[group].inputs;
    std::vector<Pack> m(packs(inputs.size()), Pack(0.0));
    for (std::size_t j = 0; j < inputs.size(); ++j)
      for (const SourceTerms::Part& part : inputs[j])
        for (int s = 0; s < count_; ++s) number(m, j, s) += part.weight * number(y_, value_of(part), s);
    return m;
  }
  void with_pointers(const std::vector<Pack>& inputs, std::size_t n, double* out, std::size_t outputs, const auto& call,
                     const SourceTerms::Group& group) const {
    std::vector<const double*> in;
    std::vector<double*> to;
    for (std::size_t j = 0; j < n; ++j) in.push_back(data(inputs) + j * delf::at(count_));
    for (std::size_t c = 0; c < outputs; ++c) to.push_back(out + c * delf::at(count_));
    std::vector<Pack> x = x_;
    for (Pack& position : x) position = position + Pack(group.space * cell_.space_step);
    call(JetBatch{count_, in.data(), cell_.t + group.time * cell_.time_step, data(x)}, to.data());
  }
  std::vector<std::vector<double>> source_rows(int group) const {
    const SourceTerms& terms = *family.sources();
    const SourceTerms::Group& of = terms.groups[group];
    const std::vector<Pack> inputs = quadrature_values(group);
    const std::size_t outputs = terms.outputs_per_group;
    return rows(outputs, [&](double* out) {
      with_pointers(
          inputs, of.inputs.size(), out, outputs,
          [&](const JetBatch& at, double* const* g) { family.evaluate_sources(group, at, g); }, of);
    });
  }

  std::size_t size_;
  Cell cell_;
  int count_;
  std::vector<Pack> x_, y_;
};

}  // namespace delf::testing

// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/SparseCore>
#include <cstdint>
#include <functional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "schemes/complex/complex_system.hpp"

namespace delf {

/// Some equations of a complex. What is proved linear is a sparse matrix,
///
///     E = r(0) + A y + Σ nonlinear stencils.
///
/// y is of the nodes that the stencils read, and columns of A are their places there. Only for sources of this
/// folder, which are compiled alike: it has matrices of Eigen.
class AssembledEquations {
 public:
  using Matrix = Eigen::SparseMatrix<double>;
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  using Vector = Eigen::VectorXd;
  using Number = std::function<int(std::size_t node)>;  ///< of an equation or an unknown; −1 for none

  /// Equations and unknowns have the numbers 0 … count − 1; `stencils` are those that touch the equations.
  AssembledEquations(const ComplexSystem&, std::vector<std::int32_t> stencils, int count, const Number& equation,
                     const Number& unknown);

  /// Those that the stencils read, ascending.
  const std::vector<std::size_t>& nodes() const { return nodes_; }
  std::int32_t place_of(std::size_t node) const;
  /// Their values.
  void read(std::span<const double> all, Vector& y) const {
    y.resize(static_cast<Eigen::Index>(nodes_.size()));
    for (std::size_t n = 0; n < nodes_.size(); ++n) y[static_cast<Eigen::Index>(n)] = all[nodes_[n]];
  }

  /// No derivative by an unknown varies: with data given, the equations are linear.
  bool is_direct() const { return direct_; }
  std::size_t bytes() const;

  /// What does not depend on y, and A.
  const Vector& at_zero() const { return at_zero_; }
  const Rows& matrix() const { return matrix_; }
  /// ∂E/∂(unknowns) as far as it is constant; all of it if the equations are direct.
  const Matrix& of_unknowns() const { return of_unknowns_; }
  void add_nonlinear(const Vector& y, Vector& E) const {
    each(nonlinear_, y, [&](std::size_t i, double r) { E[nonlinear_.rows[i]] += r; });
  }
  Vector residual(const Vector& y) const;
  /// use(equation, unknown, ∂E/∂y) of nonlinear stencils.
  template <class Use>
  void each_varying(const Vector& y, const Use& use) const {
    each(nonlinear_, y, [&](std::size_t i, std::size_t m, double value) {
      if (nonlinear_.columns[m] >= 0) use(nonlinear_.rows[i], nonlinear_.columns[m], value);
    });
  }
  /// Σ_j |∂E_i/∂y_j y_j|
  Vector absolute(const Vector& y) const;

 private:
  /// Stencils, and of each value its place in y, and the equation and the unknown that it belongs to, or −1.
  struct Stencils {
    std::vector<std::int32_t> list, places;
    std::vector<int> rows, columns;
  };
  void assemble();

  /// use(value, r), or use(value, value, ∂r/∂y), for values with an equation; values are numbers in `rows`. Derivatives that
  /// are 0 at this y and need not be at others are among them: a matrix has one pattern at every y.
  template <class Use>
  void each(const Stencils& stencils, const Vector& y, const Use& use) const {
    constexpr std::size_t most = ComplexSystem::most;
    constexpr bool of_residual = std::is_invocable_v<Use, std::size_t, double>;
    std::size_t begin = 0;  // of the batch, in values of stencils
    const auto visit = [&](ComplexSystem::Stencils batch, const double* out) {
      const ComplexSystem::Family& family = system_.family_of(batch[0]);
      const std::size_t size = family.size();
      for (std::size_t s = 0; s < batch.size(); ++s)
        for (std::size_t i = 0; i < size; ++i) {
          const std::size_t value = begin + s * size + i;
          if (stencils.rows[value] < 0) continue;
          if constexpr (of_residual) use(value, out[i * most + s]);
          else
            for (std::size_t m = 0; m < size; ++m)
              if (const double entry = out[(i * size + m) * most + s];
                  entry != 0 || family.is_varying(static_cast<int>(i), static_cast<int>(m)))
                use(value, begin + s * size + m, entry);
        }
      begin += batch.size() * size;
    };
    const std::span<const double> here{y.data(), nodes_.size()};
    if constexpr (of_residual) system_.each_residual(stencils.list, here, visit, {stencils.places});
    else system_.each_jacobian(stencils.list, here, visit, {stencils.places});
  }

  const ComplexSystem& system_;
  int count_;
  bool direct_ = true;
  std::vector<std::size_t> nodes_;
  Stencils linear_, nonlinear_;  ///< the linear ones until they are assembled
  Vector at_zero_;
  Rows matrix_;
  Matrix of_unknowns_;
};

}  // namespace delf

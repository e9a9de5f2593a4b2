// SPDX-License-Identifier: MIT
#include "schemes/solvers/linear_solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/solvers/circulant_solver.hpp"
#include "schemes/solvers/cyclic_band_lu.hpp"
#include "schemes/solvers/sparse_lu.hpp"

namespace delf {
namespace {

/// Division by the diagonal.
class DiagonalSolver final : public LinearSolver {
 public:
  DiagonalSolver(const RowLayout& layout, int d, const std::vector<double>& diagonal)
      : layout_(&layout), inverse_(layout, d), d_(d) {
    std::vector<double> sites(layout.sites());
    for (int a = 0; a < d; ++a) {
      for (std::size_t i = 0; i < sites.size(); ++i) sites[i] = 1 / diagonal[i * delf::at(d) + delf::at(a)];
      layout.scatter(sites, inverse_.row(a));
    }
  }
  void solve(double* const* w) const override {
    for (int a = 0; a < d_; ++a)
      for (int v = 0; v < layout_->packs(); ++v) {
        const auto at = layout_->at(v);
        (Pack::load(w[a] + at) * Pack::load(inverse_.row(a) + at)).store(w[a] + at);
      }
  }
  std::size_t bytes() const override { return inverse_.bytes(); }
  std::string name() const override { return "division by a diagonal"; }

 private:
  const RowLayout* layout_;
  RowBuffer inverse_;
  int d_;
};

/// Division by one number: by the right side's scale.
class ScalarSolver final : public LinearSolver {
 public:
  ScalarSolver(const RowLayout& layout, double diagonal) : layout_(&layout), inverse_(1 / diagonal) {}
  void solve(double* const*) const override {}
  std::unique_ptr<Sweeps> sweeps(int) const override { return std::make_unique<Through>(*layout_); }
  double right_side_scale(int) const override { return inverse_; }
  std::size_t bytes() const override { return 0; }
  std::string name() const override { return "division by one number"; }

 private:
  class Through final : public Sweeps {
   public:
    explicit Through(const RowLayout& layout) : layout_(layout) {}
    void begin(double*) override { done_ = ready_ = 0; }
    void forward(double*, int end) override { ready_ = end; }
    void forward(const RowSum& sum, const double* const* rows, double* w, int end) override {
      sum.evaluate(rows, layout_.at(ready_), layout_.at(end), lanes, w);
      ready_ = end;
    }
    PackRange ready() const override { return {done_, ready_}; }
    void backward(const double* w, RowUpdate& update) override {
      for (std::ptrdiff_t at = layout_.at(done_); at < layout_.at(ready_); at += lanes) update(at, Pack::load(w + at));
      done_ = ready_;
    }

   private:
    const RowLayout& layout_;
    int done_ = 0, ready_ = 0;
  };
  const RowLayout* layout_;
  double inverse_;
};

/// Solvers that work on the sites in their order go through a scratch vector.
template <class Factored>
class OrderedSolver final : public LinearSolver {
 public:
  OrderedSolver(const RowLayout& layout, int d, Factored factored, std::string name)
      : layout_(&layout),
        d_(d),
        factored_(std::move(factored)),
        name_(std::move(name)),
        site_(delf::at(layout.sites())),
        all_(site_.size() * delf::at(d)) {}
  void solve(double* const* w) const override {
    const std::size_t d = d_;
    for (std::size_t a = 0; a < d; ++a) {
      layout_->gather(w[a], d == 1 ? all_ : site_);
      if (d > 1)
        for (std::size_t i = 0; i < site_.size(); ++i) all_[i * d + a] = site_[i];
    }
    factored_.solve(all_);
    for (std::size_t a = 0; a < d; ++a) {
      if (d > 1)
        for (std::size_t i = 0; i < site_.size(); ++i) site_[i] = all_[i * d + a];
      const std::vector<double>& values = d == 1 ? all_ : site_;
      for (int l = 0; l < lanes; ++l)
        for (int v = 0; v < layout_->packs(); ++v) w[a][layout_->at(v) + l] = values[layout_->start(l) + v];
    }
  }
  std::size_t bytes() const override { return factored_.bytes() + (site_.size() + all_.size()) * sizeof(double); }
  std::string name() const override { return name_; }

 private:
  const RowLayout* layout_;
  int d_;
  Factored factored_;
  std::string name_;
  mutable std::vector<double> site_, all_;
};

struct SparseFactors {
  std::unique_ptr<SparseLU> lu;
  void solve(std::vector<double>& x) const {
    Eigen::Map<Eigen::VectorXd> vector(x.data(), static_cast<Eigen::Index>(x.size()));
    vector = lu->solve(Eigen::VectorXd(vector));
  }
  std::size_t bytes() const { return delf::at(lu->nnzL() + lu->nnzU()) * (sizeof(double) + sizeof(int)); }
};

/// Components that do not meet.
class ByComponent final : public LinearSolver {
 public:
  explicit ByComponent(std::vector<std::unique_ptr<LinearSolver>> solvers) : solvers_(std::move(solvers)) {}
  void solve(double* const* w) const override {
    for (std::size_t a = 0; a < solvers_.size(); ++a) solvers_[a]->solve(w + a);
  }
  std::unique_ptr<Sweeps> sweeps(int a) const override { return solvers_[a]->sweeps(0); }
  double right_side_scale(int a) const override { return solvers_[a]->right_side_scale(0); }
  std::size_t bytes() const override {
    std::size_t total = 0;
    for (const auto& s : solvers_) total += s->bytes();
    return total;
  }
  std::string name() const override { return solvers_[0]->name() + ", component by component"; }

 private:
  std::vector<std::unique_ptr<LinearSolver>> solvers_;
};

}  // namespace

std::unique_ptr<LinearSolver> by_component(std::vector<std::unique_ptr<LinearSolver>> solvers) {
  if (solvers.size() == 1) return std::move(solvers[0]);
  return std::make_unique<ByComponent>(std::move(solvers));
}

std::unique_ptr<LinearSolver> factor(const Lattice& lattice, const RowLayout& layout, int d,
                                     const std::vector<MatrixEntry>& entries) {
  const int size = lattice.sites() * d;
  const Bandwidth band = bandwidth(lattice, size, entries);
  if (band.lower == 0 && band.upper == 0) {
    std::vector<double> diagonal(size, 0.0);
    for (const auto& e : entries) diagonal[e.row] += e.value;
    if (std::ranges::any_of(diagonal, [](double x) { return x == 0 || !std::isfinite(x); }))
      throw NoConvergence("the constant part of the equations is singular");
    return std::make_unique<DiagonalSolver>(layout, d, diagonal);
  }
  if (auto lu = CyclicBandLU::factor(size, band, lattice.is_circle(), entries))
    return std::make_unique<OrderedSolver<CyclicBandLU>>(
        layout, d, std::move(*lu),
        "LU of a " + std::string(lattice.is_circle() ? "cyclic " : "") + "band of width " + std::to_string(band.lower) +
            "+" + std::to_string(band.upper));
  std::vector<Eigen::Triplet<double>> triplets;
  for (const auto& e : entries) triplets.emplace_back(e.row, e.column, e.value);
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  auto lu = std::make_unique<SparseLU>();
  if (!factor(*lu, matrix)) throw NoConvergence("the constant part of the equations is singular");
  return std::make_unique<OrderedSolver<SparseFactors>>(layout, d, SparseFactors{std::move(lu)}, "sparse LU");
}

std::unique_ptr<LinearSolver> factor_uniform(const Lattice& lattice, const RowLayout& layout,
                                             std::span<const BandEntry> stencil) {
  double centre = 0, left = 0, right = 0;
  int reach = 0;
  for (const BandEntry& e : stencil) {
    reach = std::max(reach, std::abs(e.offset));
    (e.offset == 0 ? centre : e.offset < 0 ? left : right) += e.value;
  }
  if (reach == 0 && centre != 0) return std::make_unique<ScalarSolver>(layout, centre);
  const bool symmetric = std::abs(left - right) <= 1e-14 * std::abs(centre);
  // Two arcs must not start at the same site, and each recurrence must decay.
  if (reach == 1 && symmetric && lattice.sites() >= 2 * lanes && std::abs(centre) > 2 * std::abs(left) * (1 + 1e-12))
    return std::make_unique<CirculantSolver>(layout, centre, left);
  std::vector<MatrixEntry> entries;
  for (int i = 0; i < lattice.sites(); ++i)
    for (const BandEntry& e : stencil) entries.push_back({i, lattice.wrapped(i + e.offset), e.value});
  return factor(lattice, layout, 1, entries);
}

}  // namespace delf

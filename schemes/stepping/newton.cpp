// SPDX-License-Identifier: MIT
#include "schemes/stepping/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/solvers/newton.hpp"
#include "schemes/solvers/sparse_lu.hpp"
#include "schemes/stepping/slab_solver.hpp"
#include "schemes/system/driven_values.hpp"

namespace delf {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

double largest(const Vector& v) { return v.size() ? v.lpNorm<Eigen::Infinity>() : 0; }

Vector as_vector(const std::vector<double>& row) {
  return Eigen::Map<const Vector>(row.data(), static_cast<Eigen::Index>(row.size()));
}
std::vector<double> as_row(const Vector& v) { return {v.data(), v.data() + v.size()}; }
int parity_of(const SolvePlan& plan, std::int64_t J) { return static_cast<int>(J & (plan.table.parities - 1)); }

/// The equations of slab J as a function of its unknowns, followed in the step s·h from s = 0 to 1. The unknowns are row J
/// as a whole, or a list of values where a slab has unknowns in several rows.
class SlabProblem {
 public:
  /// The rows that the equations read, made from the unknowns: those of the past move with s, or with row J.
  using MakeRows = std::function<void(double s, const Vector& y, SectionRing&)>;

  SlabProblem(const LatticeSystem& system, Assembly::Parts parts, std::int64_t J, MakeRows make)
      : h_(system.times()->step(J - 1)),
        J_(J),
        ring_(parts.past + parts.future + 1, delf::at(system.lattice().sites()) * delf::at(system.components())),
        equations_(system, std::move(parts)),
        make_(std::move(make)) {
    for (int n = 0; n < equations_.size(); ++n) places_.push_back(equations_.place(equations_.unknown(n)));
  }

  /// y[n] is unknown n; stencils without an unknown give `known`, whatever the step. Multipliers are not asked whether they
  /// have converged: they have no scale of their own.
  void list_unknowns(const LatticeSystem& system, const SlabPast& past) {
    known_ = past.known, momenta_ = past.momenta;
    for (int n = 0; n < equations_.size(); ++n) {
      places_[n] = n;
      asked_.push_back(system.component(equations_.unknown(n).component).role != Role::multiplier);
    }
  }

  void set(double s) { equations_.set_time_step(s * h_), s_ = s; }
  const Assembly& equations() const { return equations_; }

  /// ∂E/∂y
  const std::vector<double>& jacobian(const Vector& y) {
    make_(s_, y, ring_);
    equations_.jacobian(ring_, J_, values_, momenta_);
    return values_;
  }
  const std::vector<double>& residual(const Vector& y) {
    make_(s_, y, ring_);
    if (known_.empty() || momenta_) equations_.residual(ring_, J_, E_, nullptr, momenta_);
    else equations_.residual_from(known_, ring_, J_, E_);
    E_.resize(equations_.size());
    return E_;
  }
  /// y + by; a fixed wall keeps its value.
  Vector moved(Vector y, const Vector& by) const {
    for (const int place : places_) y[place] += by[place];
    return y;
  }
  /// y −= change
  void take(Vector& y, std::span<const double> change) const {
    for (std::size_t n = 0; n < places_.size(); ++n) y[places_[n]] -= change[n];
  }
  /// max |y|, multipliers apart.
  double size(const Vector& y) const {
    if (asked_.empty()) return largest(y);
    double most = 0;
    for (std::size_t n = 0; n < asked_.size(); ++n)
      if (asked_[n] != 0) most = std::max(most, std::abs(y[static_cast<Eigen::Index>(n)]));
    return most;
  }

 private:
  double h_, s_ = 1;
  std::int64_t J_;
  SectionRing ring_;
  Assembly equations_;
  MakeRows make_;
  std::vector<int> places_;  ///< of the unknowns in y
  std::vector<char> asked_;
  std::vector<double> known_, values_, E_;
  const std::vector<double>* momenta_ = nullptr;
};

struct Root {
  bool converged = false;
  int iterations = 0;
  Vector y;
  int sign = 0;        ///< of the determinant there
  double reached = 0;  ///< the part of the step that the root was followed to
};

/// The equations at y, with the Jacobian of each y.
struct EveryJacobian {
  SlabProblem& problem;
  Vector y;
  bool keeps_sign = true;  ///< where the determinant changes its sign from one y to the next it counts as singular
  int sign = 0;
  SparseLU lu = {};

  bool linearise(const NewtonProgress& at) {
    const Assembly& equations = problem.equations();
    const std::vector<double>& values = problem.jacobian(y);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t n = 0; n < values.size(); ++n)
      if (values[n] != 0)
        entries.emplace_back(equations.places()[n].equation, equations.places()[n].unknown, values[n]);
    Matrix J(equations.size(), equations.size());
    J.setFromTriplets(entries.begin(), entries.end());
    if (!factor(lu, J)) return false;
    const int before = std::exchange(sign, static_cast<int>(lu.signDeterminant()));
    return !keeps_sign || at.iteration == 1 || sign == before;
  }
  const std::vector<double>& residual() { return problem.residual(y); }
  std::vector<double> solve(const std::vector<double>& E) const { return as_row(lu.solve(as_vector(E))); }
  void apply(const std::vector<double>& change, NewtonProgress& at) {
    at.finite = std::ranges::all_of(change, [](double x) { return std::isfinite(x); });
    problem.take(y, change);
    at.take(problem.size(as_vector(change)), problem.size(y));
  }
};
/// Newton's method with the Jacobian where the iteration begins.
struct FirstJacobian : EveryJacobian {
  std::optional<BlockSolver> solver = {};

  bool linearise(const NewtonProgress& at) {
    if (at.iteration > 1) return true;
    const std::vector<double>& values = problem.jacobian(y);
    std::vector<char> present;
    for (const double value : values) present.push_back(value != 0);
    solver.emplace(solver_of(problem.equations(), present));
    return solver->factor(values);
  }
  std::vector<double> solve(const std::vector<double>& E) const {
    std::vector<double> change;
    solver->solve(E, change);
    return change;
  }
};

/// Each correction is at most a `share` of the one before: then Newton's method goes to no other root than the nearest.
template <class Equations>
Root tame_root(Equations equations, double absolute_tolerance, int max_iterations, double share) {
  NewtonProgress at;
  const Stop stop = newton(equations, at, Overflows{}, Converged{.absolute = absolute_tolerance}, Rounding{},
                           Stalls{share}, OutOfIterations{max_iterations});
  return {has_root(stop), at.iteration, std::move(equations.y), equations.sign};
}

/// Newton's method, with one Jacobian where that is enough.
Root at_once(SlabProblem& problem, const Vector& predicted, double absolute_tolerance, int max_iterations) {
  const Root quick = tame_root(FirstJacobian{{problem, predicted}}, absolute_tolerance, max_iterations, 0.1);
  if (quick.converged) return quick;
  Root direct = tame_root(EveryJacobian{problem, predicted}, absolute_tolerance, max_iterations, 0.5);
  direct.iterations += quick.iterations;
  return direct;
}

constexpr double next_to_nothing = 1. / 65536;  ///< of a step
/// The root of a step of next to nothing, which need not be where it was predicted.
Root at_beginning(SlabProblem& problem, Vector predicted, double absolute_tolerance, int max_iterations) {
  problem.set(next_to_nothing);
  return tame_root(EveryJacobian{problem, std::move(predicted)}, absolute_tolerance,
                   std::min(max_iterations, enough_iterations), 0.5);
}

/// Follows the root of the problem from s near 0 to s = 1. A stride is taken once and in two halves: both ways must
/// be tame and end at the same root, because Newton's method may by accident arrive quickly at a root that is far
/// away. Stops where the determinant changes sign, because there two roots meet. Where the root does not begin at its
/// prediction (`from_root`) the first one is found alone, with a step of next to nothing.
Root follow(SlabProblem& problem, const std::function<Vector(double)>& predict, double absolute_tolerance,
            int max_iterations, bool from_root = false) {
  constexpr double first = 1. / 16, largest_stride = 1. / 8, least_stride = next_to_nothing, share = 1. / 8;
  double s = 0, stride = first;
  Root at;
  Vector offset = 0 * predict(0);  // of the root from its prediction
  int iterations = 0, sign = 0;
  const auto root_at = [&](double where, const Vector& off) {
    problem.set(where);
    Root found = tame_root(EveryJacobian{problem, predict(where) + off}, absolute_tolerance,
                           std::min(max_iterations, enough_iterations), share);
    iterations += found.iterations;
    found.converged = found.converged && (sign == 0 || found.sign == sign);
    return found;
  };
  if (from_root) {
    at = at_beginning(problem, predict(s = next_to_nothing), absolute_tolerance, max_iterations);
    iterations = at.iterations;
    if (!at.converged) s = 1;
    else sign = at.sign, offset = at.y - predict(s);
  }
  while (s < 1) {
    const double next = std::min(1.0, s + stride), middle = (s + next) / 2;
    Root once = root_at(next, offset);
    bool same = false;
    if (once.converged)
      if (const Root half = root_at(middle, offset); half.converged)
        if (const Root twice = root_at(next, half.y - predict(middle)); twice.converged)
          same = problem.size(twice.y - once.y) <= 1e-6 * (1e-300 + problem.size(once.y)) + 4 * absolute_tolerance &&
                 half.sign == once.sign;
    if (!same) {
      stride /= 2;
      if (stride < least_stride) {
        at.converged = false;
        break;
      }
      continue;
    }
    sign = once.sign;
    s = next;
    offset = once.y - predict(s);
    at = std::move(once);
    stride = std::min(2 * stride, largest_stride);
  }
  at.iterations = iterations;
  at.reached = at.converged || s < 1 ? s : 0;
  return at;
}

NewtonResult as_result(const Root& found, int iterations) {
  NewtonResult result{found.converged, iterations, found.reached, {}};
  if (found.converged) result.row = as_row(found.y);
  return result;
}

}  // namespace

std::string remedy_for(int max_iterations) {
  return max_iterations < enough_iterations
             ? fmt::format("scheme.max_iterations = {} leaves it too few: raise it", max_iterations)
             : "reduce lattice.courant or lattice.time_step";
}

NewtonResult solve_slab(const LatticeSystem& system, const SolvePlan& plan, const Window& past, double tolerance,
                        int max_iterations, bool followed) {
  const std::int64_t J = past.last_row() + 1;
  const int rows = static_cast<int>(past.rows.size());
  const Vector newest = as_vector(past.rows.back());
  const Vector increment = newest - as_vector(past.rows[past.rows.size() - 2]);
  // A step of s·h has the rows before the newest as far away as the same velocities put them.
  SlabProblem problem(system, Assembly::slab(plan, parity_of(plan, J), rows, 0, past.monodromy), J,
                      [&](double s, const Vector& y, SectionRing& ring) {
                        for (int r = 0; r < rows; ++r) {
                          const auto& row = past.rows[r];
                          double* const to = ring.row(past.first_row + r);
                          for (std::size_t i = 0; i < row.size(); ++i)
                            to[i] = past.rows.back()[i] - s * (past.rows.back()[i] - row[i]);
                        }
                        std::copy(y.begin(), y.end(), ring.row(J));
                      });
  const auto predict = [&](double s) { return problem.moved(newest, s * increment); };
  const double absolute = tolerance * std::max(largest(newest), largest(predict(1)));
  const Root found = followed ? follow(problem, predict, absolute, max_iterations)
                              : at_once(problem, predict(1), absolute, max_iterations);
  return as_result(found, found.iterations);
}

namespace {

/// A slab from a step of next to nothing to its own: the problem, and where its unknowns go if they go on as before.
class SlabPath {
 public:
  SlabPath(const LatticeSystem& system, const SlabPast& past)
      : past_(past),
        components_(system.components()),
        unknowns_(past.parts.unknowns),
        base_(Vector::Zero(static_cast<Eigen::Index>(unknowns_.size()))),
        way_(base_) {
    find_way(system);
    problem_.emplace(system, past.parts, past.J,
                     [this](double s, const Vector& y, SectionRing& ring) { make_rows(s, y, ring); });
    problem_->list_unknowns(system, past);
    deep_ = system.height() > 1;
  }
  SlabPath(const SlabPath&) = delete;
  SlabPath& operator=(const SlabPath&) = delete;

  SlabProblem& problem() { return *problem_; }
  Vector predict(double s) const { return base_ + s * way_; }
  double size() const { return std::max(problem_->size(base_), problem_->size(predict(1))); }

 private:
  /// Fields begin at the newest row, and go on as in the step before.
  void find_way(const LatticeSystem& system) {
    const RowTimes& times = *system.times();
    const bool traces = std::ranges::count(system.all_components(), Role::trace, &Component::role) > 0;
    last_.assign(components_, past_.J - 1);
    is_field_.resize(last_.size());
    for (int c = 0; c < components_; ++c) is_field_[c] = system.component(c).role == Role::field;
    for (const Node& unknown : unknowns_) last_[unknown.component] = past_.J + unknown.site.time - 1;
    for (std::size_t n = 0; n < unknowns_.size(); ++n) {
      const Node& unknown = unknowns_[n];
      const Component& c = system.component(unknown.component);
      const std::int64_t row = past_.J + unknown.site.time;
      double &base = base_[static_cast<Eigen::Index>(n)], &way = way_[static_cast<Eigen::Index>(n)];
      if (c.role == Role::multiplier || c.role == Role::slaved) {
        base = value(row, unknown.site.space, unknown.component);
        continue;
      }
      const int field = system.field_component(c.field), site = unknown.site.space;
      const std::int64_t last = last_[field];
      base = value(last, site, field);
      if (last < 1) continue;
      const double before = value(last - 1, site, field), stride = times.step(last) / times.step(last - 1);
      way = stride * (base - before) * (row > last ? 1 : c.at.time);
      if (c.role == Role::field) continue;
      // Traces, and nodes between them, alternate about the vertices from slab to slab, however small the step.
      if (traces && past_.slabs > 2)
        base += value(row - 2, site, unknown.component) - value(row - 2, site, field) - (row > last ? 0 : way);
      else if (!traces && past_.slabs > 0) way = stride * (value(row - 1, site, unknown.component) - before);
    }
  }
  double value(std::int64_t row, int site, int component) const {
    return past_.rows.row(row)[site * components_ + component];
  }

  /// Stencils that reach further than one row see the rows before as far away as the same velocities put them.
  void make_rows(double s, const Vector& y, SectionRing& ring) {
    const std::size_t row_size = past_.rows.view().row_size();
    for (std::int64_t r = past_.J - past_.parts.past; r <= past_.J + past_.parts.future && !copied_; ++r)
      std::copy_n(past_.rows.row(r), row_size, ring.row(r));
    copied_ = true;
    for (std::size_t at = 0; at < row_size && deep_; ++at) {
      const std::size_t c = at % last_.size();
      const double newest = past_.rows.row(last_[c])[at];
      for (std::int64_t r = past_.J - past_.parts.past; r < last_[c] && is_field_[c] != 0; ++r)
        ring.row(r)[at] = newest - s * (newest - past_.rows.row(r)[at]);
    }
    for (std::size_t n = 0; n < unknowns_.size(); ++n)
      ring.row(past_.J + unknowns_[n].site.time)[unknowns_[n].site.space * components_ + unknowns_[n].component] =
          y[static_cast<Eigen::Index>(n)];
  }

  const SlabPast& past_;
  int components_;
  std::vector<Node> unknowns_;
  Vector base_, way_;
  std::vector<std::int64_t> last_;  ///< of each component: the newest row of it that is known
  std::vector<char> is_field_;
  bool deep_ = false, copied_ = false;
  std::optional<SlabProblem> problem_;
};

}  // namespace

NewtonResult follow_slab(const LatticeSystem& system, const SlabPast& past, double tolerance, int max_iterations) {
  SlabPath path(system, past);
  const Root followed = follow(
      path.problem(), [&](double s) { return path.predict(s); }, tolerance * path.size(), max_iterations, true);
  return as_result(followed, followed.iterations);
}

bool turns_back(const LatticeSystem& system, const SlabPast& past, const std::vector<double>& unknowns,
                double tolerance) {
  SlabPath path(system, past);
  const double absolute = tolerance * path.size();
  const Root first = at_beginning(path.problem(), path.predict(next_to_nothing), absolute, enough_iterations);
  path.problem().set(1);
  const Root last = tame_root(EveryJacobian{.problem = path.problem(), .y = as_vector(unknowns), .keeps_sign = false},
                              absolute, enough_iterations, NewtonProgress::unknown);
  return first.converged && last.converged && first.sign != last.sign;
}

NewtonResult solve_centred_start(const LatticeSystem& system, const SolvePlan& plan, const Window& row0,
                                 const std::vector<double>& velocity, bool followed, double tolerance,
                                 int max_iterations) {
  const Vector y0 = as_vector(row0.rows.back()), phi_t = as_vector(velocity);
  const double h = system.time_step();
  // Row −1 moves with row 1: its values are the same unknowns.
  Assembly::Parts parts = Assembly::slab(plan, parity_of(plan, 1), 2, 0, row0.monodromy);
  for (const Node& unknown : std::vector<Node>(parts.unknowns))
    parts.unknowns.push_back({unknown.site - Site{2, 0}, unknown.component});
  parts.copies = 2;
  const DrivenValues driven(system);
  SlabProblem problem(system, std::move(parts), 1, [&](double s, const Vector& y1, SectionRing& ring) {
    Eigen::Map<Vector>(ring.row(-1), y1.size()) = y1 - 2 * s * h * phi_t;
    std::copy(y0.begin(), y0.end(), ring.row(0));
    std::copy(y1.begin(), y1.end(), ring.row(1));
    for (const int row : {-1, 1}) driven.put_into(row, {ring.row(row), delf::at(y1.size())});
  });
  const auto predict = [&](double s) {
    Vector y1 = problem.moved(y0, s * h * phi_t);
    driven.put_into(1, {y1.data(), delf::at(y1.size())});
    return y1;
  };
  const double absolute = tolerance * std::max(largest(y0), largest(predict(1)));
  int iterations = 0;
  if (!followed) {
    const Root found = at_once(problem, predict(1), absolute, max_iterations);
    iterations = found.iterations;
    if (found.converged) return as_result(found, iterations);
  }
  const Root root = follow(problem, predict, absolute, max_iterations);
  if (!root.converged)
    throw NoConvergence(
        "the starting row of initial.start = centred was not found: Newton's method did not converge; " +
        remedy_for(max_iterations));
  return as_result(root, iterations + root.iterations);
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/solvers/circulant_solver.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace delf {

namespace {

/// The smallest effect that counts: what enters an arc is felt while q^i of it exceeds a fifth of what rounding leaves.
constexpr double smallest_felt = 1e-17;

}  // namespace

CirculantSolver::CirculantSolver(const RowLayout& layout, double centre, double side) : layout_(&layout) {
  // b = c(1 + q²), a = −cq: the root inside the unit circle, in the form that does not cancel (the other root
  // formula costs two digits).
  const double ratio = -side / centre;
  q_ = 2 * ratio / (1 + std::sqrt(1 - 4 * ratio * ratio));
  scale_ = (1 + q_ * q_) / centre;
  double power = q_;
  for (int v = 0; v < layout.packs() && std::abs(power) > smallest_felt; ++v, power *= q_) forward_.push_back(power);
  for (int l = 0; l < lanes; ++l) {
    const int before = (l + lanes - 1) % lanes;
    gap_[l] = layout.start(l) + (l == 0 ? layout.sites() : 0) - layout.start(before) - 1;
    ends_[l] = layout.at(gap_[l]) + before;
  }
  // Arcs overlap by at most two sites or so: the index that the arc before needs is small.
  const int deepest = layout.packs() - 1 - *std::ranges::min_element(gap_);
  near_ = std::min(layout.packs(), static_cast<int>(forward_.size()) + deepest);
  while (static_cast<int>(forward_.size()) < near_) forward_.push_back(0);
  build_closure();
}

/// The closure of the arcs: e_l is what the recurrence from nothing leaves at the site before arc l, U_l the true value
/// there; s_l what it leaves of x at the site after arc l, found in arc m = l + 1 at the index j_m, X_l the true value:
///
///     U_l = e_l + q^(gap_l + 1) U_{l−1}
///     X_l = s_m + K_m U_m + q^(M − j_m) X_m,      K_m = Σ_{i ≥ j_m} q^(i − j_m) q^(i + 1)
void CirculantSolver::build_closure() {
  const int M = layout_->packs();
  using Square = Eigen::Matrix<double, lanes, lanes>;
  Square U = Square::Identity(), X = Square::Identity(), next = Square::Zero(), K = Square::Zero();
  backward_ = RowBuffer(*layout_, 1);
  for (int l = 0; l < lanes; ++l) {
    const int before = (l + lanes - 1) % lanes, j = M - 1 - gap_[l];
    U(l, before) -= std::pow(q_, gap_[l] + 1);
    X(before, l) -= std::pow(q_, M - j);
    next(before, l) = 1;
    double power = 1;
    for (int v = j; v < near_; ++v, power *= q_) {
      backward_.row(0)[layout_->at(v) + l] = power;
      K(l, l) += power * forward_[v];
    }
  }
  const Square from_ends = U.inverse(), from_sums = X.inverse() * next, both = from_sums * K * from_ends;
  for (int m = 0; m < lanes; ++m)
    for (int l = 0; l < lanes; ++l) {
      const std::size_t at = m;
      u_from_ends_[at].v[l] = from_ends(l, m);
      x_from_sums_[at].v[l] = from_sums(l, m);
      x_from_ends_[at].v[l] = both(l, m);
    }
}

namespace {

/// u_i = r_i + q u_{i−1} of right sides as they are formed.
struct Recurrence {
  double q;
  double* u;
  Pack last;
  [[gnu::always_inline]] void operator()(std::ptrdiff_t at, Pack r) { (last = r + q * last).store(u + at); }
};

}  // namespace

/// u_i = r_i + q u_{i−1}, r a sum of rows, or in place; returns the last u.
Pack CirculantSolver::run_forward(const RowSum* sum, const double* const* rows, double* u, int first, int last,
                                  Pack before) const {
  Recurrence sink{q_, u, before};
  const std::ptrdiff_t begin = layout_->at(first), end = layout_->at(last);
  if (sum) sum->pass<lanes>(rows, begin, end, sink);
  else
    for (std::ptrdiff_t at = begin; at < end; at += lanes) sink(at, Pack::load(u + at));
  return sink.last;
}

/// sink(at, x_i) with x_i = (u_i + q^(i+1) U) + q x_{i+1}, U what enters the arcs, felt in the first `near` packs; returns
/// the first x. Four at once: they wait for the one after them alone.
template <class Sink>
Pack CirculantSolver::run_backward(const double* u, int first, int last, Pack after, Pack entering_u,
                                   Sink& given) const {
  auto sink = given;
  const double q = q_, q2 = q * q, q3 = q * q2, q4 = q2 * q2;
  const auto four = [&](std::ptrdiff_t at, Pack r1, Pack r2, Pack r3, Pack r4) {
    const Pack s1 = r1, s2 = r2 + q * s1, s3 = r3 + q * s2, s4 = r4 + q * s3, before = after;
    after = s4 + q4 * before;
    sink(at, s1 + q * before), sink(at - lanes, s2 + q2 * before), sink(at - 2 * lanes, s3 + q3 * before);
    sink(at - 3 * lanes, after);
  };
  const auto load = [u](std::ptrdiff_t at) { return Pack::load(u + at); };
  const std::ptrdiff_t begin = layout_->at(first), far = layout_->at(std::max(first, near_));
  std::ptrdiff_t at = layout_->at(last - 1);
  for (; at - 3 * lanes >= far; at -= 4 * lanes)
    four(at, load(at), load(at - lanes), load(at - 2 * lanes), load(at - 3 * lanes));
  for (; at >= far; at -= lanes) sink(at, after = load(at) + q * after);
  const double* power = forward_.data() + (at - layout_->at(0)) / lanes;
  for (; at - 3 * lanes >= begin; at -= 4 * lanes, power -= 4)
    four(at, load(at) + power[0] * entering_u, load(at - lanes) + power[-1] * entering_u,
         load(at - 2 * lanes) + power[-2] * entering_u, load(at - 3 * lanes) + power[-3] * entering_u);
  for (; at >= begin; at -= lanes, --power) sink(at, after = (load(at) + *power * entering_u) + q * after);
  if constexpr (!std::is_const_v<Sink>) given = sink;
  return after;
}

/// Σ weight · u over the first packs.
Pack CirculantSolver::sum_of_first(const double* u) const {
  Pack part[4] = {0.0, 0.0, 0.0, 0.0};  // a sum waits for itself
  const double *weights = backward_.row(0) + layout_->at(0), *at = u + layout_->at(0);
  int v = 0;
  for (; v + 4 <= near_; v += 4, weights += 4 * lanes, at += 4 * lanes)
    for (int p = 0; p < 4; ++p) part[p] += Pack::load(weights + p * lanes) * Pack::load(at + p * lanes);
  for (; v < near_; ++v, weights += lanes, at += lanes) part[0] += Pack::load(weights) * Pack::load(at);
  return (part[0] + part[1]) + (part[2] + part[3]);
}

CirculantSolver::Entering CirculantSolver::entering(const double* u, Pack sums) const {
  // Two sums of each: a sum waits for itself.
  Entering part[2] = {{Pack(0.0), Pack(0.0)}, {Pack(0.0), Pack(0.0)}};
  Pack x_by_ends[2] = {Pack(0.0), Pack(0.0)};
  for (int m = 0; m < lanes; ++m) {
    const std::size_t at = m;
    const Pack end(u[ends_[m]]);
    part[m % 2].u += u_from_ends_[at] * end;
    x_by_ends[m % 2] += x_from_ends_[at] * end;
    part[m % 2].x += x_from_sums_[at] * Pack(sums[m]);
  }
  return {part[0].u + part[1].u, (part[0].x + part[1].x) + (x_by_ends[0] + x_by_ends[1])};
}

void CirculantSolver::solve(double* const* w) const {
  double* const u = w[0];
  run_forward(nullptr, nullptr, u, 0, layout_->packs(), Pack(0.0));
  const Entering e = entering(u, sum_of_first(u));
  const auto store = [u](std::ptrdiff_t at, Pack x) { x.store(u + at); };
  run_backward(u, 0, layout_->packs(), e.x, e.u, store);
}

/// Both recurrences over the whole row, the second one from its end in strips.
class CirculantSolver::WholeRow final : public Sweeps {
 public:
  explicit WholeRow(const CirculantSolver& solver) : s_(solver), packs_(solver.layout_->packs()) {}
  int near() const override { return s_.near_; }
  bool takes_whole_rows() const override { return true; }
  void begin(double*, PackRange) override { ready_ = 0, last_ = Pack(0.0); }
  void forward(const RowSum* sum, const double* const* rows, double* u, int end) override {
    last_ = s_.run_forward(sum, rows, u, ready_, end, last_);
    if ((ready_ = end) < packs_) return;
    left_ = packs_;
    from_outside_ = s_.entering(u, s_.sum_of_first(u));
  }
  PackRange ready() const override {
    if (ready_ < packs_) return {0, 0};
    return {left_ < 2 * strip ? 0 : left_ - strip, left_};
  }
  void backward(const double* u, RowUpdate& update) override {
    const PackRange packs = ready();
    from_outside_.x = s_.run_backward(u, packs.first, packs.last, from_outside_.x, from_outside_.u, update);
    left_ = packs.first;
  }

 private:
  static constexpr int strip = 64;
  const CirculantSolver& s_;
  const int packs_;
  int ready_ = 0, left_ = 0;  ///< packs before left_ are still to be solved for
  Pack last_ = 0.0;
  Entering from_outside_;
};

/// The second recurrence follows the first one `near` packs behind.
class CirculantSolver::ByStrips final : public Sweeps {
 public:
  ByStrips(const CirculantSolver& solver, PackRange arc) : s_(solver), arc_(arc) {}
  int near() const override { return s_.near_; }
  void begin(double* u, PackRange before) override {
    last_ = s_.run_forward(nullptr, nullptr, u, before.first, before.last, Pack(0.0));
    if (arc_.first == 0) last_ = s_.layout_->before_first(u);
    ready_ = done_ = arc_.first;
  }
  Pack first(const double* u) const override {
    if (arc_.first == 0) return from_lane_above(s_.sum_of_first(u));
    return solution_at(u, arc_.first, arc_.first + s_.near_, Pack(0.0));
  }
  void end(Pack after) override { ready_ = arc_.last, after_ = after; }
  void forward(const RowSum* sum, const double* const* rows, double* u, int end) override {
    last_ = s_.run_forward(sum, rows, u, ready_, end, last_);
    ready_ = end;
  }
  PackRange ready() const override {
    return {done_, ready_ == arc_.last ? ready_ : std::max(done_, ready_ - s_.near_)};
  }
  void backward(const double* u, RowUpdate& update) override {
    const int end = ready().last;
    const Pack x = solution_at(u, end, ready_, ready_ == arc_.last ? after_ : Pack(0.0));
    s_.run_backward(u, done_, end, x, Pack(0.0), update);
    done_ = end;
  }

 private:
  Pack solution_at(const double* u, int first, int last, Pack x) const {
    for (int v = last - 1; v >= first; --v) x = Pack::load(u + s_.layout_->at(v)) + s_.q_ * x;
    return x;
  }

  const CirculantSolver& s_;
  const PackRange arc_;
  int ready_ = 0, done_ = 0;
  Pack last_ = 0.0, after_ = 0.0;
};

/// Returns sweeps by strips where arcs are long against the range in which their ends are felt.
std::unique_ptr<Sweeps> CirculantSolver::sweeps(int, PackRange arc) const {
  constexpr int long_row = 4096;
  if (layout_->packs() >= long_row && layout_->packs() >= 8 * near_ && layout_->finds_halos_by_packs())
    return std::make_unique<ByStrips>(*this, arc);
  return std::make_unique<WholeRow>(*this);
}

}  // namespace delf

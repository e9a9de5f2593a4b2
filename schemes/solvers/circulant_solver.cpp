// SPDX-License-Identifier: MIT
#include "schemes/solvers/circulant_solver.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace delf {

namespace {

/// What enters an arc is felt as long as q^i of it is more than a fifth of what rounding leaves.
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
  near_ = static_cast<int>(forward_.size());
  // Arcs overlap by at most two sites or so: the index that the arc before needs is small.
  const int deepest = layout.packs() - 1 - *std::ranges::min_element(gap_);
  near_ = std::min(layout.packs(), near_ + deepest);
  const int read_by_sums = (near_ + sums_at_once - 1) / sums_at_once * sums_at_once;
  are_far_apart_ = read_by_sums < layout.packs() && layout.finds_halos_by_packs();
  while (static_cast<int>(forward_.size()) < near_) forward_.push_back(0);
  build_closure();
}

/// With e_l what the recurrence from nothing leaves at the site before arc l, U_l the true value there; and with s_l what
/// it leaves of x at the site after arc l, found in arc m = l + 1 at the index j_m, X_l the true value:
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
      K(l, l) += power * forward_[static_cast<std::size_t>(v)];
    }
  }
  for (int l = 0; l < lanes; ++l) x_from_u_.v[l] = K(l, l);
  const Square from_ends = U.inverse(), from_sums = X.inverse() * next, both = from_sums * K * from_ends;
  for (int m = 0; m < lanes; ++m)
    for (int l = 0; l < lanes; ++l) {
      const auto at = static_cast<std::size_t>(m);
      u_from_ends_[at].v[l] = from_ends(l, m);
      x_from_sums_[at].v[l] = from_sums(l, m);
      x_from_ends_[at].v[l] = both(l, m);
    }
}

namespace {

/// u_i = r_i/c + q u_{i−1}
struct Recurrence {
  double q;
  double* u;
  Pack last = 0.0;
  [[gnu::always_inline]] void operator()(std::ptrdiff_t at, Pack r) {
    last = r + q * last;
    last.store(u + at);
  }
};
/// The same near the ends of arcs, with Σ weight · u.
struct SummedRecurrence {
  Recurrence recurrence;
  const double* weights;
  Pack sums = 0.0;
  [[gnu::always_inline]] void operator()(std::ptrdiff_t at, Pack r) {
    recurrence(at, r);
    sums += Pack::load(weights + at) * recurrence.last;
  }
};

}  // namespace

[[gnu::always_inline]] inline CirculantSolver::Entering CirculantSolver::entering(const double* u, Pack sums) const {
  // Two sums of each: a sum waits for itself.
  Entering part[2] = {{Pack(0.0), Pack(0.0)}, {Pack(0.0), Pack(0.0)}};
  Pack x_by_ends[2] = {Pack(0.0), Pack(0.0)};
  for (int m = 0; m < lanes; ++m) {
    const auto at = static_cast<std::size_t>(m);
    const Pack end(u[ends_[m]]);
    part[m % 2].u += u_from_ends_[at] * end;
    x_by_ends[m % 2] += x_from_ends_[at] * end;
    part[m % 2].x += x_from_sums_[at] * Pack(sums[m]);
  }
  return {part[0].u + part[1].u, (part[0].x + part[1].x) + (x_by_ends[0] + x_by_ends[1])};
}

/// Σ weight · u over the first packs.
inline Pack CirculantSolver::sum_of_first(const double* u) const {
  Pack part[sums_at_once];  // a sum waits for itself
  for (Pack& sum : part) sum = 0.0;
  const double* const weights = backward_.row(0);
  const std::ptrdiff_t end = layout_->at(near_);
  for (std::ptrdiff_t at = layout_->at(0); at < end; at += sums_at_once * lanes)
    for (int p = 0; p < sums_at_once; ++p)
      part[p] += Pack::load(weights + at + p * lanes) * Pack::load(u + at + p * lanes);
  return (part[0] + part[1]) + (part[2] + part[3]);
}

/// X_l = s_m + K_m U_m,  m = l + 1
inline Pack CirculantSolver::entering_far(Pack sums, Pack entering_u) const {
  return from_lane_above(sums + x_from_u_ * entering_u);
}

// Inlined, as the pass is: what enters would go through memory.
[[gnu::always_inline]] inline CirculantSolver::Entering CirculantSolver::forward(const RowSum& right_side, double* u) const {
  const RowLayout& layout = *layout_;
  if (are_far_apart_) {
    const Pack last = right_side.pass(layout, layout.all(), Recurrence{q_, u}).last;
    const std::ptrdiff_t at_last = layout.at(layout.packs() - 1);
    const Pack entering_u = layout.before_first([=](std::ptrdiff_t at) __attribute__((always_inline)) {
      return at == at_last ? last : Pack::load(u + at);
    });
    return {entering_u, entering_far(sum_of_first(u), entering_u)};
  }
  SummedRecurrence both{{q_, u}, backward_.row(0)};
  right_side.pass_on(layout, layout.all(), both);
  return entering(u, both.sums);
}

template <class Sink>
[[gnu::always_inline]] inline void CirculantSolver::backward(const Entering& entering, const double* u, Sink& sink) const {
  const Pack entering_u = entering.u;
  const double q = q_;
  // Counted here: the layout, which stores could change for all that compilers know, is not asked in loops.
  const std::ptrdiff_t first = layout_->at(0), near_end = layout_->at(near_);
  const double* power = forward_.data() + near_;
  std::ptrdiff_t at = layout_->at(layout_->packs() - 1);
  Pack x = entering.x;
  for (int unseen = Sink::packs_unseen; unseen > 0; --unseen, at -= lanes) {
    Pack r = Pack::load(u + at);
    if (at < near_end) r += *--power * entering_u;
    x = r + q * x;
    sink.unseen(at, x);
  }
  for (; at >= near_end; at -= lanes) {
    x = Pack::load(u + at) + q * x;
    sink(at, x);
  }
  for (; at >= first; at -= lanes) {
    x = (Pack::load(u + at) + *--power * entering_u) + q * x;
    sink(at, x);
  }
}

namespace {

/// Stores x.
struct Storing {
  static constexpr int packs_unseen = 0;
  double* x;
  [[gnu::always_inline]] void operator()(std::ptrdiff_t at, Pack value) const { value.store(x + at); }
  void unseen(std::ptrdiff_t at, Pack value) const { (*this)(at, value); }
};

}  // namespace

void CirculantSolver::solve(const double* const* rhs, double* const* w) const {
  RowSum scaled;
  scaled.add(0, 0, scale_);
  const RowSum::Rows rows{rhs};
  scaled.bind(rows);
  double* const x = w[0];
  Storing storing{x};
  backward(forward(scaled, x), x, storing);
}

RowChange CirculantSolver::advance(const RowLayout& layout, int, const RowSum* const* right_sides, const RowIncrement* rows,
                                   double* const* w) const {
  // u stands where the new increment will, unless that is made from itself.
  double* const u = rows[0].v == rows[0].v_before ? w[0] : rows[0].v;
  const Entering entering = forward(*right_sides[0], u);
  return with_increment_pass<Order::descending>(rows[0], [&](auto pass) __attribute__((always_inline)) {
    backward(entering, u, pass);
    return pass.closed(layout, rows[0]);
  });
}

/// u stands in the work space until the new row is made of it.
class CirculantSolver::Stream final : public RowStream {
 public:
  Stream(const CirculantSolver& solver, const RowSum& right_side, const RowIncrement& rows)
      : solver_(solver), right_side_(right_side), rows_(rows) {}
  PackRange last_packs() const override;
  void begin(double* u) override;
  int advance(int end, double* u, const double* expected) override;
  RowChange result() const override { return all_; }

 private:
  const CirculantSolver& solver_;
  const RowSum& right_side_;
  RowIncrement rows_;
  RowChange all_;
  Pack last_ = 0.0, sums_ = 0.0, after_ = 0.0;
  int forward_ = 0, done_ = 0;
};

/// The ends of arcs must be far apart against what is felt of them.
std::unique_ptr<RowStream> CirculantSolver::stream(const RowLayout& layout, const RowSum& right_side,
                                                   const RowIncrement& rows) const {
  if (!are_far_apart_ || layout.packs() < 4 * near_) return nullptr;
  return std::make_unique<Stream>(*this, right_side, rows);
}

/// By the last packs the arcs know what enters from the one before.
PackRange CirculantSolver::Stream::last_packs() const {
  const int packs = solver_.layout_->packs();
  return {packs - solver_.near_, packs};
}

void CirculantSolver::Stream::begin(double* u) {
  right_side_.pass(*solver_.layout_, last_packs(), Recurrence{solver_.q_, u});
  last_ = solver_.layout_->before_first(u);
}

int CirculantSolver::Stream::advance(int end, double* u, const double* expected) {
  const RowLayout& layout = *solver_.layout_;
  const int near = solver_.near_, packs = layout.packs();
  SummedRecurrence summed{{solver_.q_, u, last_}, solver_.backward_.row(0), sums_};
  if (forward_ < near) {
    summed = right_side_.pass(layout, {forward_, std::min(end, near)}, summed);
    forward_ = std::min(end, near);
    sums_ = summed.sums;
    if (forward_ == near) after_ = from_lane_above(sums_);  // of u as it is: it has begun with what enters
  }
  last_ = right_side_.pass(layout, {forward_, end}, summed.recurrence).last;
  forward_ = end;

  // x from `near` packs further on, where it starts from nothing
  const int ready = end == packs ? packs : std::max(done_, end - near);
  if (ready == done_) return done_;
  Pack x = end == packs ? after_ : Pack(0.0);
  const double q = solver_.q_;
  for (int v = end - 1; v >= ready; --v) x = Pack::load(u + layout.at(v)) + q * x;
  rows_.look.expected = expected;
  const std::ptrdiff_t last = layout.at(done_);
  // w is this function's own: captured by reference it would go through memory from pack to pack.
  const auto finish = [&layout, u, x, q, ready, last](auto pass) __attribute__((always_inline)) {
    Pack w = x;
    std::ptrdiff_t at = layout.at(ready - 1);
    for (int unseen = pass.packs_unseen; unseen > 0 && at >= last; --unseen, at -= lanes) {
      w = Pack::load(u + at) + q * w;
      pass.unseen(at, w);
    }
    for (; at >= last; at -= lanes) {
      w = Pack::load(u + at) + q * w;
      pass(at, w);
    }
    return pass.result();
  };
  all_.take(expected ? with_increment_pass<Order::descending>(rows_, finish)
                     : finish(IncrementPass<1, Order::descending, Look::increment>(rows_)));
  return done_ = ready;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/verify/phase_space_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace delf {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

double largest_coordinate(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

}  // namespace

PhaseSpaceCheck::PhaseSpaceCheck(std::vector<LinearSymmetry> symmetries, double tolerance, double rounding)
    : symmetries_(std::move(symmetries)), tolerance_(tolerance), rounding_(std::max(rounding, eps)) {
  for (auto* values : {&first_momentum_, &largest_momentum_, &worst_momentum_}) values->resize(symmetries_.size());
  worst_row_.resize(symmetries_.size());
}

void PhaseSpaceCheck::at(std::int64_t row, const CanonicalRow& z, const std::vector<CanonicalRow>& nearby) {
  for (std::size_t s = 0; s < symmetries_.size(); ++s) {
    const LinearSymmetry& symmetry = symmetries_[s];
    const std::size_t d = symmetry.shift.size();
    Balance J;
    for (std::size_t n = 0; n < z.q.size(); n += d)
      for (std::size_t a = 0; a < d; ++a) {
        J.add(z.p[n + a] * symmetry.shift[a]);
        for (std::size_t b = 0; b < d; ++b) J.add(z.p[n + a] * symmetry.matrix[a * d + b] * z.q[n + b]);
      }
    if (rows_ == 0) first_momentum_[s] = J.sum;
    largest_momentum_[s] = std::max(largest_momentum_[s], J.absolute);
    if (const double off = std::abs(J.sum - first_momentum_[s]); worse(off, worst_momentum_[s]))
      worst_momentum_[s] = off, worst_row_[s] = row;
  }
  if (!nearby.empty()) look_at_form(row, z, nearby);
  ++rows_;
}

// The differences at a row are exact, and those at the next follow by the derivative of one step, up to their size.
void PhaseSpaceCheck::look_at_form(std::int64_t row, const CanonicalRow& z, const std::vector<CanonicalRow>& nearby) {
  const std::size_t pairs = nearby.size() / 2;
  const double delta = 4 * rounding_ * std::max(largest_coordinate(z.q), largest_coordinate(z.p));
  std::vector<PairForm> now(pairs);
  for (std::size_t n = 0; n < pairs; ++n) {
    const CanonicalRow &A = nearby[2 * n], &B = nearby[2 * n + 1];
    PairForm& pair = now[n];
    for (std::size_t i = 0; i < z.q.size(); ++i) {
      const double Vq = A.q[i] - z.q[i], Vp = A.p[i] - z.p[i], Wq = B.q[i] - z.q[i], Wp = B.p[i] - z.p[i];
      pair.form.add(Vq * Wp), pair.form.add(-Wq * Vp);
      pair.rounding += delta * (std::abs(Vq) + std::abs(Vp) + std::abs(Wq) + std::abs(Wp));
      pair.size = std::max({pair.size, std::abs(Vq), std::abs(Vp), std::abs(Wq), std::abs(Wp)});
    }
  }
  const std::vector<PairForm> before = std::exchange(before_, now);
  if (before.empty()) return;
  tried_ = true;
  double next_power = 10, rounding = 0, value = 0;
  for (std::size_t n = 0; n < pairs; ++n) {
    const double absolute = std::max(now[n].form.absolute, before[n].form.absolute);
    if (absolute == 0) return;
    next_power *= now[n].size;
    rounding = std::max(rounding, (now[n].rounding + before[n].rounding) / absolute);
    // to ε = 0, by the polynomial through the sizes
    double weight = 1;
    for (std::size_t m = 0; m < pairs; ++m)
      if (m != n) weight *= now[m].size / (now[m].size - now[n].size);
    value += weight * (now[n].form.sum - before[n].form.sum) / absolute;
  }
  value = std::abs(value);
  const double tolerance = std::max(tolerance_, next_power + rounding);
  if (!(tolerance < 0.1)) return;
  if (!symplectic_) symplectic_ = Check{.name = "symplectic form dq^dp of a step", .region = {}, .tolerance = 1};
  Check& check = *symplectic_;
  if (check.samples++ > 0 && !worse(value / tolerance, check.value / check.tolerance)) return;
  check.value = value, check.tolerance = tolerance, check.normaliser = now[0].form.absolute;
  check.count = now[0].form.count;
  check.region = fmt::format("rows {} and {}, differences of {:.1e}", row - 1, row, now[0].size);
  check.failure = fmt::format(
      "The step from row {} to row {} changes dq^dp by {:.1e} of its terms, and the size of the differences explains "
      "no "
      "more than {:.1e}: the program is not symplectic in these q and p.",
      row - 1, row, value, tolerance);
}

std::vector<Check> PhaseSpaceCheck::checks() const {
  std::vector<Check> all;
  if (symplectic_) all.push_back(*symplectic_);
  for (std::size_t s = 0; s < symmetries_.size(); ++s) {
    if (largest_momentum_[s] == 0) continue;
    Check check{.name = "Noether with momenta, " + symmetries_[s].name,
                .region = fmt::format("rows 0 and {}", worst_row_[s])};
    check.value = worst_momentum_[s] / largest_momentum_[s];
    check.normaliser = largest_momentum_[s];
    check.count = rows_, check.samples = rows_;
    // Each row rounds anew.
    check.tolerance = std::max(tolerance_, 4 * rounding_ * std::sqrt(static_cast<double>(rows_)));
    check.failure = fmt::format(
        "p·ξ of {} is {:.10g} in row 0, and {:.3g} of its terms away in row {}: the program does not keep it.",
        symmetries_[s].name, first_momentum_[s], check.value, worst_row_[s]);
    all.push_back(std::move(check));
  }
  return all;
}

}  // namespace delf

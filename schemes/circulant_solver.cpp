// SPDX-License-Identifier: MIT
#include "schemes/circulant_solver.hpp"

#include <algorithm>
#include <cmath>

namespace delf {

CirculantSolver::CirculantSolver(const RowLayout& layout, double centre, double side) : layout_(&layout) {
  // b = c(1 + q²), a = −cq: the root inside the unit circle, in the form that does not cancel (the other root
  // formula costs two digits).
  const double ratio = -side / centre;
  q_ = 2 * ratio / (1 + std::sqrt(1 - 4 * ratio * ratio));
  scale_ = (1 + q_ * q_) / centre;
  double power = q_;
  for (int v = 0; v < layout.packs() && std::abs(power) > 1e-19; ++v, power *= q_) powers_.push_back(power);
  double all = 1;
  for (int l = 0; l < lanes; ++l) {
    const int before = (l + lanes - 1) % lanes;
    gap_[l] = layout.start(l) + (l == 0 ? layout.sites() : 0) - layout.start(before) - 1;
    entering_[l] = std::pow(q_, gap_[l] + 1);
    all *= entering_[l];
  }
  closing_ = 1 / (1 - all);
}

void CirculantSolver::solve(const double* const* rhs, double* const* w) const {
  const int packs = layout_->packs(), near = static_cast<int>(powers_.size());
  double* const x = w[0];

  // u_i = r_i + q u_{i−1}
  Pack u(0.0);
  for (int v = 0; v < packs; ++v) {
    u = scale_ * Pack::load(rhs[0] + layout_->at(v)) + q_ * u;
    u.store(x + layout_->at(v));
  }
  // What enters arc l from the one before it, at first without what entered that: E_l = enter_l + entering_l E_{l−1},
  // closed round the circle by E_0 = (enter_0 + entering_0 c)/(1 − Π entering), c = E_{lanes−1} for E_0 = 0.
  double enter[lanes], c = 0;
  for (int l = 0; l < lanes; ++l) enter[l] = x[layout_->at(gap_[l]) + (l + lanes - 1) % lanes];
  for (int l = 1; l < lanes; ++l) c = enter[l] + entering_[l] * c;
  double carried = (enter[0] + entering_[0] * c) * closing_;
  Pack E;
  for (int l = 0; l < lanes; ++l) {
    if (l > 0) carried = enter[l] + entering_[l] * carried;
    E.v[l] = carried;
  }
  for (int v = 0; v < near; ++v) {
    double* const at = x + layout_->at(v);
    (Pack::load(at) + powers_[static_cast<std::size_t>(v)] * E).store(at);
  }

  // x_i = u_i + q x_{i+1}, the same the other way round: what enters arc l comes from the start of arc l+1.
  u = Pack(0.0);
  for (int v = packs - 1; v >= 0; --v) {
    u = Pack::load(x + layout_->at(v)) + q_ * u;
    u.store(x + layout_->at(v));
  }
  // The site after the last of arc l has index packs − 1 − gap_{l+1} in arc l+1.
  for (int l = 0; l < lanes; ++l) {
    const int next = (l + 1) % lanes;
    enter[l] = x[layout_->at(packs - 1 - gap_[next]) + next];
  }
  c = 0;
  for (int l = lanes - 2; l >= 0; --l) c = enter[l] + entering_[l + 1] * c;
  carried = (enter[lanes - 1] + entering_[0] * c) * closing_;
  for (int l = lanes - 1; l >= 0; --l) {
    if (l < lanes - 1) carried = enter[l] + entering_[l + 1] * carried;
    E.v[l] = carried;
  }
  for (int v = 0; v < near; ++v) {
    double* const at = x + layout_->at(packs - 1 - v);
    (Pack::load(at) + powers_[static_cast<std::size_t>(v)] * E).store(at);
  }
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/verify/wrong_sign.hpp"

#include <algorithm>
#include <vector>

namespace delf {
namespace {

/// The first value whose residual depends on anything: the vertex of a broken element is in no term.
int first_with_terms(const StencilFamily& family, const LatticeSystem& system) {
  std::vector<double> y, J;
  for (int i = 0; i < family.size(); ++i) y.push_back(1 + 0.1 * i);
  J.resize(y.size());
  for (int i = 0; i < family.size(); ++i) {
    family.jacobian_row(i, {system.time_step(), system.lattice().space_step(), 0, 0}, y, J);
    if (std::ranges::any_of(J, [](double entry) { return entry != 0; })) return i;
  }
  return 0;
}

}  // namespace

std::unique_ptr<LatticeSystem> with_wrong_sign(const LatticeSystem& right) {
  std::vector<std::shared_ptr<const StencilFamily>> families(right.families().begin(), right.families().end());
  const bool repeats = right.lattice().space() != Space::mesh;
  if (repeats) families.resize(1);
  for (auto& family : families)
    if (repeats || family->size() > 1) family = std::make_shared<WrongSign>(family, first_with_terms(*family, right));
  families.insert(families.end(), right.families().begin() + std::ssize(families), right.families().end());
  auto wrong =
      std::make_unique<LatticeSystem>(right.lattice(), std::move(families), right.time_step(), right.all_components());
  wrong->share_times(right);
  return wrong;
}

}  // namespace delf

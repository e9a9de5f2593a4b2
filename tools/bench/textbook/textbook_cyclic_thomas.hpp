// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

namespace delf::bench {

/// A x = r for the circulant tridiagonal matrix with `diagonal` and `off` beside it and in the corners. Thomas'
/// algorithm on B = A − u vᵀ, which has no corners, and Sherman–Morrison: x = B⁻¹r − z (v·B⁻¹r)/(1 + v·z), z = B⁻¹u,
/// where u = (−a, 0, …, 0, b) and v = (1, 0, …, 0, −b/a). All that does not depend on r is found once.
class CyclicThomas {
 public:
  CyclicThomas(int sites, double diagonal, double off);
  void solve(double* x) const;  ///< r in, x out

 private:
  void solve_without_corners(double* x) const;

  int sites_;
  double corner_;                         ///< −b/a
  std::vector<double> inverse_, up_, z_;  ///< reciprocal pivots; b times them; z/(1 + v·z)
};

}  // namespace delf::bench

// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Dense>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "schemes/simulation.hpp"
#include "tools/diagnosis/evidence.hpp"

namespace delf {

/// Some sites and rows, few enough to be tried with every scheme: neighbouring sites where the field varies most, and rows
/// spread over the file. The sites are closed to a circle; equations that reach over its seam are not asked, so that walls
/// and windings do not matter.
class Sample {
 public:
  explicit Sample(const Evidence&);

  /// Every `sites`-th site and every `rows`-th row alone.
  struct Stride {
    int rows = 1, sites = 1;
  };
  /// Equations of a scheme at these sites and rows, divided by hk.
  struct Equations {
    Eigen::VectorXd whole;  ///< E
    double scale = 0;       ///< what is summed: the terms of E are of this size
    bool hold(double tolerance) const { return whole.cwiseAbs().maxCoeff() <= tolerance * scale; }
  };
  /// Nothing where the scheme cannot be built, has values that rows do not hold, or reads more rows than there are. `shift`:
  /// of the parity of a brick wall.
  std::optional<Equations> equations(const Problem&, Stride, int shift = 0) const;

  /// The equations by powers of the steps: E = time + space + force, time ~ 1/h², space ~ 1/k², as they are for
  /// densities that are quadratic in φ_t and in φ_x, without products with φ. Of the rows `later` rows later.
  struct Split {
    Eigen::VectorXd time, space, force, velocity;  ///< velocity: that of φ_t, −∂²ℓ/∂φ_t² φ_t by central differences
    double scale = 0;
  };
  std::optional<Split> split(const Problem&, int later = 0) const;

  /// The scene's own scheme, and all others by name whose equations can be tried; those that are the same once.
  const std::vector<NamedScheme>& schemes() const { return schemes_; }
  /// The distance of the equations of these schemes from the scene's own at these rows, |E − E'|: the median of the
  /// largest. It bounds the difference of a scheme that is as good as they are.
  double spread() const { return spread_; }

  /// Nothing in the sample changes by more than rounding.
  bool rests() const { return rests_; }

 private:
  void find_schemes();
  const std::vector<double>& row(std::int64_t) const;
  std::optional<LatticeSystem> system(const Problem&, Stride, double time_factor, double space_factor) const;
  std::vector<double> values(std::int64_t row, Stride, int shift) const;
  Eigen::VectorXd evaluated(const LatticeSystem&, Stride, int later, int shift, double& largest) const;

  const Evidence& evidence_;
  int first_ = 0, count_ = 1, fields_ = 1;
  std::vector<std::int64_t> moments_;
  std::vector<NamedScheme> schemes_;
  mutable std::map<std::int64_t, std::vector<double>> read_;  ///< rows of the file
  double spread_ = 0;
  bool rests_ = true;
};

/// E = time + space + force is exact for this theory.
bool can_be_split(const Problem&);

}  // namespace delf

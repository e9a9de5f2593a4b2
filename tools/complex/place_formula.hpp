// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "jets/expressions/evaluate.hpp"
#include "lattice/space/mesh.hpp"

namespace delf {

/// A formula of t, x, y and z, with its derivative by t.
class PlaceFormula {
 public:
  /// Throws BadInput for `key`.
  PlaceFormula(std::string_view text, const std::vector<std::pair<std::string, double>>& parameters,
               const std::string& key);

  double operator()(double t, const Mesh::Point& p) const { return evaluated(value_, t, p); }
  bool reads_time() const { return reads_time_; }
  double by_t(double t, const Mesh::Point& p) const { return evaluated(by_t_, t, p); }

 private:
  static double evaluated(const expressions::Evaluation&, double t, const Mesh::Point&);
  expressions::Evaluation value_, by_t_;
  bool reads_time_ = false;
};

}  // namespace delf

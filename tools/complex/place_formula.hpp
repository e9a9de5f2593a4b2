// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "jets/expressions/evaluate.hpp"
#include "jets/expressions/graph.hpp"
#include "lattice/space/mesh.hpp"

namespace delf {

/// A formula of t, x, y and z.
class PlaceFormula {
 public:
  /// Throws BadInput for `key`.
  PlaceFormula(std::string_view text, const std::vector<std::pair<std::string, double>>& parameters,
               const std::string& key);

  double operator()(double t, const Mesh::Point& p) const {
    return value_.operator()<double>([&](int v) { return v == 0 ? t : p[v - 1]; });
  }
  /// Its derivative by t (0), x, y or z (3).
  PlaceFormula by(int variable) const;
  bool reads_time() const;

 private:
  PlaceFormula(expressions::Graph graph, int root) : graph_(std::move(graph)), root_(root), value_(graph_, root_) {}

  expressions::Graph graph_;
  int root_;
  expressions::Evaluation value_;
};

}  // namespace delf

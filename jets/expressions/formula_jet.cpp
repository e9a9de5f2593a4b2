// SPDX-License-Identifier: MIT
#include "jets/expressions/formula_jet.hpp"

#include <algorithm>
#include <array>

#include "jets/expressions/parse.hpp"
#include "jets/expressions/tape.hpp"
#include "jets/simd/scratch_rows.hpp"

namespace delf {

using namespace expressions;

struct FormulaJet::Impl {
  Tape all;
  std::size_t count;
};

FormulaJet::FormulaJet(std::string_view text, const std::vector<std::pair<std::string, double>>& parameters,
                       const std::string& key, int order) {
  constexpr int x = 0, t = 1;
  Graph graph;
  std::vector<int> roots{parse(graph, text, Names{{{"x", x}, {"t", t}}, parameters}, key)};
  for (int o = 1; o <= order; ++o) {
    const std::vector<int> before(roots.end() - o, roots.end());
    for (const int node : before) roots.push_back(graph.differentiate(node, t));
    roots.push_back(graph.differentiate(before.back(), x));
  }
  const std::size_t count = roots.size();
  impl_.reset(new Impl{Tape(graph, roots, 2), count});
}
FormulaJet::~FormulaJet() = default;
FormulaJet::FormulaJet(FormulaJet&&) noexcept = default;

std::vector<double> FormulaJet::operator()(double t, double x) const {
  const ScratchRows in(1, lanes), out(static_cast<int>(impl_->count), lanes);
  std::fill_n(in[0], lanes, x);
  const std::array<const double*, 2> variables{in[0], nullptr};
  impl_->all.run(lanes, variables.data(), t, out.data());
  std::vector<double> jet;
  for (std::size_t n = 0; n < impl_->count; ++n) jet.push_back(out[static_cast<int>(n)][0]);
  return jet;
}

}  // namespace delf

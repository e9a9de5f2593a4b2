// SPDX-License-Identifier: MIT
#include <string>
#include <string_view>

#include "jets/expressions/evaluate.hpp"
#include "jets/expressions/parse.hpp"
#include "jets/expressions/print.hpp"
#include "jets/expressions/sums.hpp"
#include "lattice/error.hpp"
#include "tests/fuzz/target.hpp"

// The text of a density: what is accepted can be differentiated, evaluated, printed, and read again.
void delf::fuzz::read_bytes(std::string_view bytes) {
  using namespace delf::expressions;
  const Names names{{{"phi", 0}, {"phi_t", 1}, {"phi_x", 2}, {"x", 3}, {"t", 4}}, {{"m", 1.5}}};
  Graph graph;
  const int root = parse(graph, bytes, names, "theory.density");
  if (graph.size() > 60) return;  // parsing is what is tried; what follows costs more
  try {
    const int slope = graph.differentiate(root, 1);
    [[maybe_unused]] volatile double value =
        Evaluation(graph, slope).operator()<double>([](int v) { return 0.5 + 0.25 * v; });
    Sums sums(graph, [](int) { return false; });
    const Naming naming{[&](int v) { return names.variables[static_cast<std::size_t>(v)].first; }};
    const std::string text = printed(sums, sums.of({root}), naming, Notation::plain);
    try {
      parse(graph, text, names, "printed");
    } catch (const delf::BadInput& bad) {
      // numbers may overflow where terms are collected, and brackets may be deeper than they were
      const std::string_view why = bad.what();
      for (const char* allowed : {"not a finite number", "nested more than", "division by zero", "double precision",
                                  "unknown name inf", "unknown name nan"})
        if (why.find(allowed) != std::string_view::npos) return;
      __builtin_trap();
    }
  } catch (const TooLarge&) {
  }
}

// SPDX-License-Identifier: MIT
#include "jets/expressions/generator.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "jets/expressions/constraints.hpp"
#include "jets/expressions/euler_lagrange.hpp"
#include "jets/expressions/evaluate.hpp"
#include "jets/expressions/parse.hpp"
#include "jets/expressions/random_jets.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"

namespace delf {
namespace {

using namespace expressions;

/// Splits a text at the commas that are in no brackets.
std::vector<std::string_view> between_commas(std::string_view text) {
  std::vector<std::string_view> parts;
  std::size_t begin = 0;
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '(') ++depth;
    if (text[i] == ')') --depth;
    if (text[i] != ',' || depth > 0) continue;
    parts.push_back(text.substr(begin, i - begin));
    begin = i + 1;
  }
  parts.push_back(text.substr(begin));
  return parts;
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

/// The terms of δ: Σ ∂root/∂v δv over the fields and their derivatives.
std::vector<int> change(Graph& graph, int root, const LinearSymmetry& symmetry, const JetVariables& variables) {
  std::vector<int> terms;
  const int d = variables.d;
  for (int v = 0; v < 6 * d; ++v) {
    const int slope = graph.differentiate(root, v);
    if (graph.is_constant(slope, 0)) continue;
    const int slot = v / d;
    const std::size_t a = v % d;
    const auto add = [&](double factor, int times) {
      if (factor != 0) terms.push_back(graph.multiply(graph.constant(factor), graph.multiply(slope, times)));
    };
    if (slot == 0) add(symmetry.shift[a], graph.constant(1));
    for (int b = 0; b < d; ++b) add(symmetry.matrix[a * at(d) + at(b)], graph.variable(slot * d + b));
  }
  return terms;
}

}  // namespace

LinearSymmetry generator_of(std::string_view text, const ExpressionNames& given, const std::string& name,
                            const std::string& key) {
  const std::size_t d = given.fields.size();
  const auto refuse = [&](const std::string& why) { throw BadInput(key, key + ": " + why); };
  const std::vector<std::string_view> changes = between_commas(text);
  if (changes.size() != d)
    refuse("has " + std::to_string(changes.size()) + (changes.size() == 1 ? " part" : " parts") +
           "; give one for each of " + listed(given.fields) + ", separated by commas");
  LinearSymmetry symmetry{name, std::vector<double>(d * d, 0.0), std::vector<double>(d, 0.0)};
  Names names{{}, given.parameters};
  for (std::size_t b = 0; b < d; ++b) names.variables.emplace_back(given.fields[b], static_cast<int>(b));
  for (std::size_t a = 0; a < d; ++a) {
    if (changes[a].find_first_not_of(" \t") == std::string_view::npos)
      refuse("has an empty part; write 0 for a field that stays as it is");
    Graph graph;
    const int xi = parse(graph, changes[a], names, key);
    for (std::size_t b = 0; b < d; ++b) {
      const int slope = graph.differentiate(xi, static_cast<int>(b));
      if (!graph.is_constant(slope))
        refuse("the change of " + given.fields[a] + " is not linear in " + given.fields[b] +
               ", and lattices keep affine symmetries alone; give one such as 2*" + given.fields[b] + " + 1");
      symmetry.matrix[a * d + b] = graph[slope].value;
    }
    symmetry.shift[a] = Evaluation(graph, xi).operator()<double>([](int) { return 0.0; });
  }
  const auto is_zero = [](double value) { return value == 0; };
  if (std::ranges::all_of(symmetry.shift, is_zero) && std::ranges::all_of(symmetry.matrix, is_zero))
    refuse("changes no field, and of that nothing follows; give a change that is not 0");
  return symmetry;
}

bool require_symmetry(const LinearSymmetry& symmetry, std::string_view density, std::string_view constraint,
                      const ExpressionNames& names, const std::string& key) {
  const JetVariables variables(names);
  const auto refuse = [&](const std::string& why) { throw BadInput(key, key + ": is no symmetry: " + why); };
  bool exact = false;
  try {
    Graph graph;
    const int l = parse(graph, density, variables.names, key);
    const std::vector<int> terms = change(graph, l, symmetry, variables);
    const auto changed = largest_sum(graph, terms, variables, names);
    if (!changed) refuse("the density has no value at any jet that was tried");
    exact = changed.value_or(1) <= zero_at_random_jets;
    if (!exact) {
      int sum = graph.constant(0);
      for (const int term : terms) sum = graph.add(sum, term);
      for (int a = 0; a < variables.d; ++a)
        if (largest_sum(graph, euler_lagrange(graph, sum, a, variables), variables, names).value_or(1) >
            zero_at_random_jets)
          refuse("the density changes along it, by up to " +
                 std::to_string(static_cast<int>(std::ceil(100 * *changed))) +
                 " % of its terms, and not by a divergence; correct it, or leave it out");
    }
    for (const std::string& one : constraints_of(constraint)) {
      const int G = parse(graph, one, variables.names, key);
      if (largest_sum(graph, change(graph, G, symmetry, variables), variables, names).value_or(1) > zero_at_random_jets)
        refuse("it leads off the constraint; correct it, or leave it out");
    }
  } catch (const TooLarge& large) {
    throw BadInput(key, key + ": " + large.what() + "; simplify the density");
  }
  return exact;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/problem.hpp"

#include "jets/tables/named_tables.hpp"
#include "schemes/declared.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

const std::vector<TheoryInfo>& theories() {
  static const std::vector<TheoryInfo> list = [] {
    std::vector<TheoryInfo> result;
    for (const TheoryEntry* entry : theory_entries()) {
      result.push_back({entry->name, entry->formula, {}, entry->further ? 0 : make_theory(*entry)->components()});
      for (const Parameter& p : entry->parameters) result.back().parameters.push_back(p.key);
    }
    return result;
  }();
  return list;
}

const std::vector<NamedFormula>& stencils() {
  static const std::vector<NamedFormula> list = [] {
    std::vector<NamedFormula> result;
    for (const NamedTable& table : named_tables()) result.push_back({table.name, table.description});
    return result;
  }();
  return list;
}

const std::vector<NamedFormula>& methods() {
  static const std::vector<NamedFormula> list = [] {
    std::vector<NamedFormula> result;
    for (const MethodEntry* entry : method_entries()) result.push_back({entry->name, entry->formula});
    return result;
  }();
  return list;
}

Problem completed(Problem p) {
  complete(p.parameters, parameters_of(find_theory(p.theory), p.parameters));
  complete(p.parameters, find_method(p.method).parameters);
  p.stencil = stencil_name(p.stencil, p.lattice.space() == Space::point);
  return p;
}

std::string scheme_label(const Problem& p) {
  const MethodEntry& method = find_method(p.method);
  return method.label ? method.label(completed(p)) : method.name;
}

std::vector<NamedScheme> named_schemes(const Problem& base) {
  std::vector<NamedScheme> result;
  for (const MethodEntry* entry : method_entries()) {
    Problem problem = base;
    problem.method = entry->name;
    if (!entry->variants) result.push_back({entry->name, std::move(problem)});
    else
      for (NamedScheme& scheme : entry->variants(problem)) result.push_back(std::move(scheme));
  }
  return result;
}

}  // namespace delf

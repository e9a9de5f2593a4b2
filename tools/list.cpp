// SPDX-License-Identifier: MIT
#include "tools/list.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "tools/scene/shipped_scenes.hpp"
#include "tools/scene/suggestion.hpp"

namespace delf {

namespace {

void print_theories() {
  for (const TheoryInfo& t : theories())
    fmt::print("  {:<22} {}{}\n", t.name, t.formula,
               t.parameters.empty() ? "" : fmt::format("   [{}]", fmt::join(t.parameters, ", ")));
}
void print_formulas(const std::vector<NamedFormula>& all) {
  for (const NamedFormula& n : all) fmt::print("  {:<22} {}\n", n.name, n.formula);
}
void print_stencils() { print_formulas(stencils()); }
void print_schemes() { print_formulas(methods()); }
void print_states() {
  for (const StateInfo& s : states()) {
    fmt::print("  {:<22} {}\n", s.name, s.formula);
    fmt::print("  {:<22}   reads {}; for {}\n", "", s.parameters.empty() ? "nothing" : s.parameters, s.theories);
  }
  if (std::none_of(states().begin(), states().end(), [](const StateInfo& s) { return s.name == "file"; }))
    fmt::print(
        "  {:<22} rows of a fields.h5 or a .csv\n  {:<22}   reads initial.file, initial.frame; for all theories\n",
        "file", "");
}
void print_scenes() {
  for (const ShippedScene& s : shipped_scenes()) fmt::print("  {:<22} {}\n", s.name, s.title);
}

struct Kind {
  const char* name;
  void (*print)();
};
constexpr Kind kinds[] = {{"theories", print_theories},
                          {"stencils", print_stencils},
                          {"schemes", print_schemes},
                          {"states", print_states},
                          {"scenes", print_scenes}};

}  // namespace

ExitCode list(const std::string& kind) {
  std::vector<std::string> names;
  for (const Kind& k : kinds) {
    names.emplace_back(k.name);
    if (!kind.empty() && kind != k.name) continue;
    fmt::print("{}\n", k.name);
    k.print();
    if (kind == k.name) return ExitCode::done;
  }
  if (!kind.empty())
    throw BadScene(fmt::format("command line: list {}: is not known{}", kind, suggestion(kind, names)));
  return ExitCode::done;
}

}  // namespace delf

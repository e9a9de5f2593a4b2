// SPDX-License-Identifier: MIT
#include "tools/list.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "jets/tables/named_tables.hpp"
#include "schemes/declared.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"
#include "schemes/states/state_registry.hpp"
#include "tools/report/text_columns.hpp"
#include "tools/reproduce/reproduce.hpp"
#include "tools/scene/shipped_scenes.hpp"
#include "tools/scene/suggestion.hpp"

namespace delf {

namespace {

void print_theories() {
  for (const TheoryInfo& t : theories())
    fmt::print("  {:<22} {}{}\n", t.name, t.formula,
               t.parameters.empty() ? "" : fmt::format("   [{}]", fmt::join(t.parameters, ", ")));
}
void print_stencils() {
  for (const NamedTable& t : named_tables()) {
    fmt::print("  {:<22} {}\n", t.name, t.description);
    if (!t.aliases.empty()) fmt::print("  {:<22}   also found by {}\n", "", fmt::join(t.aliases, ", "));
  }
}
void print_schemes() {
  constexpr std::size_t widest_line = 120, indent = 49;
  for (const MethodEntry* m : method_entries()) {
    fmt::print("  {:<22} {}\n", m->name, m->formula);
    for (const Parameter& p : m->parameters) {
      fmt::print("  {:<22}   {:<22} {} ({})\n", "", p.key, p.help,
                 p.otherwise.empty() ? to_text(p.fallback) : p.otherwise);
      if (p.choices.empty()) continue;
      for (const std::string& line : wrapped(fmt::format("{}", fmt::join(p.choices, ", ")), widest_line - indent))
        fmt::print("{:<{}}{}\n", "", indent, line);
    }
  }
}
void print_states() {
  for (const StateEntry* s : state_entries()) {
    fmt::print("  {:<22} {}\n", s->name, s->formula);
    for (const Parameter& p : s->parameters)
      fmt::print("  {:<22}   {:<22} {} ({})\n", "", p.key, p.help,
                 p.otherwise.empty() ? to_text(p.fallback) : p.otherwise);
    fmt::print("  {:<22}   for {}\n", "", theories_in_words(*s));
  }
}
void print_scenes() {
  for (const ShippedScene& s : shipped_scenes()) fmt::print("  {:<22} {}\n", s.name, s.title);
}

struct Kind {
  const char* name;
  void (*print)();
};
constexpr Kind kinds[] = {{"theories", print_theories}, {"stencils", print_stencils}, {"schemes", print_schemes},
                          {"states", print_states},     {"scenes", print_scenes},     {"results", list_results}};

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

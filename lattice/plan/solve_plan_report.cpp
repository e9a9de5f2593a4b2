// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <string>

#include "lattice/plan/solve_plan.hpp"

namespace delf {
namespace {

std::string row(const char* name, int shift) {
  if (shift == 0) return name;
  return std::string(name) + (shift > 0 ? " + " : " − ") + std::to_string(std::abs(shift));
}

std::string blocks_in_words(const SolvePlan& plan) {
  return plan.one_block() ? "one block" : std::to_string(plan.blocks) + " blocks";
}

std::string name(const SolvePlan& plan, int component) {
  return plan.names.empty() ? "component " + std::to_string(component) : plan.names[component];
}

std::string field(const SolvePlan& plan, int component) {
  return plan.components == 1 ? "" : name(plan, component) + ": ";
}

}  // namespace

const char* to_string(SolveKind kind) {
  switch (kind) {
    case SolveKind::explicit_:
      return "explicit";
    case SolveKind::chain:
      return "chain";
    case SolveKind::cyclic_band:
      return "cyclic-band";
    case SolveKind::sparse:
      return "sparse";
  }
  return "";
}

std::string SolvePlan::describe() const {
  const std::string size = ", " + std::to_string(unknowns) + " unknowns a slab";
  const std::string width = ", width " + std::to_string(lower) + "+" + std::to_string(upper);
  switch (kind) {
    case SolveKind::explicit_:
      return "explicit" + size;
    case SolveKind::chain:
      return "chain" + width + size + (lower > 0 ? ", rightwards" : ", leftwards");
    case SolveKind::cyclic_band:
      return (cyclic ? "cyclic band" : "band") + width + size + ", " + blocks_in_words(*this);
    case SolveKind::sparse:
      return "sparse" + size + ", " + blocks_in_words(*this);
  }
  return "";
}

std::string SolvePlan::report() const {
  std::string text = describe() + "\n";
  for (int component = 0; component < components; ++component) {
    // The innermost site represents the bulk.
    const int site = table.lattice_sites / 2;
    const Entry& e = node(site, component, 0);
    if (!e.solved) continue;
    text += field(*this, component) + "the value at (" + row("j", e.offset) + ", i) is determined by the equation";
    if (e.equation_component != component) text += " of " + name(*this, e.equation_component);
    text += " at (" + row("j", e.offset + e.equation_time) + ", " + row("i", e.equation_space) + ")\n";
  }
  for (const Exception& e : exceptional)
    text += field(*this, e.component) + "site " + std::to_string(e.site) +
            (table.parities == 1 ? ""
             : e.parity == 0     ? ", even rows"
                                 : ", odd rows") +
            ": the value at " + row("j", e.offset) + ", the equation at " + row("j", -e.shift) + "\n";
  for (const int site : {0, table.lattice_sites - 1}) {
    std::string data;
    int count = 0;
    for (int component = 0; component < components; ++component)
      if (!solved(site, component)) data += field(*this, component), ++count;
    if (count == 0) continue;
    if (count == components && components > 1) data = "all components: ";
    text += data + "site " + std::to_string(site) + ": data, no equation\n";
  }
  text += "rows: an equation reaches " + std::to_string(forward) + " ahead and " + std::to_string(backward) +
          " back; a slab reads the " + std::to_string(history) + " rows before it\n";
  text += "coefficients: ";
  text += linear              ? "all constant\n"
          : nonlinear_in_slab ? "not constant in the slab\n"
                              : "constant in the slab, not before it\n";
  return text;
}

}  // namespace delf

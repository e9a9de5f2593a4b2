// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>
#include <set>
#include <string>
#include <utility>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/plan/quotient.hpp"
#include "lattice/plan/solve_plan.hpp"
#include "lattice/stencil.hpp"

namespace delf {
namespace {

/// The map from the sites of a lattice to those of its quotient.
SolvePlan::Table frame(const Lattice& lattice, const Quotient& quotient) {
  SolvePlan::Table table;
  table.circle = quotient.circle;
  table.sites = quotient.sites;
  table.period = std::min(quotient.period, quotient.sites);
  table.parities = quotient.parities;
  table.lattice_sites = lattice.sites();
  return table;
}

std::vector<SolvePlan::Entry> entries(const Quotient& quotient, const StructuralAnalysis& analysis) {
  std::vector<SolvePlan::Entry> found(quotient.nodes());
  for (int n = 0; n < quotient.nodes(); ++n) {
    if (!quotient.solved[n]) continue;
    found[n].solved = true;
    found[n].shift = -analysis.c[n];
    found[n].offset = analysis.d[n];
    const Quotient::Edge& solved = quotient.edges[analysis.match[n]];
    found[solved.unknown].equation_space = -solved.space;
    found[solved.unknown].equation_component = quotient.component(n);
    found[solved.unknown].equation_time = -solved.time;
  }
  return found;
}

/// "component 1 at sites 0 and 3", of the real lattice.
std::string named(const SolvePlan::Table& table, const Quotient& quotient, const SystemPattern& system,
                  const std::vector<int>& nodes) {
  std::string text;
  for (int component = 0; component < quotient.components; ++component) {
    std::set<int> sites, between;
    for (const int n : nodes) {
      if (quotient.component(n) != component) continue;
      const int left = (table.sites - table.period) / 2, site = quotient.site(n);
      if (table.lattice_sites == table.sites || site < left) sites.insert(site);
      else if (site >= left + table.period) sites.insert(table.lattice_sites - table.sites + site);
      else between.insert(site);
    }
    if (sites.empty() && between.empty()) continue;
    if (!text.empty()) text += " and ";
    if (quotient.components > 1) text += system.name(component) + " at ";
    if (quotient.circle || static_cast<int>(sites.size()) == table.lattice_sites) {
      text += "every site";
      continue;
    }
    std::string list;
    for (const int site : sites) list += (list.empty() ? "" : ", ") + std::to_string(site);
    if (!list.empty()) text += (sites.size() > 1 ? "sites " : "site ") + list;
    if (!between.empty()) text += list.empty() ? "sites between the walls" : " and sites between the walls";
  }
  return text;
}

bool is_fixed_everywhere(const Lattice& lattice) {
  for (int i = 0; i < lattice.sites(); ++i)
    if (!lattice.is_fixed(i)) return false;
  return true;
}

void require_solvable(const Lattice& lattice, const SolvePlan::Table& table, const Quotient& quotient,
                      const SystemPattern& system, const StructuralAnalysis& analysis) {
  if (!std::ranges::count(quotient.solved, true)) {
    if (is_fixed_everywhere(lattice))
      throw BadInput("lattice.sites", "lattice.sites = " + std::to_string(table.lattice_sites) +
                                          ": no site has an equation, every value is data; raise lattice.sites");
    throw BadInput("theory.name",
                   "the density determines no field: its field equation contains no unknown at any site; give it terms "
                   "of second order in the field, such as 0.5 phi_t^2 - 0.5 phi_x^2");
  }
  for (int component = 0; component < quotient.components; ++component) {
    bool any = false;
    for (int n = 0; n < quotient.nodes(); ++n) any = any || (quotient.solved[n] && quotient.component(n) == component);
    if (!any)
      throw BadInput("lattice.stencil", "lattice.stencil: " + system.name(component) +
                                            " has no equation at any site: no term of the action depends on it; "
                                            "add such a term to the density, or a stencil that it takes part in");
  }
  if (!analysis.solvable())
    throw BadInput("lattice.stencil",
                   "lattice.stencil: no equation is left to determine the unknown of " +
                       named(table, quotient, system, analysis.unmatched_unknowns) + ", and the equation of " +
                       named(table, quotient, system, analysis.unmatched_equations) +
                       " determines nothing that others do not; add a stencil that couples them, or fix the value");
}

int count_unknowns(const Quotient& quotient, const StructuralAnalysis& analysis, int slab_parity) {
  int count = 0;
  for (int n = 0; n < quotient.nodes(); ++n)
    count += quotient.solved[n] && (slab_parity + analysis.d[n] - quotient.parity(n)) % quotient.parities == 0;
  return count;
}

/// An analysed quotient, and whether it represents the lattice.
struct Analysed {
  Quotient quotient;
  StructuralAnalysis analysis;
  SolvePlan::Table table;
  SlabGraph slab;
  long long unknowns[2] = {0, 0}, blocks[2] = {0, 0};  // of even and odd slabs

  Analysed(const Lattice& lattice, const SystemPattern& system, Quotient q)
      : quotient(std::move(q)), analysis(quotient.analysis()), table(frame(lattice, quotient)) {
    require_solvable(lattice, table, quotient, system, analysis);
    table.entries = entries(quotient, analysis);
    const int cells = quotient.circle ? lattice.sites() / quotient.sites : 1;
    slab = slab_graph(quotient, analysis, cells);
    for (int parity = 0; parity < quotient.parities; ++parity) {
      unknowns[parity] = 1LL * cells * count_unknowns(quotient, analysis, parity);
      blocks[parity] = count_blocks(quotient, analysis, slab, cells, parity);
    }
  }
};

enum class Agreement { none, rows, all };

/// Agree if further periods between the walls change only the number of sites there.
Agreement compare(const Analysed& shorter, const Analysed& longer) {
  SolvePlan::Table extended = shorter.table;
  extended.lattice_sites = longer.quotient.sites;
  auto agreement = Agreement::all;
  for (int n = 0; n < longer.quotient.nodes(); ++n) {
    const int site = extended.position(longer.quotient.site(n));
    const auto& a =
        shorter.table.entries[shorter.quotient.node(site, longer.quotient.component(n), longer.quotient.parity(n))];
    const auto& b = longer.table.entries[n];
    if (a.solved != b.solved || a.shift != b.shift || a.offset != b.offset) return Agreement::none;
    if (a != b) agreement = Agreement::rows;
  }
  return agreement;
}

/// True if each (site, component) that is not data has one unknown and one equation in every slab.
bool regular(const Quotient& quotient, const StructuralAnalysis& analysis) {
  if (quotient.parities == 1) return true;
  for (int n = 0; n < quotient.nodes(); n += 2) {
    if (quotient.solved[n] != quotient.solved[n + 1]) return false;
    if ((analysis.d[n] - analysis.d[n + 1]) % 2 != 0 || (analysis.c[n] - analysis.c[n + 1]) % 2 != 0) return false;
  }
  return true;
}

/// The rows that the equations of the bulk, or of the innermost sites that have any, span.
void measure_rows(const Quotient& quotient, const StructuralAnalysis& analysis, SolvePlan& plan) {
  const auto inner = [&](int n) { return std::abs(quotient.site(n) - quotient.centre()); };
  int innermost = quotient.sites;
  for (int n = 0; n < quotient.nodes(); ++n) {
    if (!quotient.solved[n]) continue;
    innermost = std::min(innermost, inner(n));
    plan.history = std::max(plan.history, -(analysis.c[n] + quotient.reach[n]));
    const Quotient::Edge& solved = quotient.edges[analysis.match[n]];
    plan.own = plan.own && solved.space == 0 && quotient.component(solved.unknown) == quotient.component(n);
  }
  plan.forward = -(1 << 30);
  for (int n = 0; n < quotient.nodes(); ++n) {
    if (!quotient.solved[n] || (!quotient.circle && inner(n) != innermost)) continue;
    plan.forward = std::max(plan.forward, quotient.edges[analysis.match[n]].time);
    plan.backward = std::max(plan.backward, -quotient.reach[n]);
  }
}

void list_exceptions(const Quotient& quotient, SolvePlan& plan) {
  if (quotient.circle) return;
  const SolvePlan::Table& table = plan.table;
  const auto entry = [&](int site, int component, int parity) -> const SolvePlan::Entry& {
    return table.entries[quotient.node(site, component, parity)];
  };
  for (int component = 0; component < quotient.components; ++component)
    for (int site = 0; site < quotient.sites; ++site)
      for (int parity = 0; parity < quotient.parities; ++parity) {
        const auto& here = entry(site, component, parity);
        const auto& bulk = entry(quotient.centre(), component, parity);
        if (!here.solved || !bulk.solved || (here.shift == bulk.shift && here.offset == bulk.offset)) continue;
        const bool right = site >= (table.sites - table.period) / 2 + table.period;
        plan.exceptional.push_back(
            {right ? site + table.lattice_sites - table.sites : site, component, parity, here.shift, here.offset});
      }
}

SolveKind classify(const SolvePlan& plan, const SlabGraph& slab, long long places) {
  if (!plan.table.regular || !plan.table.matched) return SolveKind::sparse;
  // Unknowns on a circle that are each a block of their own do not depend on their neighbours all the way round; at
  // most one component depends on another.
  if (slab.edges.empty() || (plan.cyclic && plan.blocks == plan.unknowns)) return SolveKind::explicit_;
  if (plan.cyclic && places <= 2LL * std::max(plan.lower, plan.upper) + 1) return SolveKind::sparse;
  const bool one_way = plan.lower == 0 || plan.upper == 0;
  return !plan.cyclic && one_way ? SolveKind::chain : SolveKind::cyclic_band;
}

/// The plan of a mesh, whose sites are alike in time: that of one site, with those beside it somewhere in its row. Where the
/// slab couples them, they are solved together.
SolvePlan planned_on_mesh(const Lattice& lattice, const SystemPattern& system, SolvePlan plan, const SlabGraph& slab) {
  plan.cyclic = false;
  long long sites = 0, unknowns = 0, blocks = 0;
  for (int i = 0; i < lattice.sites(); ++i) {
    plan.table.held.insert(plan.table.held.end(), at(system.components), lattice.is_fixed(i));
    sites += !lattice.is_fixed(i);
  }
  for (int c = 0; c < system.components; ++c) unknowns += plan.table.entries[c].solved;
  std::vector<char> is_wide(slab.blocks, 0);  // of each block of the quotient
  for (const SlabGraph::Edge& e : slab.edges)
    if (e.cells != 0 && slab.block[e.from] == slab.block[e.to]) is_wide[at(slab.block[e.from])] = 1;
  for (const char wide : is_wide) blocks += wide ? 1 : sites;
  plan.unknowns = sites * unknowns;
  plan.blocks = blocks;
  plan.lower = plan.upper = 0;
  plan.kind = slab.edges.empty() ? SolveKind::explicit_ : SolveKind::sparse;
  return plan;
}

/// True if each of the two periods adds the same number of blocks.
bool grow_evenly(const Analysed& a, const Analysed& longer, const Analysed& longest) {
  return longer.blocks[0] - a.blocks[0] == longest.blocks[0] - longer.blocks[0] &&
         longer.blocks[1] - a.blocks[1] == longest.blocks[1] - longer.blocks[1];
}

/// The plan of a quotient. If it is shorter than the lattice, `longer` and `longest` are by one and two periods longer:
/// every part of the lattice that is 2·width wide occurs in them, and they show how the counts grow with its length.
SolvePlan planned(const Lattice& lattice, const SystemPattern& system, const Analysed& a,
                  const Analysed* longer = nullptr, const Analysed* longest = nullptr) {
  const Quotient& quotient = a.quotient;
  SolvePlan plan;
  plan.cyclic = lattice.is_circle();
  plan.components = quotient.components;
  plan.names = system.names;
  plan.linear = quotient.linear;
  plan.table = a.table;
  plan.table.regular = regular(quotient, a.analysis);
  plan.table.matched = !longest || compare(a, *longest) == Agreement::all;
  measure_rows(quotient, a.analysis, plan);
  // An interval may be all walls; one without a kinetic term may then lie within its row.
  const bool has_bulk = lattice.space() != Space::interval || lattice.sites() > 2 * system.width;
  if (has_bulk && std::ranges::all_of(quotient.edges, [](const Quotient::Edge& e) { return e.time == 0; }) &&
      std::ranges::all_of(quotient.reach, [](int time) { return time == 0; }))
    throw BadInput(
        "lattice.stencil",
        "lattice.stencil: every equation lies within one row, so that no row leads to the next; add a site at "
        "another time");
  list_exceptions(quotient, plan);

  const Analysed& whole = longest ? *longest : a;
  plan.lower = whole.slab.lower;
  plan.upper = whole.slab.upper;
  plan.nonlinear_in_slab = whole.slab.nonlinear;
  const long long periods = longest ? (lattice.sites() - longest->quotient.sites) / quotient.period : 0;
  for (int parity = 0; parity < quotient.parities; ++parity) {
    const auto extrapolated = [&](auto count) {
      return periods == 0 ? count(whole) : count(whole) + periods * (count(whole) - count(*longer));
    };
    plan.unknowns = std::max(plan.unknowns, extrapolated([&](const Analysed& b) { return b.unknowns[parity]; }));
    plan.blocks = std::max(plan.blocks, extrapolated([&](const Analysed& b) { return b.blocks[parity]; }));
  }
  plan.kind = classify(plan, whole.slab, 1LL * lattice.sites() * quotient.components);
  return plan;
}

}  // namespace

SolvePlan make_plan(const Lattice& lattice, const SystemPattern& system) {
  require_closing(lattice, system.placement);
  if (system.components < 1 || system.width < 0 || !system.equations)
    throw BadInput("lattice.stencil", "lattice.stencil: the system has no equations; add a stencil");

  if (lattice.space() == Space::mesh) {
    if (is_fixed_everywhere(lattice))
      throw BadInput("boundary.mesh",
                     "boundary.mesh = fixed: every point of the mesh keeps its value; refine the mesh");
    const Analysed site(lattice, system, Quotient::of_circle(lattice, system));
    return planned_on_mesh(lattice, system, planned(lattice, system, site), site.slab);
  }
  if (lattice.is_circle())
    return planned(lattice, system, Analysed(lattice, system, Quotient::of_circle(lattice, system)));

  // Between the walls equations repeat, and whatever repeats within 2·width sites fits into each period.
  const int period = 2 * std::max(system.width, 1);
  // The influence of walls usually ends within one period; if not, try a longer quotient.
  for (const int zones : {1, 2, 4}) {
    const int least = 2 * zones * period + 1;
    const int sites = least + positive_mod(lattice.sites() - least, period);
    const auto of = [&](int n) { return Analysed(lattice, system, Quotient::of_interval(lattice, system, n)); };
    if (sites + 2 * period >= lattice.sites()) return planned(lattice, system, of(lattice.sites()));

    const Analysed a = of(sites), longer = of(sites + period), longest = of(sites + 2 * period);
    if (compare(a, longer) == Agreement::none || compare(a, longest) == Agreement::none) continue;
    if (zones == 4 || grow_evenly(a, longer, longest)) return planned(lattice, system, a, &longer, &longest);
  }
  throw BadInput("lattice.stencil",
                 "lattice.stencil: the row at which a site is solved drifts from wall to wall, so that no slab of a "
                 "few rows determines the next; fix a wall, or add a stencil that couples neighbours in time");
}

}  // namespace delf

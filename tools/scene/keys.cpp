// SPDX-License-Identifier: MIT
#include "tools/scene/keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "jets/expressions/stencil_text.hpp"
#include "jets/tables/named_tables.hpp"
#include "lattice/nearest_name.hpp"
#include "schemes/declared.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"
#include "schemes/states/state_registry.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/stability/stability_request.hpp"
#include "tools/verify/verify_request.hpp"

namespace delf {

namespace {

std::vector<std::string> known_stencils() {
  std::vector<std::string> names = stencil_names_and_aliases();
  names.emplace_back(stencil_as_text);
  return names;
}

using Names = std::vector<std::string>;

template <class Infos>
Names names_of(const Infos& infos) {
  Names names;
  for (const auto& info : infos) names.push_back(info.name);
  return names;
}

// by their entries: to make every theory for its name would cost each start of the program
Names theory_names() {
  Names names;
  for (const TheoryEntry* entry : theory_entries()) names.push_back(entry->name);
  return names;
}
Names method_names() { return names_of(methods()); }
Names state_names() {
  Names names;
  for (const StateEntry* entry : state_entries()) names.push_back(entry->name);
  return names;
}
Names fibres() { return {"R", "S1"}; }
Names spaces() { return {"circle", "interval", "point", "complex"}; }
Names mesh_times() { return {"rows", "none", "cells"}; }
Names walls() { return {"fixed", "clamped", "natural"}; }
Names mesh_walls() { return {"fixed", "natural"}; }
Names faults() { return verify_faults(); }
Names sweep_keeps() { return {"folders", "table"}; }
Names stability_fault_names() { return stability_faults(); }
Names stability_wave_names() { return stability_waves(); }
Names starts() {
  Names names;
  for (const StartRule rule : all_start_rules) names.emplace_back(to_string(rule));
  return names;
}

// "legendre for method = a or b; else …"
std::string usual_start() {
  std::string text;
  for (const StartRule rule : all_start_rules) {
    Names names;
    for (const MethodEntry* entry : method_entries())
      if (entry->start == rule) names.push_back(entry->name);
    if (!names.empty()) text += fmt::format("{} for method = {}; ", to_string(rule), fmt::join(names, " or "));
  }
  return text + "else exact where the second row is known, or centred";
}

constexpr double largest_int = std::numeric_limits<int>::max();
constexpr double largest_count = 9007199254740992;  // 2⁵³: every integer below it is a double
constexpr Limits any{};
constexpr Limits positive{0, any.high, true};
constexpr Limits at_most_a_hundredth{0, 0.01, true};
constexpr Limits at_most_a_million{0, 1e6, true};
constexpr Limits not_negative{0, any.high};
constexpr Limits count{0, largest_count};
constexpr Limits whole{-largest_int, largest_int};
constexpr Limits one_or_more{1, largest_int};
constexpr Limits two_or_more{2, largest_int};
constexpr Limits up_to_eight{0, 8};
constexpr Limits threads{1, 1024};
constexpr Limits convergence_levels{2, 12};
constexpr auto own = "the state's own";
constexpr auto real = KeyType::real;
constexpr auto integer = KeyType::integer;
constexpr auto choice = KeyType::choice;
constexpr auto toggle = KeyType::toggle;

std::vector<Key> general_keys() {
  return {
      Key{"theory.name", choice, "sine-gordon", "", "the field theory; see `delf list theories`", "", any,
          theory_names()},
      Key{"theory.fibre", choice, "R", "", "where the field has its values: the line, or the circle of angles", "", any,
          fibres()},
      Key{"theory.speed", real, "", "1",
          "units of rows of --fields: the speed of waves there, c in phi_tt = c^2 phi_xx", "length/time", positive},
      Key{"theory.scale", real, "", "1",
          "units of rows of --fields: their values, of phi or q, over those of the theory; its cube is G M of kepler",
          "", positive},

      Key{"lattice.stencil", choice, "rectangle-symmetric", "", "stencil and jet; see `delf list stencils`", "", any,
          known_stencils()},
      Key{"lattice.space", choice, "circle", "", "the shape of space", "", any, spaces()},
      Key{"lattice.length", real, "", "must be given, but for a point", "L", "length", positive},
      Key{"lattice.sites", integer, "", "must be given, but for a point", "N; on an interval both walls are counted",
          "", two_or_more},
      Key{"lattice.courant", real, "", "this or lattice.time_step", "h/k", "", positive},
      Key{"lattice.time_step", real, "", "this or lattice.courant", "h", "time", positive},

      Key{"lattice.mesh", KeyType::text, "", "must be given with space = complex",
          "a mesh file (text, Gmsh MSH 2.2 or 4.1), a file of sites and stencils in spacetime, or icosahedron:LEVEL, "
          "graded:LENGTH,POINTS,RATIO, "
          "rectangle:WIDTH,HEIGHT,NX,NY, quadrilaterals:WIDTH,HEIGHT,NX,NY, or of spacetime "
          "refined:LENGTH,DURATION,NX,NT"},
      Key{"lattice.merge", real, "", "points at one place are refused",
          "points of a mesh file no further apart are one; 0: points at one place stay apart, as on both sides of a "
          "slit",
          "length", not_negative},
      Key{"lattice.time", choice, "rows", "",
          "on a mesh: all sites row by row, none (data all round: an elliptic problem), or each of its cells by its "
          "own "
          "step",
          "", any, mesh_times()},
      Key{"lattice.time_steps", KeyType::text, "", "none",
          "reversible: steps that the field chooses, lattice.time_step at most, on a mesh and with r-adaptive; or on a "
          "mesh steps of the rows, over and over, 0.1, 0.05, or a file of them, in place of lattice.time_step"},
      Key{"lattice.step_control", real, "1", "",
          "s of reversible steps: lattice.time_step / sqrt(1 + s^2 <phi_t^2>), with the mean over the mesh; of "
          "r-adaptive <phi_x^2> over the cells: s = mesh.alpha has steps in proportion to them; usually 0.1 to 10",
          "", at_most_a_million},

      Key{"scheme.method", choice, "multisymplectic", "", "the scheme; see `delf list schemes`", "", any,
          method_names()},
      Key{"scheme.tolerance", real, "1e-14", "",
          "an implicit step ends when its next change is below this times what the field spans; rounding allows "
          "8.9e-16 at least",
          "", at_most_a_hundredth},
      Key{"scheme.seed_order", integer, "8", "", "rows that the first guess of an implicit step is extrapolated from",
          "", up_to_eight},
      Key{"scheme.max_iterations", integer, "50", "", "iterations of an implicit step before it has failed", "",
          one_or_more},

      Key{"initial.state", choice, "", "must be given", "the state to start from; see `delf list states`", "", any,
          state_names()},
      Key{"initial.start", choice, "", usual_start(), "what gives row 1", "", any, starts()},

      Key{"boundary.left", choice, "fixed", "",
          "the left wall of an interval: phi is kept, or phi and phi_x (clamped), or nothing; an end of a beam is "
          "hinged "
          "where it is fixed, and free where it is natural",
          "", any, walls()},
      Key{"boundary.right", choice, "fixed", "", "the right wall of an interval, likewise", "", any, walls()},
      Key{"boundary.mesh", choice, "fixed", "", "the boundary of a mesh", "", any, mesh_walls()},
      Key{"boundary.winding", integer, "", own, "what the field gains around a circle, in units of 2 pi", "", whole},
      Key{"boundary.gain", real, "", "none",
          "what the field gains around a circle beside its winding, in its own units: L for phi = x"},

      Key{"run.until", real, "", "this or run.steps", "time of the last row, rounded to whole steps", "time",
          not_negative},
      Key{"run.steps", integer, "", "this or run.until", "steps after row 0", "", count},
      Key{"run.seed", integer, "1", "", "seed of whatever is random", "", count},
      Key{"run.threads", integer, "1", "",
          "threads that long rows of explicit schemes, and wide levels of a finite complex, are shared by; the bits "
          "are "
          "the same for any number",
          "", threads},

      Key{"output.every", integer, "", "about 400 records",
          "record rows 0, every, 2 every, ... and the last; 0: the last", "", count},
      Key{"output.figures", toggle, "on", "", "draw figures (by gnuplot)"},
      Key{"output.format", KeyType::text, "png, svg", "", "of the figures: some of svg, png and pdf"},
      Key{"output.titles", toggle, "on", "", "titles above the figures; a paper has captions instead"},
      Key{"output.fields", toggle, "on", "", "write the recorded rows to fields.h5"},
      Key{"output.estimate", toggle, "off", "",
          "estimate the errors of the last row and of the measures by two more runs, at half and at a quarter of h and "
          "k; "
          "they cost twenty times the run"},
      Key{"output.times", KeyType::times, "", "six, evenly spread", "times of the waveforms figure: 0, 10, 20", "time",
          not_negative},

      Key{"output.checkpoint", real, "60", "", "save all that `delf resume` needs so often; 0: never", "seconds",
          not_negative},
      Key{"output.section", KeyType::text, "", "none",
          "a Poincare section: q1 = 0, p1 > 0; its points are in section.csv. Angles of the theory count modulo 2 pi"},

      Key{"verify.regions", KeyType::text, "", "rectangle staircase hole wall slab random",
          "kinds of regions, drawn from run.seed; or ROWSxSITES, such as 0:8x10:30-3:5x18:22, rows from each moment's "
          "first"},
      Key{"verify.variations", integer, "2", "", "pairs of first variations V, W of either sort for each region", "",
          one_or_more},
      Key{"verify.moments", integer, "8", "", "moments of the run, evenly spread, at which regions are drawn", "",
          one_or_more},
      Key{"verify.tolerance", real, "1e-13", "", "a sum that ought to be zero may be this, relative to its terms", "",
          positive},
      Key{"verify.checks", KeyType::text, "", "all that apply",
          "some of equations, forms, noether, balance, reversal, derivatives, newton"},
      Key{"verify.generator", KeyType::text, "", "none",
          "a symmetry to try, as the change of each field: 1, or -phi2, phi1"},
      Key{"verify.force", toggle, "off", "", "take Noether's sums even for what is found to be no symmetry"},
      Key{"verify.identify", toggle, "off", "",
          "say whose the rows of --fields are when their equations hold too; it is said whenever they fail"},
      Key{"verify.unwrap", toggle, "off", "",
          "rows of --fields are reduced modulo 2 pi: follow every value from row to row"},
      Key{"verify.fault", choice, "none", "",
          "plants a fault that must be found: variation, sign (of one derivative of L) or field (at one site)", "", any,
          faults()},

      Key{"sweep.jobs", integer, "", "one a core", "runs side by side", "", threads},
      Key{"sweep.keep", choice, "folders", "",
          "of each run: its folder, as of `delf run`, in runs/; or only its row of the table", "", any, sweep_keeps()},
      Key{"sweep.zip", toggle, "off", "",
          "take the values of several keys together, the first with the first, ..., not all pairs"},
      Key{"sweep.settings", KeyType::text, "", "none",
          "a CSV of runs: a line of keys, then a line of their values for each run"},
      Key{"sweep.resume", toggle, "on", "", "do not repeat the runs that DIR/sweep.rows has of these settings"},
      Key{"sweep.number", KeyType::text, "", "the first measure, or the error",
          "what is drawn, and bisected: a measure, or a number of summary.json"},
      Key{"sweep.bisect", KeyType::text, "", "none",
          "KEY=a:b finds where, between these values of the key, sweep.number passes sweep.level"},
      Key{"sweep.level", real, "", "halfway between the numbers at a and b", "the level", "", any},
      Key{"sweep.accuracy", real, "1e-3", "", "of the key: how long the last interval may be", "", positive},

      Key{"convergence.levels", integer, "4", "", "lines of the table, each with half of the steps of the one before",
          "", convergence_levels},
      Key{"convergence.order", real, "", "at least that of the scheme, where it is known",
          "the order that the last two lines must show: exit code 1 if they do not", "", positive},
      Key{"convergence.agreement", real, "0.2", "", "by how much the order may be off", "", positive},

      Key{"stability.schemes", KeyType::text, "", "eight, one of each sort, and the scene's own",
          "schemes, separated by commas, or all"},
      Key{"stability.waves", choice, "", "own where the density has second derivatives, else klein-gordon",
          "waves that limits are of: klein-gordon, at several mh; own, those of the scene's theory about 0, at its k",
          "", any, stability_wave_names()},
      Key{"stability.mass_steps", KeyType::text, "", "0.5, 1, 2.3", "values of mh at which limits are found"},
      Key{"stability.most_courant", real, "3", "",
          "Courant numbers are looked at up to this, c h/k of own waves of speed c; on a point, wh up to 8 unless it is "
          "given",
          "", positive},
      Key{"stability.steps", integer, "2000", "", "steps of a run from noise", "", Limits{100, 1e7}},
      Key{"stability.agreement", real, "0.01", "", "theory and runs may differ by this, relative", "", positive},
      Key{"stability.corners", KeyType::text, "", "all",
          "some of stiff, courant, fast-kink, amplitude, size, long, second-term, wave-map, resonance, angle; or none"},
      Key{"stability.budget", real, "1", "", "seconds for a corner before it is cut", "seconds", positive},
      Key{"stability.map", toggle, "on", "", "the map of Courant number and mh"},
      Key{"stability.fault", choice, "none", "", "plants a fault that must be found: limit", "", any,
          stability_fault_names()},

      Key{"workprecision.schemes", KeyType::text, "", "all",
          "names of schemes, of methods or of peers, separated by commas; peers: all of those"},
      Key{"workprecision.sites", KeyType::text, "", "chosen, as far as the budget goes", "the ladder: N, N, ..."},
      Key{"workprecision.courants", KeyType::text, "", "chosen; with workprecision.sites the scene's own",
          "h/k, h/k, ..."},
      Key{"workprecision.accuracies", KeyType::text, "", "1e-2, 1e-3, ..., 1e-10", "errors whose cost is asked for"},
      Key{"workprecision.repeats", integer, "5", "", "how often each run is timed", "", one_or_more},
      Key{"workprecision.budget", real, "100", "", "what all of it may take, nearly", "seconds", positive},
      Key{"workprecision.peers", toggle, "on", "",
          "other programs in the same run, where they have the scene's equation"},
  };
}

std::vector<Key> all_keys() {
  std::vector<Key> table = general_keys();
  for (const Declaration& declaration : declarations())
    for (const Parameter& p : declaration.parameters) {
      if (const auto known = std::ranges::find(table, p.key, &Key::name); known != table.end()) {
        // each of several methods has its own choices (Values::known): the table lists all of them
        for (const std::string& name : p.choices)
          if (std::ranges::find(known->choices, name) == known->choices.end()) known->choices.push_back(name);
        continue;
      }
      Key key = key_of(p);
      const Names owners = declared_by(p.key);
      if (declaration.kind == DeclaredBy::method)
        key.meaning = fmt::format("method = {}: {}", fmt::join(owners, " or "), key.meaning);
      if (declaration.kind == DeclaredBy::state && owners.size() == 1)
        key.meaning = fmt::format("state = {}: {}", owners.front(), key.meaning);
      if (declaration.kind == DeclaredBy::state && owners.size() > 1)
        key.fallback.clear(), key.otherwise = own;  // each has its own
      insert_key(table, std::move(key));
    }
  return table;
}

const std::vector<Key>& table() {
  static const std::vector<Key> keys = all_keys();
  return keys;
}

}  // namespace

Key key_of(const Parameter& p) {
  Key key{p.key,   KeyType::text, p.otherwise.empty() ? to_text(p.fallback) : "", p.otherwise, p.help, p.unit,
          p.range, p.choices};
  if (std::holds_alternative<double>(p.fallback)) key.type = real;
  if (!p.choices.empty()) key.type = choice;
  if (std::holds_alternative<int>(p.fallback)) {
    key.type = integer;
    key.range = {std::max(p.range.low, -largest_int), std::min(p.range.high, largest_int), p.range.open};
  }
  return key;
}

std::span<const Key> keys() { return table(); }

const Key* find_key(std::string_view name) {
  const auto key = std::ranges::find(table(), name, &Key::name);
  return key == table().end() ? nullptr : &*key;
}

std::string_view chosen_by(DeclaredBy kind) {
  if (kind == DeclaredBy::scene) return {};
  return kind == DeclaredBy::theory ? "theory.name" : kind == DeclaredBy::method ? "scheme.method" : "initial.state";
}

std::vector<Declaration> declarations() {
  std::vector<Declaration> all;
  for (const TheoryEntry* entry : theory_entries()) all.push_back({DeclaredBy::theory, entry->name, entry->parameters});
  for (const MethodEntry* entry : method_entries()) all.push_back({DeclaredBy::method, entry->name, entry->parameters});
  for (const StateEntry* entry : state_entries()) all.push_back({DeclaredBy::state, entry->name, entry->parameters});
  return all;
}

std::vector<std::string> declared_by(std::string_view key) {
  Names names;
  for (const Declaration& declaration : declarations())
    if (std::ranges::find(declaration.parameters, key, &Parameter::key) != declaration.parameters.end())
      names.emplace_back(declaration.name);
  return names;
}

void insert_key(std::vector<Key>& table, Key key) {
  if (const auto same = std::ranges::find(table, key.name, &Key::name); same != table.end()) {
    *same = std::move(key);
    return;
  }
  const auto last = std::find_if(table.rbegin(), table.rend(),
                                 [&](const Key& k) { return section_of(k.name) == section_of(key.name); });
  table.insert(last == table.rend() ? table.end() : last.base(), std::move(key));
}

std::string nearest_key(std::string_view unknown, std::span<const Key> known) {
  // without its section, or with a wrong one, a key is known by its last part: --sites, lattice.position
  const auto last = [](std::string_view name) { return name.substr(name.rfind('.') + 1); };
  Names full, same_last;
  for (const Key& key : known) {
    full.emplace_back(key.name);
    if (last(key.name) == last(unknown)) same_last.emplace_back(key.name);
  }
  if (const auto close = nearest(unknown, full)) return *close;
  if (!same_last.empty()) return same_last.front();
  Names lasts;
  for (const Key& key : known) lasts.emplace_back(last(key.name));
  const auto close = nearest(last(unknown), lasts);
  const auto at = close ? std::find(lasts.begin(), lasts.end(), *close) : lasts.end();
  return at == lasts.end() ? std::string() : full[static_cast<std::size_t>(at - lasts.begin())];
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "jets/expressions/stencil_text.hpp"
#include "jets/tables/named_tables.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"
#include "schemes/states/state_registry.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/scene/program_keys.hpp"

namespace delf {

namespace {

using KeyNames = std::vector<std::string>;

KeyNames stencil_choices() {
  KeyNames names = stencil_names_and_aliases();
  names.emplace_back(stencil_as_text);
  return names;
}

KeyNames start_rules() {
  KeyNames names;
  for (const StartRule rule : all_start_rules) names.emplace_back(to_string(rule));
  return names;
}

/// The names of entries: to make every theory for its name would cost each start of the program.
template <class Entries>
KeyNames names_of(const Entries& entries) {
  KeyNames names;
  for (const auto* entry : entries) names.push_back(entry->name);
  return names;
}

/// "legendre for method = a or b; else …"
std::string usual_start() {
  std::string text;
  for (const StartRule rule : all_start_rules) {
    KeyNames names;
    for (const MethodEntry* entry : method_entries())
      if (entry->start == rule) names.push_back(entry->name);
    if (!names.empty()) text += fmt::format("{} for method = {}; ", to_string(rule), fmt::join(names, " or "));
  }
  return text + "else exact where the second row is known, or centred";
}

constexpr double largest_count = 9007199254740992;  // 2⁵³: every integer below it is a double

}  // namespace

std::vector<Parameter> scene_keys() {
  return {
      {.key = "theory.name",
       .fallback = "sine-gordon",
       .help = "the field theory; see `delf list theories`",
       .choices = names_of(theory_entries())},
      {.key = "theory.fibre",
       .fallback = "R",
       .help = "where the field has its values: the line, or the circle of angles",
       .choices = {"R", "S1"}},
      {.key = "theory.speed",
       .fallback = 0.0,
       .help = "units of rows of --fields: the speed of waves there, c in phi_tt = c^2 phi_xx",
       .unit = "length/time",
       .range = {.low = 0, .open = true},
       .otherwise = "1"},
      {.key = "theory.scale",
       .fallback = 0.0,
       .help = "units of rows of --fields: their values, of phi or q, "
               "over those of the theory; its cube is G M of kepler",
       .range = {.low = 0, .open = true},
       .otherwise = "1"},

      {.key = "lattice.stencil",
       .fallback = "rectangle-symmetric",
       .help = "stencil and jet; see `delf list stencils`",
       .choices = stencil_choices()},
      {.key = "lattice.space",
       .fallback = "circle",
       .help = "the shape of space",
       .choices = {"circle", "interval", "point", "complex"}},
      {.key = "lattice.length",
       .fallback = 0.0,
       .help = "L",
       .unit = "length",
       .range = {.low = 0, .open = true},
       .otherwise = "must be given, but for a point"},
      {.key = "lattice.sites",
       .fallback = 0,
       .help = "N; on an interval both walls are counted",
       .range = {.low = 2},
       .otherwise = "must be given, but for a point"},
      {.key = "lattice.courant",
       .fallback = 0.0,
       .help = "h/k",
       .range = {.low = 0, .open = true},
       .otherwise = "this or lattice.time_step"},
      {.key = "lattice.time_step",
       .fallback = 0.0,
       .help = "h; a negative one runs backward, with initial.state = file from the last rows of the file",
       .unit = "time",
       .otherwise = "this or lattice.courant"},
      {.key = "lattice.mesh",
       .fallback = "",
       .help = "a mesh file (text, Gmsh MSH 2.2 or 4.1), a file of sites and stencils in spacetime, or "
               "icosahedron:LEVEL, graded:LENGTH,POINTS,RATIO, rectangle:WIDTH,HEIGHT,NX,NY, "
               "quadrilaterals:WIDTH,HEIGHT,NX,NY, or of spacetime refined:LENGTH,DURATION,NX,NT",
       .otherwise = "must be given with space = complex"},
      {.key = "lattice.merge",
       .fallback = 0.0,
       .help = "points of a mesh file no further apart are one; 0: points "
               "at one place stay apart, as on both sides of a slit",
       .unit = "length",
       .range = {.low = 0},
       .otherwise = "points at one place are refused"},
      {.key = "lattice.time",
       .fallback = "rows",
       .help = "on a mesh: all sites row by row, none (data all round: an "
               "elliptic problem), or each of its cells by its own step",
       .choices = {"rows", "none", "cells"}},
      {.key = "lattice.time_steps",
       .fallback = "",
       .help = "reversible: steps that the field chooses, lattice.time_step at most, on a "
               "mesh and with r-adaptive; or on a mesh steps of the rows, over and over, "
               "0.1, 0.05, or a file of them, in place of lattice.time_step",
       .otherwise = "none"},
      {.key = "lattice.step_control",
       .fallback = 1.0,
       .help = "s of reversible steps: lattice.time_step / sqrt(1 + s^2 <phi_t^2>), with "
               "the mean over the mesh; of r-adaptive <phi_x^2> over the cells: s = "
               "mesh.alpha has steps in proportion to them; usually 0.1 to 10",
       .range = {.low = 0, .high = 1e6, .open = true}},

      {.key = "scheme.method",
       .fallback = "multisymplectic",
       .help = "the scheme; see `delf list schemes`",
       .choices = names_of(method_entries())},
      {.key = "scheme.tolerance",
       .fallback = 1e-14,
       .help = "an implicit step ends when its next change is below this times "
               "what the field spans; rounding allows 8.9e-16 at least",
       .range = {.low = 0, .high = 0.01, .open = true}},
      {.key = "scheme.seed_order",
       .fallback = 8,
       .help = "rows that the first guess of an implicit step is extrapolated from",
       .range = {.low = 0, .high = 8}},
      {.key = "scheme.max_iterations",
       .fallback = 50,
       .help = "iterations of an implicit step before it has failed",
       .range = {.low = 1}},

      {.key = "initial.state",
       .fallback = "",
       .help = "the state to start from; see `delf list states`",
       .choices = names_of(state_entries()),
       .otherwise = "must be given"},
      {.key = "initial.start",
       .fallback = "",
       .help = "what gives row 1",
       .choices = start_rules(),
       .otherwise = usual_start()},

      {.key = "boundary.left",
       .fallback = "fixed",
       .help =
           "the left wall of an interval: phi is kept, or phi and phi_x (clamped), or nothing, or phi moves by a formula "
           "of t, 1.8*sin(0.9*t); an end of a beam is hinged where it is fixed, and free where it is natural",
       .choices = {"fixed", "clamped", "natural", formula_choice}},
      {.key = "boundary.right",
       .fallback = "fixed",
       .help = "the right wall of an interval, likewise",
       .choices = {"fixed", "clamped", "natural", formula_choice}},
      {.key = "boundary.left.flux",
       .fallback = "",
       .help = "what flows in at a natural left wall, dl/dphi_x as a formula of t: the slope of a wave along the outer "
               "normal, and the force on it; of several fields separated by semicolons",
       .otherwise = "nothing"},
      {.key = "boundary.right.flux",
       .fallback = "",
       .help = "what flows in at a natural right wall, likewise",
       .otherwise = "nothing"},
      {.key = "boundary.mesh",
       .fallback = "fixed",
       .help = "the boundary of a mesh; boundary.NAME is a part of it, also a formula of t, x, y, z or periodic:PART; "
               "boundary.NAME.flux flows in there; boundary.part.NAME has the name of another key",
       .choices = {"fixed", "natural"}},
      {.key = "boundary.winding",
       .fallback = 0,
       .help = "what the field gains around a circle, in units of 2 pi",
       .otherwise = states_own},
      {.key = "boundary.gain",
       .fallback = 0.0,
       .help = "what the field gains around a circle beside its winding, in its own units: L for phi = x",
       .otherwise = "none"},

      {.key = "run.until",
       .fallback = 0.0,
       .help = "time of the last row, rounded to whole steps",
       .unit = "time",
       .otherwise = "this or run.steps"},
      {.key = "run.steps",
       .fallback = 0,
       .help = "steps after row 0",
       .range = {.low = 0, .high = largest_count},
       .otherwise = "this or run.until"},
      {.key = "run.seed",
       .fallback = 1,
       .help = "seed of whatever is random",
       .range = {.low = 0, .high = largest_count}},
      {.key = "run.threads",
       .fallback = 1,
       .help = "threads that long rows, and wide levels of a finite complex, are shared by; the "
               "bits are the same for any number",
       .range = {.low = 1, .high = 1024}},

      {.key = "output.every",
       .fallback = 0,
       .help = "record rows 0, every, 2 every, ... and the last; 0: the last",
       .range = {.low = 0, .high = largest_count},
       .otherwise = "about 400 records"},
      {.key = "output.figures", .fallback = "on", .help = "draw figures (by gnuplot)", .choices = on_or_off},
      {.key = "output.format", .fallback = "png, svg", .help = "of the figures: some of svg, png and pdf"},
      {.key = "output.titles",
       .fallback = "on",
       .help = "titles above the figures; a paper has captions instead",
       .choices = on_or_off},
      {.key = "output.fields", .fallback = "on", .help = "write the recorded rows to fields.h5", .choices = on_or_off},
      {.key = "output.xdmf",
       .fallback = "off",
       .help = "write what ParaView opens fields.h5 by: fields.xdmf, a series of rows, and surface.xdmf, over x "
               "and t; a mesh always has the first",
       .choices = on_or_off},
      {.key = "output.report",
       .fallback = "off",
       .help = "make a page of the results, report.html, as `delf report` does",
       .choices = on_or_off},
      {.key = "output.film",
       .fallback = "off",
       .help = "make a film of the recorded rows, film.mp4 or film.gif, as `delf film` does; a run that is not over is "
               "not filmed",
       .choices = on_or_off},
      {.key = "output.estimate",
       .fallback = "off",
       .help = "estimate the errors of the last row and of the measures by two more runs, "
               "at half and at a quarter of h and k; they cost twenty times the run",
       .choices = on_or_off},
      {.key = "output.modified",
       .fallback = 0,
       .help =
           "record the energy and momentum of the modified Lagrangian (`delf plan --modified`) of this order, 2, 4 or "
           "6; 0: neither",
       .range = {.low = 0, .high = 6}},
      {.key = "output.times",
       .fallback = "",
       .help = "times of the waveforms figure: 0, 10, 20",
       .unit = "time",
       .range = {.low = 0},
       .otherwise = "six, evenly spread"},
      {.key = "output.checkpoint",
       .fallback = 60.0,
       .help = "save all that `delf resume` needs so often; 0: never",
       .unit = "seconds",
       .range = {.low = 0}},
      {.key = "output.section",
       .fallback = "",
       .help = "a Poincare section: q1 = 0, p1 > 0; its points are in "
               "section.csv. Angles of the theory count modulo 2 pi",
       .otherwise = "none"},
      {.key = "figures.spectrum",
       .fallback = "off",
       .help = "draw |phi_k| over the wave number k, in the beginning and in the end, and the frequencies of the "
               "lattice's waves",
       .choices = on_or_off},
  };
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/help.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "tools/commands.hpp"
#include "tools/measure/measurement.hpp"
#include "tools/report/text_columns.hpp"
#include "tools/scene/keys.hpp"

namespace delf {

namespace {

// "one of R, S1"; "above 0"; "from 0 to 8"; empty for any value
std::string values_of(const Parameter& key) {
  constexpr std::size_t most = 8;  // `delf list` has those that are many
  constexpr double large = 1e9;    // limits of what can be computed with say nothing here
  if (!key.choices.empty() && key.choices.size() <= most)
    return fmt::format("; one of {}", fmt::join(key.choices, ", "));
  const bool low = std::abs(key.range.low) < large, high = std::abs(key.range.high) < large;
  const std::string from = fmt::format("{} {}", key.range.open ? "above" : "at least", key.range.low);
  if (low && high) return fmt::format("; {}, at most {}", from, key.range.high);
  return low ? "; " + from : high ? fmt::format("; at most {}", key.range.high) : "";
}

constexpr std::size_t width = 100;  ///< of all that help prints

/// A first line behind what it begins with, and further ones indented as far as `indent`.
void print_hanging(const std::string& begin, const std::string& text, std::size_t indent) {
  std::string before = begin;
  for (const std::string& line : wrapped(text, width - indent)) {
    fmt::print("{}{}\n", before, line);
    before.assign(indent, ' ');
  }
}

/// Text with lines of at most `width` columns: paragraphs are filled, and a line that is indented, or aligned by blanks,
/// stays one, broken where it is longer.
void print_filled(std::string_view text) {
  std::string paragraph;
  const auto put = [&] {
    print_hanging("", paragraph, 0);
    paragraph.clear();
  };
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
    if (const std::size_t gap = line.find("  ", indent); line.empty() || indent > 0 || gap != line.npos) {
      put();
      const std::size_t column =
          gap == line.npos ? indent + 2 : std::min(line.find_first_not_of(' ', gap), line.size());
      if (columns_of(line) <= width) fmt::print("{}\n", line);
      else
        print_hanging(std::string(line.substr(0, gap == line.npos ? indent : column)),
                      std::string(line.substr(gap == line.npos ? indent : column)), column);
    } else {
      paragraph += (paragraph.empty() ? "" : " ") + std::string(line);
    }
  }
  put();
}

/// The purpose of the keys of a section.
constexpr std::pair<std::string_view, const char*> purposes[] = {
    {"theory", "the field theory, its parameters, or its density as text"},
    {"lattice", "the stencil, space and its sites, the step in time"},
    {"scheme", "the method, and how it solves a step"},
    {"initial", "the fields that a run starts from"},
    {"boundary", "the ends of an interval, the boundary of a mesh, the gain around a circle"},
    {"run", "how far, with which random numbers, on how many threads"},
    {"output", "what is recorded, drawn and written"},
    {"figures", "which figures are drawn beside the usual ones"},
    {"stencil", "a stencil of your own"},
    {"mesh", "sites that move with the field"}};

/// "scheme.method = composition" of a help that begins with "method = composition: ", and the help without it.
std::pair<std::string, std::string> reader_of(const Parameter& key) {
  for (const std::string chooser : {"scheme.method", "initial.state"}) {
    const std::string begin = chooser.substr(chooser.find('.') + 1) + " = ";
    const auto end = key.help.find(": ");
    if (key.help.starts_with(begin) && end != key.help.npos)
      return {chooser.substr(0, chooser.find('.') + 1) + key.help.substr(0, end), key.help.substr(end + 2)};
  }
  return {"", key.help};
}

void print_key(const Parameter& key, const std::string& help) {
  const auto value = key.otherwise.empty() ? fallback_of(key) : key.otherwise;
  print_hanging(
      fmt::format("  {:<22} ", key.key),
      fmt::format("{}{} ({}{})", help, key.unit.empty() ? "" : fmt::format(" [{}]", key.unit), value, values_of(key)),
      25);
}

// A command with a section of its own lists that section's keys; other commands list the keys that all share. In a
// section the keys that one method or one state reads come last, together.
void print_keys(std::string_view only) {
  std::vector<std::string_view> sections;
  for (const Parameter& key : keys()) {
    const auto of = section_of(key.key);
    const bool elsewhere = std::ranges::any_of(commands(), [&](const Command& c) { return c.section == of; });
    if (only.empty() ? elsewhere : of != only) continue;
    if (std::ranges::find(sections, of) == sections.end()) sections.push_back(of);
  }
  for (const std::string_view section : sections) {
    const auto purpose = std::ranges::find(purposes, section, &std::pair<std::string_view, const char*>::first);
    fmt::print("\n[{}]{}\n", section, purpose == std::end(purposes) ? "" : fmt::format("  {}", purpose->second));
    std::vector<std::string> readers{""};
    for (const Parameter& key : keys())
      if (const std::string reader = reader_of(key).first;
          section_of(key.key) == section && std::ranges::find(readers, reader) == readers.end())
        readers.push_back(reader);
    for (const std::string& reader : readers) {
      if (!reader.empty()) print_hanging("  with ", reader + ":", 7);
      for (const Parameter& key : keys())
        if (const auto [of, help] = reader_of(key); section_of(key.key) == section && of == reader)
          print_key(key, help);
    }
  }
}

/// `delf help KEY`: the key, and each of its values on a line of its own.
void print_values(const Parameter& key) {
  print_hanging(
      "", fmt::format("{}{}{}", key.help, key.unit.empty() ? "" : fmt::format(" [{}]", key.unit), values_of(key)), 0);
  const std::string value = key.otherwise.empty() ? fallback_of(key) : key.otherwise;
  if (!value.empty()) print_hanging("If it is not given: ", value, 4);
  for (const std::string& choice : key.choices) fmt::print("  {}\n", choice);
}

constexpr const char* lagrangians =
    R"page(A Lagrangian density of your own is a key of a scene; equations, Jacobian, forms and plan are generated from it:

  [theory]
  density = 0.5*phi_t^2 - 0.5*phi_x^2 + m^2*(cos(phi) - 1)
  parameters = m = 1

Each parameter is a key of its own, which the command line can set: --theory.m=2. Without theory.fields there is one field,
phi. Several are named by it:

  [theory]
  fields = u, v
  parameters = m = 1, g = 0.3
  density = let w = u - v; 0.5*(u_t^2 - u_x^2 + v_t^2 - v_x^2) + m^2*(cos(u) + cos(v) - 2) + g*(cos(w) - 1)

Names      u, its derivatives u_t, u_x, and u_tt, u_tx, u_xx (on a stencil that has them); t, x, pi; parameters
Numbers    2, 0.5, 1e-3
Operators  + - * / ^, from weak to strong; -x^2 is -(x^2), 2^3^2 is 2^(3^2)
Functions  sin cos cosm1 (cos x - 1) tan exp log sqrt sinh cosh tanh atan, pow(x, p) as x^p
let        let w = ...; defines a name for the rest of the text; in C++ the end of a line will do for the semicolon

  text    = { "let" name "=" sum ";" } sum
  sum     = product { ("+" | "-") product }
  product = signed { ("*" | "/") signed }
  signed  = { "+" | "-" } power
  power   = primary [ "^" { "+" | "-" } power ]
  primary = number | name | function "(" sum [ "," sum ] ")" | "(" sum ")"

Constraints are kept at every site, by a multiplier each; symmetries, one change for each field, are tested before a run,
and conserve what series.csv and `delf verify` then show (Noether). Several of both are separated by semicolons:

  fields = u, v
  constraint = u^2 + v^2 - 1
  symmetry = -v, u

On lattice.space = point a field may be called x. Every field needs its rate: a density without phi_t determines no phi;
where phi_t occurs only linearly, as in 0.5*phi_x*phi_t, phi alone is the start. abs, min and max are refused, for they are not
differentiable. Where a density has no value at a field (log of a negative number), a run ends with exit code 3, and
says which part has none. Numbers of a scene may be formulas of numbers, pi and parameters: length = 2*pi, until = 10*sqrt(2).
`delf plan` prints the field equations of a density, and those of the stencil; with --latex for a paper.

Starting fields may be formulas too, of x, the parameters and the length L of space; or of t and x, for a solution to start
from and to compare with. In place of initial.state:

  [initial]                                                [exact]
  phi = 4*atan(exp(x - 20))                                phi = 4*atan(exp((x - 20 - 0.5*t)/sqrt(0.75)))
  phi_t = 0

Momenta dL/dq_t may take the place of rates on a point: p = 0.1, 0. An end of an interval may be a formula of t: it then moves
so, or that flows in (the slope of phi along the outer normal):

  [boundary]                                               [boundary]
  left = 1.8*sin(0.9*t)                                    left.flux = 0.5*sin(0.9*t)

A stencil may be text too: its sites, (time, space), and at each quadrature point a weight, and the jet there as a weight of
each site for h = k = 1. Points are lines of their own:

  [stencil]
  sites = (0,0) (1,0) (1,1)
  point = 1; phi: 1/3 1/3 1/3; phi_t: -1 1 0; phi_x: 0 -1 1

An action without jets is a function of the values at those sites, y1, y2, ..., of h and k, in place of the points; the
density then says what is measured. This is leapfrog, one cell's share of each edge and corner:

  [theory]
  lagrangian = h*k*(0.25*((y2 - y1)^2 + (y4 - y3)^2)/h^2 - 0.25*((y3 - y1)^2 + (y4 - y2)^2)/k^2
               + 0.25*(cos(y1) + cos(y2) + cos(y3) + cos(y4)) - 1)

  [stencil]
  sites = (0,0) (1,0) (0,1) (1,1)

theory.equation = phi_tt - phi_xx + sin(phi) = 0 is tested: by Helmholtz's conditions whether any density has it, and whether
theory.density does. exact.phi is tested at random points, and theory.lagrangian by what it tends to for small h and k.
Friction has no density: phi_tt + g*phi_t + sin(phi) = f*cos(t) is refused. With the factor exp(g*t) on all of the density
friction -g phi_t follows; a drive f(t) is a term f(t)*phi; phi_t*phi is a divergence, which adds nothing.

theory.angles = phi says that values 2 pi apart are the same state: sections, measures and figures count modulo 2 pi then.

The states noise and file work for every theory. From C++:

  auto scheme = delf::Scheme{delf::hexagon, delf::expression("0.5*phi_t^2 - 0.5*phi_x^2 - 0.25*(phi^2 - 1)^2")};

Examples: `delf run phi6-kink`, `delf run liouville`, `delf run born-infeld`, `delf run wave-map-text`, `delf run toda-chain`,
`delf run coupled-pendula`.
)page";

constexpr const char* measures_head =
    R"page(Numbers of a run are keys of a scene, of any name: expressions of measurements. They are in its summary.json, and
`delf sweep` draws and bisects them:

  [measure]
  outgoing = speed(-1)
  kinks = kinks
  loss = 1 - energy_left(L)/16

)page";
constexpr const char* measures_foot = R"page(
[level]: may be left out. All are of the first field. Extremes, crossings, frequencies and lines see all steps, the others the
recorded rows (output.every); without an answer there is null. Their numbers, and what is made of them, are sums,
products, powers and functions as in `delf help lagrangians`, of theory.NAME as NAME, L, pi, and t, the time of the last row.
)page";

// The measures, from the table of measurements.
std::string measures() {
  std::string text = measures_head;
  for (const MeasurementEntry& m : measurements())
    text += fmt::format("  {:<24} {}\n", *m.arguments ? fmt::format("{}({})", m.name, m.arguments) : m.name, m.help);
  return text + measures_foot;
}

/// A subject that help explains besides commands.
struct Topic {
  const char *name, *summary;
  std::string (*text)();
};
constexpr Topic topics[] = {{"lagrangians", "a theory of your own, as text", [] { return std::string(lagrangians); }},
                            {"measures", "numbers of a run, as text", measures}};

}  // namespace

std::string usage() {
  std::string text = "delf: a discrete multisymplectic lattice engine\n\n";
  constexpr std::size_t column = 55;
  // A summary begins below a usage that is too long, and goes on in its column.
  const auto add = [&](const std::string& words, const std::string& summary) {
    std::string before = fmt::format("  {:<{}}", words, column - 2);
    if (words.size() + 3 > column) before = "  " + words + "\n" + std::string(column, ' ');
    for (const std::string& line : wrapped(summary, width - column)) {
      text += before + line + "\n";
      before.assign(column, ' ');
    }
  };
  for (const Command& c : commands()) add(c.usage, c.summary);
  for (const Topic& t : topics) add(fmt::format("delf help {}", t.name), t.summary);
  return text + "  delf --version\n\nSCENE is a file, or the name of a shipped scene: `delf run collision`.\n";
}

ExitCode help(const std::string& name) {
  if (name.empty()) {
    fmt::print(
        "{}`delf help run` lists the keys of a scene, `delf help SECTION` those of a section, and\n"
        "`delf help KEY` the values of one.\n",
        usage());
    return ExitCode::done;
  }
  for (const Topic& topic : topics)
    if (name == topic.name) {
      print_filled(topic.text());
      return ExitCode::done;
    }
  if (const Parameter* key = find_key(name)) {
    print_values(*key);
    return ExitCode::done;
  }
  constexpr std::string_view of_boundary = "boundary.";
  if (name.starts_with(of_boundary)) {  // a part of a mesh's boundary, of any name
    print_values(*find_key("boundary.mesh"));
    return ExitCode::done;
  }
  const bool is_command = std::ranges::find(commands(), name, &Command::name) != std::ranges::end(commands());
  if (!is_command &&
      std::ranges::find(keys(), name, [](const Parameter& key) { return section_of(key.key); }) != keys().end()) {
    print_keys(name);
    return ExitCode::done;
  }
  const Command& command = find_command(name);
  fmt::print("{}\n\n", command.usage);
  print_filled(command.details);
  if (command.reads_scene || !command.section.empty()) print_keys(command.section);
  return ExitCode::done;
}

}  // namespace delf

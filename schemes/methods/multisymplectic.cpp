// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>
#include <variant>

#include "jets/expressions/field_equation.hpp"
#include "jets/expressions/stencil_expression.hpp"
#include "jets/expressions/stencil_text.hpp"
#include "jets/tables/density_on_table.hpp"
#include "jets/tables/named_tables.hpp"
#include "lattice/error.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/families/wall_families.hpp"
#include "schemes/methods/mesh_rows.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_on_space.hpp"
#include "schemes/theory_numbers.hpp"
#include "schemes/unknown_name.hpp"

namespace delf {
namespace {

/// Refuses walls whose effect on a scheme its stencils cannot see.
void check_walls(const Problem& p, const StencilFamily& family) {
  const auto [least, most] = std::ranges::minmax(family.pattern().vertices, {}, &Site::space);
  const int width = most.space - least.space;
  if (p.lattice.space() == Space::point ? width > 0 : width == 0)
    throw BadInput("lattice.stencil",
                   width > 0 ? fmt::format("lattice.stencil = {}: has sites side by side, and on lattice.space = point "
                                           "there is one; use midpoint, trapezoidal or vertex",
                                           p.stencil)
                             : fmt::format("lattice.stencil = {}: is for mechanics and couples no neighbours; use "
                                           "rectangle-symmetric, or lattice.space = point",
                                           p.stencil));
  const DensityOnTable* jets = family.made_of();
  if (p.lattice.space() == Space::interval && !(jets ? fits_between_walls(jets->table) : width < 2))
    throw BadInput(
        "lattice.stencil",
        fmt::format("lattice.stencil = {}: on an interval stencils wider than a cell leave part of the cells "
                    "at the walls out of the action, unless they have three columns around their middle; use "
                    "triangle, rectangle, rectangle-symmetric, six-tuple or nine-tuple, or lattice.space = circle",
                    p.stencil));
  for (const auto& [wall, key] : {std::pair{p.lattice.left(), "boundary.left"}, {p.lattice.right(), "boundary.right"}})
    if (wall == Wall::clamped && width < 2 && p.lattice.space() == Space::interval)
      throw BadInput(key,
                     fmt::format("{} = clamped: keeps phi_x too, which is for densities with second derivatives on "
                                 "stencils that have them; use fixed or natural, or six-tuple or nine-tuple",
                                 key));
}

constexpr auto left_slope = "boundary.left_slope", right_slope = "boundary.right_slope";

/// φ_x at clamped walls, as numbers of text, one for each field.
WallSlopes slopes_of(const FieldTheory& theory, const Problem& p) {
  const auto read = [&](const char* key) {
    const auto text = p.parameters.maybe<std::string>(key);
    if (!text || text->empty()) return std::vector<double>{};
    std::vector<double> slopes;
    std::istringstream in(*text);
    for (std::string part; std::getline(in, part, ',');) {
      std::istringstream number(part);
      double slope = 0;
      if (!(number >> slope) || !(number >> std::ws).eof() || !std::isfinite(slope))
        throw BadInput(key, fmt::format("{} = {}: is a number for each field, separated by commas", key, *text));
      slopes.push_back(slope);
    }
    if (static_cast<int>(slopes.size()) != theory.components())
      throw BadInput(key, fmt::format("{} = {}: has {} numbers, and the theory {} fields; give one for each", key,
                                      *text, slopes.size(), theory.components()));
    return slopes;
  };
  return {read(left_slope), read(right_slope)};
}

constexpr auto sites_key = "stencil.sites", point_key = "stencil.point", lagrangian_key = "theory.lagrangian",
               first_row_key = "lattice.first_row";

/// The bricks where row 0 is an odd row of a brick wall: they lie one site further on, and their vertices move to the
/// left of the anchor, so that the first column still has one:
///
///     {0, 1, 2} where i + j is even   →   {−1, 0, 1} where i + j is even,  that is {0, 1, 2} where i + j is odd
///
std::shared_ptr<const StencilFamily> from_odd_row(const FieldTheory& theory, const StencilFamily& even) {
  const DensityOnTable* jets = even.made_of();
  if (!jets || even.pattern().placement != Placement::brick_wall) return nullptr;
  StencilTable table = jets->table;
  for (Site& vertex : table.pattern.vertices) --vertex.space;
  for (TablePoint& point : table.points) --point.space;
  return theory.on_table(std::move(table));
}

/// The sum −1/(hk) Σ ∂L/∂y over the stencils of a site, on the Taylor polynomial of a jet about it, with a bound of its
/// rounding.
struct DiscreteForce {
  double value = 0, rounding = 0;
};
DiscreteForce discrete_force(const StencilFamily& family, std::span<const double> jet, double h, double k) {
  const auto& sites = family.pattern().vertices;
  const std::size_t n = sites.size();
  std::vector<double> y(n), r(n), J(n * n);
  DiscreteForce force;
  for (std::size_t l = 0; l < n; ++l) {
    double largest = 0;
    for (std::size_t m = 0; m < n; ++m) {
      const double t = (sites[m].time - sites[l].time) * h, x = (sites[m].space - sites[l].space) * k;
      y[m] = 0;
      double over = 1;  // o!
      std::size_t at = 0;
      for (int o = 0; at < jet.size(); over *= ++o) {
        double binomial = 1;
        for (int in_x = 0; in_x <= o; binomial *= static_cast<double>(o - in_x) / (in_x + 1), ++in_x)
          y[m] += jet[at++] * binomial * std::pow(t, o - in_x) * std::pow(x, in_x) / over;
      }
      largest = std::max(largest, std::abs(y[m]));
    }
    const Cell cell{h, k, 0, 0};
    family.residual(cell, y, r), family.jacobian(cell, y, J);
    force.value -= r[l] / (h * k);
    for (std::size_t m = 0; m < n; ++m)
      force.rounding += std::abs(J[l * n + m]) * largest * 16 * std::numeric_limits<double>::epsilon() / (h * k);
  }
  return force;
}

/// The action does not read k: it is that of a chain, which is no lattice of a field that varies in space.
bool is_chain(const StencilFamily& family) {
  std::vector<double> y, r(family.pattern().vertices.size()), again(r);
  for (std::size_t m = 0; m < r.size(); ++m) y.push_back(0.3 + 0.1 * std::sin(2.0 * static_cast<double>(m)));
  family.residual({0.1, 0.5, 0, 0}, y, r), family.residual({0.1, 0.25, 0, 0}, y, again);
  return r == again;
}

/// An action on values has the equations of the density as h and k tend to 0 together: tried on fields at random.
void require_action_of(const FieldTheory& theory, const StencilFamily& family, const Problem& p) {
  const auto equations = FieldEquations::of(theory.density());
  if (!equations || theory.constraint() || p.time_step == 0) return;
  const bool chain = is_chain(family), uniform = chain || p.lattice.space() == Space::point;
  const double k = chain ? 1 : p.lattice.space_step(), courant = p.time_step / p.lattice.space_step();
  std::mt19937_64 random(1);
  struct Tried {
    std::vector<double> jet;
    double limit, equation, rounding;
  };
  std::vector<Tried> all;
  double scale = 0;
  constexpr int fields = 24;
  for (int f = 0; f < fields; ++f) {
    // half of them where logarithms and roots have values
    std::uniform_real_distribution<double> anything(f % 2 ? -1 : 0, f % 2 ? 1 : 2);
    std::vector<double> jet(derivatives_up_to(equations->order()));
    for (double& value : jet) value = anything(random);
    std::size_t at = 0;
    for (int o = 0; uniform && at < jet.size(); ++o)
      for (int in_x = 0; in_x <= o; ++in_x, ++at)
        if (in_x > 0) jet[at] = 0;
    std::array<DiscreteForce, 3> D;
    for (std::size_t n = 0; n < D.size(); ++n) {
      const double s = std::ldexp(1.0, -5 - 2 * static_cast<int>(n));
      D[n] = uniform ? discrete_force(family, jet, s, k) : discrete_force(family, jet, courant * s, s);
    }
    // the limit of D₀ + a sᵖ, by Aitken
    const double last = D[2].value - D[1].value, before = D[1].value - D[0].value, bend = last - before;
    const bool settled = std::abs(last) <= D[2].rounding + D[1].rounding || std::abs(last) > 0.9 * std::abs(before);
    const double limit = D[2].value - (settled ? 0 : last * last / bend);
    const auto [equation, absolute] = (*equations)(jet, 0, 0).front();
    if (!std::isfinite(limit) || !std::isfinite(absolute)) continue;
    scale = std::max({scale, absolute, std::abs(limit)});
    all.push_back({jet, limit, equation, D[2].rounding});
  }
  constexpr double agreement = 1e-3;
  for (const Tried& tried : all)
    if (std::abs(tried.limit - tried.equation) > agreement * scale + tried.rounding)
      throw BadInput(
          lagrangian_key,
          fmt::format("{}: is no action of the density: at phi = {:.3g}, phi_t = {:.3g}, phi_x = {:.3g}, phi_tt = "
                      "{:.3g}, phi_tx = {:.3g}, phi_xx = {:.3g} the field equation of the density gives {:.6g}, "
                      "and {:.6g} is what that of the action tends to for small h and k; correct one of them",
                      lagrangian_key, tried.jet[0], tried.jet[1], tried.jet[2], tried.jet[3], tried.jet[4],
                      tried.jet[5], tried.equation, tried.limit));
}

/// L(y1, …, yn; h, k) on the sites of a stencil as text, as it is; numbers of the theory by their names. Its density says
/// what is measured.
std::shared_ptr<const StencilFamily> on_values(const FieldTheory& theory, const Problem& p,
                                               const std::string& lagrangian, const std::string& sites) {
  if (p.parameters.has(point_key))
    throw BadInput(lagrangian_key, fmt::format("{}: is an action by itself, and {} makes another; leave one out",
                                               lagrangian_key, point_key));
  if (theory.components() > 1)
    throw BadInput(lagrangian_key, fmt::format("{}: is for one field, and the theory has {}; use {}", lagrangian_key,
                                               theory.components(), point_key));
  auto family = std::make_shared<LagrangianFamily<StencilExpression>>(StencilExpression::lagrangian(
      lagrangian, StencilPattern(stencil_sites(sites, sites_key)), theory_numbers(p.parameters), lagrangian_key));
  require_action_of(theory, *family, p);
  return family;
}

/// The action on the stencil that the scene gives as text.
std::vector<std::shared_ptr<const StencilFamily>> on_own_stencil(const FieldTheory& theory, const Problem& p) {
  const auto text_of = [&](const char* key) {
    const auto text = p.parameters.maybe<std::string>(key);
    if (!text)
      throw BadInput(
          key, fmt::format("{}: must be given for lattice.stencil = {}; see `delf help lagrangians`", key, p.stencil));
    return *text;
  };
  const std::string sites = text_of(sites_key);
  if (const auto lagrangian = p.parameters.maybe<std::string>(lagrangian_key))
    return {on_values(theory, p, *lagrangian, sites)};
  const std::string points = text_of(point_key);
  return {theory.on_table(stencil_of(sites, points, sites_key, point_key))};
}

SchemeParts multisymplectic_parts(const FieldTheory& theory, const Problem& p) {
  if (p.lattice.mesh()) return rows_on_mesh(theory, p);
  if (p.step_control || !p.time_steps.empty())
    throw BadInput(
        "lattice.time_steps",
        "lattice.time_steps: scheme.method = multisymplectic has steps of one length; use scheme.method = r-adaptive with "
        "reversible steps, or a mesh, or leave it out");
  const bool own = p.stencil == stencil_as_text;
  SchemeParts parts{own ? on_own_stencil(theory, p) : std::vector{theory.variational(p.stencil)}, theory.fields(),
                    theory.symmetries()};
  if (!parts.families[0]) throw unknown_name("lattice.stencil", p.stencil, stencil_names_and_aliases());
  if (p.parameters.maybe<int>(first_row_key) == 1)
    if (parts.families[0] = from_odd_row(theory, *parts.families[0]); !parts.families[0])
      throw BadInput(first_row_key,
                     fmt::format("lattice.first_row = 1: rows of {} are all alike; leave it out, or use a "
                                 "brick wall such as hexagon",
                                 p.stencil));
  check_walls(p, *parts.families[0]);
  if (const DensityOnTable* jets = parts.families[0]->made_of())
    for (auto& term : wall_families(jets->table, theory.shared_density(), p.lattice, slopes_of(theory, p)))
      parts.families.push_back(std::move(term));
  if (auto constraint = theory.constraint()) {
    parts.families.push_back(std::move(constraint));
    for (Component& multiplier : multipliers_of(theory)) parts.components.push_back(std::move(multiplier));
  }
  return parts;
}

std::vector<NamedScheme> multisymplectic_variants(const Problem& base) {
  std::vector<NamedScheme> schemes;
  if (base.stencil == stencil_as_text) schemes.push_back({stencil_as_text, base});
  for (const NamedFormula& stencil : stencils()) {
    schemes.push_back({stencil.name, base});
    schemes.back().problem.stencil = stencil.name;
    schemes.back().rank = stencil.name == "rectangle-symmetric" ? 1 : 0;
  }
  return schemes;
}

/// All stencils with a name are of order two, but for symplectic Euler, which is so for some densities only.
std::optional<int> multisymplectic_order(const Problem& p) {
  if (p.stencil == stencil_as_text || p.stencil == "vertex") return std::nullopt;
  return 2;
}

/// The sources of the stencil; on a mesh those of its steps; none of a stencil that the scene gives as text.
std::vector<std::string> sources_of_stencil(const Problem& p) {
  const auto named = std::ranges::find(named_tables(), p.lattice.mesh() ? "trapezoidal" : p.stencil, &NamedTable::name);
  return named == named_tables().end() ? std::vector<std::string>{} : named->sources;
}

std::string multisymplectic_words(const Problem& p) {
  if (p.lattice.mesh()) return "the Störmer–Verlet method in time with linear finite elements of lumped mass in space";
  const auto named = std::ranges::find(named_tables(), p.stencil, &NamedTable::name);
  return named != named_tables().end() ? "the discrete Euler–Lagrange equations of " + named->words
                                       : "the discrete Euler–Lagrange equations of a stencil that the scene states";
}

}  // namespace

extern const MethodEntry multisymplectic_method;
const MethodEntry multisymplectic_method{
    .name = "multisymplectic",
    .formula = "discrete Euler-Lagrange field equations of lattice.stencil (5.2)",
    .build = multisymplectic_parts,
    .parameters = {{.key = sites_key,
                    .fallback = std::string(),
                    .help = "the sites of a stencil of your own, time first: "
                            "(0,0) (1,0) (1,1); in place of lattice.stencil",
                    .otherwise = "none"},
                   {.key = lagrangian_key,
                    .fallback = std::string(),
                    .help = "a Lagrangian on the values y1, y2, ... of stencil.sites, with h and k, in place of "
                            "stencil.point: h*k*(0.5*((y2 - y1)/h)^2 - ...)",
                    .otherwise = "none"},
                   {.key = point_key,
                    .fallback = std::string(),
                    .help = "a weight, and the jet there as a weight for each site: "
                            "1; phi: 1/3 1/3 1/3; phi_t: -1 1 0; phi_x: 0 -1 1; "
                            "a line for each point",
                    .otherwise = "none"},
                   {.key = first_row_key,
                    .fallback = 0,
                    .help = "of a brick wall (hexagon): 1 if the first row, or frame, is an odd row of it",
                    .range = {0, 1},
                    .otherwise = "that of the file's /time and scene, or 0"},
                   {.key = left_slope,
                    .fallback = std::string(),
                    .help = "phi_x that a clamped left wall keeps, a number for each field",
                    .otherwise = "that of the initial state"},
                   {.key = right_slope,
                    .fallback = std::string(),
                    .help = "phi_x that a clamped right wall keeps, a number for each field",
                    .otherwise = "that of the initial state"}},
    .reads_stencil = true,
    .on_meshes = true,
    .label = [](const Problem& p) { return p.lattice.mesh() ? "Stormer-Verlet" : p.stencil; },
    .starts = {StartRule::exact, StartRule::centred, StartRule::values},
    .row_density = density_of_mesh_rows,
    .variants = multisymplectic_variants,
    .order = multisymplectic_order,
    .words = multisymplectic_words,
    .sources = {"marsden-patrick-shkoller-1998"},
    .further_sources = sources_of_stencil};

}  // namespace delf

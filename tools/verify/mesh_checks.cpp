// SPDX-License-Identifier: MIT
#include "tools/verify/mesh_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "jets/expressions/expression.hpp"
#include "lattice/index.hpp"
#include "lattice/region_shapes.hpp"
#include "schemes/system/constraint_slopes.hpp"
#include "schemes/verify/equation_check.hpp"
#include "schemes/verify/wrong_sign.hpp"
#include "tools/verify/verify_request.hpp"

namespace delf {

MeshChecks::MeshChecks(const ComplexScene& scene, const Values& values)
    : scene_(scene),
      variations_(static_cast<int>(values.integer("verify.variations"))),
      fault_(values.choice("verify.fault")),
      random_(scene.scene.initial.seed),
      symmetries_(symmetries(values)),
      forced_(values.toggle("verify.force")) {
  const double tolerance = values.real("verify.tolerance");
  equations_ = {
      .name = "field equations", .region = {}, .tolerance = std::max(tolerance, 10 * scene.scene.problem.tolerance)};
  local_ = {.name = "local identity of the forms", .region = {}, .tolerance = tolerance};
  for (const int centres : sizes)
    forms_.push_back({.name = fmt::format("form formula, {}",
                                          centres == 1 ? "around a site" : fmt::format("{} connected sites", centres)),
                      .region = {},
                      .tolerance = tolerance});
  constraint_ = {.name = "constraint", .region = {}, .tolerance = equations_.tolerance};
}

void MeshChecks::add_to(Verdict& verdict) const {
  verdict.stencils = stencils_;
  verdict.points = points_;
  verdict.checks = {equations_};
  if (constraint_.samples > 0) verdict.checks.push_back(constraint_);
  for (const Check& check : forms_) verdict.checks.push_back(check);
  verdict.checks.push_back(local_);
  const std::vector<Check> noether = noether_ ? noether_->checks() : std::vector<Check>();
  verdict.checks.insert(verdict.checks.end(), noether.begin(), noether.end());
  verdict.left_out.insert(verdict.left_out.end(), left_out_.begin(), left_out_.end());
  if (noether.empty())
    verdict.left_out.push_back("Noether: the theory declares no symmetry of its fields; try one by verify.generator");
}

std::vector<LinearSymmetry> MeshChecks::symmetries(const Values& values) {
  std::vector<LinearSymmetry> all = scene_.theory->symmetries();
  if (const SymbolicDensity* density = scene_.theory->density().formula())
    for (const LinearSymmetry& symmetry : density->up_to_divergence())
      left_out_.push_back(fmt::format(
          "Noether, {}: the density has it up to a divergence, and its stencils on a mesh have not", symmetry.name));
  if (scene_.space && !scene_.space->fluxes.empty()) {
    for (const LinearSymmetry& symmetry : all)
      left_out_.push_back(
          fmt::format("Noether, {}: the action of what flows in at the boundary has it not", symmetry.name));
    all.clear();
  }
  std::vector<std::string> names;
  for (const auto& field : scene_.fields) names.push_back(field.name);
  add_generator(scene_.scene, values.text("verify.generator").value_or(""), names, all);
  return all;
}

void MeshChecks::look_at(CheckedRows given, const std::string& where) {
  const RegionSystem& everywhere = *given.everywhere;
  const Region& whole = everywhere.region();
  if (fault_ == "field") break_a_value(everywhere, given.rows);
  look_at_equations(given, where);
  stencils_ += everywhere.stencils();
  const auto wrong = fault_ == "sign" ? with_wrong_sign(everywhere.system()) : nullptr;
  const LatticeSystem& system = wrong ? *wrong : everywhere.system();
  if (!noether_) noether_.emplace(system, symmetries_, equations_.tolerance, forced_, scene_.scene.initial.seed);
  for (std::size_t n = 0; n < sizes.size(); ++n) {
    const std::vector<Site> centres = draw_connected(whole, sizes[n], random_);
    const RegionSystem here(system, region_around(whole.all(), centres, whole.is_data()), given.rows.first_row);
    const RegionSystem::Values y = here.restricted(given.rows);
    auto pairs = pairs_of(here.first_variations(y, 2 * variations_, random_));
    if (fault_ == "variation")
      if (const auto node = here.coupling_node(y)) pairs[0].V[*node] += 1e-2;
    const std::string region =
        fmt::format("{} sites, {} stencils, {}", here.region().sites().size(), here.stencils(), where);
    const std::vector<Balance> formula = here.form_formula(y, pairs);
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      if (forms_[n].take(formula[p], region) && !forms_[n].passed()) {
        const std::vector<Balance> left = here.linearised(y, pairs[p].V);
        forms_[n].failure = std::ranges::any_of(left, [](const Balance& E) { return E.relative() > 1e-9; })
                                ? "V does not solve the linearised equations"
                                : "the stencils' equations are no derivatives of one action";
      }
      if (local_.take(here.local_identity(y, pairs[p]).balance, region) && !local_.passed())
        local_.failure = "∂²L/∂y∂y of a stencil is not symmetric";
    }
    noether_->at(here, y, region);
    points_.push_back({fmt::format("{} sites", sizes[n]), here.stencils(), forms_[n].value, true});
  }
}

void MeshChecks::break_a_value(const RegionSystem& everywhere, Window& rows) {
  std::vector<Node> fields;
  for (const std::size_t n : everywhere.equations())
    if (const Node node = everywhere.node(n); node.component < std::ssize(scene_.fields)) fields.push_back(node);
  const Node one = fields[random_() % fields.size()];
  rows.rows[at(one.site.time)][at(one.site.space * rows.components + one.component)] += 1e-3;
}

// Relative to the largest terms of the window: a vacuum has no scale of its own.
void MeshChecks::look_at_equations(const CheckedRows& given, const std::string& where) {
  const RegionSystem& everywhere = *given.everywhere;
  const RegionSystem::Values y = everywhere.restricted(given.rows);
  const std::vector<Balance> E = everywhere.residual(y);
  const std::vector<double> equation_sizes = everywhere.sizes(y);
  double size = 0, terms = 0;
  for (const double own : equation_sizes) size = larger_or_nan(own, size);
  for (const Balance& one : E) terms = larger_or_nan(one.absolute, terms);
  // The terms are differences of rows, which the last digits of the values change: |E| ≤ ε Σ |∂E/∂y y| is none. Where all
  // terms are rounding, as the differences of a constant field, they are no scale.
  constexpr double few = 8 * std::numeric_limits<double>::epsilon();
  const double scale = terms <= few * size ? size : std::max(terms, ValueError().of(size) / equations_.tolerance);
  const bool by_cells = scene_.time == MeshTime::cells;
  const std::vector<double> around = by_cells ? everywhere.sizes_of_stencils(y) : std::vector<double>();
  for (std::size_t n = 0; n < E.size(); ++n) {
    const std::size_t node = everywhere.equations()[n];
    // The times of a site may lie close together: the terms are those of y itself, Σ |∂E/∂y y|, not of its quotients. Where
    // y is rounding at a site, as on the node of a standing wave, its equation is rounded like the stencils around.
    const double own =
        by_cells ? std::max(equation_sizes[node], ValueError().of(around[node]) / equations_.tolerance) : scale;
    if (equations_.take({E[n].sum, own, E[n].count}, where))
      equations_.region = fmt::format("{}, {}", name_of(given, everywhere.node(node).site), where),
      worst_site_ = equations_.region;
  }
  if (!equations_.passed()) equations_.failure = "the values around " + worst_site_ + " are not those of a solution";
}

// Where there are multipliers, the numbers of sites say nothing.
std::string MeshChecks::name_of(const CheckedRows& given, Site site) const {
  const std::string name = given.name(site);
  return scene_.theory->constraint() ? "the point" + name.substr(name.find(" at ")) : name;
}

// Relative to Σ |∂G/∂φ φ|: the terms of G cancel within one stencil.
void MeshChecks::look_at_constraint(std::span<const double> fields, const std::string& where) {
  if (!scene_.theory->constraint()) return;
  const auto d = scene_.fields.size();
  scene_.space->each_constraint(fields, [&](std::size_t n, double G, std::span<const double> slopes) {
    const Balance balance{G, constraint_terms(slopes, fields.subspan(n * d, d)), 1};
    const std::size_t sites = scene_.space->mesh.points.size();
    if (constraint_.take(balance, fmt::format("point {}, {}", n % sites, where)) && !constraint_.passed())
      constraint_.failure = "the fields leave the surface of the constraint at " + constraint_.region;
  });
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "jets/expressions/expression.hpp"
#include "schemes/complex/complex_form.hpp"
#include "schemes/verify/equation_check.hpp"
#include "tools/verify/verify_request.hpp"

namespace delf {

MeshChecks::MeshChecks(const ComplexScene& scene, const Values& values)
    : scene_(scene),
      variations_(static_cast<int>(values.integer("verify.variations"))),
      fault_(values.choice("verify.fault")),
      random_(scene.scene.initial.seed) {
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
  noether_.emplace(symmetries(values), equations_.tolerance, values.toggle("verify.force"), fault_ == "sign");
}

void MeshChecks::add_to(Verdict& verdict) const {
  verdict.stencils = stencils_;
  verdict.points = points_;
  verdict.checks = {equations_};
  if (constraint_.samples > 0) verdict.checks.push_back(constraint_);
  for (const Check& check : forms_) verdict.checks.push_back(check);
  verdict.checks.push_back(local_);
  const std::vector<Check> noether = noether_->checks();
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

void MeshChecks::look_at(const ComplexSystem& system, std::vector<double> y, const std::string& where) {
  const Complex& complex = system.complex();
  const Touching touching(complex);
  if (fault_ == "field") {
    const std::vector<int> one = draw_centres(complex, touching, 1, random_);
    y[one.front() * system.components()] += 1e-3;
  }
  look_at_equations(system, y, where);
  stencils_ += complex.stencils();
  for (std::size_t n = 0; n < sizes.size(); ++n) {
    const ComplexForm form(system,
                           ComplexRegion::around(complex, touching, draw_centres(complex, touching, sizes[n], random_)),
                           y, fault_ == "sign");
    auto V = form.first_variations(2 * variations_, random_);
    if (fault_ == "variation")
      if (const auto node = form.coupling_node()) V[0][*node] += 1e-2;
    const std::string region =
        fmt::format("{} sites, {} stencils, {}", form.region().sites().size(), form.region().stencils().size(), where);
    for (std::size_t v = 0; v + 1 < V.size(); v += 2) {
      if (forms_[n].take(form.form_formula(V[v], V[v + 1]), region) && !forms_[n].passed())
        forms_[n].failure = form.linearised(V[v]) > 1e-9 ? "V does not solve the linearised equations"
                                                         : "the stencils' equations are no derivatives of one action";
      if (local_.take(form.local_identity(V[v], V[v + 1]), region) && !local_.passed())
        local_.failure = "∂²L/∂y∂y of a stencil is not symmetric";
    }
    noether_->look_at(system, form.region(), y, region, random_);
    points_.push_back({fmt::format("{} sites", sizes[n]), static_cast<std::int64_t>(form.region().stencils().size()),
                       forms_[n].value, true});
  }
}

// Relative to the largest terms of the window: a vacuum has no scale of its own.
void MeshChecks::look_at_equations(const ComplexSystem& system, std::span<const double> y, const std::string& where) {
  std::vector<Balance> E = system.residual(y);
  const std::size_t d = system.components();
  // The terms are differences of rows, which the last digits of the values change: |E| ≤ ε Σ |∂E/∂y y| is none.
  const std::vector<double> sizes = system.sizes(y);
  const double rounding = ValueError().of(*std::ranges::max_element(sizes));
  if (scene_.time == MeshTime::cells) {
    // The times of a site may lie close together: the terms are those of y itself, Σ |∂E/∂y y|, not of its quotients.
    for (std::size_t n = 0; n < E.size(); ++n) E[n].absolute = sizes[n];
  }
  const double scale = std::max(scale_of_equations(system, E, y), rounding / equations_.tolerance);
  for (std::size_t n = 0; n < E.size(); ++n) {
    const auto site = static_cast<int>(n / d);
    if (!system.complex().has_equation(site)) continue;
    const double own = scene_.time == MeshTime::cells ? E[n].absolute : scale;
    if (equations_.take({E[n].sum, own, E[n].count}, where))
      equations_.region = fmt::format("{}, {}", name_of(system, site), where), worst_site_ = equations_.region;
  }
  if (!equations_.passed()) equations_.failure = "the values around " + worst_site_ + " are not those of a solution";
}

// Where every value is a site of its own, their numbers say nothing.
std::string MeshChecks::name_of(const ComplexSystem& system, int site) const {
  const std::string name = system.complex().name(site);
  return scene_.theory->constraint() ? "the point" + name.substr(name.find(" at ")) : name;
}

// Relative to Σ |∂G/∂φ φ|: the terms of G cancel within one stencil.
void MeshChecks::look_at_constraint(std::span<const double> fields, const std::string& where) {
  if (!scene_.theory->constraint()) return;
  const auto d = scene_.fields.size();
  scene_.space->each_constraint(fields, [&](std::size_t n, double G, std::span<const double> slopes) {
    Balance balance{G, 0, 1};
    for (std::size_t a = 0; a < d; ++a) balance.absolute += std::abs(slopes[a] * fields[n * d + a]);
    const std::size_t sites = scene_.space->mesh.points.size();
    if (constraint_.take(balance, fmt::format("point {}, {}", n % sites, where)) && !constraint_.passed())
      constraint_.failure = "the fields leave the surface of the constraint at " + constraint_.region;
  });
}

}  // namespace delf

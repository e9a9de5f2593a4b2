// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "jets/batch_of.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/families/damped_leapfrog.hpp"
#include "schemes/families/guo.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/families/vu_quoc_li.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tests/jets/random.hpp"
#include "tests/row_distance.hpp"

/// What the tests of this folder share.
namespace delf::testing {

using Families = std::vector<std::shared_ptr<const StencilFamily>>;

inline Row random_row(Random& random, int sites, double amplitude) {
  Row row(delf::at(sites));
  for (double& y : row) y = random(-amplitude, amplitude);
  return row;
}
/// `count` rows that move on by random increments of a tenth of the amplitude.
inline std::vector<Row> random_rows(Random& random, int count, int sites, double amplitude) {
  std::vector<Row> rows{random_row(random, sites, amplitude)};
  const Row step = random_row(random, sites, amplitude / 10);
  while (static_cast<int>(rows.size()) < count) {
    rows.push_back(rows.back());
    for (std::size_t i = 0; i < step.size(); ++i) rows.back()[i] += step[i];
  }
  return rows;
}

/// Parameters away from special values, so that no term of a theory is missing.
inline Problem problem_of(const std::string& theory) {
  Problem p;
  p.theory = theory, p.parameters["theory.mass"] = 1.2, p.parameters["theory.lambda"] = 0.4;
  p.parameters["theory.density"] = std::string("0.5*phi_t^2 - 0.5*phi_x^2 + cosm1(phi)");
  p.parameters["theory.strength"] = 0.6, p.parameters["theory.width"] = 0.8, p.parameters["theory.position"] = 0.3;
  return p;
}
inline std::unique_ptr<FieldTheory> theory_named(const Problem& p) {
  for (const TheoryEntry* entry : theory_entries())
    if (p.theory == entry->name) return make_theory(*entry, p.parameters);
  throw std::logic_error("no theory " + p.theory);
}
/// Theories of one field on a space that is more than a point.
inline std::vector<std::string> theory_names() {
  std::vector<std::string> names;
  for (const TheoryInfo& theory : theories())
    if (theory.components == 1 && theory.name != "pendulum" && theory.name != "harmonic-oscillator")
      names.push_back(theory.name);
  return names;
}
/// Stencils for fields: not the two sites of a time lattice.
inline std::vector<std::string> stencil_names() {
  std::vector<std::string> names;
  for (const NamedFormula& stencil : stencils())
    if (stencil.name != "midpoint" && stencil.name != "trapezoidal" && stencil.name != "vertex")
      names.push_back(stencil.name);
  return names;
}
/// The scheme of a stencil, or of a comparator; null if the theory has none.
inline std::shared_ptr<const StencilFamily> family_of(const FieldTheory& theory, const std::string& scheme) {
  if (scheme == "guo") return theory.comparator(guo());
  if (scheme == "vu-quoc-li") return theory.comparator(vu_quoc_li());
  if (scheme == "damped") return theory.comparator(damped_leapfrog());
  return theory.variational(scheme);
}
inline std::shared_ptr<const StencilFamily> family_of(const Problem& p, const std::string& scheme) {
  return family_of(*theory_named(p), scheme);
}
/// A density on any table.
template <Density D>
std::shared_ptr<const JetFamily> jet_family(StencilTable table, const D& density) {
  return std::make_shared<JetFamily>(std::move(table), std::make_shared<BatchOf<D>>(density));
}
inline Evolution evolution_of(const Problem& p, const std::string& scheme, const Lattice& lattice, double h,
                              const StepOptions& options = {}) {
  return {lattice, {family_of(p, scheme)}, h, options};
}

/// The rows that a stepper holds, its newest last.
inline Window window_of(const Evolution& evolution, double monodromy = 0) {
  const Stepper& stepper = evolution.stepper();
  const int held = std::min<int>(stepper.starting_rows() + 1, static_cast<int>(stepper.newest()) + 1);
  Window window{
      &evolution.system().lattice(), evolution.system().components(), monodromy, stepper.newest() - held + 1, {}};
  for (int back = held - 1; back >= 0; --back) window.rows.push_back(stepper.row(back));
  return window;
}

/// E of one site and component in a window around it.
inline LatticeSystem::Value equation_at(const LatticeSystem& system, const Window& window, std::int64_t row, int site,
                                        int component = 0) {
  std::vector<LatticeSystem::Value> values;
  system.equations(window, row, values);
  return values[site * system.components() + component];
}

/// max |E| over the sites, of the equations that determine the last row of the window; relative to the largest
/// Σ |∂E/∂y| times the largest |y|, of which E is a difference.
inline double equation_defect(const Evolution& evolution, const Window& window) {
  const LatticeSystem& system = evolution.system();
  const SolvePlan& plan = evolution.plan();
  const int C = system.components();
  double defect = 0, slopes = 0, values = 0;
  for (const Row& row : window.rows)
    for (double y : row) values = std::max(values, std::abs(y));
  std::map<std::int64_t, std::vector<LatticeSystem::Value>> equations;
  std::vector<MatrixEntry> entries;
  for (int i = 0; i < system.lattice().sites(); ++i)
    for (int a = 0; a < C; ++a) {
      if (!plan.solved(i, a)) continue;
      const std::int64_t row = window.last_row() - plan.shift(i, a, static_cast<int>(window.last_row() & 1));
      const auto [at, fresh] = equations.try_emplace(row);
      if (fresh) system.equations(window, row, at->second);
      const double E = std::abs(at->second[i * C + a].sum);
      if (!(E <= defect)) defect = E;  // a NaN too
      if (i != 0 && i != system.lattice().sites() / 2 && i != system.lattice().sites() - 1) continue;
      entries.clear();
      for (std::int64_t r = window.first_row; r <= window.last_row(); ++r)
        system.jacobian(window, row, i, a, r, system.time_step(), entries);
      double sum = 0;
      for (const auto& e : entries) sum += e.row == i * C + a ? std::abs(e.value) : 0;
      slopes = std::max(slopes, sum);
    }
  return defect / (slopes * values);
}

/// The key that a refusal names; "accepted" if there is none.
inline std::string refused_key(const std::function<void()>& request) {
  try {
    request();
  } catch (const BadInput& error) {
    return error.key();
  }
  return "accepted";
}
inline std::string message_of(const std::function<void()>& request) {
  try {
    request();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}
inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace delf::testing

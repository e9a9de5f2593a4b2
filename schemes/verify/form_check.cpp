// SPDX-License-Identifier: MIT
#include "schemes/verify/form_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/system/assembly.hpp"

namespace delf {
namespace {

/// "X": the slaved components at the vertices.
std::string slaved_names(const LatticeSystem& system) {
  std::string names;
  for (const Component& c : system.all_components())
    if (c.role == Role::slaved && (c.position || names.empty()))
      names = c.position ? c.name : "slaved values";  // nodes inside a step go with the position
  return names;
}

/// Two numbers with as many digits as they need to differ, six or more.
std::pair<std::string, std::string> told_apart(double a, double b) {
  for (int digits = 6;; ++digits) {
    auto texts = std::pair(fmt::format("{:.{}g}", a, digits), fmt::format("{:.{}g}", b, digits));
    if (texts.first != texts.second || digits == 17) return texts;
  }
}

}  // namespace

std::vector<Balance> symplectic_form(const LatticeSystem& system, const Window& y, const std::vector<Window>& V,
                                     std::int64_t cut) {
  const int reach = system.height();
  const Assembly stencils(system, Assembly::across(system, static_cast<int>(cut & 1), y.monodromy));
  std::vector<SectionRing> variations;
  for (const Window& v : V) variations.emplace_back(v, cut - reach, cut + reach);
  std::vector<Balance> balances(V.size() / 2);
  std::vector<double> v, w;
  stencils.each_jacobian(SectionRing(y, cut - reach, cut + reach), cut, [&](const Assembly::Local& at) {
    for (std::size_t p = 0; p < balances.size(); ++p) {
      Assembly::gather(at, variations[2 * p], cut, v);
      Assembly::gather(at, variations[2 * p + 1], cut, w);
      for (int n = 0; n < at.family.size(); ++n)
        if (at.anchor.site.time + at.family.site(n).time >= 0 &&
            system.component(at.family.values()[n].component).role != Role::slaved)
          add_form(balances[p], delf::at(n), at.derivatives, v, w);
    }
  });
  return balances;
}

FormCheck::FormCheck(const LatticeSystem& system, const SolvePlan& plan, int rows, Options options)
    : system_(system),
      options_(std::move(options)),
      variational_(is_variational(system)),
      slaved_(slaved_names(system)),
      constrained_(std::ranges::any_of(system.families(), [&](const auto& f) { return has_multiplier(system, *f); })),
      tangent_(std::make_unique<Tangent>(system, plan, rows, options_.monodromy)),
      solved_(Tangent::solved_rows(system, plan, rows)),
      forms_(options_.regions.size()),
      drawn_(options_.regions.size(), false) {
  beyond_.resize(forms_.size());
  for (std::size_t n = 0; n < forms_.size(); ++n) {
    const std::string& kind = options_.regions[n].name;
    forms_[n] = {.name = "form formula, " + kind, .region = {}, .tolerance = options_.tolerance};
    if (!slaved_.empty()) {
      forms_[n].name = fmt::format("form formula with {} known, {}", slaved_, kind);
      beyond_[n].name = fmt::format("form formula with {} solved for, {}", slaved_, kind);
    } else {
      beyond_[n].name = "form formula without multipliers, " + kind;
    }
  }
  local_ = {.name = "local identity of the forms", .region = {}, .tolerance = options_.tolerance};
  cuts_ = {.name = "symplectic form, slab to slab", .region = {}, .tolerance = options_.tolerance};
}

int FormCheck::rows_wanted(const LatticeSystem& system, const SolvePlan& plan,
                           const std::vector<RegionRequest>& regions) {
  int solved = RegionDrawer::rows_wanted(system);
  for (const RegionRequest& request : regions)
    for (const Site& site : request.sites) solved = std::max(solved, site.time + 2);
  return Tangent::least_rows(system, plan) - 1 + solved;
}

void FormCheck::at(const Window& y, std::mt19937_64& random) {
  const int count = 2 * options_.pairs;
  std::vector<Window> evolved;
  try {
    evolved = tangent_->evolve(y, count, random);
  } catch (const NoConvergence& error) {
    no_evolution_ = error.what();
  }
  const RegionDrawer drawer(system_, solved_);
  for (std::size_t n = 0; n < options_.regions.size(); ++n) {
    const RegionRequest& request = options_.regions[n];
    const auto region = drawer.draw(request, random);
    if (!region) continue;
    drawn_[n] = true;
    const RegionSystem system(system_, *region, y.first_row, options_.monodromy);
    const auto values = system.restricted(y);
    if (variational_) look_at_stencils(system, values, random);
    if (!evolved.empty() && slaved_.empty()) {
      std::vector<RegionSystem::Values> restricted;
      for (const Window& V : evolved) restricted.push_back(system.restricted(V));
      auto pairs = pairs_of(std::move(restricted));
      look(request, system, values, pairs, false);
    }
    if (system.nodes() > most_local) continue;
    auto pairs = pairs_of(system.first_variations(values, count, random));
    if (slaved_.empty()) {
      look(request, system, values, pairs, true);
      if (constrained_) measure(request, system, values, pairs);
      continue;
    }
    measure(request, system, values, pairs);
    const RegionSystem known(system_, *region, y.first_row, options_.monodromy, SlavedValues::known);
    pairs = pairs_of(known.first_variations(values, count, random));
    look(request, known, values, pairs, true);
  }
  if (!evolved.empty() && (variational_ || !slaved_.empty())) look_at_cuts(y, evolved);
}

void FormCheck::measure(const RegionRequest& request, const RegionSystem& system, const RegionSystem::Values& y,
                        const std::vector<RegionSystem::Pair>& pairs) {
  Check& beyond = beyond_[&request - options_.regions.data()];
  const std::string where = in_words(system.region(), system.origin(), system.stencils());
  for (const Balance& left :
       slaved_.empty() ? system.form_without_multipliers(y, pairs) : system.form_formula(y, pairs))
    beyond.take(left, where);
}

void FormCheck::look(const RegionRequest& request, const RegionSystem& system, const RegionSystem::Values& y,
                     std::vector<RegionSystem::Pair>& pairs, bool local) {
  if (options_.break_variation)
    if (const auto node = system.coupling_node(y)) pairs[0].V[*node] += 1e-2;
  const std::string where = fmt::format("{}, {} V and W", in_words(system.region(), system.origin(), system.stencils()),
                                        local ? "local" : "evolved");
  Check& check = forms_[&request - options_.regions.data()];
  const auto balances = system.form_formula(y, pairs);
  stencils_ += system.stencils();
  std::size_t worst = 0;
  bool shown = false;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    if (!(balances[p].relative() <= balances[worst].relative())) worst = p;
    if (check.take(balances[p], where)) shown = true;
  }
  const double value = balances[worst].relative();
  points_.push_back({request.name, system.stencils(), value, local});
  if (!(value <= options_.tolerance) && shown) check.failure = why(system, y, pairs[worst]);
  if (!(value <= worst_.value)) {
    worst_ = {value, request.name + ", " + where,           system.region().sites(), {},
              {},    system.boundary_terms(y, pairs[worst])};
    for (Site& site : worst_.sites) {
      worst_.interior.push_back(system.region().in_interior(site));
      worst_.boundary.push_back(system.region().in_boundary(site));
      site.time += static_cast<int>(system.origin());
    }
  }
}

/// ΣΩˡ = 0 whatever V and W are.
void FormCheck::look_at_stencils(const RegionSystem& system, const RegionSystem::Values& y, std::mt19937_64& random) {
  RegionSystem::Pair pair{RegionSystem::Values(system.nodes()), RegionSystem::Values(system.nodes())};
  std::normal_distribution<double> normal;
  for (auto* values : {&pair.V, &pair.W})
    for (double& value : *values) value = normal(random);
  const auto defect = system.local_identity(y, pair);
  Node anchor{defect.anchor, 0};
  if (local_.take(defect.balance, fmt::format("the stencil at {}", in_words(system_, anchor, system.origin()))) &&
      !local_.passed())
    local_.failure = fmt::format(
        "The second derivatives of the stencil's Lagrangian are not symmetric on {}: of its value {} by its value {} "
        "is not that of {} by {}. A residual like this is the gradient of no Lagrangian; look at the sign and the "
        "terms "
        "of these derivatives.",
        local_.region, defect.row, defect.column, defect.column, defect.row);
}

/// The reason in words, and the place: V is none, or the equations are those of no action.
std::string FormCheck::why(const RegionSystem& system, const RegionSystem::Values& y,
                           const RegionSystem::Pair& pair) const {
  for (const auto* variation : {&pair.V, &pair.W}) {
    const auto left = system.linearised(y, *variation);
    const auto worst = std::ranges::max_element(left, {}, &Balance::relative);
    if (worst == left.end() || worst->relative() <= 1e-10) continue;
    const Node node = system.node(system.equations()[worst - left.begin()]);
    return fmt::format(
        "{} is no first variation: at {} the linearised field equation is missed by {:.1e} of its terms. The "
        "variation was changed there or at a site next to it, or it was evolved by other equations.",
        variation == &pair.V ? "V" : "W", in_words(system_, node, system.origin()), worst->relative());
  }
  if (const auto pair_of_nodes = system.least_mutual(y)) {
    const auto [by_a, by_b] = told_apart(pair_of_nodes->b_by_a, pair_of_nodes->a_by_b);
    return fmt::format(
        "The equations are not those of an action: the equation at {} feels the value at {} with {}, and the other "
        "way round it is {}. {}",
        in_words(system_, pair_of_nodes->b, system.origin()), in_words(system_, pair_of_nodes->a, system.origin()),
        by_a, by_b,
        variational_ ? "The scheme is said to be variational: look at the derivatives of its Lagrangian."
                     : "The scheme comes from no Lagrangian, and nothing multisymplectic is conserved.");
  }
  return "The linearised equations hold and are those of an action on int U, and still the terms at the boundary do "
         "not "
         "cancel: a stencil that touches the boundary has a residual that is the gradient of no Lagrangian.";
}

void FormCheck::look_at_cuts(const Window& y, const std::vector<Window>& V) {
  const std::int64_t first = y.first_row + solved_.first, last = y.first_row + solved_.last + 1;
  const auto at_first = symplectic_form(system_, y, V, first);
  for (std::int64_t cut = first + 1; cut <= last; ++cut) {
    const auto here = symplectic_form(system_, y, V, cut);
    for (std::size_t p = 0; p < here.size(); ++p) {
      Balance change = here[p];
      change.sum -= at_first[p].sum;
      change.absolute = std::max(here[p].absolute, at_first[p].absolute);
      cuts_.take(change, fmt::format("between rows {} and {}", first, cut));
    }
  }
  if (!cuts_.passed() && slaved_.empty())
    cuts_.failure = fmt::format(
        "The symplectic form of two first variations changes {}: the step is no symplectic map, or its linearisation "
        "is "
        "not that of the equations.",
        cuts_.region);
}

std::vector<Check> FormCheck::checks() const {
  std::vector<Check> result;
  for (const Check& check : forms_)
    if (check.samples > 0) result.push_back(check);
  if (local_.samples > 0) result.push_back(local_);
  if (cuts_.samples > 0 && slaved_.empty()) result.push_back(cuts_);
  return result;
}

std::vector<Measured> FormCheck::measured() const {
  std::vector<Measured> result;
  const auto add = [&](const Check& of, const std::string& remark) {
    if (of.samples > 0)
      result.push_back({.name = of.name,
                        .region = of.region,
                        .value = of.value,
                        .normaliser = of.normaliser,
                        .count = of.count,
                        .remark = remark});
  };
  for (const Check& check : beyond_) add(check, "");
  if (slaved_.empty()) return result;
  Check cuts = cuts_;
  cuts.name = "symplectic form of the fields, slab to slab";
  add(cuts, fmt::format("{} follows the field, and the step is not symplectic", slaved_));
  return result;
}

std::vector<std::string> FormCheck::left_out() const {
  std::vector<std::string> words;
  std::string missing;
  for (std::size_t n = 0; n < drawn_.size(); ++n)
    if (!drawn_[n]) missing += (missing.empty() ? "" : ", ") + options_.regions[n].name;
  if (!missing.empty())
    words.push_back("form formula on regions of this kind, for which the lattice has no room: " + missing);
  for (std::size_t n = 0; n < drawn_.size(); ++n)
    if (drawn_[n] && forms_[n].samples == 0)
      words.push_back(fmt::format("form formula, {}: more than {} nodes, and no evolved variations",
                                  options_.regions[n].name, most_local));
  if (!slaved_.empty())
    words.push_back(
        fmt::format("the equations of {}: it is slaved, and to the forms a known function, V = 0 there; what "
                    "they leave where it is solved for is measured",
                    slaved_));
  if (!no_evolution_.empty()) words.push_back("evolved variations: " + no_evolution_);
  if (!variational_ && slaved_.empty())
    words.push_back("local identity and symplectic form: the scheme has no Lagrangian");
  return words;
}

}  // namespace delf

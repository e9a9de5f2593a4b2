// SPDX-License-Identifier: MIT
#include "schemes/verify/equation_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "lattice/index.hpp"
#include "schemes/system/assembly.hpp"
#include "schemes/verify/drawn_region.hpp"

namespace delf {

double ValueError::of(double y) const {
  const double size = std::abs(y), error = std::max(absolute, relative * size);
  if (digits == 0 || size == 0) return error;
  return std::max(error, 0.5 * std::pow(10.0, std::floor(std::log10(size)) - digits + 1));
}

EquationCheck::EquationCheck(const LatticeSystem& system, const SolvePlan& plan, double tolerance, int data_rows,
                             const std::optional<ValueError>& values)
    : system_(&system), row_(system), tolerance_(tolerance), data_rows_(data_rows), rounded_(values), seen_(3) {
  reach_ = std::max(1, system.height());
  constexpr std::array names{"field equations", "field equations at natural ends", "constraints"};
  for (std::size_t n = 0; n < seen_.size(); ++n)
    seen_[n].check = {.name = names[n], .region = {}, .tolerance = tolerance};
  for (int i = 0; i < system.lattice().sites(); ++i)
    for (int c = 0; c < system.components(); ++c) {
      solved_.push_back(plan.solved(i, c));
      shifts_.push_back(solved_.back() ? plan.shift(i, c) : 0);
      sorts_.push_back(sort_of(i, c));
    }
}

/// The equation of a multiplier, or of what is slaved: it has a scale of its own.
bool EquationCheck::is_constraint(int component) const {
  const Role role = system_->component(component).role;
  return role == Role::multiplier || role == Role::slaved;
}

EquationCheck::Sort EquationCheck::sort_of(int site, int component) const {
  if (is_constraint(component)) return constraint;
  const Lattice& lattice = system_->lattice();
  if (lattice.space() != Space::interval) return bulk;
  const bool end = (site == 0 && lattice.left() == Wall::natural) ||
                   (site == lattice.sites() - 1 && lattice.right() == Wall::natural);
  return end ? natural_end : bulk;
}

std::vector<double> EquationCheck::sizes_at(const Window& window, std::int64_t row, int site,
                                            const std::vector<int>& components, const Size& size) const {
  const int reach = system_->height();
  Assembly::Parts parts{.equations = {},
                        .parity = static_cast<int>(row & 1),
                        .past = reach,
                        .future = reach,
                        .monodromy = window.monodromy};
  for (const int c : components) parts.equations.push_back({{0, site}, c});
  const Assembly assembly(*system_, parts);
  std::vector<double> sizes(components.size(), 0.0);
  assembly.each_jacobian(SectionRing(window, row - reach, row + reach), row, [&](const Assembly::Local& at) {
    for (int i = 0; i < at.family.size(); ++i) {
      const Site read = at.anchor.site + at.family.site(i);
      const auto c = std::ranges::find(components, at.family.values()[i].component);
      if (read.time != 0 || system_->lattice().home(read.space) != site || c == components.end()) continue;
      for (std::size_t m = 0; m < at.y.size(); ++m)
        sizes[c - components.begin()] +=
            std::abs(at.derivatives[delf::at(i) * at.y.size() + m]) * size(at.family.values()[m].component, at.y[m]);
    }
  });
  return sizes;
}

double EquationCheck::error_at(const Window& window, std::int64_t row, int site, int component,
                               const ValueError& error) const {
  std::vector<double> largest(system_->components(), 0.0);
  for (std::int64_t j = row - reach_; j <= row + reach_; ++j)
    for (int i = 0; i < system_->lattice().sites(); ++i)
      for (std::size_t c = 0; c < largest.size(); ++c)
        largest[c] = std::max(largest[c], std::abs(window(j, i, static_cast<int>(c))));
  for (double& of_component : largest) of_component = error.of(of_component);
  return sizes_at(window, row, site, {component}, [&](int c, double) { return largest[c]; }).front();
}

/// The largest field or node at each site, of the rows that the equations read.
void EquationCheck::find_sizes(const Window& window, std::int64_t row) {
  sizes_.assign(system_->lattice().sites(), 0.0);
  for (std::int64_t j = row - reach_; j <= row + reach_; ++j)
    for (int i = 0; i < system_->lattice().sites(); ++i)
      for (int c = 0; c < system_->components(); ++c)
        if (system_->component(c).role != Role::multiplier) {
          double& size = sizes_[i];
          size = std::max(size, std::abs(window(j, i, c)));
        }
}

/// The site with the largest residual among those that have the component's equation; −1 if none has.
int EquationCheck::largest_site(int component) const {
  int site = -1;
  for (int i = 0; i < system_->lattice().sites(); ++i)
    if (solved_[i * system_->components() + component] && (site < 0 || sizes_[i] > sizes_[site])) site = i;
  return site;
}

void EquationCheck::at(const Window& window, std::int64_t row) {
  row_.equations(window, row, values_);
  const std::size_t C = system_->components();
  find_sizes(window, row);
  std::array<double, 3> scale{};
  std::map<int, std::vector<int>> largest;  // components by site: a stencil is differentiated once for all of them
  for (int c = 0; c < system_->components(); ++c)
    if (const int site = largest_site(c); site >= 0) largest[site].push_back(c);
  for (const auto& [site, components] : largest) {
    const std::vector<double> sizes =
        sizes_at(window, row, site, components, [](int, double y) { return std::abs(y); });
    for (std::size_t n = 0; n < sizes.size(); ++n) {
      double& of = scale[is_constraint(components[n]) ? constraint : bulk];
      of = std::max(of, sizes[n]);
      if (rounded_) of = std::max(of, error_at(window, row, site, components[n], *rounded_) / tolerance_);
    }
  }
  scale_ = scale[natural_end] = scale[bulk];  // ends are measured by the scale of the bulk
  newest_.assign(values_.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t n = 0; n < values_.size(); ++n) {
    if (!solved_[n] || row + shifts_[n] < data_rows_) continue;
    const double value = values_[n].sum == 0 ? 0 : std::abs(values_[n].sum) / scale[sorts_[n]];
    newest_[n] = value;
    Seen& seen = seen_[sorts_[n]];
    Check& check = seen.check;
    const int site = static_cast<int>(n / C);
    ++check.samples;
    if (!(value <= tolerance_)) {
      if (seen.failures++ == 0) seen.first_row = row, seen.first_site = seen.last_site = site;
      seen.last_row = row;
      seen.first_site = std::min(seen.first_site, site);
      seen.last_site = std::max(seen.last_site, site);
    }
    if (check.samples > 1 && !worse(value, check.value)) continue;
    check.value = value;
    check.normaliser = scale[sorts_[n]];
    const Node node{{0, site}, static_cast<int>(n % C)};
    check.region = in_words(*system_, node, row);
  }
  ++rows_;
}

std::vector<Check> EquationCheck::checks() const {
  std::vector<Check> result;
  for (const Seen& seen : seen_) {
    if (seen.check.samples == 0) continue;
    Check check = seen.check;
    check.count = check.samples;
    if (seen.failures > 0) {
      const std::string sites =
          system_->lattice().sites() > 1 ? fmt::format(", sites {} to {}", seen.first_site, seen.last_site) : "";
      const bool together = seen.last_row - seen.first_row <= 4 * reach_ && seen.last_site - seen.first_site <= 8;
      const bool few = static_cast<double>(seen.failures) < 0.05 * static_cast<double>(check.samples);
      check.failure = fmt::format(
          "{} of {} equations do not hold: rows {} to {}{}, and worst at {}. {}", seen.failures, check.samples,
          seen.first_row, seen.last_row, sites, check.region,
          together && few ? "So few, and together: the values in the midst of them were changed, and not by a step."
          : few           ? "So few, and scattered: single steps were not solved to this tolerance."
                : "So many say that the rows were made by other equations than these: another scheme, theory, "
                  "time step or length, or that they were not solved to this tolerance.");
    }
    result.push_back(std::move(check));
  }
  return result;
}

}  // namespace delf

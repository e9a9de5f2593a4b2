// SPDX-License-Identifier: MIT
#include "jets/expressions/stencil_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <sstream>
#include <string_view>

#include "jets/expressions/expression.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/text_parts.hpp"

namespace delf {
namespace {

std::string quoted(std::string_view text) { return std::string(1, '"').append(text.substr(0, 60)).append(1, '"'); }

[[noreturn]] void refuse(const std::string& key, const std::string& why) { throw BadInput(key, key + ": " + why); }

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(trimmed(part));
  return parts;
}

std::vector<Site> sites_of(const std::string& text, const std::string& key) {
  constexpr std::size_t most_sites = 32;
  constexpr int farthest = 16;
  std::vector<Site> sites;
  std::istringstream in(text);
  char open = 0, comma = 0, close = 0;
  int time = 0, space = 0;
  while (in >> open) {
    if (open != '(' || !(in >> time >> comma >> space >> close) || comma != ',' || close != ')')
      refuse(key, quoted(text) + " is no list of sites; write it like (0,0) (1,0) (1,1), time first");
    if (std::abs(time) > farthest || std::abs(space) > farthest)
      refuse(key, "a site lies more than " + std::to_string(farthest) + " steps from the first; move it nearer");
    const Site site{time, space};
    if (std::ranges::count(sites, site) > 0) refuse(key, "names a site twice; name it once");
    sites.push_back(site);
    if (sites.size() > most_sites) refuse(key, "more than " + std::to_string(most_sites) + " sites; use fewer");
  }
  if (sites.size() < 2) refuse(key, "names fewer than two sites; write them like (0,0) (1,0) (1,1), time first");
  const auto [first, last] = std::ranges::minmax(sites, {}, &Site::time);
  if (first.time == last.time)
    refuse(key, "all sites lie in one row, and no row would determine the next; add one of another row");
  return sites;
}

double moment(const TablePoint& point, JetSlot slot, const std::vector<Site>& sites, int in_time, int in_space) {
  double sum = 0;
  for (const TablePoint::Entry& e : point[slot]) {
    const Site v = sites[e.vertex];
    sum += e.weight * std::pow(v.time, in_time) * std::pow(v.space, in_space);
  }
  return sum;
}

TablePoint point_of(const std::string& text, const std::vector<Site>& sites, const std::string& key) {
  const std::vector<std::string> parts = split(text, ';');
  if (parts.empty() || parts[0].empty())
    refuse(key, "an empty point; write one like 1; phi: 1/3 1/3 1/3; phi_t: -1 1 0; phi_x: 0 -1 1");
  TablePoint point;
  point.weight = number_of(parts[0], key);
  for (std::size_t n = 1; n < parts.size(); ++n) {
    const auto colon = parts[n].find(':');
    const std::string name = trimmed(parts[n].substr(0, colon));
    const auto slot = std::ranges::find(slot_names, name);
    if (colon == std::string::npos || slot == slot_names.end())
      refuse(key,
             quoted(parts[n]) + " gives no slot of a jet; write phi:, phi_t: or phi_x: and a weight for each site");
    std::vector<double> weights;
    std::istringstream in(parts[n].substr(colon + 1));
    for (std::string weight; in >> weight;) weights.push_back(number_of(weight, key));
    if (weights.size() != sites.size())
      refuse(key, name + " has " + std::to_string(weights.size()) + " weights for " + std::to_string(sites.size()) +
                      " sites; give one each, separated by spaces");
    auto& entries = point.slots[at(slot - slot_names.begin())];
    if (!entries.empty()) refuse(key, name + " is given twice at a point; give it once");
    point.set(static_cast<JetSlot>(slot - slot_names.begin()), weights);
  }
  point.time = moment(point, JetSlot::phi, sites, 1, 0);
  point.space = moment(point, JetSlot::phi, sites, 0, 1);
  return point;
}

/// Exact on affine fields: φ finds 1, φ_t finds the slope of t, φ_x that of x, and neither finds anything else.
void check_consistent(const TablePoint& point, const std::vector<Site>& sites, bool wide, const std::string& key) {
  struct Rule {
    JetSlot slot;
    int in_time, in_space;
    double value;
    const char* field;
  };
  const std::array<Rule, 7> rules{{{JetSlot::phi, 0, 0, 1, "1"},
                                   {JetSlot::phi_t, 0, 0, 0, "1"},
                                   {JetSlot::phi_t, 1, 0, 1, "t"},
                                   {JetSlot::phi_t, 0, 1, 0, "x"},
                                   {JetSlot::phi_x, 0, 0, 0, "1"},
                                   {JetSlot::phi_x, 1, 0, 0, "t"},
                                   {JetSlot::phi_x, 0, 1, wide ? 1.0 : 0.0, "x"}}};
  for (const Rule& rule : rules) {
    const double found = moment(point, rule.slot, sites, rule.in_time, rule.in_space);
    if (std::abs(found - rule.value) < 1e-12) continue;
    std::ostringstream why;
    why << "is not consistent: of the field " << rule.field << ", " << slot_names[at(rule.slot)] << " finds " << found
        << ", not " << rule.value << "; correct its weights";
    refuse(key, why.str());
  }
}

}  // namespace

StencilTable stencil_of(const std::string& sites_text, const std::string& points_text, const std::string& sites_key,
                        const std::string& points_key) {
  StencilTable table;
  table.pattern.vertices = sites_of(sites_text, sites_key);
  const auto& sites = table.pattern.vertices;
  const bool wide = std::ranges::any_of(sites, [&](const Site& v) { return v.space != sites[0].space; });
  double total = 0;
  for (const std::string& text : split(points_text, '|')) {
    table.points.push_back(point_of(text, sites, points_key));
    check_consistent(table.points.back(), sites, wide, points_key);
    total += table.points.back().weight;
  }
  if (table.points.empty())
    refuse(points_key, "no point is given; write one like 1; phi: 1/3 1/3 1/3; phi_t: -1 1 0; phi_x: 0 -1 1");
  if (std::abs(total - 1) > 1e-12) {
    std::ostringstream why;
    why << "the weights of the points sum to " << total << ", not to 1; correct them";
    refuse(points_key, why.str());
  }
  return table;
}

std::vector<Site> stencil_sites(const std::string& sites, const std::string& key) { return sites_of(sites, key); }

int order_of_consistency(const StencilTable& table) {
  constexpr int highest = 10, terms = highest + 3;
  using Series = std::array<std::complex<double>, terms>;  // in ε, of τ = ε cos θ, ξ = ε sin θ
  int order = highest;
  for (int direction = 1; direction < 6; ++direction) {
    const double tau = std::cos(direction * 1.1), xi = std::sin(direction * 1.1);
    const auto of_slot = [&](const TablePoint& point, int slot) {
      Series series{};
      for (const TablePoint::Entry& e : point.slots[at(slot)]) {
        const Site v = table.pattern.vertices[e.vertex];
        std::complex<double> power = e.weight;
        for (int n = 0; n < terms; ++n) {
          series[n] += power;
          power *= std::complex<double>(0, tau * v.time + xi * v.space) / static_cast<double>(n + 1);
        }
      }
      return series;
    };
    const std::array<std::complex<double>, 3> sigma{1, {0, tau}, {0, xi}};
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b <= a; ++b) {
        const int lowest = (a > 0) + (b > 0);
        if (lowest == 1) continue;         // φ φ_t is half a divergence
        std::array<double, terms> form{};  // Re conj(m_a) m_b: what an equation sees of ∂²ℓ/∂a∂b
        for (const TablePoint& point : table.points) {
          const Series u = of_slot(point, static_cast<int>(a)), v = of_slot(point, static_cast<int>(b));
          for (int n = 0; n < terms; ++n)
            for (int m = 0; m <= n; ++m) form[n] += point.weight * std::real(std::conj(u[m]) * v[n - m]);
        }
        form[lowest] -= std::real(std::conj(sigma[a]) * sigma[b]);
        for (int n = lowest; n < lowest + order && n < terms; ++n)
          if (std::abs(form[n]) > 1e-9) order = std::min(order, n - lowest);
      }
  }
  return order;
}

}  // namespace delf

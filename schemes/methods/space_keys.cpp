// SPDX-License-Identifier: MIT
#include "schemes/methods/space_keys.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "jets/tables/space_table.hpp"
#include "lattice/error.hpp"
#include "schemes/methods/pair_parts.hpp"
#include "schemes/simulation.hpp"

namespace delf {
namespace {

constexpr int usual_order = 4, usual_degree = 2;

std::string space_of(const Problem& p) { return p.parameters.maybe<std::string>("scheme.space").value_or("lumped"); }
int order_of(const Problem& p) { return p.parameters.maybe<int>("lattice.space_order").value_or(usual_order); }
int degree_of(const Problem& p) { return p.parameters.maybe<int>("scheme.degree_space").value_or(usual_degree); }

/// A key of another space would have no effect.
void require_of(const Problem& p, const char* key, const char* of) {
  if (p.parameters.has(key) && space_of(p) != of)
    throw BadInput(
        key, fmt::format("{}: belongs to scheme.space = {}, and here it is {}; leave it out", key, of, space_of(p)));
}

StencilTable pairs_on(const Problem& p, int order) {
  if (!p.lattice.is_circle())
    throw BadInput("scheme.space",
                   "scheme.space = pairs: wide stencils have no walls in this version; use scheme.space = spectral, or "
                   "lattice.space = circle");
  return pair_space(pair_weights(pairs_of_order(p, "lattice.space_order", order)));
}

}  // namespace

Parameter space_key() {
  return {.key = "scheme.space",
          .fallback = "lumped",
          .help = "space: linear elements lumped or consistent, pairs of sites, or spectral elements",
          .choices = {"lumped", "linear", "pairs", "spectral"},
          .otherwise = "lumped on a circle and an interval"};
}
Parameter space_order_key() {
  return {.key = "lattice.space_order",
          .fallback = usual_order,
          .help = "order of pairs in space: 2, 4, ..., 20",
          .range = {.low = 2, .high = 2 * widest_pair},
          .otherwise = "4 for pairs"};
}
Parameter degree_space_key() {
  return {.key = "scheme.degree_space",
          .fallback = usual_degree,
          .help = "degree of spectral elements in space",
          .range = {.low = 1, .high = 12},
          .otherwise = "2 for spectral elements"};
}

StencilTable space_table(const Problem& p) {
  if (p.lattice.space() == Space::point || p.lattice.space() == Space::mesh) {
    for (const char* key : {"scheme.space", "lattice.space_order", "scheme.degree_space"})
      if (p.parameters.has(key))
        throw BadInput(key, fmt::format("{}: is for lattice.space = circle or interval; leave it out", key));
    return point_space();
  }
  require_of(p, "lattice.space_order", "pairs");
  require_of(p, "scheme.degree_space", "spectral");
  const std::string space = space_of(p);
  if (space == "pairs") return pairs_on(p, order_of(p));
  if (space == "spectral") return spectral_space(degree_of(p));
  return space == "linear" ? linear_space() : spectral_space(1);
}

std::string space_in_words(const Problem& p) {
  if (p.lattice.space() == Space::point) return {};
  if (p.lattice.mesh()) return " with linear finite elements of lumped mass in space";
  const std::string space = space_of(p);
  if (space == "pairs") return fmt::format(" with central differences of order {} in space", order_of(p));
  if (space == "spectral") return fmt::format(" with spectral elements of degree {} in space", degree_of(p));
  return space == "linear" ? " with linear finite elements in space"
                           : " with linear finite elements of lumped mass in space";
}
std::string space_label(const Problem& p) {
  if (p.lattice.space() == Space::point || p.lattice.space() == Space::mesh) return {};
  const std::string space = space_of(p);
  if (space == "pairs") return fmt::format(", pairs of order {}", order_of(p));
  if (space == "spectral") return fmt::format(", spectral of degree {}", degree_of(p));
  return ", " + space;
}

std::optional<int> order_in_space(const Problem& p, int in_time) {
  if (p.lattice.space() == Space::point) return in_time;
  if (p.lattice.space() == Space::mesh) return std::min(in_time, 2);  // of linear and bilinear cells
  const std::string space = space_of(p);
  if (space == "spectral") return std::nullopt;
  return std::min(in_time, space == "pairs" ? order_of(p) : 2);
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "lattice/complex/complex.hpp"

#include <algorithm>
#include <cstdio>

#include "lattice/error.hpp"
#include "lattice/index.hpp"

namespace delf {

int Complex::add_site(const Position& position, SiteRole role) {
  positions_.push_back(position);
  roles_.push_back(role);
  return sites() - 1;
}

int Complex::add_shape(ComplexShape shape) {
  shapes_.push_back(std::move(shape));
  return static_cast<int>(shapes_.size()) - 1;
}

int Complex::add_stencil(int shape, std::span<const int> sites_of) {
  const auto refuse = [&](const std::string& why) {
    throw BadInput("lattice.mesh", "stencil " + std::to_string(stencils()) + ": " + why);
  };
  if (static_cast<int>(sites_of.size()) != shapes_[shape].size)
    refuse("has " + std::to_string(sites_of.size()) + " sites, and its shape another number; give one site a vertex");
  for (auto s = sites_of.begin(); s != sites_of.end(); ++s) {
    if (*s < 0 || *s >= sites()) refuse("site " + std::to_string(*s) + " is not there; add it first");
    if (std::find(sites_of.begin(), s, *s) != s) refuse("names site " + std::to_string(*s) + " twice; name it once");
  }
  shape_of_.push_back(shape);
  vertices_.insert(vertices_.end(), sites_of.begin(), sites_of.end());
  first_.push_back(static_cast<std::int64_t>(vertices_.size()));
  return stencils() - 1;
}

std::string Complex::name(int site) const {
  const Position& p = position(site);
  char text[120];
  std::snprintf(text, sizeof text, "site %d at (t, x, y, z) = (%.6g, %.6g, %.6g, %.6g)", site, p[0], p[1], p[2], p[3]);
  return text;
}

Touching::Touching(const Complex& complex) : first_(at(complex.sites()) + 1, 0) {
  for (int s = 0; s < complex.stencils(); ++s)
    for (const int site : complex.vertices(s)) ++first_[at(site) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  stencils_.resize(first_.back());
  std::vector<std::int64_t> next(first_.begin(), first_.end() - 1);
  for (int s = 0; s < complex.stencils(); ++s)
    for (const int site : complex.vertices(s)) stencils_[at(next[site]++)] = s;
}

}  // namespace delf

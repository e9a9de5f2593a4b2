// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lattice/index.hpp"

namespace delf {

/// A kind of stencil: how many sites it has, and which of its equations contain which of its values.
struct ComplexShape {
  int size = 0;
  std::vector<char> couples = {};  ///< [l·size + m]: the equation of vertex l contains vertex m; empty: all do

  bool is_coupled(int l, int m) const { return couples.empty() || couples[l * size + m] != 0; }
};

/// What is asked at a site of a complex.
enum class SiteRole : char {
  free,     ///< the value is unknown, and the equation holds
  given,    ///< the value is data, and there is no equation: a wall
  initial,  ///< the value is data, and the equation holds: a row to start from
  final     ///< the value is unknown, and there is no equation: the last row
};

/// A finite set of stencils over sites with coordinates in spacetime. A stencil is an ordered list of sites; stencils of
/// several shapes lie side by side, and a regular lattice is one kind of complex. Memory is linear in what is added.
class Complex {
 public:
  using Position = std::array<double, 4>;  ///< t, x, y, z

  /// So many are to be added, with so many sites of stencils in all.
  void reserve(std::size_t sites, std::size_t stencils, std::size_t vertices) {
    positions_.reserve(sites), roles_.reserve(sites);
    shape_of_.reserve(stencils), first_.reserve(stencils + 1), vertices_.reserve(vertices);
  }
  int add_site(const Position&, SiteRole = SiteRole::free);
  int add_shape(ComplexShape);
  /// Throws BadInput for a site that is not there, or that the stencil names twice.
  int add_stencil(int shape, std::span<const int> sites);
  void set_role(int site, SiteRole role) { roles_[site] = role; }

  int sites() const { return static_cast<int>(positions_.size()); }
  int stencils() const { return static_cast<int>(shape_of_.size()); }
  const Position& position(int site) const { return positions_[site]; }
  SiteRole role(int site) const { return roles_[site]; }
  bool is_unknown(int site) const { return role(site) == SiteRole::free || role(site) == SiteRole::final; }
  bool has_equation(int site) const { return role(site) == SiteRole::free || role(site) == SiteRole::initial; }

  const ComplexShape& shape(int stencil) const { return shapes_[shape_number(stencil)]; }
  int shape_number(int stencil) const { return shape_of_[stencil]; }
  /// Δ⁰, Δ¹, …
  std::span<const int> vertices(int stencil) const {
    const std::size_t s = stencil;
    return {vertices_.data() + first_[s], at(first_[s + 1] - first_[s])};
  }
  /// "site 17 at (t, x, y, z) = (0.5, 1, 0, 0)"
  std::string name(int site) const;

 private:
  std::vector<Position> positions_;
  std::vector<SiteRole> roles_;
  std::vector<ComplexShape> shapes_;
  std::vector<std::int32_t> shape_of_, vertices_;
  std::vector<std::int64_t> first_{0};
};

/// Which stencils touch a site: the transposed list, O(1) a question.
class Touching {
 public:
  explicit Touching(const Complex&);
  std::span<const std::int32_t> operator[](int site) const {
    const std::size_t s = site;
    return {stencils_.data() + first_[s], at(first_[s + 1] - first_[s])};
  }

 private:
  std::vector<std::int64_t> first_;
  std::vector<std::int32_t> stencils_;
};

}  // namespace delf

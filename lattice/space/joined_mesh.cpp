// SPDX-License-Identifier: MIT
#include "lattice/space/joined_mesh.hpp"

#include <algorithm>
#include <set>
#include <sstream>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/space/coincident_points.hpp"
#include "lattice/space/point_vectors.hpp"
#include "lattice/space/united_points.hpp"

namespace delf {
namespace {

[[noreturn]] void refuse(const JoinedParts& pair, const std::string& why) {
  throw BadInput("boundary." + pair.part, "boundary." + pair.part + " = periodic:" + pair.with + ": " + why);
}

std::string in_words(const Mesh& mesh, const Mesh::Point& p) {
  std::ostringstream text;
  for (int c = 0; c < mesh.coordinates(); ++c) text << (c == 0 ? "(" : ", ") << p[at(c)];
  return text.str() + ")";
}

const Mesh::Part& part_of(const Mesh& mesh, const JoinedParts& pair, const std::string& name) {
  const auto found = std::ranges::find(mesh.parts, name, &Mesh::Part::name);
  if (found == mesh.parts.end()) refuse(pair, "the mesh has no part " + name + "; name one of its boundary's parts");
  return *found;
}

/// The points of a part, and the middle of its sides: wherever its points lie on them, copies have the same.
struct PartPoints {
  std::vector<std::int32_t> points;
  Mesh::Point middle{};

  PartPoints(const Mesh& mesh, const Mesh::Part& part) {
    double length = 0;
    for (const auto& [a, b] : part.sides) {
      const Mesh::Point &p = mesh.points[at(a)], &q = mesh.points[at(b)];
      const double side = a == b ? 1 : norm(between(p, q));
      for (std::size_t c = 0; c < 3; ++c) middle[c] += 0.5 * side * (p[c] + q[c]);
      length += side;
      points.push_back(a), points.push_back(b);
    }
    for (double& x : middle) x /= length;
    std::ranges::sort(points);
    points.erase(std::unique(points.begin(), points.end()), points.end());
  }
};

/// partner[n] of points[n] of a part, among those of the other one.
std::vector<std::int32_t> partners(const Mesh& mesh, const JoinedParts& pair) {
  const PartPoints here(mesh, part_of(mesh, pair, pair.part)), there(mesh, part_of(mesh, pair, pair.with));
  const Mesh::Point shift = between(here.middle, there.middle);
  const double edge = shortest_edge(mesh);
  constexpr double near = 1e-6;
  if (!(norm(shift) > near * edge)) refuse(pair, "the two parts lie at one place; name the one on the other side");
  std::vector<Mesh::Point> all;  // those of `with`, then the shifted ones of `part`
  for (const auto p : there.points) all.push_back(mesh.points[at(p)]);
  for (const auto p : here.points) {
    all.push_back(mesh.points[at(p)]);
    for (std::size_t c = 0; c < 3; ++c) all.back()[c] += shift[c];
  }
  const std::size_t others = there.points.size();
  std::vector<std::int32_t> found(here.points.size(), -1);
  std::vector<char> taken(others, 0);
  each_close_pair(all, near * edge, [&](std::size_t p, std::size_t q) {
    if (p >= others && q < others) found[p - others] = there.points[q], taken[q] = 1;
    return true;
  });
  const auto alone = [&](std::int32_t p, const std::string& part, const std::string& other, double sign) {
    Mesh::Point wanted = mesh.points[at(p)];
    for (std::size_t c = 0; c < 3; ++c) wanted[c] += sign * shift[c];
    refuse(pair, "point " + std::to_string(mesh.point_number(at(p))) + " of " + part + ", at " +
                     in_words(mesh, mesh.points[at(p)]) + ", has no partner on " + other + ", at " +
                     in_words(mesh, wanted) + "; mesh both parts alike, one a translation of the other");
  };
  for (std::size_t n = 0; n < found.size(); ++n)
    if (found[n] < 0) alone(here.points[n], pair.part, pair.with, 1);
  for (std::size_t q = 0; q < others; ++q)
    if (!taken[q]) alone(there.points[q], pair.with, pair.part, -1);
  std::vector<std::int32_t> of_all(mesh.points.size(), -1);
  for (std::size_t n = 0; n < found.size(); ++n) of_all[at(here.points[n])] = found[n];
  return of_all;
}

}  // namespace

Mesh joined(const Mesh& mesh, std::span<const JoinedParts> pairs) {
  if (pairs.empty()) return mesh;
  UnitedPoints united(mesh.points.size());
  std::set<std::array<std::int32_t, 2>> inside;
  for (const JoinedParts& pair : pairs) {
    const std::vector<std::int32_t> partner = partners(mesh, pair);
    for (std::size_t p = 0; p < partner.size(); ++p)
      if (partner[p] >= 0) united.unite(p, at(partner[p]));
    for (const std::string& name : {pair.part, pair.with})
      for (const auto& [a, b] : part_of(mesh, pair, name).sides) inside.insert({std::min(a, b), std::max(a, b)});
  }
  auto [one, number] = MeshOfFirstPoints(mesh, united);
  if (mesh.point_tags.empty()) one.point_tags.clear();
  for (const auto p : mesh.vertices) one.vertices.push_back(number[at(p)]), one.places.push_back(mesh.points[at(p)]);
  const auto outer = boundary_sides(mesh);
  for (const Mesh::Part& part : mesh.parts) {
    Mesh::Part kept{part.name, {}};
    for (const auto& [a, b] : part.sides)
      if (!inside.contains({std::min(a, b), std::max(a, b)})) kept.sides.push_back({number[at(a)], number[at(b)]});
    if (!kept.sides.empty()) one.parts.push_back(std::move(kept));
  }
  // Cells that meet themselves, or each other along two sides, have sides that boundary_sides() cannot tell apart.
  const auto fault = find_fault(one);
  if (fault || boundary_sides(one).size() + inside.size() != outer.size())
    refuse(pairs.front(),
           "a cell would meet itself, or another one twice; take three cells at least from one part to the "
           "other");
  return one;
}

}  // namespace delf

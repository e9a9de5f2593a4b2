// SPDX-License-Identifier: MIT
#include "lattice/space/coincident_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "lattice/index.hpp"
#include "lattice/space/united_points.hpp"

namespace delf {
namespace {

double distance(const Mesh::Point& a, const Mesh::Point& b) {
  return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}

using Bucket = std::array<std::int64_t, 3>;
struct BucketHash {
  std::size_t operator()(const Bucket& b) const {
    std::uint64_t hash = 14695981039346656037U;
    for (const std::int64_t n : b) {
      hash = (hash ^ static_cast<std::uint64_t>(n)) * 1099511628211U;
      hash ^= hash >> 29;
    }
    return at(hash);
  }
};

}  // namespace

void each_close_pair(std::span<const Mesh::Point> points, double near,
                     const std::function<bool(std::size_t, std::size_t)>& visit) {
  double largest = 0;
  for (const Mesh::Point& p : points)
    for (const double x : p) largest = std::max(largest, std::abs(x));
  // A bucket is no smaller than numbers that large can tell apart.
  const double size =
      std::max({4 * near, 8 * std::numeric_limits<double>::epsilon() * largest, std::numeric_limits<double>::min()});
  std::unordered_map<Bucket, std::vector<std::size_t>, BucketHash> buckets;
  buckets.reserve(points.size());
  const auto bucket = [&](double x) { return static_cast<std::int64_t>(std::floor(x / size)); };
  for (std::size_t p = 0; p < points.size(); ++p) {
    std::vector<std::size_t> close;
    Bucket low, high, b;
    for (std::size_t c = 0; c < 3; ++c) low[c] = bucket(points[p][c] - near), high[c] = bucket(points[p][c] + near);
    for (b[0] = low[0]; b[0] <= high[0]; ++b[0])
      for (b[1] = low[1]; b[1] <= high[1]; ++b[1])
        for (b[2] = low[2]; b[2] <= high[2]; ++b[2])
          if (const auto found = buckets.find(b); found != buckets.end())
            for (const std::size_t q : found->second)
              if (distance(points[p], points[q]) <= near) close.push_back(q);
    std::ranges::sort(close);
    for (const std::size_t q : close)
      if (!visit(p, q)) return;
    buckets[{bucket(points[p][0]), bucket(points[p][1]), bucket(points[p][2])}].push_back(p);
  }
}

std::optional<std::pair<std::size_t, std::size_t>> coincident_points(const Mesh& mesh) {
  constexpr double near = 1e-6;
  std::vector<double> shortest(mesh.points.size(), std::numeric_limits<double>::infinity());
  double longest = 0;
  for (int c = 0; c < mesh.cells(); ++c) {
    const double edge = shortest_edge(mesh, c);
    for (const auto p : mesh.cell(c)) shortest[p] = std::min(shortest[p], edge);
  }
  for (const double edge : shortest)
    if (std::isfinite(edge)) longest = std::max(longest, edge);
  std::optional<std::pair<std::size_t, std::size_t>> found;
  each_close_pair(mesh.points, near * longest, [&](std::size_t p, std::size_t q) {
    if (distance(mesh.points[p], mesh.points[q]) <= near * std::min(shortest[p], shortest[q])) found = {p, q};
    return !found;
  });
  return found;
}

Mesh merged(const Mesh& mesh, double near) {
  UnitedPoints united(mesh.points.size());
  each_close_pair(mesh.points, near, [&](std::size_t p, std::size_t q) {
    united.unite(p, q);
    return true;
  });
  auto [one, number] = MeshOfFirstPoints(mesh, united);
  for (const auto p : mesh.vertices)  // a number that is of no point is of none still
    one.vertices.push_back(p >= 0 && at(p) < number.size() ? number[p] : p);
  one.parts = mesh.parts;
  for (Mesh::Part& part : one.parts)
    for (auto& side : part.sides)
      for (auto& p : side) p = number[p];
  return one;
}

}  // namespace delf

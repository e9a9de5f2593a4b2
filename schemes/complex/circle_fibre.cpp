// SPDX-License-Identifier: MIT
#include "schemes/complex/circle_fibre.hpp"

#include <cmath>
#include <string>

#include "jets/fibre.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"

namespace delf {
namespace {

/// The point of a cell that is too far from the cell's first one, in the values' own differences or modulo 2π; or −1.
int first_too_far(const Mesh& mesh, std::span<const double> values, bool modulo) {
  for (int c = 0; c < mesh.cells(); ++c)
    for (const int p : mesh.cell(c)) {
      const double apart = values[p] - values[mesh.cell(c)[0]];
      if (!(std::abs(modulo ? wrap(apart) : apart) <= largest_wrapped_difference)) return p;
    }
  return -1;
}

}  // namespace

std::vector<double> lifted(const Mesh& mesh, std::vector<double> angles) {
  if (const int p = first_too_far(mesh, angles, true); p >= 0)
    throw NotFinite(
        "point " + std::to_string(mesh.point_number(at(p))) +
        ": on the fibre S1 the starting values jump by more than 0.9 pi within a cell; refine the mesh or use "
        "theory.fibre = R");
  std::vector<std::vector<int>> cells_of(angles.size());
  for (int c = 0; c < mesh.cells(); ++c)
    for (const int p : mesh.cell(c)) cells_of[p].push_back(c);
  // Outwards from a point, each next to a neighbour that is lifted already.
  std::vector<char> done(angles.size(), 0);
  for (std::size_t begin = 0; begin < angles.size(); ++begin) {
    if (done[begin]) continue;
    std::vector<std::size_t> front{begin};
    done[begin] = 1;
    for (std::size_t k = 0; k < front.size(); ++k)
      for (const int c : cells_of[front[k]])
        for (const int p : mesh.cell(c)) {
          const std::size_t next = p;
          if (done[next]) continue;
          angles[next] = angles[front[k]] + wrap(angles[next] - angles[front[k]]);
          done[next] = 1;
          front.push_back(next);
        }
  }
  if (const int p = first_too_far(mesh, angles, false); p >= 0)
    throw BadInput("theory.fibre",
                   "theory.fibre = S1: the start winds around a hole of the mesh, or is not continuous, at point " +
                       std::to_string(mesh.point_number(at(p))) + "; fill the hole, or give another start");
  return angles;
}

void check_wrapped_differences(const Mesh& mesh, std::span<const double> row, std::span<const double> before) {
  int p = first_too_far(mesh, row, false);
  for (std::size_t i = 0; i < row.size() && p < 0; ++i)
    if (!(std::abs(row[i] - before[i]) <= largest_wrapped_difference)) p = static_cast<int>(i);
  if (p >= 0)
    throw NotFinite(
        "point " + std::to_string(mesh.point_number(at(p))) +
        ": on the fibre S1 a difference within a cell or a step is above 0.9 pi, where it cannot be distinguished from "
        "its complement; refine the mesh, take shorter steps, or use theory.fibre = R");
}

}  // namespace delf

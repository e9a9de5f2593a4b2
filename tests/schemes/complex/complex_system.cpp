// SPDX-License-Identifier: MIT
#include "schemes/complex/complex_system.hpp"

#include <array>
#include <cmath>

#include "jets/expressions/expression.hpp"
#include "schemes/complex/space_tables.hpp"
#include "tests/catch.hpp"

namespace {

using namespace delf;

constexpr int points = 7;

/// A segment from point i to the next one, with this measure. Segments 0, 2 and 4 are alike, and 1 and 3.
struct Segment {
  int first;
  double measure;
};

/// E of these segments at every point.
std::vector<double> equations(std::span<const Segment> segments, std::span<const double> y) {
  const SpaceTables tables(expression("0.5*phi_t^2 - 0.5*(1 + phi^2)*phi_x^2"));
  Mesh mesh{.points = {}, .vertices = {}};
  for (int i = 0; i < points; ++i) mesh.points.push_back({i + (i % 2 == 0 ? 0 : 0.25), 0, 0});
  for (int i = 0; i + 1 < points; ++i) mesh.add_cell(std::array<std::int32_t, 2>{i, i + 1});
  ComplexSystem system(1);
  for (const Mesh::Point& p : mesh.points) system.add_site({0, p[0], p[1], p[2]});
  const int family = system.add_family(tables.gradient(2));
  for (const auto& [first, measure] : segments)
    system.add_stencil(family, std::array{first, first + 1},
                       system.add_table(family, tables.gradient_table(mesh, first)), measure);
  std::vector<double> E;
  for (const Balance& sum : system.residual(y)) E.push_back(sum.sum);
  return E;
}

TEST_CASE("equal tables of a complex are one, and others are not") {
  const SpaceTables tables(expression("0.5*phi_t^2 - 0.5*phi_x^2"));
  const Mesh mesh = graded_interval(3, 4, 1), other = graded_interval(3, 4, 0.9);
  ComplexSystem system(1);
  const int family = system.add_family(tables.gradient(2));
  const int first = system.add_table(family, tables.gradient_table(mesh, 0));
  CHECK(system.add_table(family, tables.gradient_table(other, 1)) != first);
  CHECK(system.add_table(family, tables.gradient_table(mesh, 0)) == first);
}

TEST_CASE("stencils that share their numbers have the equations of stencils alone") {
  const std::array segments{Segment{0, 1}, Segment{1, 1}, Segment{2, 1}, Segment{3, 1}, Segment{4, 3}, Segment{5, 1}};
  std::array<double, points> y{};
  for (int i = 0; i < points; ++i) y[i] = std::sin(1.0 + i * i);
  const std::vector<double> together = equations(segments, y);
  std::vector<double> apart(points, 0.0);
  for (const Segment& segment : segments) {
    const std::vector<double> alone = equations({&segment, 1}, y);
    for (int i = 0; i < points; ++i) apart[i] += alone[i];
  }
  for (int i = 0; i < points; ++i) CHECK(together[i] == Approx(apart[i]).epsilon(1e-13));
}

}  // namespace

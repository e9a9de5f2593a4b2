// SPDX-License-Identifier: MIT
#include <cmath>

#include "tests/catch.hpp"
#include "tools/film/painted_cells.hpp"

using delf::Mesh;
using delf::PaintedCells;

TEST_CASE("a map of a plane has a linear field at each pixel, and nothing beside the mesh") {
  Mesh mesh;  // a quadrilateral and a triangle, which leave a corner of their box free
  mesh.points = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {0, 2, 0}};
  mesh.add_cell(std::vector<std::int32_t>{0, 1, 2, 3});
  mesh.add_cell(std::vector<std::int32_t>{3, 2, 4});
  const auto field = [](double x, double y) { return 1 + 3 * x - 2 * y; };
  std::vector<double> values;
  for (const Mesh::Point& p : mesh.points) values.push_back(field(p[0], p[1]));
  const PaintedCells cells(mesh, 100);
  REQUIRE(cells.width() == 100);
  REQUIRE(cells.height() == 100);
  const std::vector<float> map = cells.values(values);
  for (int j = 0; j < 100; ++j)
    for (int i = 0; i < 100; ++i) {
      const double x = (i + 0.5) * 0.02, y = (j + 0.5) * 0.02;
      const float value = map[static_cast<std::size_t>(100 * j + i)];
      if (y > 1.01 && x > 2 * (2 - y) + 0.01) CHECK(std::isnan(value));
      else if (y < 1 || x < 2 * (2 - y)) CHECK(std::abs(value - field(x, y)) < 1e-5);
    }
}

TEST_CASE("a surface is seen from where gnuplot sees it") {
  // by set view 65,40 a point at (1, 0, 0) is to the right of the middle, below it and in front
  Mesh mesh;
  mesh.points = {{1, -0.1, -0.1}, {1, 0.1, -0.1}, {1, 0, 0.1}, {-1, -1, -1}, {-1, 1, 1}};
  mesh.add_cell(std::vector<std::int32_t>{0, 1, 2});
  mesh.add_cell(std::vector<std::int32_t>{3, 3, 4});  // of no area: it makes room
  const PaintedCells cells(mesh, 200);
  const std::vector<float> map = cells.values(std::vector<double>(5, 1.0));
  double x = 0, y = 0, count = 0;
  for (std::size_t n = 0; n < map.size(); ++n)
    if (!std::isnan(map[n])) {
      const auto width = static_cast<std::size_t>(cells.width());
      x += static_cast<double>(n % width) + 0.5, y += static_cast<double>(n / width) + 0.5, ++count;
    }
  REQUIRE(count > 0);
  const auto place = [&](std::size_t axis, double pixel, int pixels) {
    return cells.low()[axis] + (cells.high()[axis] - cells.low()[axis]) * pixel / pixels;
  };
  constexpr double degree = 3.14159265358979 / 180;
  CHECK(std::abs(place(0, x / count, cells.width()) - std::cos(40 * degree)) < 0.03);
  CHECK(std::abs(place(1, y / count, cells.height()) + std::sin(40 * degree) * std::cos(65 * degree)) < 0.05);
}

TEST_CASE("of a surface its near side is seen") {
  Mesh mesh;  // two parallel squares, the second one in front by set view 65,40
  for (const double y : {1.0, -1.0})
    for (const auto& [x, z] : {std::pair(-5.0, -5.0), {5.0, -5.0}, {5.0, 5.0}, {-5.0, 5.0}})
      mesh.points.push_back({x, y, z});
  std::vector<double> values(4, 1.0);
  values.resize(8, 2.0);
  const auto middle = [&](bool front_first) {
    Mesh two = mesh;
    for (const int square : front_first ? std::vector{1, 0} : std::vector{0, 1})
      two.add_cell(std::vector<std::int32_t>{4 * square, 4 * square + 1, 4 * square + 2, 4 * square + 3});
    const PaintedCells cells(two, 99);
    return cells.values(values)[static_cast<std::size_t>(cells.height() / 2 * cells.width() + cells.width() / 2)];
  };
  CHECK(middle(false) == 2);
  CHECK(middle(true) == 2);
}

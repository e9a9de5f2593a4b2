// SPDX-License-Identifier: MIT
#include "schemes/complex/space_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/families/mesh_families.hpp"

namespace delf {
namespace {

/// Whether ℓ(φ, 0, p) − ℓ(φ, 0, 0) is multiplied by s² as p is by s, at random jets.
bool is_quadratic(const BatchDensity& density) {
  const int d = density.components(), v = density.variables();
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0.1, 0.7);
  std::vector<std::array<double, 8>> jets(v);
  const std::array<double, 4> factors{0, 1, 2, -1};
  for (int i = 0; i < v; ++i) {
    const double value = uniform(random);
    for (std::size_t s = 0; s < 8; ++s)
      jets[i][s] = i < d ? value : i >= 2 * d && i < 3 * d ? value * factors[s % 4] : 0;
  }
  alignas(64) std::array<double, 8> l{};
  std::vector<const double*> slots;
  // packs are aligned
  std::vector<Pack> aligned(at(v + 1) * 8 / lanes);
  for (int i = 0; i < v; ++i) {
    double* const row = reinterpret_cast<double*>(aligned.data()) + 8 * i;
    for (std::size_t s = 0; s < 8; ++s) row[s] = jets[i][s];
    slots.push_back(row);
  }
  double* const x = reinterpret_cast<double*>(aligned.data()) + 8 * v;
  std::fill_n(x, 8, uniform(random));
  density.value({8, slots.data(), uniform(random), x}, l.data());
  const double one = l[1] - l[0], size = std::abs(one) + std::abs(l[0]) + 1e-300;
  return std::abs(l[2] - l[0] - 4 * one) < 1e-12 * size && std::abs(l[3] - l[0] - one) < 1e-12 * size;
}

}  // namespace

SpaceTables::SpaceTables(std::shared_ptr<const BatchDensity> density) : density_(std::move(density)), coupled_(false) {
  const auto refuse = [](const std::string& why) {
    throw BadInput("theory.name",
                   "theory.name: lattice.space = complex needs a density T(phi_t) + V(phi, grad phi), "
                   "quadratic in the gradient; this one " +
                       why + "; choose lattice.space = circle");
  };
  const int d = density_->components();
  if (density_->slots() > 3) refuse("has second derivatives");
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b)
      if (!density_->is_zero(d + a, b) || !density_->is_zero(d + a, 2 * d + b))
        refuse("couples phi_t with phi or phi_x");
  coupled_ = couples_gradient(*density_);
  if (!is_quadratic(*density_)) refuse("is not quadratic in phi_x");
}

std::vector<TablePoint> SpaceTables::motion_table() const {
  TablePoint point;
  point.set(JetSlot::phi_t, {-1, 1});
  return {point};
}

std::vector<TablePoint> SpaceTables::site_table() const {
  TablePoint point;
  point.set(JetSlot::phi, {1});
  return {point};
}

ComplexSystem::Family SpaceTables::motion() const {
  ComplexSystem::Family family(density_, 2, motion_table());
  family.add_table(motion_table());
  return family;
}
ComplexSystem::Family SpaceTables::site() const {
  ComplexSystem::Family family(density_, 1, site_table());
  family.add_table(site_table());
  return family;
}

namespace {

Mesh cell_of(int corners) {
  Mesh mesh{.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, .vertices = {}};
  std::vector<std::int32_t> cell{0, 1, 2, 3};
  cell.resize(corners);
  mesh.add_cell(cell);
  return mesh;
}

}  // namespace

ComplexSystem::Family SpaceTables::gradient(int corners) const {
  return {density_, corners, gradient_table(cell_of(corners), 0)};
}
ComplexSystem::Family SpaceTables::cell(int corners) const {
  return {density_, corners, cell_table(cell_of(corners), 0)};
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <utility>
#include <vector>

#include "jets/tables/jet_table.hpp"
#include "lattice/index.hpp"
#include "lattice/stencil_shape.hpp"

namespace delf {

/// The numbers in a jet, for each component of the field. Second derivatives are there for densities that ask for them.
enum class JetSlot { phi, phi_t, phi_x, phi_tt, phi_tx, phi_xx };
inline constexpr int jet_slots = 6;
inline constexpr std::array<const char*, jet_slots> slot_names{"phi", "phi_t", "phi_x", "phi_tt", "phi_tx", "phi_xx"};

/// Weights of a slot are divided by h^time k^space.
struct SlotPowers {
  int time, space;
};
inline constexpr std::array<SlotPowers, jet_slots> slot_powers{{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};

/// One quadrature point: a sparse linear map from the values at the vertices to the jet there, with h = k = 1.
struct TablePoint {
  struct Entry {
    int vertex;
    double weight;
  };
  double weight = 1;
  double time = 0, space = 0;  ///< where it lies, from the anchor, in steps
  std::array<std::vector<Entry>, jet_slots> slots;
  /// On a space where stencils do not repeat, each has numbers of its own (schemes/families/own_weights.hpp): the number that
  /// multiplies the point's weight, those that are the place x and the time t, from the batch's, and those that multiply the
  /// entries of a slot; −1, or no list: none. A batch has one time: with times of their own a batch is one stencil.
  struct Own {
    int weight = -1, place = -1, time = -1;
    std::array<std::vector<int>, jet_slots> slots = {};
  };
  Own own = {};

  /// Weights that are zero are left out.
  void set(JetSlot slot, const std::vector<double>& weights) {
    auto& entries = slots[at(slot)];
    entries.clear();
    for (std::size_t l = 0; l < weights.size(); ++l)
      if (weights[l] != 0) entries.push_back({static_cast<int>(l), weights[l]});
  }
  const std::vector<Entry>& operator[](JetSlot slot) const { return slots[at(slot)]; }
};

/// The place of a node of the unit cell in the cell, as fractions of h and k. Node 0 is the vertex (0, 0).
struct NodePosition {
  double time = 0, space = 0;
};

/// The data of one scheme: the vertices that a stencil reads and the jets that their values stand for,
///
///     L_Δ = |Δ| Σ_q w_q ℓ(t_q, x_q, j_q),    j_q = M_q y_Δ,    |Δ| = measure · h k.
///
/// A stencil of sites, an element with nodes inside its cell, and the sub-steps of a composition are tables alike.
struct StencilTable {
  StencilPattern pattern;
  std::vector<TablePoint> points;
  std::vector<NodePosition> nodes = {{}};  ///< of the unit cell
  double measure = 1;  ///< the share of spacetime that one stencil stands for, so that Σ_Δ |Δ| is the area
  /// Elements: the quadrature of the lower side, where a step starts: weights, and φ and φ_x of the vertices there
  /// (time and node's time 0), in their order. φ_t has the weights of φ.
  std::vector<TablePoint> lower_side = {};
  /// The functions that take the place of M_qᵀ in methods that are not variational: ∂ℓ/∂j enters residuals by them.
  std::vector<TablePoint> tests = {};

  const TablePoint& test(std::size_t point) const { return tests.empty() ? points[point] : tests[point]; }
};

/// True if the weights of every point are exact on affine fields and those of the points sum to 1: the rule that
/// built-in tables are checked by when they are compiled (is_consistent of a JetTable).
bool is_consistent(const StencilTable&);

/// A built-in table, made at compile time, as the type that families work with.
template <int n, int Q>
StencilTable stencil_table(const JetTable<n, Q>& map) {
  StencilTable table{.pattern = StencilPattern(map.shape), .points = {}, .measure = map.measure};
  for (const QuadraturePoint<n>& q : map.quadrature) {
    TablePoint point{
        .weight = q.weight, .time = time_offset(map.shape, q), .space = space_offset(map.shape, q), .slots = {}};
    const auto list = [](const auto& weights) { return std::vector<double>(weights.begin(), weights.end()); };
    point.set(JetSlot::phi, list(q.phi));
    point.set(JetSlot::phi_t, list(q.phi_t));
    point.set(JetSlot::phi_x, list(q.phi_x));
    point.set(JetSlot::phi_tt, list(q.phi_tt));
    point.set(JetSlot::phi_tx, list(q.phi_tx));
    point.set(JetSlot::phi_xx, list(q.phi_xx));
    table.points.push_back(std::move(point));
  }
  return table;
}

}  // namespace delf

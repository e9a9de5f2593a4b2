// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "lattice/plan/incidence.hpp"
#include "lattice/lattice.hpp"
#include "lattice/plan/sigma_method.hpp"

namespace delf {

/// a mod n, at least 0.
inline int positive_mod(int a, int n) { return ((a % n) + n) % n; }

/// The equations of a lattice up to repetition: on a circle those of one cell (one site; two for a brick wall), on an
/// interval those of a short one with the same walls. Nodes are (site, component, parity of the row); only brick walls
/// have two parities.
class Quotient {
 public:
  static Quotient of_circle(const Lattice&, const SystemPattern&);
  /// The interval of `sites` sites instead.
  static Quotient of_interval(const Lattice&, const SystemPattern&, int sites);
  /// The cell in the middle of an interval, as if space were a circle of such cells.
  Quotient middle() const;

  /// An equation contains an unknown, `time` rows later and `space` sites to the right. Both are nodes.
  struct Edge {
    int equation, unknown;
    int time, space;
    Dependence dependence;
  };

  int node(int site, int component, int parity) const { return (site * components + component) * parities + parity; }
  int nodes() const { return sites * components * parities; }
  int site(int node) const { return node / (components * parities); }
  int component(int node) const { return node / parities % components; }
  int parity(int node) const { return node % parities; }
  /// site·components + component, without bounds
  int place(int node, int space) const { return (site(node) + space) * components + component(node); }
  /// The distance of a site from the cell's own, in whole cells of a circle.
  int cell(int shifted_site) const { return circle ? (shifted_site - wrapped(shifted_site)) / sites : 0; }
  int wrapped(int shifted_site) const { return ((shifted_site % sites) + sites) % sites; }
  /// A site as far from both walls as possible that keeps its place in its period in longer intervals.
  int centre() const { return sites / 2 < period ? sites / 2 : sites / 2 / period * period; }

  bool circle = true;
  int sites = 1, components = 1, parities = 1;
  int period = 1;            ///< of the plan between the walls, in sites
  std::vector<char> solved;  ///< of each node: it has an equation; a node without one is data
  std::vector<Edge> edges;   ///< between solved nodes
  std::vector<int> reach;    ///< of each node: the time of the oldest value in its equation, data too
  bool linear = true;        ///< all equations are

  /// The structural analysis of its solved nodes, in terms of nodes; match holds edges. Between the walls d is what it
  /// is on a circle, where that is possible; at the walls then as near to that as it can be.
  StructuralAnalysis analysis() const;

 private:
  using Couplings = std::vector<std::vector<Coupling>>;  // of each node
  Quotient(bool circle_, int sites_, const SystemPattern&, const Lattice&);
  Quotient(bool circle_, int sites_, int components_, int parities_, int period_, Couplings);

  Couplings couplings_;
};

/// The unknowns of a slab as a directed graph: an edge from u to v if the equation that determines u contains v.
struct SlabGraph {
  struct Edge {
    int from, to;
    int cells;  ///< from u to v, along a circle
  };
  std::vector<Edge> edges;
  int lower = 0, upper = 0;
  bool nonlinear = false;
  std::vector<int> block;  ///< of each node: its strongly connected component
  int blocks = 0;
};
/// `cells` is the number of cells of the circle; 1 for an interval.
SlabGraph slab_graph(const Quotient&, const StructuralAnalysis&, int cells);
/// The number of strongly connected components that the slabs of a parity have, on the whole circle or interval.
long long count_blocks(const Quotient&, const StructuralAnalysis&, const SlabGraph&, int cells, int slab_parity);

}  // namespace delf

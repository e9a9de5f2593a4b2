// SPDX-License-Identifier: MIT
#include "lattice/plan/quotient.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <string>
#include <utility>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/connected_components.hpp>
#include <boost/graph/strong_components.hpp>

#include "lattice/error.hpp"

namespace delf {
namespace {

int parities_of(const SystemPattern& system) { return system.placement == Placement::brick_wall ? 2 : 1; }

/// The couplings of an equation; checks that the lattice has all of its unknowns.
std::vector<Coupling> checked(const SystemPattern& system, const Lattice& lattice, bool circle, Site site,
                              int component) {
  std::vector<Coupling> equation = system.equations(lattice, site, component);
  for (const Coupling& c : equation) {
    const int shifted = site.space + c.offset.space;
    const bool inside = circle || (0 <= shifted && shifted < lattice.sites());
    if (!inside || c.component < 0 || c.component >= system.components || std::abs(c.offset.space) > system.width)
      throw BadInput("lattice.stencil", "lattice.stencil: the equation of site " + std::to_string(site.space) +
                                            " contains component " + std::to_string(c.component) + " at offset " +
                                            std::to_string(c.offset.space) +
                                            ", outside the lattice, the components or the stated width; correct it");
  }
  return equation;
}

/// The preference among equally good unknowns of an equation: its own site and component first, else a near
/// one. The last digits differ for all offsets, so that the best matching is unique and repeats along the lattice.
long long farness(const Quotient& quotient, const Quotient::Edge& edge) {
  const long long steps = std::abs(edge.space) * quotient.components +
                          std::abs(quotient.component(edge.unknown) - quotient.component(edge.equation));
  if (steps == 0) return 0;
  auto mixed = static_cast<std::uint64_t>(edge.space + (1 << 20)) * 0x9e3779b97f4a7c15u;
  mixed = (mixed ^ (mixed >> 29) ^ static_cast<std::uint64_t>(quotient.component(edge.unknown))) * 0xbf58476d1ce4e5b9u;
  mixed = (mixed ^ (mixed >> 32) ^ static_cast<std::uint64_t>(quotient.component(edge.equation))) * 0x94d049bb133111ebu;
  return (steps << 24) + static_cast<long long>(mixed >> 44);
}

/// Shifts c and d together so that in each connected part the innermost unknown of the lowest component has d = 0.
void centre_offsets(const Quotient& quotient, const std::vector<int>& part, StructuralAnalysis& analysis) {
  const auto inner = [&](int node) {
    return std::pair{quotient.component(node), std::abs(quotient.site(node) - quotient.centre())};
  };
  std::vector<int> centre(part.size(), -1);
  for (int node = 0; node < quotient.nodes(); ++node) {
    int& best = centre[part[node]];
    if (quotient.solved[node] && (best < 0 || inner(node) < inner(best))) best = node;
  }
  std::vector<int> shift(part.size(), 0);
  for (std::size_t p = 0; p < part.size(); ++p)
    if (centre[p] >= 0) shift[p] = analysis.d[centre[p]];
  for (int node = 0; node < quotient.nodes(); ++node) {
    analysis.c[node] -= shift[part[node]];
    analysis.d[node] -= shift[part[node]];
  }
}

/// Finds offsets that equal those of a circle between the walls, and are nearest to them at the walls.
void extend_from_middle(const Quotient& quotient, const std::vector<Occurrence>& occurrences,
                        StructuralAnalysis& analysis) {
  const Quotient cell = quotient.middle();
  const StructuralAnalysis bulk = cell.analysis();
  if (!bulk.solvable()) return;

  int far = 1;  // more rows than any chain of equations spans
  for (const Occurrence& o : occurrences) far += 2 * std::abs(o.time);
  std::vector<int> profile, least;
  for (int n = 0; n < quotient.nodes(); ++n) {
    const int same = cell.node(quotient.site(n) % cell.sites, quotient.component(n), quotient.parity(n));
    profile.push_back(bulk.d[same]);
    least.push_back(quotient.site(n) == quotient.centre() ? profile[n] : profile[n] - far);
  }

  // The lowest offsets that the middle allows at the walls, then the highest below the profile, or below those.
  StructuralAnalysis extended = analysis;
  raise_offsets(extended, occurrences, least);
  for (int n = 0; n < quotient.nodes(); ++n)
    if (quotient.site(n) == quotient.centre() && extended.d[n] != profile[n]) return;
  std::vector<int> most(quotient.nodes());
  for (int n = 0; n < quotient.nodes(); ++n) most[n] = std::max(extended.d[n], profile[n]);
  lower_offsets(extended, occurrences, most);
  analysis = extended;
}

}  // namespace

Quotient Quotient::of_circle(const Lattice& lattice, const SystemPattern& system) {
  return {true, parities_of(system), system, lattice};
}

Quotient Quotient::of_interval(const Lattice& lattice, const SystemPattern& system, int sites) {
  if (lattice.space() == Space::point) return {false, sites, system, lattice};
  const double length = lattice.space_step() * (sites - 1);
  return {false, sites, system, Lattice::interval(sites, length, lattice.left(), lattice.right())};
}

Quotient::Quotient(bool circle_, int sites_, const SystemPattern& system, const Lattice& lattice)
    : Quotient(circle_, sites_, system.components, parities_of(system), 2 * std::max(system.width, 1), [&] {
        Couplings couplings;
        for (int i = 0; i < sites_; ++i)
          for (int component = 0; component < system.components; ++component)
            for (int j = 0; j < parities_of(system); ++j)
              couplings.push_back(checked(system, lattice, circle_, {j, i}, component));
        return couplings;
      }()) {}

Quotient::Quotient(bool circle_, int sites_, int components_, int parities_, int period_, Couplings couplings)
    : circle(circle_),
      sites(sites_),
      components(components_),
      parities(parities_),
      period(period_),
      reach(nodes()),
      couplings_(std::move(couplings)) {
  for (const auto& equation : couplings_) solved.push_back(!equation.empty());
  for (int n = 0; n < nodes(); ++n)
    for (const Coupling& c : couplings_[n]) {
      linear = linear && c.dependence == Dependence::linear;
      reach[n] = std::min(reach[n], c.offset.time);
      const int row_parity = positive_mod(parity(n) + c.offset.time, parities);
      const int u = node(wrapped(site(n) + c.offset.space), c.component, row_parity);
      if (solved[u]) edges.push_back({n, u, c.offset.time, c.offset.space, c.dependence});
    }
}

Quotient Quotient::middle() const {
  // A brick wall's cell must begin at an even site, as those of a circle do.
  const int first = centre() / parities * parities;
  return {true, parities, components, parities, 1,
          Couplings(couplings_.begin() + node(first, 0, 0), couplings_.begin() + node(first + parities, 0, 0))};
}

StructuralAnalysis Quotient::analysis() const {
  // Data take part as equations of themselves, so that nodes keep their numbers.
  std::vector<Occurrence> occurrences;
  for (const Edge& e : edges) occurrences.push_back({e.equation, e.unknown, e.time, farness(*this, e)});
  for (int n = 0; n < nodes(); ++n)
    if (!solved[n]) occurrences.push_back({n, n, 0, 0});

  StructuralAnalysis result = analyse(nodes(), occurrences);
  if (!result.solvable()) return result;

  boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS> graph(nodes());
  for (const Occurrence& o : occurrences) boost::add_edge(o.equation, o.unknown, graph);
  std::vector<int> part(nodes());
  boost::connected_components(graph, part.data());

  if (!circle) extend_from_middle(*this, occurrences, result);
  centre_offsets(*this, part, result);
  return result;
}

SlabGraph slab_graph(const Quotient& quotient, const StructuralAnalysis& analysis, int cells) {
  SlabGraph slab;
  for (const Quotient::Edge& e : quotient.edges) {
    if (e.time != analysis.d[e.unknown] - analysis.c[e.equation]) continue;  // of an earlier slab
    slab.nonlinear = slab.nonlinear || e.dependence == Dependence::nonlinear;

    const Quotient::Edge& solved = quotient.edges[analysis.match[e.equation]];
    const int site = quotient.site(e.equation);
    const int distance = quotient.cell(site + e.space) - quotient.cell(site + solved.space);
    if (e.unknown == solved.unknown && distance % cells == 0) continue;
    slab.edges.push_back({solved.unknown, e.unknown, distance});

    const int step = (solved.space - e.space) * quotient.components + quotient.component(solved.unknown) -
                     quotient.component(e.unknown);
    slab.lower = std::max(slab.lower, step);
    slab.upper = std::max(slab.upper, -step);
  }

  boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS> graph(quotient.nodes());
  for (const SlabGraph::Edge& e : slab.edges) boost::add_edge(e.from, e.to, graph);
  slab.block.resize(quotient.nodes());
  slab.blocks = boost::strong_components(
      graph, boost::make_iterator_property_map(slab.block.begin(), boost::get(boost::vertex_index, graph)));
  return slab;
}

long long count_blocks(const Quotient& quotient, const StructuralAnalysis& analysis, const SlabGraph& slab, int cells,
                       int slab_parity) {
  // On the circle of M cells, a block of the quotient whose closed walks wind by multiples of g cells falls apart into
  // gcd(g, M) blocks. Walks are closed with respect to heights: the cells walked from the block's first node.
  constexpr int unseen = 1 << 30;
  std::vector<int> height(quotient.nodes(), unseen), winding(slab.blocks, 0);
  std::vector<std::vector<SlabGraph::Edge>> leaving(quotient.nodes());
  for (const SlabGraph::Edge& e : slab.edges)
    if (slab.block[e.from] == slab.block[e.to]) leaving[e.from].push_back(e);

  std::vector<char> counted(slab.blocks, false);
  long long blocks = 0;
  for (int first = 0; first < quotient.nodes(); ++first) {
    const int row = slab_parity + analysis.d[first] - quotient.parity(first);
    if (!quotient.solved[first] || row % quotient.parities != 0 || counted[slab.block[first]]) continue;
    int& g = winding[slab.block[first]];
    std::vector<int> stack{first};
    height[first] = 0;
    while (!stack.empty()) {
      const int u = stack.back();
      stack.pop_back();
      for (const SlabGraph::Edge& e : leaving[u])
        if (height[e.to] == unseen)
          height[e.to] = height[u] + e.cells, stack.push_back(e.to);
        else
          g = std::gcd(g, height[u] + e.cells - height[e.to]);
    }
    counted[slab.block[first]] = true;
    blocks += std::gcd(g, cells);
  }
  return blocks;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <optional>
#include <random>
#include <string>

#include "lattice/error.hpp"
#include "lattice/plan/sigma_method.hpp"
#include "lattice/plan/solve_plan.hpp"
#include "tests/catch.hpp"
#include "tests/lattice/plan/systems.hpp"

using namespace delf;
using testing::pick;

namespace {

struct Example {
  Lattice lattice = Lattice::circle(2, 1);
  SystemPattern system;
};

/// Stencils of one or two families, coupled at random, on a small circle or interval.
Example random_example(std::mt19937& random) {
  const int components = pick(random, 1, 2);
  std::vector<StencilIncidence> families;
  for (int f = pick(random, 1, 2); f > 0; --f) {
    const auto placement = pick(random, 0, 2) == 0 ? Placement::brick_wall : Placement::every_site;
    StencilIncidence family{testing::random_pattern(random, placement), {}};
    for (int l = 0; l < family.pattern.size(); ++l)
      for (int m = 0; m < family.pattern.size(); ++m)
        for (int a = 0; a < components; ++a)
          for (int b = 0; b < components; ++b)
            if (l == m && a == b ? pick(random, 0, 3) > 0 : pick(random, 0, 2) == 0)
              family.couplings.push_back({l, m, a, b});
    families.push_back(family);
  }
  Example example{Lattice::circle(2, 1), system_of(components, families)};
  const int N = 2 * pick(random, 1, 12);
  const auto wall = [&] { return pick(random, 0, 1) == 0 ? Wall::fixed : Wall::natural; };
  if (pick(random, 0, 1) == 0)
    example.lattice = Lattice::circle(N, 1);
  else
    example.lattice = Lattice::interval(N + pick(random, 0, 1), 1, wall(), wall());
  return example;
}

/// All unknowns that an equation contains, in the real lattice, and not data.
std::vector<Node> contained(const Example& e, const Node& equation) {
  std::vector<Node> unknowns;
  for (const Coupling& c : e.system.equations(e.lattice, equation.site, equation.component)) {
    Site site = equation.site + c.offset;
    if (e.lattice.is_circle()) site.space = e.lattice.wrapped(site.space);
    if (!e.system.equations(e.lattice, site, c.component).empty()) unknowns.push_back({site, c.component});
  }
  return unknowns;
}

/// The matching of the whole lattice, every site a node of its own.
bool solvable_in_full(const Example& e) {
  const int components = e.system.components, N = e.lattice.sites();
  const auto node = [&](const Node& n) { return ((n.site.time & 1) * N + n.site.space) * components + n.component; };
  std::vector<Occurrence> occurrences;
  for (int j : {0, 1})
    for (int i = 0; i < N; ++i)
      for (int a = 0; a < components; ++a) {
        const Node equation{{j, i}, a};
        if (e.system.equations(e.lattice, equation.site, a).empty())
          occurrences.push_back({node(equation), node(equation), 0});
        for (const Node& u : contained(e, equation)) occurrences.push_back({node(equation), node(u), u.site.time - j});
      }
  return analyse(2 * N * components, occurrences).solvable();
}

/// The slab of every unknown whose row is near 0.
std::map<Node, int> slabs_of_unknowns(const SolvePlan& plan, bool& once) {
  std::map<Node, int> slab_of;
  for (int J = -60; J <= 60; ++J)
    for (const Node& u : plan.slab(J).unknowns) once = slab_of.emplace(u, J).second && once;
  return slab_of;
}

/// Strongly connected components, by transitive closure.
int blocks_of(std::vector<std::vector<char>> reaches) {
  const std::size_t n = reaches.size();
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t a = 0; a < n; ++a)
      if (reaches[a][k])
        for (std::size_t b = 0; b < n; ++b) reaches[a][b] |= reaches[k][b];
  int blocks = 0;
  for (std::size_t a = 0; a < n; ++a) {
    bool first = true;
    for (std::size_t b = 0; b < a; ++b) first = first && !(reaches[a][b] && reaches[b][a]);
    blocks += first;
  }
  return blocks;
}

struct Measured {
  bool causal = true, matched = true, coupled = false;
  int lower = 0, upper = 0, blocks = 0;
  std::size_t unknowns = 0;
};

/// Slab J, equation by equation.
Measured measure(const Example& e, const SolvePlan& plan, const std::map<Node, int>& slab_of, int J, int earlier = 0) {
  const Slab slab = plan.slab(J);
  Measured m;
  m.unknowns = slab.unknowns.size();
  if (slab.equations.size() != slab.unknowns.size()) m.matched = false;
  std::map<Node, std::size_t> number;
  for (std::size_t n = 0; n < slab.unknowns.size(); ++n) number[slab.unknowns[n]] = n;

  const int places = e.lattice.sites() * plan.components;
  const auto place = [&](const Node& n) { return n.site.space * plan.components + n.component; };
  std::vector<std::vector<char>> graph(m.unknowns, std::vector<char>(m.unknowns, false));
  for (std::size_t n = 0; n < slab.equations.size(); ++n) {
    bool own = false;
    for (const Node& u : contained(e, slab.equations[n])) {
      own = own || u == slab.unknowns[n];
      if (slab_of.at(u) > J - earlier) m.causal = false;
      if (slab_of.at(u) != J || u == slab.unknowns[n]) continue;
      m.coupled = true;
      graph[n][number.at(u)] = true;
      int step = place(slab.unknowns[n]) - place(u);
      if (plan.cyclic) step = ((step + places / 2) % places + places) % places - places / 2;
      m.lower = std::max(m.lower, step);
      m.upper = std::max(m.upper, -step);
    }
    m.matched = m.matched && own;
  }
  m.blocks = blocks_of(std::move(graph));
  return m;
}

}  // namespace

TEST_CASE("the plan of a short quotient is a plan of the whole lattice: complete, causal, and measured right") {
  std::mt19937 random(17);
  std::map<std::string, int> seen;
  for (int trial = 0; trial < 250; ++trial) {
    const Example e = random_example(random);
    std::optional<SolvePlan> made;
    std::string refusal;
    try {
      made = make_plan(e.lattice, e.system);
    } catch (const BadInput& error) {
      refusal = error.what();
    }
    if (!made) {
      ++seen["refused"];
      const bool unsolvable = refusal.find("no equation is left") != std::string::npos;
      CHECK((!unsolvable || !solvable_in_full(e)));
      continue;
    }
    const SolvePlan& plan = *made;
    ++seen[to_string(plan.kind)];

    bool once = true;
    const auto slab_of = slabs_of_unknowns(plan, once);
    CHECK(once);
    long long unknowns = 0, blocks = 0;
    int lower = 0, upper = 0;
    bool coupled = false;
    for (const int J : {0, 1}) {
      const Measured m = measure(e, plan, slab_of, J);
      INFO(plan.describe() << ", N = " << e.lattice.sites() << ", trial " << trial);
      CHECK(m.causal);
      unknowns = std::max(unknowns, static_cast<long long>(m.unknowns));
      if (!plan.table.matched) continue;
      CHECK(m.matched);
      blocks = std::max(blocks, static_cast<long long>(m.blocks));
      lower = std::max(lower, m.lower);
      upper = std::max(upper, m.upper);
      coupled = coupled || m.coupled;
    }
    INFO(plan.describe() << ", N = " << e.lattice.sites() << ", trial " << trial);
    CHECK(plan.unknowns == unknowns);
    if (!plan.table.matched) continue;
    CHECK(plan.blocks == blocks);
    if (plan.kind == SolveKind::sparse) continue;
    // On a circle unknowns that are all on their own wait for other rows at most, never for their neighbours in turn.
    CHECK((coupled && !(e.lattice.is_circle() && blocks == unknowns)) == (plan.kind != SolveKind::explicit_));
    CHECK(plan.lower == lower);
    CHECK(plan.upper == upper);
  }
  for (const char* kind : {"explicit", "chain", "cyclic-band", "sparse", "refused"}) {
    INFO(kind << ": " << seen[kind]);
    CHECK(seen[kind] > 2);
  }
}

TEST_CASE("the check can fail: a slab that may not use its own unknowns is not causal") {
  std::mt19937 random(17);
  const Example e{Lattice::circle(8, 1),
                  system_of(1, {StencilIncidence::dense(testing::random_pattern(random, Placement::every_site))})};
  const SolvePlan plan = make_plan(e.lattice, e.system);
  bool once = true;
  const auto slab_of = slabs_of_unknowns(plan, once);
  CHECK(measure(e, plan, slab_of, 0).causal);
  CHECK_FALSE(measure(e, plan, slab_of, 0, 1).causal);
}

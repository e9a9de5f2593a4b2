// SPDX-License-Identifier: MIT
#include "lattice/plan/solve_plan.hpp"

namespace delf {

int SolvePlan::Table::position(int site) const {
  if (circle) return site % sites;
  const int left = (sites - period) / 2, right = sites - period - left;
  if (site < left) return site;
  if (site >= lattice_sites - right) return site - lattice_sites + sites;
  return left + (site - left) % period;
}

const SolvePlan::Entry& SolvePlan::node(int site, int component, int parity) const {
  return table.entries[(table.position(site) * components + component) * table.parities + parity];
}

bool SolvePlan::solved(int site, int component) const {
  if (is_held(site, component)) return false;
  return node(site, component, 0).solved || node(site, component, table.parities - 1).solved;
}

int SolvePlan::shift(int site, int component, int slab) const {
  for (int parity = 0; parity < table.parities; ++parity)
    if (const Entry& e = node(site, component, parity); e.solved && (slab - e.shift - parity) % table.parities == 0)
      return e.shift;
  return node(site, component, 0).shift;
}

int SolvePlan::offset(int site, int component, int slab) const {
  for (int parity = 0; parity < table.parities; ++parity)
    if (const Entry& e = node(site, component, parity); e.solved && (slab + e.offset - parity) % table.parities == 0)
      return e.offset;
  return node(site, component, 0).offset;
}

Slab SolvePlan::slab(int J) const {
  Slab slab;
  slab.matched = table.matched;
  const int N = table.lattice_sites;
  for (int site = 0; site < N; ++site)
    for (int component = 0; component < components; ++component) {
      if (is_held(site, component)) continue;
      for (int parity = 0; parity < table.parities; ++parity) {
        const Entry& e = node(site, component, parity);
        if (!e.solved) continue;
        const Site unknown{J + e.offset, site}, equation{J - e.shift, site};
        if ((unknown.time - parity) % table.parities == 0) {
          slab.unknowns.push_back({unknown, component});
          if (slab.matched)
            slab.equations.push_back(
                {{unknown.time + e.equation_time, ((site + e.equation_space) % N + N) % N}, e.equation_component});
        }
        if (!slab.matched && (equation.time - parity) % table.parities == 0)
          slab.equations.push_back({equation, component});
      }
    }
  return slab;
}

}  // namespace delf

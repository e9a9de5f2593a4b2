// SPDX-License-Identifier: MIT
#include "schemes/slab_equations.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <tuple>

#include "schemes/block_solver.hpp"

namespace delf {

SlabEquations::SlabEquations(const LatticeSystem& system, const SolvePlan& plan, int parity, int past, int future,
                             double turn)
    : time_step_(system.time_step()),
      space_step_(system.lattice().space_step()),
      components_(system.components()),
      depth_(past + future + 1),
      row_size_(static_cast<std::size_t>(system.lattice().sites()) * static_cast<std::size_t>(components_)),
      slab_(plan.slab(parity)) {
  const Lattice& lattice = system.lattice();
  std::map<std::tuple<int, int, int>, int> number_of_unknown, number_of_equation;
  const auto key = [](const Node& n) { return std::tuple{n.site.time, n.site.space, n.component}; };
  for (auto* nodes : {&slab_.unknowns, &slab_.equations})
    for (Node& node : *nodes) node.site.time -= parity;
  for (int n = 0; n < size(); ++n) {
    number_of_unknown[key(unknown(n))] = n;
    number_of_equation[key(equation(n))] = n;
  }
  const auto find = [](const auto& map, const auto& k) {
    const auto it = map.find(k);
    return it == map.end() ? -1 : it->second;
  };

  std::map<std::tuple<int, int, int>, int> seen;  // (family, row, space)
  std::map<std::pair<int, int>, int> place;
  for (int n = 0; n < size(); ++n) {
    const Node& e = equation(n);
    for (const auto& touch : system.touching({e.site.time + parity, e.site.space}, e.component)) {
      const StencilFamily& family = *touch.family;
      const int row = e.site.time + touch.anchor.time, space = e.site.space + touch.anchor.space;
      const int home = lattice.is_circle() ? lattice.wrapped(space) : space;
      if (!seen.try_emplace({touch.family_index, row, home}, 0).second) continue;

      Member member{&family, static_cast<int>(reads_.size()), row,
                    row,     lattice.position(home),          static_cast<int>(entry_.size())};
      for (int i = 0; i < family.size(); ++i) {
        const Site vertex = family.site(i);
        const int c = family.values()[static_cast<std::size_t>(i)].component;
        const int r = row + vertex.time, x = home + vertex.space, at = lattice.is_circle() ? lattice.wrapped(x) : x;
        const bool turns = system.component(c).role != Role::multiplier;
        member.lowest_row = std::min(member.lowest_row, r);
        reads_.push_back(
            {std::clamp(r, -past, future), at * components_ + c, turns ? turn * ((x - at) / lattice.sites()) : 0.0,
             find(number_of_equation, std::tuple{r, at, c}), find(number_of_unknown, std::tuple{r, at, c})});
      }
      for (int i = 0; i < family.size(); ++i)
        for (int m = 0; m < family.size(); ++m) {
          const int equation = reads_[static_cast<std::size_t>(member.first + i)].equation;
          const int unknown = reads_[static_cast<std::size_t>(member.first + m)].unknown;
          if (equation < 0 || unknown < 0) continue;
          const auto [where, fresh] = place.try_emplace({equation, unknown}, static_cast<int>(places_.size()));
          if (fresh) places_.push_back({equation, unknown});
          entry_.push_back(where->second);
        }
      members_.push_back(member);
    }
  }
}

Cell SlabEquations::cell(const Member& member, std::int64_t J) const {
  return {time_step_, space_step_, static_cast<double>(J + member.anchor_row) * time_step_, member.x};
}

void SlabEquations::gather(const Member& member, const SectionRing& ring, std::int64_t J) const {
  const auto size = static_cast<std::size_t>(member.family->size());
  y_.resize(size);
  const Read* read = reads_.data() + member.first;
  for (std::size_t i = 0; i < size; ++i) y_[i] = ring.row(J + read[i].row)[read[i].place] + read[i].add;
}

void SlabEquations::residual(const SectionRing& ring, std::int64_t J, std::vector<double>& E,
                             std::vector<double>* absolute, const std::vector<double>* momenta) const {
  E.assign(static_cast<std::size_t>(size()), 0.0);
  if (absolute) absolute->assign(E.size(), 0.0);
  if (momenta)
    for (int n = 0; n < size(); ++n)
      if (J + equation(n).site.time == 0)
        E[static_cast<std::size_t>(n)] =
            (*momenta)[static_cast<std::size_t>(equation(n).site.space * components_ + equation(n).component)];
  for (const Member& member : members_) {
    if (momenta && J + member.lowest_row < 0) continue;
    gather(member, ring, J);
    r_.resize(y_.size());
    member.family->residual(cell(member, J), y_, r_);
    const Read* read = reads_.data() + member.first;
    for (std::size_t i = 0; i < r_.size(); ++i) {
      if (read[i].equation < 0) continue;
      E[static_cast<std::size_t>(read[i].equation)] += r_[i];
      if (absolute) (*absolute)[static_cast<std::size_t>(read[i].equation)] += std::abs(r_[i]);
    }
  }
}

void SlabEquations::jacobian(const SectionRing& ring, std::int64_t J, std::vector<double>& values,
                             const std::vector<double>* momenta) const {
  std::vector<std::vector<double>> none;
  linearised(ring, J, {}, none, values, momenta);
}

void SlabEquations::linearised(const SectionRing& y, std::int64_t J, const std::vector<SectionRing>& V,
                               std::vector<std::vector<double>>& E, std::vector<double>& values,
                               const std::vector<double>* momenta) const {
  values.assign(places_.size(), 0.0);
  E.resize(V.size());
  for (auto& e : E) e.assign(static_cast<std::size_t>(size()), 0.0);
  for (const Member& member : members_) {
    if (momenta && J + member.lowest_row < 0) continue;
    gather(member, y, J);
    const std::size_t size = y_.size();
    J_.resize(size * size);
    member.family->jacobian(cell(member, J), y_, J_);
    const Read* read = reads_.data() + member.first;
    const int* entry = entry_.data() + member.first_entry;
    for (std::size_t i = 0; i < size; ++i) {
      if (read[i].equation < 0) continue;
      for (std::size_t m = 0; m < size; ++m)
        if (read[m].unknown >= 0) values[static_cast<std::size_t>(*entry++)] += J_[i * size + m];
    }
    for (std::size_t v = 0; v < V.size(); ++v) {
      r_.resize(size);
      for (std::size_t m = 0; m < size; ++m) r_[m] = V[v].row(J + read[m].row)[read[m].place];
      for (std::size_t i = 0; i < size; ++i) {
        if (read[i].equation < 0) continue;
        double sum = 0;
        for (std::size_t m = 0; m < size; ++m) sum += J_[i * size + m] * r_[m];
        E[v][static_cast<std::size_t>(read[i].equation)] += sum;
      }
    }
  }
}

BlockSolver SlabEquations::solver() const {
  std::vector<std::pair<int, int>> places;
  for (const Place& place : places_) places.emplace_back(place.equation, place.unknown);
  return {size(), places, present(), matched()};
}

std::vector<char> SlabEquations::present() const {
  SectionRing ring(depth_, row_size_);
  std::mt19937_64 engine(20251121);
  std::vector<char> found(places_.size(), false);
  std::vector<double> values;
  for (int sample = 0; sample < 3; ++sample) {
    for (int r = 0; r < depth_; ++r)
      for (std::size_t at = 0; at < row_size_; ++at)
        ring.row(r)[at] = 4.0 * static_cast<double>(engine() >> 11) * 0x1p-53 - 2.0;
    jacobian(ring, depth_, values);
    std::vector<double> largest(slab_.unknowns.size(), 0.0);
    for (std::size_t p = 0; p < values.size(); ++p) {
      double& size = largest[static_cast<std::size_t>(places_[p].equation)];
      size = std::max(size, std::abs(values[p]));
    }
    for (std::size_t p = 0; p < values.size(); ++p)
      if (!(std::abs(values[p]) <= 1e-13 * largest[static_cast<std::size_t>(places_[p].equation)])) found[p] = true;
  }
  return found;
}

std::size_t SlabEquations::bytes() const {
  return members_.size() * sizeof(Member) + reads_.size() * sizeof(Read) + places_.size() * sizeof(Place) +
         entry_.size() * sizeof(int) + 2 * slab_.unknowns.size() * sizeof(Node);
}

}  // namespace delf

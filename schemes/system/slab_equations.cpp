// SPDX-License-Identifier: MIT
#include "schemes/system/slab_equations.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "jets/simd/pack_gather.hpp"
#include "schemes/solvers/block_solver.hpp"
#include "schemes/families/row_kernel.hpp"

namespace delf {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Numbers of nodes, looked up by their place: −1 where there is none.
class NodeNumbers {
 public:
  NodeNumbers(const std::vector<Node>& nodes, int sites, int components) : components_(components) {
    if (nodes.empty()) return;
    const auto [low, high] = std::ranges::minmax(nodes, {}, [](const Node& n) { return n.site.time; });
    low_ = low.site.time, high_ = high.site.time, row_ = sites * components;
    numbers_.assign(at(high_ - low_ + 1) * at(row_), -1);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const Site site = nodes[n].site;
      numbers_[at(site.time - low_) * at(row_) + at(site.space * components + nodes[n].component)] =
          static_cast<int>(n);
    }
  }
  int operator()(int row, int site, int component) const {
    if (row < low_ || row > high_) return -1;
    return numbers_[at(row - low_) * at(row_) + at(site * components_ + component)];
  }

 private:
  int components_, low_ = 0, high_ = -1, row_ = 0;
  std::vector<int> numbers_;
};

/// One stencil, before it has its place in a batch.
struct Anchored {
  int family, row, site;
  friend auto operator<=>(const Anchored&, const Anchored&) = default;
};

/// The same linear function of y in every cell.
bool is_linear(const StencilFamily& family) {
  const RowKernel* kernel = family.row_kernel();
  return kernel && kernel->nonlinearity() == Nonlinearity::none && !family.is_placed();
}

bool constant_part(const StencilFamily& family, const Cell& cell, std::span<double> J, std::vector<double>& r0) {
  const RowKernel* kernel = family.row_kernel();
  if (!kernel) return family.constant_jacobian(cell, J);
  r0.resize(at(family.size()));
  kernel->linear_part(cell, J, r0);
  return true;
}

}  // namespace

SlabEquations::SlabEquations(const LatticeSystem& system, const SolvePlan& plan, int parity, int past, int future,
                             double turn)
    : time_step_(system.time_step()),
      space_step_(system.lattice().space_step()),
      components_(system.components()),
      depth_(past + future + 1),
      row_size_(static_cast<std::size_t>(system.lattice().sites()) * static_cast<std::size_t>(components_)),
      slab_(plan.slab(parity)) {
  for (auto* nodes : {&slab_.unknowns, &slab_.equations})
    for (Node& node : *nodes) node.site.time -= parity;
  list_stencils(system, parity);
  list_reads(system, past, future, turn);
  list_places();
  fixed_.assign(places_.size(), 0.0);
  at_zero_.assign(value_row_.size(), 0.0);
  for (Batch& b : batches_)
    if (is_linear(*b.family)) take_linear_part(b);
}

/// The batches with their stencils, without what those read: x_ holds the sites of the anchors.
void SlabEquations::list_stencils(const LatticeSystem& system, int parity) {
  const Lattice& lattice = system.lattice();
  std::vector<Anchored> stencils;
  for (const Node& e : slab_.equations)
    for (const auto& touch : system.touching({e.site.time + parity, e.site.space}, e.component)) {
      const int space = e.site.space + touch.anchor.space;
      stencils.push_back(
          {touch.family_index, e.site.time + touch.anchor.time, lattice.is_circle() ? lattice.wrapped(space) : space});
    }
  std::ranges::sort(stencils);
  stencils.erase(std::ranges::unique(stencils).begin(), stencils.end());

  for (std::size_t first = 0; first < stencils.size();) {
    const auto [family_index, row, site] = stencils[first];
    std::size_t last = first;
    while (last < stencils.size() && stencils[last].family == family_index && stencils[last].row == row) ++last;
    const StencilFamily& family = *system.families()[at(family_index)];
    Batch b{.family = &family, .size = family.size(), .row = row, .lowest_row = row, .first_value = value_row_.size()};
    b.stencils = static_cast<int>(last - first);
    b.padded = (b.stencils + lanes - 1) / lanes * lanes;
    b.first_anchor = x_.size();
    for (int s = 0; s < b.padded; s += lanes) {
      x_.emplace_back(0.0);
      for (int l = 0; l < lanes; ++l) x_.back().v[l] = stencils[first + at(std::min(s + l, b.stencils - 1))].site;
    }
    for (int i = 0; i < b.size; ++i) {
      value_row_.push_back(row + family.site(i).time);
      b.lowest_row = std::min(b.lowest_row, value_row_.back());
    }
    batches_.push_back(b);
    first = last;
  }
}

void SlabEquations::list_reads(const LatticeSystem& system, int past, int future, double turn) {
  const Lattice& lattice = system.lattice();
  const NodeNumbers unknown_at(slab_.unknowns, lattice.sites(), components_);
  const NodeNumbers equation_at(slab_.equations, lattice.sites(), components_);
  std::size_t reads = 0;
  int largest = 0;
  for (Batch& b : batches_) {
    b.first_read = reads;
    reads += at(b.size) * at(b.padded);
    largest = std::max(largest, b.size);
  }
  place_.resize(reads), equation_.resize(reads), unknown_.resize(reads);
  if (turn != 0) add_.resize(reads);
  written_.assign(value_row_.size(), false);
  for (Batch& b : batches_)
    for (int i = 0; i < b.size; ++i) {
      const Site vertex = b.family->site(i);
      const int c = b.family->values()[at(i)].component, row = b.row + vertex.time;
      const bool turns = system.component(c).role != Role::multiplier;
      for (int s = 0; s < b.padded; ++s) {
        const int x = static_cast<int>(x_[b.first_anchor + at(s / lanes)][s % lanes]) + vertex.space;
        const int home = lattice.is_circle() ? lattice.wrapped(x) : x;
        const std::size_t n = b.first_read + at(i * b.padded + s);
        const int equation = s < b.stencils ? equation_at(row, home, c) : -1;
        place_[n] = home * components_ + c;
        equation_[n] = equation < 0 ? size() : equation;
        unknown_[n] = unknown_at(row, home, c);
        if (turn != 0 && turns) add_[n] = turn * ((x - home) / lattice.sites());
        if (equation >= 0) written_[b.first_value + at(i)] = true;
        if (unknown_[n] >= 0) b.has_unknown = true;
      }
      value_row_[b.first_value + at(i)] = std::clamp(row, -past, future);
    }
  for (Pack& pack : x_)
    for (int l = 0; l < lanes; ++l) pack.v[l] = lattice.position(static_cast<int>(pack[l]));
  y_.resize(at(largest)), r_.resize(at(largest));
  y_one_.reserve(at(largest)), r_one_.reserve(at(largest));
}

/// Calls visit(stencil, i, m) for each pair of an equation and an unknown, stencil by stencil.
template <class Visit>
void SlabEquations::for_each_entry(const Batch& b, const Visit& visit) const {
  if (!b.has_unknown) return;
  for (int s = 0; s < b.stencils; ++s)
    for (int i = 0; i < b.size; ++i) {
      if (equation_[b.first_read + at(i * b.padded + s)] == size()) continue;
      for (int m = 0; m < b.size; ++m)
        if (unknown_[b.first_read + at(m * b.padded + s)] >= 0) visit(s, i, m);
    }
}

void SlabEquations::list_places() {
  struct Pair {
    Place place;
    int entry;
  };
  std::vector<Pair> pairs;
  for (Batch& b : batches_) {
    b.first_entry = pairs.size();
    for_each_entry(b, [&](int s, int i, int m) {
      pairs.push_back({{equation_[b.first_read + at(i * b.padded + s)], unknown_[b.first_read + at(m * b.padded + s)]},
                       static_cast<int>(pairs.size())});
    });
  }
  std::ranges::sort(pairs, {}, [](const Pair& p) { return std::pair{p.place.equation, p.place.unknown}; });
  entry_.resize(pairs.size());
  for (const auto& [place, entry] : pairs) {
    if (places_.empty() || places_.back().equation != place.equation || places_.back().unknown != place.unknown)
      places_.push_back(place);
    entry_[at(entry)] = static_cast<int>(places_.size()) - 1;
  }
  places_.shrink_to_fit();
}

void SlabEquations::take_linear_part(Batch& b) {
  b.linear = true;
  y_one_.assign(at(b.size), 0.0), r_one_.resize(at(b.size)), J_one_.resize(at(b.size * b.size));
  b.family->jacobian(cell(b, 0, 0), y_one_, J_one_);
  b.family->residual(cell(b, 0, 0), y_one_, r_one_);
  std::ranges::copy(r_one_, at_zero_.begin() + static_cast<std::ptrdiff_t>(b.first_value));
  b.first_term = terms_.size();
  for (int i = 0; i < b.size; ++i)
    for (int m = 0; m < b.size; ++m)
      if (const double value = J_one_[at(i * b.size + m)]; value != 0) terms_.push_back({i, m, value});
  b.last_term = terms_.size();
  if (!b.has_unknown) return;
  const int* entry = entry_.data() + b.first_entry;
  for (int s = 0; s < b.stencils; ++s) add_jacobian(b, J_one_, s, entry, fixed_);
}

/// r = r(0) + J y
void SlabEquations::evaluate_linear(const Batch& b, const Pack* y, Pack* r) const {
  for (int i = 0; i < b.size; ++i) r[i] = Pack(at_zero_[b.first_value + at(i)]);
  for (std::size_t n = b.first_term; n < b.last_term; ++n) r[terms_[n].i] += terms_[n].value * y[terms_[n].m];
}

Cell SlabEquations::cell(const Batch& b, std::int64_t J, double x) const {
  return {time_step_, space_step_, static_cast<double>(J + b.row) * time_step_, x};
}

void SlabEquations::gather(const Batch& b, const SectionRing& ring, std::int64_t J, int stencil) const {
  y_one_.resize(at(b.size));
  for (int i = 0; i < b.size; ++i) {
    const std::size_t n = b.first_read + at(i * b.padded + stencil);
    y_one_[at(i)] = ring.row(J + value_row_[b.first_value + at(i)])[place_[n]] + (add_.empty() ? 0.0 : add_[n]);
  }
}

/// r of the pack of stencils from `first` on, into r_.
void SlabEquations::evaluate(const Batch& b, const SectionRing& ring, std::int64_t J, int first) const {
  double* const y = reinterpret_cast<double*>(y_.data());
  double* const r = reinterpret_cast<double*>(r_.data());
  for (int i = 0; i < b.size; ++i) {
    const std::size_t n = b.first_read + at(i * b.padded + first);
    Pack value = delf::gather(ring.row(J + value_row_[b.first_value + at(i)]), place_.data() + n);
    if (!add_.empty())
      for (int l = 0; l < lanes; ++l) value.v[l] += add_[n + at(l)];
    y_[at(i)] = value;
  }
  if (b.linear) {
    evaluate_linear(b, y_.data(), r_.data());
    return;
  }
  const Pack& x = x_[b.first_anchor + at(first / lanes)];
  if (b.family->residuals(cell(b, J, 0), reinterpret_cast<const double*>(&x), y, r)) return;
  y_one_.resize(at(b.size)), r_one_.resize(at(b.size));
  for (int l = 0; l < std::min(lanes, b.stencils - first); ++l) {
    for (int i = 0; i < b.size; ++i) y_one_[at(i)] = y[i * lanes + l];
    b.family->residual(cell(b, J, x[l]), y_one_, r_one_);
    for (int i = 0; i < b.size; ++i) r[i * lanes + l] = r_one_[at(i)];
  }
}

/// E and `absolute` have one number more than there are equations, which takes what belongs to none: what a pack repeats,
/// too.
void SlabEquations::add_residual(const Batch& b, const SectionRing& ring, std::int64_t J, double* E,
                                 double* absolute) const {
  const auto add = [](Pack r, double* to, const int* equation) { scatter(delf::gather(to, equation) + r, to, equation); };
  for (int s = 0; s < b.padded; s += lanes) {
    evaluate(b, ring, J, s);
    for (int i = 0; i < b.size; ++i) {
      if (!written_[b.first_value + at(i)]) continue;
      // No two stencils of a row have the same equation at the same value.
      const int* const equation = equation_.data() + b.first_read + at(i * b.padded + s);
      add(r_[at(i)], E, equation);
      if (absolute) add(abs(r_[at(i)]), absolute, equation);
    }
  }
}

void SlabEquations::residual(const SectionRing& ring, std::int64_t J, std::vector<double>& E,
                             std::vector<double>* absolute, const std::vector<double>* momenta) const {
  E.assign(at(size()) + 1, 0.0);
  if (absolute) absolute->assign(E.size(), 0.0);
  if (momenta)
    for (int n = 0; n < size(); ++n)
      if (J + equation(n).site.time == 0)
        E[at(n)] = (*momenta)[at(equation(n).site.space * components_ + equation(n).component)];
  for (const Batch& b : batches_)
    if (!below_start(b, J, momenta != nullptr))
      add_residual(b, ring, J, E.data(), absolute ? absolute->data() : nullptr);
  E.resize(at(size()));
  if (absolute) absolute->resize(E.size());
}

void SlabEquations::known(const SectionRing& ring, std::int64_t J, std::vector<double>& E) const {
  E.assign(at(size()) + 1, 0.0);
  for (const Batch& b : batches_)
    if (!b.has_unknown) add_residual(b, ring, J, E.data(), nullptr);
}

void SlabEquations::residual_from(const std::vector<double>& known, const SectionRing& ring, std::int64_t J,
                                  std::vector<double>& E) const {
  E = known;
  for (const Batch& b : batches_)
    if (b.has_unknown) add_residual(b, ring, J, E.data(), nullptr);
}

void SlabEquations::add_jacobian(const Batch& b, std::span<const double> J, int stencil, const int*& entry,
                                 Numbers& values) const {
  for (int i = 0; i < b.size; ++i) {
    if (equation_[b.first_read + at(i * b.padded + stencil)] == size()) continue;
    for (int m = 0; m < b.size; ++m)
      if (unknown_[b.first_read + at(m * b.padded + stencil)] >= 0) values[at(*entry++)] += J[at(i * b.size + m)];
  }
}

void SlabEquations::jacobian(const SectionRing& ring, std::int64_t J, std::vector<double>& values,
                             const std::vector<double>* momenta) const {
  values = fixed_;
  for (const Batch& b : batches_) {
    if (!b.has_unknown || b.linear || below_start(b, J, momenta != nullptr)) continue;
    J_one_.resize(at(b.size * b.size));
    const int* entry = entry_.data() + b.first_entry;
    for (int s = 0; s < b.stencils; ++s) {
      gather(b, ring, J, s);
      b.family->jacobian(cell(b, J, x_[b.first_anchor + at(s / lanes)][s % lanes]), y_one_, J_one_);
      add_jacobian(b, J_one_, s, entry, values);
    }
  }
}

bool SlabEquations::constant_jacobian(std::vector<double>& values) const {
  values.assign(places_.size(), 0.0);
  for (const Batch& b : batches_) {
    if (!b.has_unknown) continue;
    J_one_.resize(at(b.size * b.size));
    const int* entry = entry_.data() + b.first_entry;
    // What depends on the place is not in the constant part: one cell stands for all.
    if (!constant_part(*b.family, cell(b, 0, x_[b.first_anchor][0]), J_one_, r_one_)) return false;
    for (int s = 0; s < b.stencils; ++s) add_jacobian(b, J_one_, s, entry, values);
  }
  return true;
}

void SlabEquations::linearised(const SectionRing& y, std::int64_t J, const std::vector<SectionRing>& V,
                               std::vector<std::vector<double>>& E, std::vector<double>& values,
                               const std::vector<double>* momenta) const {
  values.assign(places_.size(), 0.0);
  E.resize(V.size());
  for (auto& e : E) e.assign(at(size()) + 1, 0.0);
  for (const Batch& b : batches_) {
    if (below_start(b, J, momenta != nullptr)) continue;
    J_one_.resize(at(b.size * b.size)), r_one_.resize(at(b.size));
    const int* entry = entry_.data() + b.first_entry;
    for (int s = 0; s < b.stencils; ++s) {
      gather(b, y, J, s);
      b.family->jacobian(cell(b, J, x_[b.first_anchor + at(s / lanes)][s % lanes]), y_one_, J_one_);
      if (b.has_unknown) add_jacobian(b, J_one_, s, entry, values);
      for (std::size_t v = 0; v < V.size(); ++v) {
        for (int m = 0; m < b.size; ++m)
          r_one_[at(m)] = V[v].row(J + value_row_[b.first_value + at(m)])[place_[b.first_read + at(m * b.padded + s)]];
        for (int i = 0; i < b.size; ++i) {
          double sum = 0;
          for (int m = 0; m < b.size; ++m) sum += J_one_[at(i * b.size + m)] * r_one_[at(m)];
          E[v][at(equation_[b.first_read + at(i * b.padded + s)])] += sum;
        }
      }
    }
  }
  for (auto& e : E) e.resize(at(size()));
}

BlockSolver SlabEquations::solver() const {
  std::vector<std::pair<int, int>> places;
  places.reserve(places_.size());
  for (const Place& place : places_) places.emplace_back(place.equation, place.unknown);
  BlockSolver::Sites sites;
  for (int n = 0; n < size(); ++n) {
    sites.of_row.push_back(equation(n).site.space);
    sites.of_column.push_back(unknown(n).site.space);
  }
  return {size(), places, present(), matched(), sites};
}

std::vector<char> SlabEquations::present() const {
  SectionRing ring(depth_, row_size_);
  std::mt19937_64 engine(20251121);
  std::vector<char> found(places_.size(), false);
  std::vector<double> values;
  for (int sample = 0; sample < 3; ++sample) {
    for (int r = 0; r < depth_; ++r)
      for (std::size_t n = 0; n < row_size_; ++n)
        ring.row(r)[n] = 4.0 * static_cast<double>(engine() >> 11) * 0x1p-53 - 2.0;
    jacobian(ring, depth_, values);
    std::vector<double> largest(slab_.unknowns.size(), 0.0);
    for (std::size_t p = 0; p < values.size(); ++p) {
      double& size = largest[at(places_[p].equation)];
      size = std::max(size, std::abs(values[p]));
    }
    for (std::size_t p = 0; p < values.size(); ++p)
      if (!(std::abs(values[p]) <= 1e-13 * largest[at(places_[p].equation)])) found[p] = true;
  }
  return found;
}

std::size_t SlabEquations::bytes() const {
  return batches_.size() * sizeof(Batch) +
         (value_row_.size() + place_.size() + equation_.size() + unknown_.size() + entry_.size()) * sizeof(int) +
         (add_.size() + fixed_.size()) * sizeof(double) + x_.size() * sizeof(Pack) + places_.size() * sizeof(Place) +
         2 * slab_.unknowns.size() * sizeof(Node);
}

}  // namespace delf

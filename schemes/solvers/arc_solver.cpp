// SPDX-License-Identifier: MIT
#include "schemes/solvers/arc_solver.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "jets/simd/pack_gather.hpp"

namespace delf {

std::unique_ptr<ArcSolver> ArcSolver::make(const SiteGroups& groups, Entries entries) {
  auto arcs = std::make_unique<ArcSolver>();
  return arcs->place(groups, entries) ? std::move(arcs) : nullptr;
}

bool ArcSolver::factor(const std::vector<double>& values, Entries entries) {
  std::ranges::fill(pool_, Pack(0.0));
  std::ranges::fill(couplings_, 0.0);
  double* const pool = reinterpret_cast<double*>(pool_.data());
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const double value = values[at(entries[e].place)];
    (where_[e] >= 0 ? pool[where_[e]] : couplings_[static_cast<std::size_t>(-1 - where_[e])]) = value;
  }
  return eliminate() && join() && is_accurate(values, entries);
}

void ArcSolver::solve(const double* rhs, double* x) const {
  if (b_ == 2) solve_groups_of<2>(rhs, x);
  else if (b_ == 3) solve_groups_of<3>(rhs, x);
  else if (b_ == 4) solve_groups_of<4>(rhs, x);
  else solve_groups_of<0>(rhs, x);
}

std::size_t ArcSolver::bytes() const {
  return (pool_.size() + z_.size()) * sizeof(Pack) +
         (couplings_.size() + static_cast<std::size_t>(inverse_.size())) * sizeof(double) +
         (where_.size() + row_.size() + column_.size()) * sizeof(int);
}

std::size_t ArcSolver::coupling(int separator, bool next) const {
  return at(separated_) * at(separated_) + at(2 * separator + next) * at(b_ * b_);
}

bool ArcSolver::place(const SiteGroups& groups, Entries entries) {
  const int G = groups.count();
  std::map<int, int> how_many;
  for (const int size : groups.sizes) ++how_many[size];
  b_ = std::ranges::max_element(how_many, {}, [](const auto& s) { return s.second; })->first;
  if (b_ > largest_group) return false;
  // What is not like the others goes into the first separator: after the longest stretch of others.
  std::vector<int> odd;
  for (int g = 0; g < G; ++g)
    if (groups.sizes[at(g)] != b_) odd.push_back(g);
  int begin = 0, length = 1;
  if (!odd.empty()) {
    int longest = -1;
    for (std::size_t i = 0; i < odd.size(); ++i) {
      const int next = i + 1 < odd.size() ? odd[i + 1] : odd[0] + G;
      if (next - odd[i] > longest) longest = next - odd[i], begin = next % G;
    }
    length = G - longest + 1;
  }
  arc_ = (G - length - (lanes - 1)) / lanes;
  if (arc_ < 2) return false;
  int spare = G - length - (lanes - 1) - arc_ * lanes;

  struct Home {
    int separator = -1, lane = 0, t = 0;
  };
  std::vector<Home> home(at(G));
  std::vector<int> number_in_separators(at(G), 0);
  int g = begin;
  separated_ = 0;
  for (int l = 0; l < lanes; ++l) {
    Separator s{g, l == 0 ? length : 1, 0, 0, 0, 0};
    if (l > 0 && spare > 0) ++s.groups, --spare;
    for (int i = 0; i < s.groups; ++i, ++g) {
      const int group = g % G, size = groups.sizes[at(group)];
      // Its end groups' couplings have the room of a usual group.
      if (size > b_ && (i == 0 || i == s.groups - 1)) return false;
      home[at(group)].separator = l;
      number_in_separators[at(group)] = separated_;
      if (i == 0) s.first = separated_, s.first_size = size;
      s.last = separated_, s.last_size = size;
      separated_ += size;
    }
    for (int t = 0; t < arc_; ++t, ++g) home[at(g % G)] = {-1, l, t};
    separators_.push_back(s);
  }
  if (separated_ > most_separated) return false;

  pool_.resize(block(diagonal, arc_));
  couplings_.resize(coupling(lanes, false));
  z_.resize(at(arc_ * b_));
  inverse_.resize(separated_, separated_);
  separated_rhs_.resize(separated_), separated_x_.resize(separated_);
  std::vector<int> row_in_group, column_in_group;
  list_members(groups.of_row, G, home, number_in_separators, row_, separated_row_, row_in_group);
  list_members(groups.of_column, G, home, number_in_separators, column_, separated_column_, column_in_group);

  for (const auto& e : entries) {
    const int from = groups.of_row[at(e.row)], to = groups.of_column[at(e.column)];
    const int i = row_in_group[at(e.row)], m = column_in_group[at(e.column)];
    const Home row = home[at(from)], column = home[at(to)];
    std::ptrdiff_t where;
    const auto in_pool = [&](Part p) {
      return static_cast<std::ptrdiff_t>((block(p, row.t) + at(i * b_ + m)) * lanes + at(row.lane));
    };
    const auto in_couplings = [](std::size_t n) { return -1 - static_cast<std::ptrdiff_t>(n); };
    if (row.separator >= 0 && column.separator >= 0) {
      where = in_couplings(at(number_in_separators[at(from)] + i) * at(separated_) +
                           at(number_in_separators[at(to)] + m));
    } else if (row.separator >= 0) {
      where = in_couplings(coupling(row.separator, to == (from + 1) % G) + at(i * b_ + m));
    } else if (column.separator >= 0) {
      where = in_pool(to == (from + 1) % G ? right : left);
    } else {
      where = in_pool(from == to ? diagonal : to == (from + 1) % G ? upper : lower);
    }
    where_.push_back(static_cast<int>(where));
  }
  return true;
}

template <class Home>
void ArcSolver::list_members(const std::vector<int>& group_of, int G, const std::vector<Home>& home,
                  const std::vector<int>& number, std::vector<int>& in_arcs, std::vector<int>& separated,
                  std::vector<int>& in_group) const {
  std::vector<int> next(at(G), 0);
  in_arcs.resize(at(arc_ * b_ * lanes));
  separated.resize(at(separated_));
  for (std::size_t n = 0; n < group_of.size(); ++n) {
    const int group = group_of[n], i = next[at(group)]++;
    const Home& h = home[at(group)];
    in_group.push_back(i);
    if (h.separator >= 0) separated[at(number[at(group)] + i)] = static_cast<int>(n);
    else in_arcs[at((h.t * b_ + i) * lanes + h.lane)] = static_cast<int>(n);
  }
}

void ArcSolver::subtract_product(Pack* a, const Pack* l, const Pack* u) const {
  for (int i = 0; i < b_; ++i)
    for (int c = 0; c < b_; ++c)
      for (int m = 0; m < b_; ++m) a[i * b_ + c] -= l[i * b_ + m] * u[m * b_ + c];
}

void ArcSolver::multiply(const Pack* l, Pack* a) const {
  Pack column[largest_group];
  for (int c = 0; c < b_; ++c) {
    for (int i = 0; i < b_; ++i) {
      column[i] = Pack(0.0);
      for (int m = 0; m < b_; ++m) column[i] += l[i * b_ + m] * a[m * b_ + c];
    }
    for (int i = 0; i < b_; ++i) a[i * b_ + c] = column[i];
  }
}

double ArcSolver::least(Pack a) {
  double smallest = std::abs(a[0]);
  for (int l = 1; l < lanes; ++l) smallest = std::min(smallest, std::abs(a[l]));
  return smallest;
}

bool ArcSolver::invert(Pack* a) const {
  Pack rest[largest_group][2 * largest_group];
  for (int i = 0; i < b_; ++i)
    for (int c = 0; c < b_; ++c) rest[i][c] = a[i * b_ + c], rest[i][b_ + c] = Pack(i == c ? 1.0 : 0.0);
  for (int p = 0; p < b_; ++p) {
    int best = p;
    double size = least(rest[p][p]);
    for (int i = p + 1; i < b_; ++i)
      if (const double other = least(rest[i][p]); other > size) best = i, size = other;
    if (!(size > 0)) return false;
    if (best != p) std::swap_ranges(rest[p] + p, rest[p] + 2 * b_, rest[best] + p);
    const Pack scale = Pack(1.0) / rest[p][p];
    for (int c = p; c < 2 * b_; ++c) rest[p][c] *= scale;
    for (int i = 0; i < b_; ++i) {
      if (i == p) continue;
      const Pack by = rest[i][p];
      for (int c = p; c < 2 * b_; ++c) rest[i][c] -= by * rest[p][c];
    }
  }
  for (int i = 0; i < b_; ++i)
    for (int c = 0; c < b_; ++c) a[i * b_ + c] = rest[i][b_ + c];
  return true;
}

bool ArcSolver::eliminate() {
  for (int t = 0; t < arc_; ++t) {
    Pack* const D = part(diagonal, t);
    if (t > 0) {
      subtract_product(D, part(lower, t), part(upper, t - 1));
      subtract_product(part(left, t), part(lower, t), part(left, t - 1));
    }
    if (!invert(D)) return false;
    multiply(D, part(upper, t));
    multiply(D, part(left, t));
    if (t + 1 == arc_) multiply(D, part(right, t));
  }
  for (int t = arc_ - 2; t >= 0; --t) {
    subtract_product(part(left, t), part(upper, t), part(left, t + 1));
    subtract_product(part(right, t), part(upper, t), part(right, t + 1));
  }
  return true;
}

bool ArcSolver::join() {
  Eigen::MatrixXd S(separated_, separated_);
  for (int i = 0; i < separated_; ++i)
    for (int c = 0; c < separated_; ++c) S(i, c) = couplings_[at(i) * at(separated_) + at(c)];
  for (int l = 0; l < lanes; ++l) {
    const Separator &s = separators_[at(l)], &after = separators_[at((l + 1) % lanes)];
    const double *forward = &couplings_[coupling(l, true)], *back = &couplings_[coupling((l + 1) % lanes, false)];
    const auto subtract = [&](int row, int rows, const double* by, const Pack* through, int column, int columns) {
      for (int i = 0; i < rows; ++i)
        for (int c = 0; c < columns; ++c)
          for (int m = 0; m < b_; ++m) S(row + i, column + c) -= by[i * b_ + m] * through[m * b_ + c][l];
    };
    subtract(s.last, s.last_size, forward, part(left, 0), s.last, s.last_size);
    subtract(s.last, s.last_size, forward, part(right, 0), after.first, after.first_size);
    subtract(after.first, after.first_size, back, part(left, arc_ - 1), s.last, s.last_size);
    subtract(after.first, after.first_size, back, part(right, arc_ - 1), after.first, after.first_size);
  }
  if (!S.allFinite()) return false;
  inverse_ = S.partialPivLu().inverse();
  return inverse_.allFinite();
}

bool ArcSolver::is_accurate(const std::vector<double>& values, Entries entries) const {
  const std::size_t n = row_.size() + separated_row_.size();
  std::vector<double> b(n, 0.0), size(n, 0.0), x(n), left_over;
  for (std::size_t i = 0; i < n; ++i)
    x[i] = 1 - 0.5 * static_cast<double>(i % 3) + 0.125 * static_cast<double>(i % 5);
  for (const auto& e : entries) b[at(e.row)] += values[at(e.place)] * x[at(e.column)];
  left_over = b;
  solve(b.data(), x.data());
  for (const auto& e : entries) {
    const double term = values[at(e.place)] * x[at(e.column)];
    left_over[at(e.row)] -= term;
    size[at(e.row)] += std::abs(term);
  }
  for (std::size_t i = 0; i < n; ++i)
    if (!(std::abs(left_over[i]) <= 1e-12 * size[i])) return false;
  return true;
}

template <int size>
void ArcSolver::solve_groups_of(const double* rhs, double* x) const {
  const int b = size > 0 ? size : b_;
  Pack r[largest_group];
  for (int t = 0; t < arc_; ++t) {
    for (int i = 0; i < b; ++i) r[i] = gather(rhs, &row_[at((t * b + i) * lanes)]);
    const Pack *D = part(diagonal, t), *L = part(lower, t);
    Pack* const z = z_.data() + t * b;
    if (t > 0)
      for (int m = 0; m < b; ++m)
        for (int i = 0; i < b; ++i) r[i] -= L[i * b + m] * z[m - b];
    for (int i = 0; i < b; ++i) z[i] = D[i * b] * r[0];
    for (int m = 1; m < b; ++m)
      for (int i = 0; i < b; ++i) z[i] += D[i * b + m] * r[m];
  }
  for (int t = arc_ - 2; t >= 0; --t) {
    const Pack* W = part(upper, t);
    Pack* const z = z_.data() + t * b;
    for (int m = 0; m < b; ++m)
      for (int i = 0; i < b; ++i) z[i] -= W[i * b + m] * z[b + m];
  }
  Pack s_left[largest_group], s_right[largest_group];
  solve_separators(rhs, x, s_left, s_right);
  for (int t = 0; t < arc_; ++t) {
    const Pack *P = part(left, t), *Q = part(right, t);
    for (int i = 0; i < b; ++i) {
      Pack value = z_[at(t * b + i)];
      for (int m = 0; m < b; ++m) value -= P[i * b + m] * s_left[m] + Q[i * b + m] * s_right[m];
      scatter(value, x, &column_[at((t * b + i) * lanes)]);
    }
  }
}

void ArcSolver::solve_separators(const double* rhs, double* x, Pack* s_left, Pack* s_right) const {
  for (int i = 0; i < separated_; ++i) separated_rhs_[i] = rhs[separated_row_[at(i)]];
  for (int l = 0; l < lanes; ++l) {
    const Separator &s = separators_[at(l)], &after = separators_[at((l + 1) % lanes)];
    const double *forward = &couplings_[coupling(l, true)], *back = &couplings_[coupling((l + 1) % lanes, false)];
    for (int i = 0; i < s.last_size; ++i)
      for (int m = 0; m < b_; ++m) separated_rhs_[s.last + i] -= forward[i * b_ + m] * z_[at(m)][l];
    for (int i = 0; i < after.first_size; ++i)
      for (int m = 0; m < b_; ++m)
        separated_rhs_[after.first + i] -= back[i * b_ + m] * z_[at((arc_ - 1) * b_ + m)][l];
  }
  separated_x_.noalias() = inverse_ * separated_rhs_;
  for (int i = 0; i < separated_; ++i) x[separated_column_[at(i)]] = separated_x_[i];
  for (int m = 0; m < b_; ++m) {
    s_left[m] = s_right[m] = Pack(0.0);
    for (int l = 0; l < lanes; ++l) {
      const Separator &s = separators_[at(l)], &after = separators_[at((l + 1) % lanes)];
      if (m < s.last_size) s_left[m].v[l] = separated_x_[s.last + m];
      if (m < after.first_size) s_right[m].v[l] = separated_x_[after.first + m];
    }
  }
}

}  // namespace delf

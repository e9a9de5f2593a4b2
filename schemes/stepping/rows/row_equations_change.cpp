// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_equations.hpp"

#include <algorithm>
#include <cmath>

namespace delf {

namespace {

double weight_of(const Argument& look) {
  double sum = 0;
  for (const Argument::Part& part : look.parts) sum += std::abs(part.weight);
  return sum;
}

}  // namespace

/// What outputs look at, at the unknown row, from the first of its vertices on; each alike but for a shift counts once.
void RowEquations::build_looks() {
  if (!reads_unknown_row()) return;
  constexpr int packs_in_cache = 4096;
  const bool one_age = outputs_.size() == 1 && outputs_[0].reads_unknown_row(outputs_[0].newest) &&
                       !outputs_[0].reads_unknown_row(outputs_[0].newest - 1);
  if (d_ == 1 && equations_.exceptional.empty() && !solver_[1] && !equations_.correction_form && turn_ == 0 &&
      one_age && !arguments_ && layout_.packs() >= packs_in_cache) {
    is_streamed_ = solver_[0]->stream(layout_, right_side(0), {}) != nullptr;
    if (const auto mixture = Mixture::of(system_)) build_division(*mixture, true);
  }
  if (is_streamed_)
    for (int c = 0; c < outputs_[0].kernel->outputs(); ++c)
      output_windows_.emplace_back(layout_), output_places_.push_back(nullptr);
  for (const Outputs& o : outputs_) {
    const Argument whole{{{Site{}, 1.0}}};
    const auto& arguments = o.kernel->arguments();
    for (std::size_t c = 0; c < std::max<std::size_t>(1, arguments.size()); ++c) {
      Argument look;
      if (arguments.empty()) look = whole;
      else
        for (const Argument::Part& part : arguments[c].parts)
          if (part.vertex.time == o.kernel->outputs_read_until()) look.parts.push_back(part);
      if (look.parts.empty()) continue;
      if (look.parts.size() > 3) look = whole;
      const int first = look.parts[0].vertex.space;
      for (Argument::Part& part : look.parts) part.vertex = {0, part.vertex.space - first};
      const auto same = [&](const Argument& other) {
        return std::ranges::equal(other.parts, look.parts, [](const Argument::Part& p, const Argument::Part& q) {
          return p.vertex == q.vertex && p.weight == q.weight;
        });
      };
      if (std::ranges::none_of(looks_, same)) looks_.push_back(std::move(look));
    }
  }
  // One look at neighbours that follow each other can be taken while the row is made.
  if (arguments_ || looks_.size() != 1 || static_cast<int>(looks_[0].parts.size()) > layout_.packs()) return;
  for (std::size_t p = 0; p < looks_[0].parts.size(); ++p)
    if (looks_[0].parts[p].vertex.space != static_cast<int>(p)) return;
  looks_on_the_way_ = true;
  for (RowIncrement& rows : own_.increments)
    for (std::size_t p = 0; p < looks_[0].parts.size(); ++p) rows.look.weights[p] = looks_[0].parts[p].weight;
}

double RowEquations::least_weight() const {
  double least = 1;
  for (const Argument& look : looks_) least = std::min(least, weight_of(look));
  return least;
}

double RowEquations::most_weight() const {
  double most = 0;
  for (const Argument& look : looks_) most = std::max(most, weight_of(look));
  return most;
}

/// With E = Σ_c W_c * out_c, the change of y_{n+1} is at most Σ_c ‖A₊⁻¹ W_c‖₁ times that of the outputs; and the nonlinear
/// part of ∂E/∂y_{n+1} sums to ℓ″ Σ_c |W_c| |weights of argument c|.
double RowEquations::gain() {
  if (d_ != 1 || !equations_.exceptional.empty() || equations_.correction_form || solver_[1]) return 0;
  if (system_.families().size() != 1 || system_.families()[0]->row_kernel()->arguments().empty()) return 0;
  const Outputs& o = outputs_[0];
  RowBuffer impulse(layout_, 1), response(layout_, 1);
  std::vector<double> sites(static_cast<std::size_t>(layout_.sites()));
  double responses = 0, sums[2] = {0, 0};
  for (int age = o.oldest; age <= o.newest; ++age)
    for (int c = 0; c < o.kernel->outputs() && o.reads_unknown_row(age); ++c) {
      std::ranges::fill(sites, 0.0);
      double weights = 0;
      for (const Argument::Part& part :
           o.kernel->arguments()[static_cast<std::size_t>(c % static_cast<int>(o.kernel->arguments().size()))].parts)
        if (part.vertex.time + age == 1) weights += std::abs(part.weight);
      if (weights == 0) continue;
      for (const Term& t : equations_.bulk[0].terms)
        if (t.source == Source::output && t.age == age && t.output == c) {
          sites[static_cast<std::size_t>(system_.lattice().wrapped(layout_.sites() / 2 - t.shift))] += t.coefficient;
          for (int parity = 0; parity < 2; ++parity)
            if (!bricks_ || brick_exists(t, equations_.bulk[0].shift, parity))
              sums[parity] += std::abs(t.coefficient) * weights;
        }
      layout_.scatter(sites, impulse.row(0));
      const double* const rhs[] = {impulse.row(0)};
      double* const w[] = {response.row(0)};
      solver_[0]->solve(rhs, w);
      layout_.copy_overlaps(w[0]);
      layout_.gather(w[0], sites);
      for (double x : sites) responses += std::abs(x);
    }
  const double sum = std::max(sums[0], sums[1]);
  return sum > 0 ? responses / sum : 0;
}

void RowEquations::make_row_the_candidate() {
  candidate_.hold_whole();
  for (int a = 0; a < d_; ++a)
    std::copy_n(increment(a).y, layout_.doubles(), candidate_.row(a));
}

namespace {

/// max |Σ_p weight_p (y − z)(shifted by p)| for a number of parts that is known.
template <int count>
Pack largest_difference(const RowLayout& layout, PackRange packs, const Argument& look, const double* y,
                        const double* z) {
  const double *above[count], *below[count];
  double weight[count];
  for (int p = 0; p < count; ++p) {
    const auto& part = look.parts[static_cast<std::size_t>(p)];
    const std::ptrdiff_t shift = static_cast<std::ptrdiff_t>(part.vertex.space) * lanes;
    above[p] = y + shift, below[p] = z + shift, weight[p] = part.weight;
  }
  Pack largest(0.0);
  for (int v = packs.first; v < packs.last; ++v) {
    const std::ptrdiff_t at = layout.at(v);
    Pack sum(0.0);
    for (int p = 0; p < count; ++p) sum += weight[p] * (Pack::load(above[p] + at) - Pack::load(below[p] + at));
    largest = largest_magnitude(largest, sum);
  }
  return largest;
}

}  // namespace

double RowEquations::largest_change(const std::vector<Argument>& looks, PackRange packs) const {
  Pack largest(0.0);
  for (const Argument& look : looks)
    for (int a = 0; a < d_; ++a) {
      const double *y = increment(a).y, *z = candidate_.row(a);
      switch (look.parts.size()) {
        case 1:
          largest = max_or_nan(largest_difference<1>(layout_, packs, look, y, z), largest);
          break;
        case 2:
          largest = max_or_nan(largest_difference<2>(layout_, packs, look, y, z), largest);
          break;
        default:
          largest = max_or_nan(largest_difference<3>(layout_, packs, look, y, z), largest);
          break;
      }
    }
  return max_or_nan(largest);
}

}  // namespace delf

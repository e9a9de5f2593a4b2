// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_strips.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "lattice/index.hpp"

namespace delf {
namespace {

// Strips that stay in the first level of the cache; in the second one where a solve follows a recurrence strip by strip.
constexpr int short_strip = 64, medium_strip = 256, long_strip = 1024;
constexpr int packs_of_a_thread = 1024, packs_beyond_cache = 4096;
constexpr std::size_t most_outputs = 32;

using Pointers = std::array<double*, most_outputs>;

}  // namespace

RowStrips::RowStrips(const LatticeSystem& system, const RowEquations& equations, const RowLayout& layout,
                     RowTable& table, const KeptRows& kept, const StepOptions& options, int history)
    : equations_(equations),
      layout_(layout),
      kept_(kept),
      d_(system.components()),
      monodromy_(options.monodromy),
      table_(&table),
      from_(0),
      to_(layout.packs()),
      w_(at(d_)) {
  choose_solver();
  const int warm_up = sweeps_.empty() ? 0 : sweeps_[0]->warm_up().last - sweeps_[0]->warm_up().first;
  lay_out_strips(warm_up);
  delay_ = std::max(warm_up, equations.reach());
  for (const SourceRow& source : equations.sources()) {
    has_local_ = has_local_ || source.is_local;
    if (!source.reads_unknown) continue;
    reads_left_ = std::min({reads_left_, source.left, -source.highest});
    reads_right_ = std::max({reads_right_, source.right, -source.lowest});
    ahead_ = std::max(ahead_, source.highest);
  }
  sums_are_updates_ = solver_ == Solver::number && equations.right_side(0, Solving::step);
  const bool takes_whole_rows =
      solver_ == Solver::whole_rows || (solver_ == Solver::sweeps && sweeps_[0]->takes_whole_rows());
  const bool is_long = !takes_whole_rows && layout.packs() > packs_beyond_cache;
  const int packs =
      takes_whole_rows ? to_ : std::min(to_, (warm_up > 0 ? 2 * long_strip : longest_strip_) + 2 * delay_);
  if (!sums_are_updates_ || is_long) memory_ = RowBuffer(at(packs) * lanes, d_);
  // The first update waits for all right sides, or stays far enough behind them.
  const bool updates_late =
      (is_long && (warm_up == 0 || warm_up > equations.reach())) || (solver_ == Solver::sweeps && takes_whole_rows);
  can_go_in_place_ = updates_late && history == 2 && equations.reads_newest_alone() && options.fibre == Fibre::real;
  // A recurrence is not shared out.
  const int parts = std::min(options.threads, to_ / packs_of_a_thread);
  if (solver_ != Solver::number || equations.iterates() || parts < 2) return;
  team_.emplace(parts);
  can_go_in_place_ = false;
  for (int p = 0; p < parts; ++p)
    parts_.emplace_back(new RowStrips(*this, layout.first_of_part(p, parts), layout.first_of_part(p + 1, parts)));
}

RowStrips::RowStrips(const RowStrips& whole, int from, int to)
    : equations_(whole.equations_),
      layout_(whole.layout_),
      kept_(whole.kept_),
      d_(whole.d_),
      monodromy_(whole.monodromy_),
      table_(&own_),
      from_(from),
      to_(to),
      solver_(whole.solver_),
      sums_are_updates_(whole.sums_are_updates_),
      has_local_(whole.has_local_),
      delay_(whole.delay_),
      w_(at(d_)) {
  if (!sums_are_updates_) memory_ = RowBuffer(at(static_cast<int>(whole.memory_.stride())), d_);
  lay_out_strips(0);
}

void RowStrips::choose_solver() {
  // Source terms of known rows that neighbours read are evaluated in whole rows.
  const auto& sources = equations_.sources();
  if (equations_.has_walls() ||
      std::ranges::any_of(sources, [](const SourceRow& row) { return !row.reads_unknown && !row.is_local; }))
    return;
  for (int a = 0; a < d_; ++a) sweeps_.push_back(equations_.solver(0).sweeps(a));
  // Components that advance by other strips would have to wait for each other.
  if (std::ranges::any_of(sweeps_, [this](const auto& one) {
        return !one || one->warm_up().first != sweeps_[0]->warm_up().first ||
               one->takes_whole_rows() != sweeps_[0]->takes_whole_rows();
      }))
    return sweeps_.clear();
  const bool recurs = sweeps_[0]->takes_whole_rows() || sweeps_[0]->warm_up().first < sweeps_[0]->warm_up().last;
  solver_ = recurs ? Solver::sweeps : Solver::number;
}

/// Recurrences by strips begin with the right sides of the last packs.
void RowStrips::lay_out_strips(int warm_up) {
  // Short passes over rows that come from memory wait for it.
  const int length = solver_ == Solver::whole_rows          ? to_ - from_
                     : warm_up > 0                          ? long_strip
                     : layout_.packs() > packs_beyond_cache ? medium_strip
                                                            : short_strip;
  if (warm_up > 0) strips_.push_back({to_ - warm_up, to_});
  for (int begin = from_, end; begin < to_; begin = end) {
    end = warm_up > 0 && to_ - begin < 2 * length ? to_ : std::min(to_, begin + length);
    strips_.push_back({begin, end});
  }
  for (const Strip& strip : strips_) longest_strip_ = std::max(longest_strip_, strip.last - strip.first);
}

// ---- A pass.

double RowStrips::pass(Solving solving, std::vector<double>* corrections,
                       const std::function<void(RowOperations&)>& along) {
  if (!team_) {
    const ScratchRows local(has_local_ ? static_cast<int>(equations_.sources().size()) : 0, longest_strip_ * lanes);
    local_ = &local;
    begin(solving, corrections);
    along(*this);
  } else {
    largest_ = 0.0;
    team_->run(team_->size(), [&](int p) {
      RowStrips& part = *parts_[p];
      part.own_ = *table_;
      part.pass(solving, nullptr, along);
    });
    for (const auto& part : parts_) largest_ = larger_size(largest_, part->largest_);
  }
  if (to_ - from_ < layout_.packs()) return 0;
  close();
  if (corrections) {
    compare_inside(0, layout_.packs());
    for (const SourceRow& source : equations_.sources())
      if (source.reads_unknown) layout_.fill_halo((*table_)[source.ring.row(0)]);
  }
  return max_or_nan(largest_);
}

void RowStrips::begin(Solving solving, std::vector<double>* corrections) {
  solving_ = solving;
  corrections_ = corrections;
  if (corrections) std::ranges::fill(*corrections, 0.0);
  formed_ = updated_ = from_;
  predicted_ = std::numeric_limits<int>::min();
  made_ = compared_ = {from_, from_};
  largest_ = 0.0;
  if (solving == Solving::correction) find_corrections();
  else order_ = 0;
  warms_up_ = strips_[0].first > from_;
  move_window(strips_[0].first);
  if (!warms_up_)
    for (std::size_t a = 0; a < sweeps_.size(); ++a) sweeps_[a]->begin(w_[a]);
}

/// δ with its halos; δ = g′ − g again where the pass of the step has not kept it.
void RowStrips::find_corrections() {
  const std::ptrdiff_t begin = layout_.at(0), end = layout_.at(layout_.packs());
  for (const SourceRow& source : equations_.sources()) {
    if (!source.reads_unknown) continue;
    const double* const g = (*table_)[source.ring.row(0)];
    double* const delta = (*table_)[source.correction];
    if (!keeps_corrections_) {
      equations_.prediction(source, order_).evaluate(table_->data(), begin, end, lanes, delta);
      for (std::ptrdiff_t i = begin; i < end; i += lanes) (Pack::load(g + i) - Pack::load(delta + i)).store(delta + i);
    }
    layout_.fill_halo(delta);
  }
}

void RowStrips::move_window(int first) {
  for (int a = 0; a < memory_.rows(); ++a) w_[a] = memory_.row(a) - layout_.at(first);
}

/// A group of source terms, into number 0 of their rings, or `back` rows before.
void RowStrips::evaluate_group(std::size_t first, int from, int to, int back) const {
  const RowTable& rows = *table_;
  const SourceRow& source = equations_.sources()[first];
  Pointers out;
  for (int c = 0; c < source.outputs; ++c) out[c] = rows[equations_.sources()[first + at(c)].ring.row(back)];
  equations_.evaluate(rows, kept_.newest(), source, back, from, to, out.data());
}

void RowStrips::evaluate_rows(std::size_t first, int back) {
  evaluate_group(first, 0, layout_.packs(), back);
  for (int c = 0; c < equations_.sources()[first].outputs; ++c)
    layout_.fill_halo((*table_)[equations_.sources()[first + at(c)].ring.row(back)]);
}
void RowStrips::evaluate_known() {
  for (std::size_t s = 0; s < equations_.sources().size(); ++s) {
    const SourceRow& source = equations_.sources()[s];
    if (source.component == 0 && !source.reads_unknown && !source.is_local) evaluate_rows(s);
  }
}
void RowStrips::evaluate_unknown() {
  for (std::size_t s = 0; s < equations_.sources().size(); ++s)
    if (equations_.sources()[s].component == 0 && equations_.sources()[s].reads_unknown) evaluate_rows(s);
}

/// Source terms that their own sites alone read.
void RowStrips::evaluate(Strip packs) {
  if (!has_local_) return;
  for (std::size_t s = 0; s < equations_.sources().size(); ++s) {
    const SourceRow& source = equations_.sources()[s];
    if (!source.is_local) continue;
    (*table_)[source.ring.row(0)] = (*local_)[static_cast<int>(s)] - layout_.at(packs.first);
    if (source.component + 1 == source.outputs) evaluate_group(s + 1 - at(source.outputs), packs.first, packs.last, 0);
  }
}

/// The first pack with bricks, which fill every second one.
int RowStrips::first_brick(const SourceRow& source, int pack) const {
  return source.stride == 2 ? pack + static_cast<int>((pack + kept_.newest() + source.newest) & 1) : pack;
}

/// Into number 0 of the ring, as far as right sides of the strip read it, where it is not there yet; halos too.
void RowStrips::predict(int order, Strip packs) {
  order_ = order;
  const int from = packs.first == 0 ? -layout_.halo() : std::max(packs.first - layout_.halo(), predicted_);
  predicted_ = packs.last == layout_.packs() ? packs.last + layout_.halo() : packs.last + ahead_;
  for (const SourceRow& source : equations_.sources())
    if (source.reads_unknown)
      equations_.prediction(source, order)
          .evaluate(table_->data(), layout_.at(first_brick(source, from)), layout_.at(predicted_),
                    source.stride * lanes, (*table_)[source.ring.row(0)]);
}

void RowStrips::right_side(Strip packs) {
  const RowTable& rows = *table_;
  const std::int64_t n = kept_.newest();
  if (warms_up_) {
    equations_.right_sides(rows, n, solving_, packs.first, packs.last, w_.data());
    for (std::size_t a = 0; a < sweeps_.size(); ++a) sweeps_[a]->begin(w_[a]);
    warms_up_ = false;
    predicted_ = std::numeric_limits<int>::min();
    return move_window(from_);
  }
  formed_ = packs.last;
  if (updates_from_sums()) return;
  // Right sides that are not used yet move to the beginning of the window.
  if (packs.first > from_ && static_cast<std::ptrdiff_t>(to_ - from_) * lanes > memory_.stride()) {
    for (int a = 0; a < d_; ++a)
      std::memmove(memory_.row(a), w_[a] + layout_.at(updated_),
                   at(static_cast<int>(layout_.at(packs.first) - layout_.at(updated_))) * sizeof(double));
    move_window(updated_);
  }
  const bool are_sums = solver_ == Solver::sweeps && equations_.right_side(0, solving_);
  if (!are_sums) equations_.right_sides(rows, n, solving_, packs.first, packs.last, w_.data());
  if (solver_ == Solver::sweeps)
    for (std::size_t a = 0; a < sweeps_.size(); ++a) {
      if (!are_sums) sweeps_[a]->forward(w_[a], packs.last);
      else sweeps_[a]->forward(*equations_.right_side(static_cast<int>(a), solving_), rows.data(), w_[a], packs.last);
    }
}

Strip RowStrips::solve() {
  if (warms_up_ || formed_ == from_) return {};
  switch (solver_) {
    case Solver::number:
      // Right sides still to come read rows this far back.
      return {updated_, updates_from_sums() || formed_ == to_ ? formed_ : std::max(updated_, formed_ - delay_)};
    case Solver::sweeps: {
      const PackRange ready = sweeps_[0]->ready();  // all components advance alike
      return {ready.first, ready.last};
    }
    case Solver::whole_rows:
      if (formed_ < to_ || updated_ == to_) return {};
      equations_.solver(kept_.newest()).solve(w_.data());
      for (double* const w : w_) layout_.copy_overlaps(w);
      return {from_, to_};
  }
  return {};
}

RowUpdate RowStrips::updating(int a) const {
  const RowTable& rows = *table_;
  const bool is_step = solving_ == Solving::step;
  return {.v = rows[equations_.v().row(is_step ? 1 : 0, a)],
          .y = rows[equations_.y().row(is_step ? 1 : 0, a)],
          .new_v = rows[equations_.v().row(0, a)],
          .new_y = rows[equations_.y().row(0, a)],
          .of_increment = is_step ? 1.0 : 0.0,
          .of_change = is_step ? 0.0 : 1.0,
          .largest = largest_};
}

namespace {

/// v_{n+1} and y_{n+1} from w, or where w is the right side; returns the largest |y|. Not inlined: what is updated stays in
/// registers.
[[gnu::noinline]] Pack update_by(const double* w, RowUpdate update, std::ptrdiff_t begin, std::ptrdiff_t end) {
  for (std::ptrdiff_t i = begin; i < end; i += lanes) update(i, Pack::load(w + i));
  return update.largest;
}
[[gnu::noinline]] Pack update_by(const RowSum& w, const RowTable& rows, RowUpdate update, std::ptrdiff_t begin,
                                 std::ptrdiff_t end) {
  w.pass<lanes>(rows.data(), begin, end, update);
  return update.largest;
}

}  // namespace

void RowStrips::update(Strip packs) {
  const std::ptrdiff_t begin = layout_.at(packs.first), end = layout_.at(packs.last);
  for (int a = 0; a < d_; ++a) {
    if (solver_ == Solver::sweeps) {
      RowUpdate update = updating(a);
      sweeps_[a]->backward(w_[a], update);
      largest_ = update.largest;
    } else if (updates_from_sums()) {
      largest_ = update_by(*equations_.right_side(a, solving_), *table_, updating(a), begin, end);
    } else {
      largest_ = update_by(w_[a], updating(a), begin, end);
    }
  }
  updated_ = std::max(updated_, packs.last);
}

/// Rows that stay in the cache are compared when all of them is there.
void RowStrips::compare(Strip packs) {
  if (layout_.packs() <= 2 * short_strip) return;
  made_ = made_.first == made_.last ? PackRange{packs.first, packs.last}
                                    : PackRange{std::min(made_.first, packs.first), std::max(made_.last, packs.last)};
  compare_inside(made_.first - reads_left_, made_.last - reads_right_);
}

void RowStrips::compare_inside(int from, int to) {
  if (from >= to) return;
  if (compared_.first == compared_.last) compared_ = {from, from};
  if (from < compared_.first) compare_packs(from, compared_.first);
  if (to > compared_.last) compare_packs(compared_.last, to);
  compared_ = {std::min(from, compared_.first), std::max(to, compared_.last)};
}

namespace {

/// δ = g′ − g, kept unless null, and g ← g′; the largest |δ|.
Pack take_over(const double* now, double* g, double* delta, std::ptrdiff_t begin, std::ptrdiff_t end,
               std::ptrdiff_t stride) {
  Pack most = 0.0;
  for (std::ptrdiff_t i = begin; i < end; i += stride) {
    const Pack value = Pack::load(now + i), change = value - Pack::load(g + i);
    most = largest_magnitude(most, change);
    if (delta) change.store(delta + i);
    value.store(g + i);
  }
  return most;
}

}  // namespace

void RowStrips::compare_packs(int from, int to) {
  // Beyond the cache a row that few steps read is not worth writing: δ is then found again.
  keeps_corrections_ = solving_ == Solving::correction || order_ == 0 || layout_.packs() <= packs_beyond_cache;
  const RowTable& rows = *table_;
  const auto& sources = equations_.sources();
  for (std::size_t first = 0; first < sources.size(); first += at(sources[first].outputs)) {
    const SourceRow& source = sources[first];
    if (!source.reads_unknown) continue;
    const ScratchRows scratch(source.outputs, short_strip * lanes);
    for (int begin = from; begin < to; begin += short_strip) {
      const int end = std::min(to, begin + short_strip);
      Pointers out;
      for (int c = 0; c < source.outputs; ++c) out[c] = scratch[c] - layout_.at(begin);
      equations_.evaluate(rows, kept_.newest(), source, 0, begin, end, out.data());
      const int own = first_brick(source, begin);
      for (int c = 0; c < source.outputs; ++c) {
        const std::size_t s = first + at(c);
        const Pack most =
            take_over(out[c], rows[sources[s].ring.row(0)], keeps_corrections_ ? rows[sources[s].correction] : nullptr,
                      layout_.at(own), layout_.at(end), source.stride * lanes);
        (*corrections_)[s] = larger_or_nan(max_or_nan(most), (*corrections_)[s]);
      }
    }
  }
}

/// Halos and overlaps of the new row.
void RowStrips::close() const {
  for (int a = 0; a < d_; ++a) {
    double *const y = (*table_)[equations_.y().row(0, a)], *const v = (*table_)[equations_.v().row(0, a)];
    // Loads wait for slots of theirs that have just been stored alone.
    const bool overlaps_last = layout_.halos_come_first();
    if (!overlaps_last) layout_.copy_overlaps(v, y);
    layout_.fill_halo(y, monodromy_);
    if (equations_.reads_increments_beside()) layout_.fill_halo(v);
    if (overlaps_last) layout_.copy_overlaps(v, y);
  }
}

std::size_t RowStrips::bytes() const {
  std::size_t bytes = memory_.bytes();
  for (const auto& part : parts_) bytes += part->memory_.bytes();
  return bytes;
}

}  // namespace delf

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
constexpr int packs_beyond_cache = 4096;
// Arcs are as many for any number of threads, and long against their joints, whose packs are swept forward twice.
constexpr int most_arcs = 32, shortest_arc = 1024, shortest_arc_of_sweeps = 4096, arc_over_joint = 16;
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
  const bool is_long = solver_ != Solver::whole_rows && !takes_whole_rows() && to_ > packs_beyond_cache;
  for (const SourceRow& source : equations.sources()) {
    has_local_ = has_local_ || source.is_local;
    if (!source.reads_unknown) continue;
    reads_left_ = std::min({reads_left_, source.left, -source.highest});
    reads_right_ = std::max({reads_right_, source.right, -source.lowest});
    ahead_ = std::max(ahead_, source.highest);
  }
  sums_are_updates_ = solver_ == Solver::number && equations.right_side(0, Solving::step);
  // The first update waits for all right sides, or stays far enough behind them.
  const int distance = sweeps_.empty() || takes_whole_rows() ? 0 : sweeps_[0]->near();
  const bool updates_late =
      is_long ? distance == 0 || distance > equations.reach() : solver_ == Solver::sweeps && takes_whole_rows();
  can_go_in_place_ = updates_late && history == 2 && equations.reads_newest_alone() && options.fibre == Fibre::real;
  const int most = solver_ == Solver::whole_rows ? 0 : std::min(most_arcs, to_ / packs_of_an_arc()) / 2 * 2;
  if (distance > 0 || is_long || (solver_ == Solver::number && options.threads > 1 && most > 1)) {
    near_ = distance + layout.halo();
    delay_ = std::max(distance, equations.reach());
    // An arc changes no bit where there is no recurrence.
    const int arcs = std::max(1, distance > 0 || options.threads > 1 ? most : 1);
    for (int p = 0; p < arcs; ++p)
      arcs_.emplace_back(new RowStrips(*this, layout.first_of_part(p, arcs), layout.first_of_part(p + 1, arcs)));
    if (options.threads > 1 && arcs > 1) team_.emplace(std::min(options.threads, arcs), arcs);
    return;
  }
  lay_out_strips(0, to_);
  if (sums_are_updates_) return;
  memory_ = RowBuffer(at(to_) * lanes, d_);
  for (int a = 0; a < d_; ++a) window_.push_back(memory_.row(a));
}

RowStrips::RowStrips(const RowStrips& whole, int from, int to)
    : equations_(whole.equations_),
      layout_(whole.layout_),
      kept_(whole.kept_),
      d_(whole.d_),
      monodromy_(whole.monodromy_),
      table_(whole.has_local_ ? &own_ : whole.table_),
      of_whole_(whole.table_),
      from_(from),
      to_(to),
      solver_(whole.solver_),
      has_local_(whole.has_local_),
      delay_(whole.delay_),
      reads_left_(whole.reads_left_),
      reads_right_(whole.reads_right_),
      ahead_(whole.ahead_),
      near_(whole.near_),
      memory_(at(2 * near_) * lanes, d_),
      at_joint_{{(from == 0 ? layout_.packs() : from) - near_, from == 0 ? layout_.packs() : from},
                {from, from + near_}},
      first_(at(d_), Pack(0.0)),
      own_corrections_(equations_.sources().size()),
      window_(at(d_)),
      w_(at(d_)) {
  for (std::size_t a = 0; a < whole.sweeps_.size(); ++a)
    sweeps_.push_back(equations_.solver(0).sweeps(static_cast<int>(a), {from, to}));
  lay_out_strips(from + near_, to - layout_.halo());
}

void RowStrips::choose_solver() {
  // Source terms of known rows that neighbours read are evaluated in whole rows.
  const auto& sources = equations_.sources();
  if (equations_.has_walls() ||
      std::ranges::any_of(sources, [](const SourceRow& row) { return !row.reads_unknown && !row.is_local; }))
    return;
  const LinearSolver& solver = equations_.solver(0);
  if (solver.is_a_number()) {
    solver_ = Solver::number;
    return;
  }
  for (int a = 0; a < d_; ++a) sweeps_.push_back(solver.sweeps(a, layout_.all()));
  // Components that advance by other strips would have to wait for each other.
  if (std::ranges::any_of(sweeps_, [this](const auto& one) {
        return !one || one->near() != sweeps_[0]->near() || one->takes_whole_rows() != sweeps_[0]->takes_whole_rows();
      }))
    return sweeps_.clear();
  solver_ = Solver::sweeps;
}

int RowStrips::packs_of_an_arc() const {
  if (solver_ == Solver::whole_rows) return 0;
  return sweeps_.empty() ? shortest_arc : std::max(shortest_arc_of_sweeps, arc_over_joint * sweeps_[0]->near());
}

void RowStrips::lay_out_strips(int from, int to) {
  // Short passes over rows that come from memory wait for it.
  const int length = solver_ == Solver::whole_rows            ? to - from
                     : solver_ == Solver::sweeps && near_ > 0 ? long_strip
                     : layout_.packs() > packs_beyond_cache   ? medium_strip
                                                              : short_strip;
  for (int begin = from, end; begin < to; begin = end) {
    end = near_ > 0 && to - begin < 2 * length ? to : std::min(to, begin + length);
    strips_.push_back({begin, end});
    longest_strip_ = std::max(longest_strip_, end - begin);
  }
}

// ---- A pass.

double RowStrips::pass(Solving solving, std::vector<double>* corrections, const Along& along) {
  begin(solving, corrections);
  if (solving == Solving::correction) {
    if (arcs_.empty()) find_corrections();
    else if (!arcs_[0]->keeps_corrections_) for_each_arc([this](int p) { arcs_[at(p)]->find_corrections(); });
    for (const SourceRow& source : equations_.sources())
      if (source.reads_unknown) layout_.fill_halo((*table_)[source.correction]);
  }
  if (arcs_.empty()) {
    if (!window_.empty()) move_window(from_);
    for (std::size_t a = 0; a < sweeps_.size(); ++a) sweeps_[a]->begin(w_[a], {0, 0});
    along_strips(along);
  } else {
    for_each_arc([&](int p) { arcs_[at(p)]->make_joint(solving, corrections != nullptr, along); });
    for_each_arc([&](int p) { arcs_[at(p)]->go_on(*arcs_[at(p + 1) % arcs_.size()], along); });
    order_ = arcs_[0]->order_;
    for (const auto& arc : arcs_) {
      largest_ = larger_size(largest_, arc->largest_);
      for (std::size_t s = 0; corrections && s < corrections->size(); ++s)
        (*corrections)[s] = larger_or_nan(arc->own_corrections_[s], (*corrections)[s]);
    }
  }
  close();
  if (corrections) compare_rest();
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
  if (solving == Solving::step) order_ = 0;
}

void RowStrips::along_strips(const Along& along) {
  const ScratchRows local(has_local_ ? static_cast<int>(equations_.sources().size()) : 0,
                          std::max(longest_strip_, near_) * lanes);
  local_ = &local;
  along(*this);
}
void RowStrips::for_each_arc(const std::function<void(int)>& part) {
  const int arcs = static_cast<int>(arcs_.size());
  if (team_) return team_->run(arcs, part);
  for (int p = 0; p < arcs; ++p) part(p);
}

/// Right sides of the packs before the arc and of its first ones, swept forward; and the solution where they meet.
void RowStrips::make_joint(Solving solving, bool compares, const Along& along) {
  if (has_local_) own_.point_as(*of_whole_);
  begin(solving, compares ? &own_corrections_ : nullptr);
  is_at_joint_ = true;
  std::swap(strips_, at_joint_);
  along_strips(along);
  std::swap(strips_, at_joint_);
  is_at_joint_ = false;
}
void RowStrips::right_side_at_joint(Strip packs) {
  const bool is_before = packs.first != from_;
  for (int a = 0; a < d_; ++a) w_[a] = memory_.row(a) + (is_before ? 0 : near_ * lanes) - layout_.at(packs.first);
  equations_.right_sides(*table_, kept_.newest(), solving_, packs.first, packs.last, w_.data());
  for (std::size_t a = 0; a < sweeps_.size(); ++a) {
    if (is_before) sweeps_[a]->begin(w_[a], {packs.first, packs.last});
    else sweeps_[a]->forward(nullptr, nullptr, w_[a], packs.last), first_[a] = sweeps_[a]->first(w_[a]);
  }
}

/// The packs between the joints.
void RowStrips::go_on(const RowStrips& next, const Along& along) {
  const ScratchRows window(d_, (longest_strip_ + near_ + delay_ + layout_.halo()) * lanes);
  next_ = &next;
  for (int a = 0; a < d_; ++a) {
    window_[a] = window[a];
    std::memcpy(window[a], memory_.row(a) + near_ * lanes, at(near_ * lanes) * sizeof(double));
  }
  move_window(from_);
  formed_ = from_ + near_;
  along_strips(along);
}

/// δ = g′ − g again, where the pass of the step has not kept it.
void RowStrips::find_corrections() {
  if (keeps_corrections_) return;
  const std::ptrdiff_t begin = layout_.at(from_), end = layout_.at(to_);
  for (const SourceRow& source : equations_.sources()) {
    if (!source.reads_unknown) continue;
    const double* const g = (*table_)[source.ring.row(0)];
    double* const delta = (*table_)[source.correction];
    equations_.prediction(source, order_).evaluate(table_->data(), begin, end, lanes, delta);
    for (std::ptrdiff_t i = begin; i < end; i += lanes) (Pack::load(g + i) - Pack::load(delta + i)).store(delta + i);
  }
}

void RowStrips::move_window(int first) {
  for (int a = 0; a < d_; ++a) w_[a] = window_[a] - layout_.at(first);
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
  if (is_at_joint_) return right_side_at_joint(packs);
  formed_ = packs.last;
  if (updates_from_sums()) return;
  const RowTable& rows = *table_;
  const std::int64_t n = kept_.newest();
  // Right sides that are not used yet move to the beginning of the window.
  if (next_) {
    for (int a = 0; a < d_; ++a)
      std::memmove(window_[a], w_[a] + layout_.at(updated_), at(packs.first - updated_) * lanes * sizeof(double));
    move_window(updated_);
  }
  const bool are_sums = solver_ == Solver::sweeps && equations_.right_side(0, solving_);
  if (!are_sums) equations_.right_sides(rows, n, solving_, packs.first, packs.last, w_.data());
  for (std::size_t a = 0; a < sweeps_.size(); ++a)
    sweeps_[a]->forward(equations_.right_side(static_cast<int>(a), solving_), rows.data(), w_[a], packs.last);
  if (!next_ || packs.last != strips_.back().last) return;
  // The last packs of an arc are those of the joint with the next one.
  formed_ = to_;
  const int last = to_ - packs.last;
  for (int a = 0; a < d_; ++a)
    std::memcpy(w_[a] + layout_.at(packs.last), next_->memory_.row(a) + (near_ - last) * lanes,
                at(last * lanes) * sizeof(double));
  for (std::size_t a = 0; a < sweeps_.size(); ++a) sweeps_[a]->end(next_->first_[a]);
}

Strip RowStrips::solve() {
  if (is_at_joint_ || formed_ == from_) return {};
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

/// Compares the packs whose neighbours were not all there in their arc.
void RowStrips::compare_rest() {
  if (arcs_.empty()) compare_inside(0, to_);
  int done = 0;
  for (const auto& arc : arcs_) compare_packs(done, arc->compared_.first), done = arc->compared_.last;
  if (!arcs_.empty()) compare_packs(done, to_);
  for (const SourceRow& source : equations_.sources())
    if (source.reads_unknown) layout_.fill_halo((*table_)[source.ring.row(0)]);
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
  for (const auto& arc : arcs_) bytes += arc->memory_.bytes();
  return bytes;
}

}  // namespace delf

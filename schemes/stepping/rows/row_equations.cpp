// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_equations.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "schemes/stepping/rows/row_equations_step.hpp"

namespace delf {

RowEquations::RowEquations(const LatticeSystem& system, const SolvePlan& plan, SectionRows& rows, int history,
                           const std::optional<Mixture>& mixture, int most_order)
    : system_(system),
      rows_(rows),
      layout_(rows.layout()),
      d_(system.components()),
      history_(history),
      turn_(rows.turn()),
      time_step_(system.time_step()),
      space_step_(system.lattice().space_step()),
      bricks_(system.placement() == Placement::brick_wall),
      equations_(assemble(system, plan)),
      y_slots_(rows.rows_held()),
      v_slots_(rows.increments_held()),
      candidate_(layout_, d_),
      work_window_(layout_) {
  build_marks();
  build_solvers();
  build_loop();
  build_outputs();
  build_sums();
  if (mixture) build_arguments(*mixture, most_order);
  build_looks();
  if (can_go_in_place()) make_room_in_place();
  build_places();
}

void RowEquations::begin_in_place(std::int64_t n) {
  begin(n);
  in_place_ = true;
  go_in_place();
  let_sums_read_here();
}

/// Before something is sent elsewhere for once.
RowEquations::StepRows& RowEquations::own_rows() {
  if (here_ != &own_) own_ = *here_, here_ = &own_;
  return own_;
}

/// The new row and its increment take the place of the old ones.
void RowEquations::go_in_place() {
  StepRows& rows = own_rows();
  for (int a = 0; a < d_; ++a) {
    RowIncrement& increment = rows.increments[static_cast<std::size_t>(a)];
    increment.y = base(y_base_ + a), increment.v = base(v_base_ + a);
  }
}

void RowEquations::find_rows_at(std::int64_t place) {
  here_ = &own_;
  y_slots_.at(place);
  v_slots_.at(place);
  for (Outputs& o : outputs_) o.slots.at(place);
  for (int row = oldest_value_; row <= newest_value_; ++row)
    for (int a = 0; a < d_; ++a)
      own_.values[value_index(row) + static_cast<std::size_t>(a)] =
          rows_.y_at(y_slots_(-std::clamp(row, 1 - history_, 1)), a);
  for (int a = 0; a < d_; ++a) {
    base(y_base_ + a) = rows_.y_at(y_slots_(0), a);
    base(E_base_ + a) = rows_.y_at(y_slots_(-1), a);
    base(v_new_base_ + a) = rows_.v_at(v_slots_(-1), a);
    for (int age = 0; age < ages_; ++age) base(v_base_ + age * d_ + a) = rows_.v_at(v_slots_(age), a);
    RowIncrement& rows = increment(a);
    rows.y_before = base(y_base_ + a);
    rows.v = base(v_new_base_ + a);
    rows.y = base(E_base_ + a);
    rows.v_before = equations_.correction_form ? rows.v : base(v_base_ + a);
  }
  for (Outputs& o : outputs_)
    for (int age = o.oldest; age <= o.newest; ++age)
      for (int c = 0; c < o.kernel->outputs(); ++c)
        output(o, age, c) = o.ring.row(o.slots(-age) * o.kernel->outputs() + c);
  if (!arguments_) return;
  own_.known_values = rows_.y_at(y_slots_(arguments_->mixture().known_row - 1), 0);
  own_.output = newest_output();
  const Outputs& o = outputs_[0];
  for (int back = 1; back <= static_cast<int>(own_.past_outputs.size()); ++back)
    own_.past_outputs[static_cast<std::size_t>(back - 1)] = o.ring.row(o.slots(back - o.newest));
}

/// The rings come round together after as many steps as their common multiple: where rows lie can be looked up then. To
/// find it out takes a tenth of an implicit step of a few hundred sites.
void RowEquations::build_places() {
  if (is_one_loop()) return;
  int period = std::lcm(rows_.rows_held(), rows_.increments_held());
  for (const Outputs& o : outputs_) period = std::lcm(period, std::max(1, o.held));
  if (!reads_unknown_row() || period > longest_period) return;
  std::vector<StepRows> places;
  for (int place = 0; place < period; ++place) {
    find_rows_at(place);
    places.push_back(own_);
  }
  period_ = RingSlots(period);
  places_ = std::move(places);
}

SlabRows RowEquations::slab_of(const double* const* values, std::int64_t row) const {
  return {&layout_, values, positions(), static_cast<double>(row) * time_step_,
          time_step_, space_step_};
}

/// The outputs of the stencils anchored `age` rows after row n, reading rows n + 1 − history … n + 1 and no others.
void RowEquations::evaluate(const Outputs& o, int age, double* const* out, At which, const PackRange& packs,
                            double largest, const RowsAhead& ahead) {
  const double* const* values = here_->values.data() + value_index(age + o.first_time);
  if (which != At::row) {
    const auto rows = static_cast<std::size_t>((o.last_time - o.first_time + 1) * d_);
    std::copy_n(values, rows, slab_rows_.begin());
    const double** const newest = slab_rows_.data() + (1 - age - o.first_time) * d_;
    for (int a = 0; a < d_; ++a) newest[a] = which == At::candidate ? candidate_.row(a) : increment(a).y_before;
    values = slab_rows_.data();
  }
  SlabRows slab = slab_of(values, n_ + age);
  slab.ahead = ahead;
  slab.near = largest <= o.kernel->near_below();
  if (which == At::straight_line) o.kernel->evaluate_straight(slab, increment(0).v_before, out, packs_of(o, age, packs));
  else o.kernel->evaluate(slab, out, packs_of(o, age, packs));
  if (turn_ != 0)
    for (int c = 0; c < o.kernel->outputs(); ++c) layout_.fill_halo(out[c]);
}

void RowEquations::evaluate_outputs() {
  if (is_one_loop()) return;
  for (Outputs& o : outputs_)
    for (int age = o.oldest; age <= o.newest; ++age)
      if (!o.reads_unknown_row(age)) evaluate_in_ring(o, age, At::row);
  if (arguments_) find_arguments();
}

void RowEquations::evaluate_unknown_outputs(At at) {
  if (arguments_) return evaluate_arguments(at);
  for (Outputs& o : outputs_)
    for (int age = o.oldest; age <= o.newest; ++age)
      if (o.reads_unknown_row(age)) evaluate_in_ring(o, age, at);
}

void RowEquations::evaluate_in_ring(Outputs& o, int age, At at) {
  for (int c = 0; c < o.kernel->outputs(); ++c) slab_out_[static_cast<std::size_t>(c)] = output(o, age, c);
  evaluate(o, age, slab_out_.data(), at, where_read(o));
}

void RowEquations::evaluate_newest_known_outputs() {
  for (Outputs& o : outputs_)
    if (o.oldest <= o.newest && !o.reads_unknown_row(o.newest)) evaluate_in_ring(o, o.newest, At::row);
}

bool RowEquations::reads_unknown_row() const {
  return std::ranges::any_of(outputs_, [](const Outputs& o) { return o.rows() > 0 && o.reads_unknown_row(o.newest); });
}

void RowEquations::store_right_sides() {
  for (int a = 0; a < d_; ++a) {
    double* const E = stored_right_side(a);
    sums_[first_sum(a)].pass(layout_, layout_.all(), [E](std::ptrdiff_t at, Pack sum) __attribute__((always_inline)) {
      sum.store(E + at);
    });
  }
}

RowChange RowEquations::advance(bool compared) {
  const bool on_the_way = compared && looks_on_the_way_;
  for (int a = 0; a < d_; ++a) {
    RowLook& look = increment(a).look;
    look.parts = on_the_way ? static_cast<int>(looks_[0].parts.size()) : 0;
    look.expected = candidate_.row(a);
  }
  RowChange all = make_new_row();
  if (compared && !on_the_way) all.change = largest_change(looks_);
  return all;
}

bool RowEquations::can_go_in_place() const {
  if (arguments_ || !(is_streamed_ || divides_straight()) || history_ > 2 || outputs_[0].rows() > 2) return false;
  for (const Term& t : equations_.bulk[0].terms)
    if (t.source == Source::increment) return false;
  return !outputs_[0].kernel->arguments().empty() && (divides_straight() || !looks_back());
}

bool RowEquations::looks_back() const {
  for (const Outputs& o : outputs_)
    for (const Argument& argument : o.kernel->arguments())
      for (const Argument::Part& part : argument.parts)
        if (o.newest + part.vertex.time < 0) return true;
  return false;
}

/// A stream's windows; and where steps in place write over the newest outputs, those of the row that can be gone back
/// to, and those of a next step that is not in place, lie beside.
void RowEquations::make_room_in_place() {
  if (is_streamed_) {
    const int window = window_packs(solver_[0]->stream(layout_, right_side(0), {})->last_packs());
    for (PackWindow& out : output_windows_) out.hold(window, 0, 0);
    work_window_.hold(window, 0, 0);
  }
  Outputs& o = outputs_[0];
  if (o.rows() < 2) return;
  o.held = o.rows() + 1;
  o.slots = RingSlots(o.held);
  o.ring = RowBuffer(layout_, o.held * o.kernel->outputs());
}

RowChange RowEquations::stream(At which, const std::function<void(PackRange)>& find, double largest) {
  const bool straight = which == At::straight_line;
  Outputs& o = outputs_[0];
  const int packs = layout_.packs(), halo = layout_.halo(), count = o.kernel->outputs();
  const PackRange read = where_read(o);
  for (int c = 0; c < count; ++c) output_places_[static_cast<std::size_t>(c)] = newest_output(c);
  int reach = 0;
  for (const Argument& look : looks_)
    for (const Argument::Part& part : look.parts) reach = std::max(reach, part.vertex.space);

  RowLook& look = increment(0).look;
  look.parts = looks_on_the_way_ ? static_cast<int>(looks_[0].parts.size()) : 0;
  const auto stream = solver_[0]->stream(layout_, right_side(0), increment(0));
  const PackRange last = stream->last_packs();
  const int window = window_packs(last);
  const auto hold_candidate = [&](int first, int kept_until) {
    if (find) candidate_.hold_window(window, first, kept_until);
  };
  // What would stand in a row beside the old one has windows where there is none.
  const auto hold = [&](PackWindow& place, double* beside, int first, int kept_until) {
    if (!in_place_) return beside;
    place.hold(window, first, kept_until);
    return place.row();
  };
  const auto hold_outputs = [&](int first, int kept_until) {
    for (int c = 0; c < count; ++c) {
      const auto at = static_cast<std::size_t>(c);
      output(o, o.newest, c) = slab_out_[at] = hold(output_windows_[at], output_places_[at], first, kept_until);
    }
  };
  const auto work = [&](int first, int kept_until) {
    return hold(work_window_, increment(0).v, first, kept_until);
  };
  // What a strip is made from, so many packs further on: it comes from memory while those before are evaluated.
  const auto rows_after = [&](int shift) {
    RowsAhead ahead{increment(0).y_before, increment(0).v_before, old_output()};
    for (const double*& row : ahead)
      if (row) row += static_cast<std::ptrdiff_t>(shift) * lanes;
    return ahead;
  };
  hold_candidate(last.first - halo, 0);
  if (find) find({last.first - halo, packs + halo});
  hold_outputs(last.first + o.lowest, 0);
  evaluate(o, o.newest, slab_out_.data(), which, {last.first + o.lowest, read.last}, largest);
  stream->begin(work(last.first, last.first));
  hold_candidate(-halo, 0);
  if (find) find({-halo, halo});
  int found = halo, evaluated = read.first, kept = read.first, summed = 0, done = 0, changed = 0;
  double change = 0;
  for (int end = 0; end < packs;) {
    end = packs - end < 2 * strip_packs ? packs : end + strip_packs;
    const bool all = end == packs;
    hold_candidate(std::max(-halo, changed - 2 * halo), found);
    if (find) find({found, all ? packs + halo : end + halo});
    found = end + halo;
    const int evaluated_until = all ? read.last : end + o.highest;
    hold_outputs(kept, evaluated);
    evaluate(o, o.newest, slab_out_.data(), which, {evaluated, evaluated_until}, largest,
             all ? RowsAhead{} : rows_after(found - evaluated));
    evaluated = evaluated_until;
    double* const room = work(done, summed);
    summed = end;
    const int before = done;
    done = stream->advance(end, room, straight ? nullptr : candidate_.row(0));
    // Outputs take the place of those that are no longer read.
    const int keep_until = all ? read.last : end + o.lowest;
    for (int c = 0; c < count && in_place_; ++c) {
      const double* const from = slab_out_[static_cast<std::size_t>(c)];
      std::copy(from + layout_.at(kept), from + layout_.at(keep_until),
                output_places_[static_cast<std::size_t>(c)] + layout_.at(kept));
    }
    kept = keep_until;
    if (straight) continue;
    // What is looked at on the way is that from one end of a strip to the next, and not beyond it.
    const int seen = done - reach;
    if (seen > (looks_on_the_way_ ? before : changed)) {
      change = larger_or_nan(largest_change(looks_, {changed, looks_on_the_way_ ? before : seen}), change);
      changed = seen;
    }
  }
  increment(0).close(layout_, [](const auto&) {});
  RowChange result = stream->result();
  if (!straight)
    result.change = larger_or_nan(larger_or_nan(largest_change(looks_, {changed, packs}), change), result.change);
  return result;
}

/// The pass over whole rows has left the bulk's equation at these sites: puts their own sums in its place.
void RowEquations::set_exceptional_sites() {
  for (const SiteEquation& special : equations_.exceptional) {
    const double E = value_at(special, false, nullptr);
    for (int slot : layout_.slots_of(special.site)) stored_right_side(special.component)[slot] = -E;
  }
}

/// E at one site, by its own terms.
double RowEquations::value_at(const SiteEquation& special, bool unknown_too, double* absolute) const {
  const int own = layout_.slot(special.site), a = special.component;
  if (special.fixed) {
    // v_{n+1} = v_n + w = 0; where w corrects the candidate, v_{n+1} is the candidate's
    const int v = equations_.correction_form || unknown_too ? v_new_base_ : v_base_;
    return base(v + a)[own];
  }
  const EquationTerms& equation = special.equation;
  const double sign = (n_ + 1 - equation.shift + special.site) % 2 == 0 ? 1 : -1;
  double value = equation.constant + sign * equation.constant_alternating;
  for (const Term& t : equation.terms) {
    if (t.source == Source::unknown && !unknown_too) continue;
    const double* row = base(index_of(t, unknown_too));
    const int beside = layout_.slot(std::clamp(special.site + t.shift, 0, layout_.sites() - 1));
    const double less = t.source == Source::difference ? row[own]
                        : t.source == Source::unknown
                            ? base(v_base_ + t.component)[beside]  // w = v_{n+1} − v_n
                            : 0;
    const double x = (t.coefficient + sign * t.alternating) * (row[beside] - less);
    value += x;
    if (absolute) *absolute += std::abs(x);
  }
  return value;
}

std::size_t RowEquations::bytes_to_come(int parts, bool residual) const {
  const auto missing = [](std::size_t bytes, std::size_t there) { return bytes > there ? bytes - there : 0; };
  const std::size_t row = layout_.doubles();
  std::size_t total = missing(RowBuffer::bytes_of(edge_doubles(parts)), edges_.bytes());
  if (residual) total += missing(RowBuffer::bytes_of(row, residual_rows()), scratch_.bytes());
  if (is_streamed_) {
    // First steps, whose seeds are of low order, iterate: their candidate is whole.
    const PackRange last = solver_[0]->stream(layout_, right_side(0), {})->last_packs();
    const std::size_t window = static_cast<std::size_t>(window_packs(last)) * lanes;
    total += missing(RowBuffer::bytes_of(window) + RowBuffer::bytes_of(row), candidate_.bytes());
  }
  if (divides_straight()) total += missing(RowBuffer::bytes_of(row), candidate_.bytes());
  return total;
}

std::size_t RowEquations::window_bytes() const {
  std::size_t total = work_window_.bytes();
  for (const PackWindow& out : output_windows_) total += out.bytes();
  return total;
}

std::size_t RowEquations::output_bytes() const {
  std::size_t total = 0;
  for (const Outputs& o : outputs_) total += o.ring.bytes();
  return total;
}

std::size_t RowEquations::matrix_bytes() const { return solver_[0]->bytes() + (solver_[1] ? solver_[1]->bytes() : 0); }
std::size_t RowEquations::work_bytes() const {
  std::size_t total = layout_.bytes();
  total += places_.size() * (sizeof(StepRows) + (own_.bases.size() + own_.values.size()) * sizeof(double*) +
                             own_.increments.size() * sizeof(RowIncrement));
  for (const RowBuffer* b : {&w_, &scratch_, &positions_, &edges_}) total += b->bytes();
  return total + window_bytes() + candidate_.bytes() + (arguments_ ? arguments_->bytes() : 0) +
         (tiles_ ? tiles_->bytes() : 0);
}

}  // namespace delf

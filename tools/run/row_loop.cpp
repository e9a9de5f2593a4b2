// SPDX-License-Identifier: MIT
#include "tools/run/row_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "schemes/stepping/evolution.hpp"
#include "schemes/stepping/flush_denormals.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "tools/report/failure.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/seconds_since.hpp"

namespace delf {
namespace {

// Adds the seconds of its life to a total, also when an exception ends it.
class Stopwatch {
 public:
  explicit Stopwatch(double& total) : total_(total) {}
  ~Stopwatch() { total_ += seconds_since(begin_) - left_out_; }
  /// Runs something that it does not count.
  void leave_out(const auto& look) {
    const auto from = Clock::now();
    look();
    left_out_ += seconds_since(from);
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& total_;
  double left_out_ = 0;
  Clock::time_point begin_ = Clock::now();
};

// A row that was made, and is no result.
struct Unrecorded {
  const char* status;
  std::string why;
};

}  // namespace

bool is_solution(double residual, double tolerance) {
  constexpr double most = 1e-6;  // of the sum of the absolute terms; a loose tolerance asks for more
  return residual <= std::max(most, 1e3 * tolerance);
}

RowLoop::RowLoop(const Scene& scene, Outcome& outcome, const Simulation& simulation, const WatchedRows& watched)
    : scene_(scene), outcome_(outcome), simulation_(simulation), watched_(watched) {}

double RowLoop::time(std::int64_t row) const { return row == 0 ? 0 : simulation_.time(row); }

std::optional<RunFiles::Written> RowLoop::begin(SavedState* checkpoint) {
  if (checkpoint == nullptr) return start(), std::nullopt;
  RunFiles::Written written;
  (*checkpoint)("written", written);
  visit(*checkpoint);
  return written;
}

void RowLoop::start() {
  try {
    make_first_rows();
  } catch (const NumericalFailure& error) {
    return fail(error);
  }
  started_ = true;
  newest_ = simulation_.newest();
  note_length();
}

void RowLoop::visit(SavedState& state) {
  started_ = true;  // there are no checkpoints before
  state("newest", newest_), state("recorded", recorded_), state("iterations", iterations_);
  state("iterations of the last step", last_iterations_);
  visit_rows(state);
  outcome_.visit(state);
}

/// A checkpoint of the newest row, before this is recorded as the last one: a run that is resumed may go on from it.
void RowLoop::save() {
  saved_ = newest_;
  if (!checkpoints_->wanted()) return;
  RunFiles::Written written = files_->flush(true);
  checkpoints_->write(newest_, [&](SavedState& state) {
    state("written", written);
    visit(state);
    files_->visit(state);
  });
}

void RowLoop::run(RunFiles& files, Checkpoints& checkpoints) {
  files_ = &files, checkpoints_ = &checkpoints;
  try {
    record_and_step();
  } catch (const Unrecorded& row) {
    outcome_.status = row.status;
    outcome_.break_time = time(newest_);
    if (recorded_ < 0 && record_start()) recorded_ = 0;
    outcome_.failure =
        fmt::format("{} ({})", row.why,
                    recorded_ < 0 ? std::string("no row is recorded")
                                  : fmt::format("row {} is the last good one that was recorded", recorded_));
  } catch (const SystemFailure&) {
    close();
    throw;
  } catch (const BadInput& bad) {  // a formula without a value at a later time
    outcome_.status = "not-finite";
    outcome_.failure = scene_.settings.located(bad).what();
    close();
    throw BadScene(outcome_.failure);
  }
  close();
  if (!outcome_.failure.empty()) throw NumericalFailure(outcome_.failure);
}

void RowLoop::record_and_step() {
  for (std::int64_t row = recorded_ + 1; started_ && row <= scene_.last_row(newest_); ++row)
    if (is_due(row)) put(row);
  if (started_ && is_over()) save();
  try {
    Progress progress(scene_.steps);
    find_next_watched();
    while (started_ && !is_over() && !Interrupt::asked()) {
      step_until(scene_.next_record(newest_), progress);
      if (is_over()) save();
      if (is_due(newest_)) put(newest_);
    }
    if (started_ && !is_over()) {
      outcome_.status = "interrupted";
      if (saved_ < newest_ - 1) save();
    }
  } catch (const NumericalFailure& error) {
    fail(error);
  }
  if (const std::int64_t last = scene_.last_row(newest_); recorded_ != last) put(last);
}

// The rows held are still the last good ones; of steps that were taken together some may be good.
void RowLoop::fail(const NumericalFailure& error) {
  if (started_) newest_ = simulation_.newest();
  outcome_.status = status_of(error);
  outcome_.break_time = time(newest_ + 1);
  const std::string what = error.what();
  const std::string where =
      what.starts_with("step ") ? "" : fmt::format("step {}, t = {:.6g}: ", newest_ + 1, time(newest_ + 1));
  outcome_.failure = fmt::format("{}{} (row {} is the last good one, and is saved)", where, what, newest_);
}

void RowLoop::step_until(std::int64_t row, Progress& progress) {
  Stopwatch stopwatch(outcome_.seconds);
  const FlushDenormals for_all_steps;  // each would set and restore it
  bool looked_at = true;               // as the row that an interruption leaves must be: it is recorded
  while (newest_ < row && !(looked_at && (Interrupt::asked() || (scene_.until && is_over())))) {
    if (Interrupt::asked() || checkpoints_->due(newest_)) save();
    if (rows_due_.at(newest_)) files_->flush(false), rows_due_.restart();
    const std::int64_t unseen = Interrupt::asked() ? 0 : row - 1 - newest_;
    const bool watched = newest_ + 1 == next_watched_;
    looked_at = unseen == 0 || watched || looks_at_all() || scene_.until;  // any row may be the last
    step(looked_at);
    ++newest_;
    ++outcome_.steps_taken;
    note_length();
    last_iterations_ = simulation_.iterations();
    iterations_ += last_iterations_;
    outcome_.iterations_max = std::max(outcome_.iterations_max, last_iterations_);
    progress.at(newest_);
    if (!watched) continue;
    stopwatch.leave_out([&] { require_result([&] { watch(); }); });
    find_next_watched();
  }
}

void RowLoop::note_length() {
  const RowTimes& times = *simulation_.evolution().system().times();
  if (times.uniform()) return;
  const double h = times.step(newest_ - 1);
  outcome_.longest = std::max(outcome_.longest, h);
  outcome_.shortest = outcome_.shortest == 0 ? h : std::min(outcome_.shortest, h);
}

bool RowLoop::is_due(std::int64_t row) const { return scene_.is_recorded(row, newest_, time(newest_)); }

// A row that is recorded by its number is measured there. The last row of a run may be none of a run that goes further: it
// is watched all the same.
void RowLoop::find_next_watched() {
  next_watched_ = watched_.next(newest_);
  while (scene_.every > 0 && scene_.every != 1 && next_watched_ % scene_.every == 0)
    next_watched_ = watched_.next(next_watched_);
  if (scene_.every == 1) next_watched_ = -1;
}

// Steps that the field chooses end by time, and their number is a guess.
bool RowLoop::is_over() const { return scene_.is_over(newest_, time(newest_)); }

void RowLoop::put(std::int64_t row) {
  const std::int64_t before = recorded_;
  recorded_ = row;
  try {
    require_result([&] { record(row); });
  } catch (const Unrecorded&) {
    recorded_ = before;
    throw;
  }
}

template <class Look>
void RowLoop::require_result(const Look& look) const {
  try {
    look();
  } catch (const NumericalFailure& error) {
    throw Unrecorded{status_of(error), error.what()};
  }
}

void RowLoop::close() {
  outcome_.steps = std::max<std::int64_t>(0, recorded_);
  outcome_.time = time(outcome_.steps);
  if (outcome_.steps_taken > 0) outcome_.iterations_mean = iterations_ / static_cast<double>(outcome_.steps_taken);
  outcome_.maxima_over = watched_.in_words(outcome_.steps, scene_.every);
  finish();
}

}  // namespace delf

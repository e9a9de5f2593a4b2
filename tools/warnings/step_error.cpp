// SPDX-License-Identifier: MIT
#include "tools/warnings/step_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "tools/rows/engine.hpp"

namespace delf {
namespace {

/// The largest distance of two values of one component, over rows.
class Spread {
 public:
  explicit Spread(std::size_t components)
      : least_(components, std::numeric_limits<double>::infinity()), most_(components, -least_.front()) {}
  void add(std::span<const double> row) {
    for (std::size_t n = 0; n < row.size(); ++n) {
      double &least = least_[n % least_.size()], &most = most_[n % least_.size()];
      least = std::min(least, row[n]), most = std::max(most, row[n]);
    }
  }
  double value() const {
    double spread = 0;
    for (std::size_t a = 0; a < least_.size(); ++a) spread = std::max(spread, most_[a] - least_[a]);
    return spread;
  }

 private:
  std::vector<double> least_, most_;
};

/// The number of steps that the copies go: a two-hundredth of the run, or as many as take some 0.2 ms.
std::int64_t steps_of_copies(const Simulation& simulation, std::int64_t steps) {
  const Stepper& stepper = simulation.evolution().stepper();
  constexpr std::int64_t most_values = 4096, part = 200, most_nanoseconds = 200'000, steps_for_each = 3;
  const auto values = static_cast<std::int64_t>(simulation.evolution().system().lattice().sites()) *
                      static_cast<std::int64_t>(simulation.components().size());
  if (values > most_values) return 0;  // copies take memory
  // by rows a value takes some nanoseconds, by Newton's method forty times as long
  const bool by_rows = stepper.layout() || !stepper.iterates();
  const std::int64_t nanoseconds = by_rows ? 100 + 8 * values : 1500 + 300 * values;
  return std::min(steps, std::max(steps / part, most_nanoseconds / steps_for_each / nanoseconds));
}

}  // namespace

void TurnOfStep::see(std::span<const double> row) {
  if (last_.empty()) return last_.assign(row.begin(), row.end());
  const bool has_two = !change_.empty();
  change_.resize(row.size());
  for (std::size_t n = 0; n < row.size(); ++n) {
    const double change = row[n] - last_[n], second = change - change_[n];
    if (has_two) changes_ += change * change, second_ += second * second;
    change_[n] = change, last_[n] = row[n];
  }
}

double TurnOfStep::value() const { return std::sqrt(second_ / changes_); }

void TurnOfStep::visit(SavedState& state) {
  state("row of the turn", last_), state("change of the turn", change_);
  state("changes", changes_), state("second changes", second_);
}

std::optional<StepError> step_error(const Scene& scene, const InitialRows& initial, const Simulation& simulation,
                                    std::int64_t steps, std::span<const double> last_row) try {
  if (scene.from_file() || scene.problem.step_control || simulation.evolution().system().moves()) return {};
  const std::int64_t last = steps_of_copies(simulation, steps);
  constexpr std::int64_t fewest = 8;
  if (last < std::min(steps, fewest)) return {};
  constexpr int most_components = 8;  // to build the equations of many costs more than all else
  if (simulation.components().size() > most_components) return {};
  Simulation own = build(scene, initial.winding());
  Scene half = scene;
  half.problem.time_step /= 2, half.steps *= 2;
  const InitialRows of_half(half);
  Simulation fine = build(half, of_half.winding());
  initial.start(own), of_half.start(fine);

  const std::size_t d = at(own.count(Role::field));
  std::vector<double> row(last_row.size()), of_fine(row);
  Spread spread(d);
  spread.add(initial.row0()), spread.add(last_row);
  double largest = 0, early = 0;  // until the middle of the copies
  for (std::int64_t n = std::max<std::int64_t>(1, own.newest()); n <= last; ++n) {
    while (own.newest() < n) own.step();
    while (fine.newest() < 2 * n) fine.step();
    own.observe(static_cast<int>(own.newest() - n), row),
        fine.observe(static_cast<int>(fine.newest() - 2 * n), of_fine);
    spread.add(row);
    for (std::size_t i = 0; i < row.size(); ++i) largest = std::max(largest, std::abs(row[i] - of_fine[i]));
    if (2 * n <= last) early = largest;
  }
  if (!(spread.value() > 0)) return {};
  const double error = largest / spread.value();
  // An error of phase grows with t; one of a front that an end or the start sends out is there at once, and stays.
  constexpr double grows = 1.5;
  const bool to_end = last < steps && largest > grows * early;
  return StepError{error, static_cast<double>(last) * scene.problem.time_step,
                   to_end ? error * static_cast<double>(steps) / static_cast<double>(last) : error};
} catch (const Error&) {
  return {};
}

}  // namespace delf

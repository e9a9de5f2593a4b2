// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "schemes/stepping/rows/row_equations.hpp"
#include "schemes/stepping/rows/row_team.hpp"
#include "schemes/stepping/rows/stepped_rows.hpp"
#include "schemes/stepping/rows/time_tiles.hpp"

namespace delf {

/// Steps that are one loop through the rows, by one thread or more; in place where no one looks at them.
class ExplicitSteps {
 public:
  /// `threads`: none but this one, if the equations are not one loop.
  ExplicitSteps(SteppedRows& at, RowEquations& equations, int threads) : at_(at), equations_(equations) {
    if (threads > 1 && equations.is_one_loop())
      team_.emplace(threads), squares_of_parts_.resize(static_cast<std::size_t>(threads));
  }

  /// False if the row overflows.
  /// Rows that are written over are gone. But a step that is not in place leaves the row before it where it is, until
  /// two more of its kind have been taken: at every time two good rows are there, or follow from that one.
  bool step(bool looked_at) {
    const bool in_place = !looked_at && steps_in_place_left() > 0;
    equations_.begin(at_.n);
    if (in_place) at_.known = 0;
    bool fine = loop_in_parts(in_place);
    if (!fine) {
      if (at_.known < 2) fine = loop_again();
      at_.kept_row = -1;  // from here on nothing is written over
    } else if (!in_place) {
      at_.keep();
    }
    return fine;
  }

  /// How many steps that no one looks at, of so many to come, go at once: several where rows outgrow the cache.
  int levels(int count) const {
    if (!equations_.is_tiled()) return 1;
    return static_cast<int>(std::min<std::int64_t>({TimeTiles::most_levels, count, steps_in_place_left()}));
  }
  /// So many. If one of them fails, those before it are taken again, each beside the row before; NotFinite then.
  void step_at_once(int levels) {
    double squares[TimeTiles::most_levels];
    const std::span<double> of_levels(squares, static_cast<std::size_t>(levels));
    equations_.begin(at_.n);
    const bool fine = equations_.loop_levels(of_levels, at_.squares_ever, team_ ? &*team_ : nullptr) &&
                      !squares_overflowed(std::ranges::max(of_levels));
    at_.n += levels - 1;
    at_.known = 0;
    if (fine) {
      at_.squares_ever = std::max(at_.squares_ever, std::ranges::max(of_levels));
    } else {
      const bool is_found = loop_again();
      at_.kept_row = -1;
      if (!is_found) at_.report_not_finite();
    }
    at_.row_is_found(0);
    ++at_.n;
  }

  /// As many threads as there are rows enough for.
  int parts() const {
    constexpr int worth_a_thread = 1024;  // packs: below, waiting for each other costs more than it saves
    return team_ ? std::clamp(at_.rows.layout().packs() / worth_a_thread, 1, team_->size()) : 1;
  }

 private:
  static constexpr std::int64_t most_steps_in_place = 1024;  ///< as many may have to be taken again
  std::int64_t steps_in_place_left() const {
    return at_.kept_row >= 0 && at_.n > at_.kept_row ? at_.kept_row + most_steps_in_place - at_.n : 0;
  }
  bool loop_in_parts(bool in_place) {
    const int parts = this->parts();
    equations_.begin_loop(parts, in_place, at_.squares_ever);
    double squares = 0;
    if (parts == 1) {
      squares = equations_.loop(0, 1);
    } else {
      team_->run(parts,
                [&](int part) { squares_of_parts_[static_cast<std::size_t>(part)] = equations_.loop(part, parts); });
      for (int part = 0; part < parts; ++part) squares += squares_of_parts_[static_cast<std::size_t>(part)];
    }
    equations_.close_loop();
    at_.squares_ever = std::max(at_.squares_ever, squares);
    return !squares_overflowed(squares);
  }

  /// The steps from the kept row on once more, each beside the row before.
  bool loop_again() {
    const std::int64_t last = at_.n;
    at_.go_back();
    equations_.forget_rows();
    for (;; ++at_.n) {
      equations_.begin(at_.n);
      const bool fine = loop_in_parts(false);
      if (at_.n == last || !fine) return fine;
      at_.row_is_found(0);
    }
  }

  SteppedRows& at_;
  RowEquations& equations_;
  std::optional<RowTeam> team_;
  std::vector<double> squares_of_parts_;
};

}  // namespace delf

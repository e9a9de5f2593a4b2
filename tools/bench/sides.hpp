// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <utility>
#include <vector>

#include "schemes/stepping/flush_denormals.hpp"
#include "tools/bench/collision.hpp"
#include "tools/bench/pairing.hpp"

namespace delf::bench {

/// Anything that starts from two rows and steps.
template <class Stepped>
Side side_of(std::shared_ptr<Stepped> stepped, std::vector<std::vector<double>> two_rows) {
  return {[stepped, rows = std::move(two_rows)] {
            if constexpr (requires { stepped->start(rows); }) stepped->start(rows);
            else stepped->start(rows[0], rows[1]);
          },
          [stepped](long steps) {
            if constexpr (requires { stepped->step(false); }) {
              const FlushDenormals for_all_steps;  // as in `delf run`
              stepped->steps(static_cast<int>(steps));  // rows that no one reads
            } else {
              for (long n = 0; n < steps; ++n) stepped->step();
            }
          }};
}

template <class Stepped>
Side side_of(std::shared_ptr<Stepped> stepped, const Collision& collision) {
  return side_of(std::move(stepped), collision.rows());
}

inline Side textbook_side(const Collision& collision) {
  return side_of(std::shared_ptr<Textbook>(collision.textbook()), collision);
}

inline std::shared_ptr<Simulation> engine(const Collision& collision) {
  return std::make_shared<Simulation>(collision.problem());
}
inline Side engine_side(const Collision& collision) { return side_of(engine(collision), collision); }

}  // namespace delf::bench

// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "tools/fields_reader.hpp"
#include "tools/scene.hpp"

namespace delf {

/// The rows that a run starts from: those of a known state, or those of a file. Throws BadScene.
class InitialRows {
 public:
  explicit InitialRows(const Scene&);

  int winding() const;
  StartRule rule() const;
  std::string description() const;
  /// Row 0, for when there is nothing else to show.
  std::vector<double> row0() const;
  void start(Simulation&) const;
  /// The solution to compare with, or null.
  const State* exact() const { return state_ && state_->exact() ? state_.get() : nullptr; }

 private:
  std::vector<double> values(int row) const;

  const Scene& scene_;
  std::unique_ptr<State> state_;  ///< one of these two
  std::optional<FieldsReader> file_;
};

}  // namespace delf

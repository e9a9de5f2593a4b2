// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "schemes/simulation.hpp"
#include "tools/rows/recorded_section.hpp"

namespace delf {

/// The fields at the vertices alone, [i·d + a], of a row of all components.
std::vector<double> fields_of(const LatticeSystem&, const std::vector<double>& row);

/// Rows of a section one after the other from row 0 on, each with all its components at that very row: [i·C + c].
class SectionSource {
 public:
  virtual ~SectionSource() = default;
  /// The next row; nothing after the last.
  virtual std::optional<std::vector<double>> next() = 0;
};

/// The rows that a simulation makes, `rows` of them: it is stepped when one is asked for. What is found with a later
/// row (multipliers, nodes inside cells) is waited for.
class ComputedRows final : public SectionSource {
 public:
  /// The simulation has been started.
  ComputedRows(Simulation&, std::int64_t rows);
  std::optional<std::vector<double>> next() override;

 private:
  Simulation& simulation_;
  std::int64_t rows_, next_ = 0, behind_ = 0;
};

/// The rows of a file that have all their components.
class RowsOfFile final : public SectionSource {
 public:
  RowsOfFile(const RecordedSection& section, std::int64_t rows) : section_(section), rows_(rows) {}
  std::optional<std::vector<double>> next() override {
    if (next_ == rows_) return std::nullopt;
    return section_.row(next_++);
  }

 private:
  const RecordedSection& section_;
  std::int64_t rows_, next_ = 0;
};

}  // namespace delf

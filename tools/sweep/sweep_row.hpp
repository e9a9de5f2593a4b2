// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/scene/scene.hpp"

namespace delf {

/// The summary of a run: a row of a sweep.
struct SweepRow {
  std::string fingerprint;
  std::string status;              ///< of its summary.json; or bad-input, crashed
  std::string failure;             ///< in words
  std::string folder;              ///< inside that of the sweep; empty if only the row is kept
  nlohmann::ordered_json summary;  ///< null if there is none

  /// A number of summary.json, a measure, or error_estimate; not a number if there is none.
  double number(const std::string& name) const;
  /// The names of all numbers, measures first.
  std::vector<std::string> numbers() const;
};

/// 64 bits, in hex, of all that a run's results depend on: the settings in force, and the version.
std::string fingerprint_of(const Scene&);

/// The rows of finished runs, one line of JSON each, in the file sweep.rows: written as runs finish, so that a sweep that
/// is killed loses only runs in flight. Lines that were cut short are not read.
class SweepJournal {
 public:
  SweepJournal(const std::filesystem::path& file, bool keep_earlier);
  const SweepRow* find(const std::string& fingerprint) const;
  void append(const SweepRow&);

 private:
  std::filesystem::path file_;
  std::map<std::string, SweepRow> rows_;
};

}  // namespace delf

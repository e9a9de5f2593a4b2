// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>

namespace delf {

/// The results of an earlier run, moved out of the way of the next one: results/NAME becomes results/NAME~1, or ~2, the
/// first that is free.
class KeptResults {
 public:
  /// Moves nothing where there is no run, nor where the same run goes again: its scene.ini is `resolved`. Throws
  /// SystemFailure if a run is under way there.
  KeptResults(const std::filesystem::path& folder, const std::string& resolved);
  /// Says where it is, or moves it back if the next run has begun no files.
  ~KeptResults();
  KeptResults(const KeptResults&) = delete;
  KeptResults& operator=(const KeptResults&) = delete;

 private:
  std::filesystem::path folder_, kept_;
};

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <functional>
#include <vector>

#include "tools/files/logged_process.hpp"
#include "tools/sweep/sweep_request.hpp"
#include "tools/sweep/sweep_row.hpp"

namespace delf {

/// Runs of a sweep, side by side: each in a process of its own, so that none can harm another.
class RunPool {
 public:
  /// Results go to `folder`.
  RunPool(const SweepRequest&, const std::filesystem::path& folder);

  /// The rows of these runs, in their order. Runs that the journal knows are not repeated, and of equal ones one is
  /// run. After Ctrl-C, and once number_is_unknown(), those that have not finished have no status, and nothing of them
  /// is left.
  std::vector<SweepRow> rows_of(const std::vector<SweptRun>&);

  std::size_t reused() const { return reused_; }
  /// sweep.number is none of the numbers of the first run that had any.
  bool number_is_unknown() const;
  const std::vector<std::string>& known_numbers() const { return known_numbers_; }

 private:
  struct Process {
    LoggedProcess process;
    std::size_t run;
    std::filesystem::path folder;
  };
  Process start(const SweptRun&, std::size_t run);
  SweepRow finished(const Process&, const SweptRun&, const std::string& fingerprint);
  void look_for_number(const SweepRow&);
  const SweepRow* known(const std::string& fingerprint) const;
  std::filesystem::path folder_of(const SweptRun&, std::size_t run) const;

  const SweepRequest& request_;
  std::filesystem::path folder_;
  SweepJournal journal_;
  std::size_t reused_ = 0;
  std::vector<std::string> known_numbers_;
};

}  // namespace delf

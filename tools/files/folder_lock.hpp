// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

namespace delf {

/// Holds a folder of results for one run, or one sweep: a lock on the folder itself, which ends with the process, however that ends.
class FolderLock {
 public:
  /// Throws SystemFailure if another command holds it. Where the file system knows no locks, nothing is held.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace delf

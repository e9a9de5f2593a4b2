// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

namespace delf {

/// Marks a file of HDF5 as closed that its writer had to give up, as one with a single writer and multiple readers: its
/// last flush is whole, and any reader opens it then. The superblock says until then that somebody writes, and how long the
/// file was to become; all else in the file stays. A file with another superblock, or with a damaged one, is left alone.
void mark_closed(const std::filesystem::path&) noexcept;

}  // namespace delf

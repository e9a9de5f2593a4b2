// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <functional>

namespace delf {

/// HDF5 1.10 crashes, or never ends, on some damaged files. Does `read` once in a child process, and throws BadInput, key
/// initial.file, if that is its end; what it throws there is for the reader itself to meet. Only where metadata have no
/// checksums (before HDF5 1.10, and by default still): in other files, such as delf's, HDF5 refuses what is damaged.
void read_apart(const std::filesystem::path&, const std::function<void()>& read);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace delf::fuzz {

/// A file for readers that take a path. In memory where there is such a folder: it is written for each input.
inline std::filesystem::path written(std::string_view ending, std::string_view bytes) {
  static const std::filesystem::path folder =
      std::filesystem::exists("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path();
  static struct Files {  // of this process, gone when it ends
    std::string stem = (folder / ("delf-fuzz-" + std::to_string(getpid()))).string();
    ~Files() {
      std::error_code none;
      for (const char* e : {".ini", ".csv", ".npy", ".npz", ".h5", ".h5.part"}) std::filesystem::remove(stem + e, none);
    }
  } files;
  const std::string path = files.stem + std::string(ending);
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return path;
}

}  // namespace delf::fuzz

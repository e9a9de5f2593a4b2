// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>

namespace delf {

/// A scratch folder inside a folder of results, removed with its contents by the destructor.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::filesystem::path& parent);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

/// Runs gnuplot in `folder` on a script that is there. Returns an empty string if it went well, or else one line that
/// says what is missing or what gnuplot complained of.
std::string run_gnuplot(const std::filesystem::path& folder, const std::string& script);

/// The line where there is no gnuplot.
inline constexpr auto gnuplot_is_missing =
    "gnuplot is missing: install the package gnuplot-nox (or gnuplot) to have figures";

/// Text as a gnuplot string.
std::string gnuplot_quoted(const std::string& text);

}  // namespace delf

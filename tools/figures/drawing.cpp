// SPDX-License-Identifier: MIT
#include "tools/figures/drawing.hpp"

#include <fmt/format.h>

#include "tools/figures/figure_style.hpp"
#include "tools/figures/gnuplot.hpp"
#include "tools/files/text_file.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

std::string drawn(const std::vector<Drawing>& drawings, const FigureForm& form, const fs::path& folder) {
  const ScratchFolder scratch(folder);
  std::string script;
  std::vector<std::string> names;
  for (const Drawing& drawing : drawings)
    if (const std::string body = drawing.body(scratch.path()); !body.empty())
      script += figure_script(drawing.name, body, form), names.push_back(drawing.name);
  if (script.empty()) return {};
  write_text_file(scratch.path() / "script", script);
  if (const std::string wrong = run_gnuplot(scratch.path(), "script"); !wrong.empty()) return wrong;
  fs::create_directories(folder / "figures");
  std::string missing;
  for (const std::string& name : names)
    for (const std::string& format : form.formats)
      if (const std::string file = fmt::format("{}.{}", name, format); fs::exists(scratch.path() / file))
        fs::rename(scratch.path() / file, folder / "figures" / file);
      else missing = missing.empty() ? "gnuplot ended well, and left no " + file : missing;
  return missing;
}

}  // namespace

std::string draw(const std::vector<Drawing>& drawings, const FigureForm& form, const fs::path& folder) {
  try {
    return drawn(drawings, form, folder);
  } catch (const std::exception& error) {
    return error.what();
  }
}

void remove_figures(const std::vector<std::string>& names, const fs::path& folder) {
  std::error_code none;
  for (const std::string& name : names)
    for (const std::string& format : figure_formats)
      fs::remove(folder / "figures" / fmt::format("{}.{}", name, format), none);
}

}  // namespace delf

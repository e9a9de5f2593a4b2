// SPDX-License-Identifier: MIT
#include "tools/figures/drawing.hpp"

#include "tools/figures/figure_style.hpp"
#include "tools/figures/gnuplot.hpp"
#include "tools/scene/text_file.hpp"

namespace delf {

namespace fs = std::filesystem;

std::string draw(const std::vector<Drawing>& drawings, const fs::path& folder) {
  const ScratchFolder scratch(folder);
  std::string script;
  for (const Drawing& drawing : drawings)
    if (const std::string body = drawing.body(scratch.path()); !body.empty())
      script += figure_script(drawing.name, body);
  if (script.empty()) return {};
  write_text_file(scratch.path() / "script", script);
  if (const std::string wrong = run_gnuplot(scratch.path(), "script"); !wrong.empty()) return wrong;
  fs::create_directories(folder / "figures");
  for (const Drawing& drawing : drawings)
    for (const char* ending : {".png", ".svg"})
      if (const std::string file = drawing.name + ending; fs::exists(scratch.path() / file))
        fs::rename(scratch.path() / file, folder / "figures" / file);
  return {};
}

}  // namespace delf

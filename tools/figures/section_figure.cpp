// SPDX-License-Identifier: MIT
#include "tools/figures/section_figure.hpp"

#include <fmt/format.h>

#include "tools/figures/figure_style.hpp"
#include "tools/files/text_file.hpp"

namespace delf {

std::string section_figure(const FigureSource& source, const std::filesystem::path& scratch) {
  const auto& [table, title, columns] = source.section;
  if (table.empty() || columns[0] == 0) return {};
  write_text_file(scratch / "section", table);
  return figure_title(fmt::format("{}: where {}", source.scene, title),
                      fmt::format("{}, {}", source.theory, source.scheme)) +
         fmt::format(
             "set bmargin at screen 0.12\nset tmargin at screen top\nset grid lc rgb '#e4e4e4' lt 1 lw 0.7\n"
             "set datafile separator ','\nset xlabel 'q{0}'\nset ylabel 'p{0}'\n"
             "plot 'section' skip 1 using {1}:{2} with points pt 7 ps 0.3 lc rgb '{3}'\n",
             columns[0] - 1, columns[0], columns[1], line_colour);
}

}  // namespace delf

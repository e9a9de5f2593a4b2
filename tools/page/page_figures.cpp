// SPDX-License-Identifier: MIT
#include "tools/page/page_figures.hpp"

#include <fmt/format.h>

#include <string_view>

namespace delf {

std::string data_url(const std::string& type, const std::string& bytes) {
  std::string url = fmt::format("data:image/{}", type);
  if (type == "svg+xml") {
    url += ",";
    for (const char c : bytes)  // that are not themselves in a URL in an attribute; a URL has no line breaks
      if (std::string_view("%#\"<>&").find(c) != std::string_view::npos)
        url += fmt::format("%{:02X}", static_cast<unsigned char>(c));
      else url += c == '\n' || c == '\t' || c == '\r' ? ' ' : c;
    return url;
  }
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  url += ";base64,";
  for (std::size_t n = 0; n < bytes.size(); n += 3) {
    unsigned group = 0;
    for (std::size_t b = 0; b < 3; ++b)
      group = group << 8 | (n + b < bytes.size() ? static_cast<unsigned char>(bytes[n + b]) : 0);
    for (std::size_t d = 0; d < 4; ++d) url += n + d > bytes.size() ? '=' : digits[group >> (18 - 6 * d) & 63];
  }
  return url;
}

std::vector<std::vector<PageFigure>> page_figures(const std::vector<ResultFolder>& folders, std::size_t most_bytes) {
  std::vector<std::vector<PageFigure>> figures;
  std::size_t bytes = 0;
  const auto read = [](const ResultFolder& folder, const std::string& file, const char* type) {
    return folder.has_file(file) ? data_url(type, file_text(folder.path / file)) : std::string();
  };
  for (const ResultFolder& folder : folders) {
    figures.emplace_back();
    for (const std::string& name : folder.figures) {
      PageFigure figure{name, "", ""};
      for (const auto& [ending, type] : {std::pair("svg", "svg+xml"), std::pair("png", "png"), std::pair("pdf", "")})
        if (const std::string file = fmt::format("figures/{}.{}", name, ending);
            figure.file.empty() && folder.has_file(file)) {
          figure.file = file;
          if (*type) figure.source = read(folder, file, type);
        }
      for (const char* film : {"film.mp4", "film.gif"})
        if (figure.name == "film" && folder.has_file(film)) figure.film = film;
      bytes += figure.source.size();
      figures.back().push_back(std::move(figure));
    }
  }
  // PNG in place of the largest SVG that are larger, then none in place of the largest figures.
  const auto shrink = [&](const auto& smaller_of) {
    while (bytes > most_bytes) {
      PageFigure* largest = nullptr;
      std::string instead;
      for (std::size_t f = 0; f < folders.size(); ++f)
        for (PageFigure& figure : figures[f]) {
          if (figure.source.size() <= (largest ? largest->source.size() : 0)) continue;
          std::string smaller = smaller_of(folders[f], figure);
          if (smaller.size() < figure.source.size()) largest = &figure, instead = std::move(smaller);
        }
      if (!largest) return;
      bytes -= largest->source.size() - instead.size();
      if (!instead.empty()) largest->file.replace(largest->file.size() - 3, 3, "png");
      largest->source = std::move(instead);
    }
  };
  shrink([&](const ResultFolder& folder, const PageFigure& figure) {
    const std::string png =
        figure.file.ends_with(".svg") ? read(folder, fmt::format("figures/{}.png", figure.name), "png") : "";
    return png.empty() ? figure.source : png;
  });
  shrink([](const ResultFolder&, const PageFigure&) { return std::string(); });
  return figures;
}

}  // namespace delf

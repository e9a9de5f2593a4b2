// SPDX-License-Identifier: MIT
#include "tools/page/markup.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "tools/page/style.hpp"
#include "tools/results/result_folder.hpp"

namespace delf {
namespace {

/// Bytes of the code point of UTF-8 that begins here; 0: there is none that HTML may have.
std::size_t code_point(std::string_view text) {
  const auto byte = [&](std::size_t n) { return static_cast<unsigned char>(n < text.size() ? text[n] : 0); };
  const unsigned char first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : first == '\n' || first == '\t' ? 1 : 0;
  const std::size_t length = first >= 0xF0 && first < 0xF5   ? 4
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xC2 && first < 0xE0 ? 2
                                                             : 0;
  for (std::size_t n = 1; n < length; ++n)
    if ((byte(n) & 0xC0) != 0x80) return 0;
  // overlong forms, surrogates, and what is beyond Unicode
  if ((first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) >= 0xA0) || (first == 0xF0 && byte(1) < 0x90) ||
      (first == 0xF4 && byte(1) >= 0x90))
    return 0;
  return length;
}

bool is_number(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == '\0';
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string html;
  while (!text.empty()) {
    const std::size_t length = code_point(text);
    const std::string_view one = text.substr(0, length);
    if (length == 0) html += "\uFFFD";
    else if (one == "&") html += "&amp;";
    else if (one == "<") html += "&lt;";
    else if (one == ">") html += "&gt;";
    else if (one == "\"") html += "&quot;";
    else html += one;
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return html;
}

std::string table(const PageTable& t) {
  if (t.rows.empty()) return {};
  std::string head, body;
  for (const std::string& heading : t.headings) head += fmt::format("<th scope=\"col\">{}</th>", escaped(heading));
  if (!head.empty()) head = fmt::format("<thead><tr>{}</tr></thead>\n", head);
  for (const auto& row : t.rows) {
    body += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c) {
      const bool right = !head.empty() && is_number(row[c]);
      body += c == 0 ? fmt::format("<th scope=\"row\">{}</th>", escaped(row[c]))
                     : fmt::format("<td{}>{}</td>", right ? " class=\"number\"" : "", escaped(row[c]));
    }
    body += "</tr>\n";
  }
  return fmt::format(
      "<div class=\"wide\" tabindex=\"0\" role=\"group\" aria-label=\"{0}\"><table><caption>{0}</caption>\n"
      "{1}<tbody>{2}</tbody></table></div>\n",
      escaped(t.caption), head, body);
}

std::string table_of(const std::string& caption, const std::vector<std::pair<std::string, std::string>>& columns,
                     const std::vector<Json>& list) {
  PageTable t{caption, {}, {}};
  for (const auto& [heading, key] : columns) t.headings.push_back(heading);
  for (const Json& one : list) {
    t.rows.emplace_back();
    for (const auto& [heading, key] : columns) t.rows.back().push_back(value_text(&one, key));
  }
  return table(t);
}

std::string paragraph(std::string_view text) { return text.empty() ? "" : fmt::format("<p>{}</p>\n", escaped(text)); }

std::string list(const std::vector<std::string>& items) {
  if (items.empty()) return {};
  std::string html = "<ul>\n";
  for (const std::string& item : items) html += fmt::format("<li>{}</li>\n", escaped(item));
  return html + "</ul>\n";
}

std::string code_block(std::string_view label, std::string_view text) {
  return fmt::format("<pre tabindex=\"0\" role=\"group\" aria-label=\"{}\"><code>{}</code></pre>\n", escaped(label),
                     escaped(text));
}

std::string details(std::string_view summary, const std::string& html) {
  return html.empty() ? "" : fmt::format("<details><summary>{}</summary>\n{}</details>\n", escaped(summary), html);
}

std::string section(std::string_view id, std::string_view heading, const std::string& html) {
  return fmt::format(
      "<section id=\"{0}\" aria-labelledby=\"{0}-heading\">\n<h2 id=\"{0}-heading\">{1}</h2>\n{2}</section>\n",
      escaped(id), escaped(heading), html);
}

std::string document(std::string_view title, const std::string& html) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src "
      "'unsafe-inline'\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<meta name=\"color-scheme\" content=\"light dark\"/>\n<title>{}</title>\n<style>{}</style>\n</head>\n"
      "<body>\n{}</body>\n</html>\n",
      escaped(title), page_style, html);
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/cite/references.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "tools/cite/citation.hpp"

namespace delf {
namespace {

constexpr const char* bibliography =
#include "references.inc"  // made of references.bib
    ;

/// The place after the brace that closes the one before `at`.
std::size_t after_group(std::string_view text, std::size_t at) {
  for (int depth = 1; at < text.size() && depth > 0; ++at) depth += text[at] == '{' ? 1 : text[at] == '}' ? -1 : 0;
  return at;
}

/// Reads an entry: @type{key, name = {value}, …}.
CitedWork read_entry(std::string_view entry) {
  const std::size_t brace = entry.find('{'), comma = entry.find(',');
  CitedWork reference{.key = std::string(entry.substr(brace + 1, comma - brace - 1)),
                      .type = std::string(entry.substr(1, brace - 1)),
                      .bibtex = std::string(entry) + "\n",
                      .fields = {}};
  for (std::size_t at = comma + 1;;) {
    const std::size_t equals = entry.find(" = {", at);
    if (equals == entry.npos) return reference;
    std::size_t name = equals;
    while (name > at && std::isalpha(static_cast<unsigned char>(entry[name - 1]))) --name;
    const std::size_t value = equals + 4;
    at = after_group(entry, value);
    reference.fields.emplace(entry.substr(name, equals - name), entry.substr(value, at - 1 - value));
  }
}

/// The value of a line of CITATION.cff that begins with `key`, without quotes.
std::string cited(std::string_view key) {
  const std::string_view text = citation;
  const std::size_t line = text.find(fmt::format("\n{}: ", key));
  if (line == text.npos) return {};
  const std::size_t begin = line + key.size() + 3;
  std::string value(text.substr(begin, text.find('\n', begin) - begin));
  std::erase(value, '"');
  return value;
}

CitedWork delf_itself() {
  return read_entry(
      fmt::format("@misc{{delf,\n  author = {{{{{}}}}},\n  title = {{{}}},\n  note = {{version {}}},\n"
                  "  checked = {{CITATION.cff}}\n}}",
                  cited("  - name"), cited("title"), DELF_VERSION));
}

/// TeX's markup of a field as text: {PDE}s, --, ``, $\varphi^4$.
std::string without_tex(std::string text) {
  static const std::pair<std::string, std::string> marks[] = {
      {"--", "–"},  {"``", "“"}, {"''", "”"}, {"\\varphi", "φ"}, {"\\lambda", "λ"},   {"\\log", "log "},
      {"\\,", " "}, {"^4", "⁴"}, {"^2", "²"}, {"_2", "₂"},       {"^{5/2}", "^(5/2)"}};
  for (const auto& [mark, sign] : marks)
    for (std::size_t at = 0; (at = text.find(mark, at)) != text.npos; at += sign.size())
      text.replace(at, mark.size(), sign);
  std::erase_if(text, [](char c) { return c == '{' || c == '}' || c == '$'; });
  return text;
}

/// "Butcher, John C." as "J. C. Butcher"; a name without a comma as it is.
std::string short_name(const std::string& name) {
  const std::size_t comma = name.find(", ");
  if (comma == name.npos) return without_tex(name);
  std::string initials;
  for (std::size_t at = comma + 2; at < name.size();) {
    const std::size_t end = std::min(name.find(' ', at), name.size());
    std::size_t letter = 1;  // bytes of the first letter
    while (at + letter < end && (name[at + letter] & 0xC0) == 0x80) ++letter;
    initials += name.substr(at, letter) + ". ";
    for (std::size_t dash = name.find('-', at); dash < end; dash = name.find('-', dash + 1))
      initials.back() = '-', initials += name.substr(dash + 1, 1) + ". ";
    at = end + 1;
  }
  return initials + name.substr(0, comma);
}

std::string authors_of(const CitedWork& reference) {
  std::vector<std::string> names;
  const std::string all = reference.field("author");
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t end = std::min(all.find(" and ", at), all.size());
    names.push_back(all.substr(at, end - at) == "others" ? "others" : short_name(all.substr(at, end - at)));
    at = end + 5;
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::string CitedWork::field(const std::string& name) const {
  const auto found = fields.find(name);
  return found == fields.end() ? "" : found->second;
}

bool CitedWork::is_checked() const {
  const std::string checked = field("checked");
  return !checked.empty() && checked != "not checked";
}

const std::vector<CitedWork>& references() {
  static const std::vector<CitedWork> all = [] {
    std::vector<CitedWork> list{delf_itself()};
    const std::string_view text = bibliography;
    for (std::size_t at = 0; (at = text.find("\n@", at)) != text.npos;) {
      const std::size_t end = after_group(text, text.find('{', at) + 1);
      list.push_back(read_entry(text.substr(at + 1, end - at - 1)));
      at = end;
    }
    return list;
  }();
  return all;
}

const CitedWork* find_reference(const std::string& key) {
  const auto found = std::ranges::find(references(), key, &CitedWork::key);
  return found == references().end() ? nullptr : &*found;
}

std::string in_words(const CitedWork& reference) {
  std::string text = authors_of(reference) + ", " + without_tex(reference.field("title"));
  const auto add = [&](const std::string& part, const char* before = ", ", const char* behind = "") {
    if (!part.empty()) text += before + without_tex(part) + behind;
  };
  add(reference.field("edition"), ", ", " edition");
  add(reference.field("journal") + reference.field("booktitle") + reference.field("institution"));
  add(reference.field("series"));
  add(reference.field("publisher"));
  add(reference.field("volume"), " ");
  if (reference.type == "techreport") add(reference.field("number"), " ");
  add(reference.field("note"));
  add(reference.field("howpublished"));
  add(reference.field("year"), " (", ")");
  add(reference.field("pages"), " ");
  add(reference.field("doi"), ", doi:");
  return text;
}

}  // namespace delf

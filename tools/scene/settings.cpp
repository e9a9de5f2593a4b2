// SPDX-License-Identifier: MIT
#include "tools/scene/settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/program_options.hpp>
#include <optional>
#include <sstream>

#include "lattice/text_parts.hpp"
#include "tools/scene/declared_keys.hpp"
#include "tools/scene/made_settings.hpp"
#include "tools/scene/keys.hpp"
#include "tools/scene/repeated_keys.hpp"
#include "tools/scene/scene_text.hpp"

namespace delf {

namespace {

// The second pass: on which line each value stands. Boost.Program_options reads values, but does not tell their lines.
std::vector<int> lines_of_values(const std::string& text, const std::string& file) {
  std::vector<int> lines;
  std::istringstream in(text);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::string content = trimmed(line.substr(0, line.find('#')));
    if (content.empty() || (content.front() == '[' && content.back() == ']')) continue;
    if (content.find('=') == std::string::npos)
      throw BadScene(fmt::format("{}:{}: \"{}\" is neither a [section] nor key = value; correct it, or begin it with #",
                                 file, number, content.substr(0, 60)));
    lines.push_back(number);
  }
  return lines;
}

boost::program_options::parsed_options parsed(const std::string& text) {
  namespace po = boost::program_options;
  po::options_description known;
  for (const Parameter& key : keys()) known.add_options()(key.key.c_str(), po::value<std::string>());
  std::istringstream in(text);
  return po::parse_config_file(in, known, true);  // unknown keys are kept, to be reported with their line
}

std::string unknown_key(const std::string& key, std::span<const Parameter> known) {
  if (constexpr std::string_view of_field = "exact."; key.starts_with(of_field)) {
    std::vector<std::string> names;
    for (const Parameter& k : known)
      if (std::string_view(k.key).starts_with(of_field)) names.emplace_back(k.key);
    if (!names.empty()) return fmt::format("unknown key; the fields of the theory have {}", fmt::join(names, ", "));
  }
  const std::string meant = nearest_key(key, known);
  return meant.empty() ? "unknown key; `delf help run` lists all keys"
                       : fmt::format("unknown key; did you mean {}?", meant);
}

BadScene unknown_on_command_line(const std::string& key, std::span<const Parameter> known) {
  return BadScene(fmt::format("command line: --{}: {}", key, unknown_key(key, known)));
}

// Lines of a key that may be repeated become one value, in the place of the first.
void join_repeated(std::vector<Setting>& settings) {
  for (auto s = settings.begin(); s != settings.end(); ++s) {
    if (!may_repeat(s->key)) continue;
    for (auto again = s + 1; again != settings.end();)
      if (again->key == s->key) s->value += " | " + again->value, again = settings.erase(again);
      else ++again;
  }
}

const Setting* given_twice(const std::vector<Setting>& settings, const Setting*& first) {
  for (auto s = settings.begin(); s != settings.end(); ++s)
    for (auto earlier = settings.begin(); earlier != s; ++earlier)
      if (earlier->key == s->key) {
        first = &*earlier;
        return &*s;
      }
  return nullptr;
}

}  // namespace

Settings::Settings(std::filesystem::path file, std::vector<Setting> in_file, std::vector<Setting> on_command_line)
    : file_(std::move(file)), all_(std::move(on_command_line)) {
  all_.insert(all_.end(), in_file.begin(), in_file.end());  // the first one found wins
}

const Setting* Settings::find(std::string_view key) const {
  const auto found = std::find_if(all_.begin(), all_.end(), [&](const Setting& s) { return s.key == key; });
  return found == all_.end() ? nullptr : &*found;
}

void Settings::keep_one_of(std::string_view key, std::string_view other, std::string_view remedy) {
  const Setting *a = find(key), *b = find(other);
  if (!a && !b) throw BadScene(fmt::format("{}: neither {} nor {} is given; {}", file_.string(), key, other, remedy));
  if (!a || !b) return;
  if ((a->line == 0) == (b->line == 0)) {
    const std::string_view later = a->line > b->line ? key : other, earlier = a->line > b->line ? other : key;
    throw error(later, fmt::format("{} is given too; keep one of them", earlier));
  }
  const std::string forgotten(a->line == 0 ? other : key);
  std::erase_if(all_, [&](const Setting& s) { return s.key == forgotten; });
}

void Settings::imply(std::string_view key, std::string_view value, std::string_view by) {
  const Setting* const reason = find(by);
  if (!find(key)) all_.push_back({std::string(key), std::string(value), reason ? reason->line : 0});
}

const Parameter* Settings::key(std::string_view name) const {
  const auto own =
      std::ranges::find(declared_, name, [](const DeclaredKey& d) -> const std::string& { return d.parameter.key; });
  return own == declared_.end() ? find_key(name) : &own->parameter;
}

std::vector<Parameter> Settings::all_keys() const {
  std::vector<Parameter> all(keys().begin(), keys().end());
  for (const DeclaredKey& own : declared_) insert_key(all, own.parameter);
  return all;
}

std::string Settings::place(std::string_view key) const {
  const Setting* s = find(key);
  if (!s) return file_.string();
  return s->line == 0 ? std::string("command line") : fmt::format("{}:{}", file_.string(), s->line);
}

BadScene Settings::error(std::string_view key, std::string_view wrong) const {
  const Setting* s = find(key);
  if (!s) return BadScene(fmt::format("{}: {}: {}", place(key), key, wrong));
  return BadScene(fmt::format("{}: {}{} = {}: {}", place(key), s->line == 0 ? "--" : "", key, s->value, wrong));
}

BadScene Settings::located(const BadInput& bad) const {
  if (const auto* scene = dynamic_cast<const BadScene*>(&bad)) return *scene;
  const std::string message = bad.what();
  if (bad.key().empty()) return BadScene(fmt::format("{}: {}", file_.string(), message));
  // "lattice.sites = 1: at least 2 …" repeats key and value: keep what comes after them
  if (message.starts_with(bad.key() + " = "))
    if (const auto colon = message.find(": "); colon != std::string::npos && find(bad.key()))
      return error(bad.key(), message.substr(colon + 2));
  if (message.starts_with(bad.key())) return BadScene(fmt::format("{}: {}", place(bad.key()), message));
  return error(bad.key(), message);
}

Settings read_settings(const std::filesystem::path& file, const std::vector<Setting>& on_command_line) {
  check_command_line(on_command_line);
  const std::string text = read_scene_text(file);
  const std::vector<int> lines = lines_of_values(text, file.string());
  std::vector<Setting> in_file;
  for (const auto& option : parsed(text).options) {
    if (in_file.size() == lines.size()) break;
    in_file.push_back({option.string_key, option.value.front(), lines[in_file.size()]});
  }
  if (in_file.empty())
    throw BadScene(fmt::format("{}: the scene is empty; `delf list scenes` names some to copy", file.string()));
  join_repeated(in_file);
  const Setting* first = nullptr;
  if (const Setting* again = given_twice(in_file, first))
    throw BadScene(fmt::format("{}:{}: {} = {}: line {} gives it already; keep one of them", file.string(), again->line,
                               again->key, again->value, first->line));
  return made_settings(file, in_file, on_command_line);
}

Settings made_settings(const std::filesystem::path& file, const std::vector<Setting>& in_file,
                       const std::vector<Setting>& on_command_line) {
  check_command_line(on_command_line);
  Settings settings(file, in_file, on_command_line);
  declare_keys(settings);
  const std::vector<Parameter> known = settings.all_keys();
  for (const Setting& s : in_file)
    if (!settings.key(s.key))
      throw BadScene(fmt::format("{}:{}: {}: {}", file.string(), s.line, s.key, unknown_key(s.key, known)));
  for (const Setting& s : on_command_line)
    if (!settings.key(s.key)) throw unknown_on_command_line(s.key, known);
  return settings;
}

void check_command_line(const std::vector<Setting>& on_command_line) {
  for (const Setting& s : on_command_line) {
    if (!find_key(s.key) && !may_be_declared(s.key)) throw unknown_on_command_line(s.key, keys());
    if (s.value.find_first_of("#\n\r") != std::string::npos)
      throw BadScene(
          fmt::format("command line: --{}: a value holds neither # nor line breaks, for no scene could "
                      "repeat it; rename",
                      s.key));
  }
  const Setting* first = nullptr;
  if (const Setting* again = given_twice(on_command_line, first))
    throw BadScene(fmt::format("command line: --{} = {}: given twice; keep one of them", again->key, again->value));
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/reproduce/reproduction.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

#include "jets/expressions/expression.hpp"
#include "lattice/error.hpp"
#include "lattice/text_parts.hpp"
#include "tools/files/logged_process.hpp"
#include "tools/reproduce/discrete_equation.hpp"
#include "tools/reproduce/result_number.hpp"
#include "tools/scene/shipped_scenes.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity(), unknown = std::numeric_limits<double>::quiet_NaN();
constexpr auto of_equation = "equation";  ///< the number that is a difference of coefficients
constexpr double rounding = 1e-12;        ///< of coefficients

// Words between blanks; '…' keeps blanks, as in a shell.
std::vector<std::string> shell_words(const std::string& line) {
  std::vector<std::string> words;
  bool quoted = false, begun = false;
  for (const char c : line) {
    const bool blank = !quoted && (c == ' ' || c == '\n');
    if (c == '\'') quoted = !quoted;
    if (blank) begun = false;
    if (blank || (c == '\'' && begun)) continue;
    if (!begun) words.emplace_back(), begun = true;
    if (c != '\'') words.back() += c;
  }
  return words;
}

std::string key_in(const std::string& word) { return word.starts_with("--") ? word.substr(2, word.find('=') - 2) : ""; }

std::string text_in(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

void judge_number(Reproduction& found, const fs::path& folder) {
  const PublishedResult& result = found.result;
  found.value = result_number(result.number, folder);
  if (numbers_of(result.expected, result.tolerance).holds(found.value)) found.verdict = Reproduced::yes;
  else if (!result.correct.empty() && numbers_of(result.correct, result.tolerance).holds(found.value))
    found.verdict = Reproduced::misprint, found.reason = "correct: " + result.correct;
  else found.reason = fmt::format("is not the {} number", result.kind);
}

// The mass that a command computes with, which the table of a plan does not show.
double mass_of(const std::vector<std::string>& words) {
  std::vector<Setting> keys;
  for (const std::string& word : words)
    if (const std::string key = key_in(word); !key.empty() && word.find('=') != word.npos)
      keys.push_back({key, word.substr(word.find('=') + 1)});
  const Settings settings = read_settings(find_scene(words[1]), keys);
  const Setting* mass = settings.find("theory.mass");
  return mass ? number_of(mass->value, mass->key) : 1;
}

void judge_equation(Reproduction& found, const std::vector<std::string>& words, const std::string& plan) {
  const PublishedResult& result = found.result;
  const double most = result.tolerance.empty() ? rounding : number_of(result.tolerance, "tolerance");
  const double mass = mass_of(words);
  const EquationDifference off = equation_difference(plan, result.expected, mass);
  found.value = off.largest;
  if (off.largest <= most) {
    found.verdict = Reproduced::yes;
    return;
  }
  found.reason = off.where;
  if (result.correct.empty()) return;
  const EquationDifference from_correct = equation_difference(plan, result.correct, mass);
  if (!(from_correct.largest <= most)) return;
  found.verdict = Reproduced::misprint, found.reason += "; the corrected equation holds";
}

}  // namespace

std::string words_of(Reproduced verdict) {
  switch (verdict) {
    case Reproduced::yes:
      return "reproduced";
    case Reproduced::misprint:
      return "misprint";
    case Reproduced::differs:
      return "differs";
    case Reproduced::failed:
      break;
  }
  return "failed";
}

Printed numbers_of(const std::string& printed, const std::string& tolerance) {
  const std::string text = trimmed(printed);
  if (text.starts_with("<")) return {-infinity, number_of(text.substr(1), "printed")};
  if (text.starts_with(">")) return {number_of(text.substr(1), "printed"), infinity};
  if (const auto to = text.find(" to "); to != text.npos)
    return {number_of(text.substr(0, to), "printed"), number_of(text.substr(to + 4), "printed")};
  if (tolerance.empty()) throw BadInput("", "a printed number needs a `tolerance`, and `because`");
  const double number = number_of(text, "printed");
  const bool relative = tolerance.ends_with('%');
  const double by = number_of(relative ? tolerance.substr(0, tolerance.size() - 1) : tolerance, "tolerance");
  const double off = relative ? std::abs(number) * by / 100 : by;
  return {number - off, number + off};
}

std::vector<std::string> words_for(const PublishedResult& result, const fs::path& folder,
                                   const std::vector<Setting>& keys) {
  std::vector<std::string> words = shell_words(result.command + " " + result.keys);
  if (std::error_code none; words.size() > 1 && fs::exists(words[1], none))
    for (const ShippedScene& scene : shipped_scenes())
      if (scene.name == words[1]) words[1] = scene.file.string();
  const bool writes = words[0] != "plan";
  // Of two words with one key the later one is meant: `like` gives a result the command of another.
  for (std::size_t i = 0; i < words.size();) {
    const std::string key = key_in(words[i]);
    const auto same = [&](const std::string& word) { return !key.empty() && key_in(word) == key; };
    const bool again = std::ranges::any_of(words.begin() + static_cast<std::ptrdiff_t>(i) + 1, words.end(), same);
    const bool given = std::ranges::find(keys, key, &Setting::key) != keys.end();
    if (again || given) words.erase(words.begin() + static_cast<std::ptrdiff_t>(i));
    else ++i;
  }
  for (const Setting& key : keys) words.push_back(fmt::format("--{}={}", key.key, key.value));
  const auto otherwise = [&](const std::string& key, const std::string& value) {
    if (std::ranges::find(words, key, key_in) == words.end()) words.push_back(fmt::format("--{}={}", key, value));
  };
  otherwise("output.figures", "off");
  if (words[0] == "run" || words[0] == "sweep") otherwise("output.fields", "off");
  if (words[0] == "sweep")
    otherwise("sweep.keep", "table"), otherwise("sweep.jobs", "1"), otherwise("sweep.resume", "off");
  for (std::string& word : words)
    if (word == "SCENE") word = (folder / "scene" / (result.id + ".ini")).string();
  if (writes) words.push_back("--out"), words.push_back(folder.string());
  return words;
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string line = "delf";
  for (const std::string& word : words)
    line += word.find_first_of(" ()*;<>&|$") == word.npos ? " " + word : " '" + word + "'";
  return line;
}

Reproduction judged(const PublishedResult& result, const std::vector<std::string>& words, const fs::path& folder,
                    int code, const std::vector<Setting>& keys) {
  Reproduction found{result, shell_line(words), Reproduced::failed, unknown, "", 0};
  const std::string log = text_in(folder / "run.log");
  try {
    constexpr int bad_input = 2, system_failed = 4;
    if (code == bad_input || code >= system_failed) throw BadInput("", error_in_log(folder));
    if (result.number == of_equation) judge_equation(found, words, log);
    else judge_number(found, folder);
    if (found.verdict == Reproduced::failed && !result.differs.empty())
      found.verdict = Reproduced::differs, found.reason = result.differs;
  } catch (const std::exception& error) {
    found.reason = error.what();
    if (found.reason.empty()) found.reason = fmt::format("exit code {}", code);
    return found;
  }
  if (found.verdict == Reproduced::yes) return found;
  for (const Setting& key : keys)
    found.reason += fmt::format("{} --{}={}", &key == keys.data() ? "; computed with" : "", key.key, key.value);
  if (keys.empty() && found.verdict == Reproduced::failed && result.number != of_equation)
    found.reason += ", and no reason is known";
  return found;
}

}  // namespace delf

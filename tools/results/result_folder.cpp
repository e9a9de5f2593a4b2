// SPDX-License-Identifier: MIT
#include "tools/results/result_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "lattice/index.hpp"
#include "tools/report/failure.hpp"
#include "tools/results/sha256.hpp"
#include "tools/scene/recorded_scene.hpp"

namespace delf {

namespace fs = std::filesystem;

std::string file_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return std::move(text).str();
}

const std::vector<std::string>& ResultFolder::kinds() {
  static const std::vector<std::string> all{"summary", "verify", "convergence", "sweep", "workprecision", "stability"};
  return all;
}

namespace {

/// Other programs have files of these names, too.
bool is_of_delf(const std::string& kind, const Json& json) {
  static const std::map<std::string, std::vector<const char*>> keys{
      {"summary", {"status"}}, {"verify", {"checks"}},      {"convergence", {"levels"}},
      {"sweep", {"runs"}},     {"workprecision", {"runs"}}, {"stability", {"limits", "point_limits"}}};
  return !text_in(&json, "version").empty() &&
         std::ranges::any_of(keys.at(kind), [&](const char* key) { return json.contains(key); });
}

}  // namespace

ResultFolder::ResultFolder(const fs::path& given, const char* command) : path(given) {
  std::error_code none;
  if (!fs::is_directory(path, none))
    throw BadScene(
        fmt::format("command line: {} {}: no such folder; name a folder of results", command, path.string()));
  const fs::path whole = fs::weakly_canonical(path, none);
  name = (whole.has_filename() ? whole : whole.parent_path()).filename().string();
  for (const std::string& kind : kinds()) {
    const fs::path file = path / (kind + ".json");
    if (!fs::exists(file, none)) continue;
    Json json = Json::parse(file_text(file), nullptr, false);
    if (!json.is_object()) {
      damaged.insert(kind);
      missing.push_back(fmt::format("{}.json is damaged, and is not used.", kind));
    } else if (is_of_delf(kind, json)) results.emplace(kind, std::move(json));
    else missing.push_back(fmt::format("{}.json is of another program, and is not used.", kind));
  }
  scene_file = path / "scene.ini";
  if (const auto runs = list_in(result("sweep"), "runs"); !runs.empty() && !fs::exists(scene_file, none))
    scene_file = path / text_in(&runs[0], "folder") / "scene.ini";
  scene = file_text(scene_file);
  keys = recorded_keys(scene);
  for (const std::string& kind : kinds())
    if (const std::string of_scene = text_in(result(kind), "scene"); !of_scene.empty()) name = of_scene;
  series = SeriesTable(path / "series.csv");
  if (results.empty() && damaged.empty() && scene.empty() && series.columns.empty())
    throw BadScene(
        fmt::format("command line: {} {}: holds no results of delf; name a folder that has a scene.ini, "
                    "summary.json or verify.json",
                    command, path.string()));
}

void ResultFolder::list_files() {
  constexpr std::size_t most = 40;
  std::error_code error;
  std::vector<std::string> names;
  for (auto entry = fs::recursive_directory_iterator(path, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const std::string file = fs::path(entry->path()).lexically_relative(path).string();
    const bool own = entry->path().filename() == "report.html" || entry->path().filename().string().starts_with('.');
    if (std::error_code none; !own && entry->is_regular_file(none)) names.push_back(file);
  }
  // the files of the folder itself come before those of folders in it
  std::ranges::sort(names, {}, [](const std::string& n) { return std::pair(std::ranges::count(n, '/'), n); });
  std::set<std::string> drawn;
  for (const std::string& file : names)
    if (file.starts_with("figures/")) drawn.insert(fs::path(file).stem().string());
  figures.assign(drawn.begin(), drawn.end());
  // Fields come first, what is derived from them later.
  static const std::vector<std::string> order{"spacetime",  "field", "film",  "waveforms", "error",
                                              "trajectory", "orbit", "phase", "section"};
  std::ranges::stable_sort(figures, {},
                           [](const std::string& f) { return std::ranges::find(order, f) - order.begin(); });
  further_files = names.size() > most ? names.size() - most : 0;
  names.resize(names.size() - further_files);
  const auto sums = sha256_of(path, names);
  for (const std::string& file : names) {
    const auto sum = sums.find(file);
    const auto bytes = fs::file_size(path / file, error);
    files.push_back({file, error ? 0 : bytes, sum == sums.end() ? "" : sum->second});
  }
  if (scene.empty()) missing.emplace_back("There is no scene.ini: keys, equations and the command are not known.");
  if (!result("summary") && !damaged.contains("summary") && !series.columns.empty())
    missing.emplace_back("There is no summary.json: the run goes on still, or was killed.");
  if (!result("verify") && !damaged.contains("verify"))
    missing.emplace_back("There is no verify.json: nobody has verified these rows here.");
  if (figures.empty()) missing.emplace_back("There are no figures.");
}

const Json* ResultFolder::result(const std::string& file) const {
  const auto found = results.find(file);
  return found == results.end() ? nullptr : &found->second;
}

bool ResultFolder::has_file(const std::string& file) const {
  return std::ranges::find(files, file, &File::name) != files.end();
}

namespace {

const Json* value_in(const Json* json, const std::string& key) {
  if (!json || !json->is_object()) return nullptr;
  const auto found = json->find(key);
  return found == json->end() ? nullptr : &*found;
}

}  // namespace

std::optional<double> number_in(const Json* json, const std::string& key) {
  const auto* value = value_in(json, key);
  return value && value->is_number() ? std::optional(value->get<double>()) : std::nullopt;
}

std::string text_in(const Json* json, const std::string& key) {
  const auto* value = value_in(json, key);
  return value && value->is_string() ? value->get<std::string>() : "";
}

bool is_true_in(const Json* json, const std::string& key) {
  const auto* value = value_in(json, key);
  return value && value->is_boolean() && value->get<bool>();
}

std::vector<Json> list_in(const Json* json, const std::string& key) {
  const auto* value = value_in(json, key);
  return value && value->is_array() ? value->get<std::vector<Json>>() : std::vector<Json>{};
}

std::vector<std::string> texts_in(const Json* json, const std::string& key) {
  std::vector<std::string> texts;
  for (const Json& one : list_in(json, key))
    if (one.is_string()) texts.push_back(one);
  return texts;
}

std::string value_text(const Json* json, const std::string& key) {
  const Json* value = value_in(json, key);
  if (value && value->is_boolean()) return value->get<bool>() ? "yes" : "no";
  const std::string text = text_in(json, key);
  return text.empty() ? number_text(number_in(json, key)) : text;
}

std::string number_text(std::optional<double> value) {
  if (!value || std::isnan(*value)) return {};
  return std::abs(*value) < 1e15 && *value == std::floor(*value) ? fmt::format("{:.0f}", *value)
                                                                 : fmt::format("{:.6g}", *value);
}

}  // namespace delf

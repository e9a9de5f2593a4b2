// SPDX-License-Identifier: MIT
#include "tools/sweep/sweep_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <thread>

#include "lattice/read_number.hpp"
#include "lattice/text_parts.hpp"
#include "tools/complex/complex_scene.hpp"
#include "tools/scene/keys.hpp"
#include "tools/scene/values.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

BadScene wrong(const Setting& s, const std::string& why) {
  return BadScene(fmt::format("command line: --{} = {}: {}", s.key, s.value, why));
}

// from, from + step, …, to; twelve digits hide the rounding of the sums
std::vector<std::string> range(const Setting& s, double from, double to, double step) {
  const double count = std::floor((to - from) / step + 1e-9);
  if (!(count >= 0)) throw wrong(s, "the step does not lead from the first value to the second; write from:to:step");
  if (count >= static_cast<double>(most_runs)) throw wrong(s, "are more runs than a sweep takes; use a longer step");
  std::vector<std::string> values;
  for (int i = 0; i <= static_cast<int>(count); ++i) values.push_back(fmt::format("{:.12g}", from + i * step));
  return values;
}

// Text, lists of times and regions hold commas and colons of their own.
bool may_be_swept(const Setting& s) {
  if (const Parameter* key = find_key(s.key)) return type_of(*key) != KeyType::text;
  return s.key.starts_with("theory.");  // a parameter that the scene declares
}

// A line of keys, then a line of values for each run; # begins a comment.
void read_table(const fs::path& file, const Setting& key, SweepRequest& request) {
  std::ifstream in(file);
  if (!in) throw wrong(key, "no such file; check the path");
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (const std::string content = trimmed(line); content.empty() || content.front() == '#') continue;
    std::vector<std::string> cells = parts_of(line);
    if (request.keys.empty()) {
      request.keys = std::move(cells);
      continue;
    }
    if (cells.size() != request.keys.size())
      throw BadScene(fmt::format("{}:{}: {} values for {} keys; give one for each", file.string(), number, cells.size(),
                                 request.keys.size()));
    request.values.push_back(std::move(cells));
  }
  if (request.values.empty()) throw wrong(key, "has no runs; write a line of keys, and a line of values for each run");
}

// Every value of the keys before it with every value of this one; or value by value.
void add_key(const Setting& s, std::vector<std::string> values, bool together, SweepRequest& request) {
  request.keys.push_back(s.key);
  if (request.values.empty()) {
    for (std::string& value : values) request.values.push_back({std::move(value)});
    return;
  }
  if (together) {
    if (values.size() != request.values.size())
      throw wrong(s, fmt::format("are {} values beside {} of {}; with sweep.zip = on give as many", values.size(),
                                 request.values.size(), request.keys.front()));
    for (std::size_t i = 0; i < values.size(); ++i) request.values[i].push_back(values[i]);
    return;
  }
  if (request.values.size() * values.size() > most_runs) throw wrong(s, "are more runs than a sweep takes; use fewer");
  std::vector<std::vector<std::string>> product;
  for (const auto& before : request.values)
    for (const std::string& value : values) {
      product.push_back(before);
      product.back().push_back(value);
    }
  request.values = std::move(product);
}

// KEY=a:b
void read_bisection(const Scene& scene, const Values& values, SweepRequest& request) {
  const std::string text = *values.text("sweep.bisect");
  const auto equals = text.find('=');
  const std::vector<std::string> ends =
      equals == std::string::npos ? std::vector<std::string>() : parts_of(text.substr(equals + 1), ':');
  std::optional<double> low, high;
  if (ends.size() == 2) low = read_finite(ends[0]), high = read_finite(ends[1]);
  if (!low || !high || !(*low < *high))
    throw scene.settings.error("sweep.bisect", "write KEY=a:b with a < b, such as initial.speed=0.2:0.3");
  if (!request.keys.empty())
    throw scene.settings.error("sweep.bisect",
                               fmt::format("{} has several values; give one of both", request.keys.front()));
  request.keys = {trimmed(text.substr(0, equals))};
  if (const Parameter* key = scene.settings.key(request.keys[0]); !key || type_of(*key) != KeyType::real)
    throw scene.settings.error(
        "sweep.bisect", fmt::format("{} is no key with real values; choose one of `delf help run`", request.keys[0]));
  request.bisection =
      SweepRequest::Bisection{*low, *high, values.real("sweep.accuracy"), values.maybe_real("sweep.level")};
}

/// A mesh is not kept: a run reads it again.
Scene scene_of(Settings settings) {
  AnyScene any = read_any_scene(std::move(settings));
  Scene scene = std::visit([](auto& read) { return std::move(common_part(read)); }, any);
  if (scene.problem.lattice.mesh()) scene.problem.lattice = Lattice::point();
  return scene;
}

}  // namespace

std::vector<std::string> swept_values(const Setting& s) {
  if (!may_be_swept(s)) return {s.value};
  const std::vector<std::string> ends = parts_of(s.value, ':');
  if (ends.size() == 3) {
    const auto from = read_finite(ends[0]), to = read_finite(ends[1]), step = read_finite(ends[2]);
    if (!from || !to || !step || *step == 0) throw wrong(s, "is no range; write from:to:step, such as 0.1:0.5:0.05");
    return range(s, *from, *to, *step);
  }
  std::vector<std::string> values = parts_of(s.value);
  if (values.size() > 1 && std::ranges::any_of(values, &std::string::empty))
    throw wrong(s, "a value is missing between commas; give it, or remove the comma");
  return values;
}

SweptRun SweepRequest::run(const std::vector<std::string>& of_keys) const {
  std::vector<Setting> settings;  // without the keys of the sweep, which are none of the run's
  for (const Setting& s : common)
    if (!s.key.starts_with("sweep.")) settings.push_back(s);
  for (std::size_t i = 0; i < keys.size(); ++i) settings.push_back({keys[i], of_keys[i], 0});
  // Figures of each run, and with rows only all its fields, are not asked for unless by name.
  const auto otherwise = [&](const char* key, const char* value) {
    if (std::ranges::find(settings, key, &Setting::key) == settings.end()) settings.push_back({key, value, 0});
  };
  otherwise("output.figures", "off");
  otherwise("output.checkpoint", "0");  // a run that is cut short is run again
  if (table) otherwise("output.fields", "off");
  SweptRun run{scene_of(read_settings(file, settings)), of_keys};
  // Titles and formats given here are those of the sweep's own figure.
  std::erase_if(run.scene.warnings, [](const std::string& warning) {
    return warning.starts_with("command line: --output.titles") || warning.starts_with("command line: --output.format");
  });
  return run;
}

SweepRequest read_sweep_request(const fs::path& scene_file, const std::vector<Setting>& on_command_line,
                                std::string_view command) {
  SweepRequest request;
  request.file = scene_file;
  std::vector<std::pair<Setting, std::vector<std::string>>> several;
  std::vector<Setting> first;  // a scene that can be read for the keys [sweep]
  for (const Setting& s : on_command_line) {
    std::vector<std::string> values = swept_values(s);
    if (values.size() > 1 && s.key.starts_with("sweep.")) throw wrong(s, "has one value only; give one");
    first.push_back({s.key, values.front(), 0});
    if (values.size() > 1) several.emplace_back(s, std::move(values));
    else request.common.push_back(s);
  }
  const Scene scene = scene_of(read_settings(scene_file, first));
  const Values values(scene.settings);
  const bool together = values.toggle("sweep.zip");
  if (const auto file = values.text("sweep.settings")) {
    if (!several.empty())
      throw wrong(several[0].first, "sweep.settings gives the runs; put this key into its table, or give one value");
    read_table(*file, *scene.settings.find("sweep.settings"), request);
  }
  for (auto& [setting, list] : several) add_key(setting, std::move(list), together, request);
  if (values.text("sweep.bisect")) read_bisection(scene, values, request);
  if (request.keys.empty())
    throw BadScene(
        fmt::format("command line: {} what? Give a key several values, as --initial.speed=0.1:0.5:0.1 or "
                    "--lattice.stencil=triangle,rectangle",
                    command));
  request.table = values.choice("sweep.keep") == "table";
  request.resume = values.toggle("sweep.resume");
  request.number = values.text("sweep.number").value_or("");
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / scene.problem.threads);
  request.jobs = static_cast<int>(values.maybe_integer("sweep.jobs").value_or(cores));
  return request;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/sweep/sweep_row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <memory>

#include "tools/report/failure.hpp"

namespace delf {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

double as_number(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

double SweepRow::number(const std::string& name) const {
  if (!summary.is_object()) return std::numeric_limits<double>::quiet_NaN();
  if (const auto measures = summary.find("measures"); measures != summary.end() && measures->contains(name))
    return as_number((*measures)[name]);
  if (name == "error_estimate" && summary.contains(name) && summary[name].is_object())
    return as_number(summary[name].value("error", Json()));
  return as_number(summary.value(name, Json()));
}

std::vector<std::string> SweepRow::numbers() const {
  std::vector<std::string> names;
  if (!summary.is_object()) return names;
  if (const auto measures = summary.find("measures"); measures != summary.end())
    for (const auto& [name, value] : measures->items()) names.push_back(name);
  for (const auto& [name, value] : summary.items())
    if (value.is_number() || value.is_null() || name == "error_estimate")
      if (name != "failure") names.push_back(name);
  return names;
}

std::string fingerprint_of(const Scene& scene) {
  std::vector<std::string> lines{DELF_VERSION};
  for (const Setting& s : scene.settings.all())
    if (!s.key.starts_with("sweep.") && scene.settings.find(s.key) == &s) lines.push_back(s.key + " = " + s.value);
  std::error_code none;
  if (scene.from_file())
    lines.push_back(fmt::format("{}", fs::last_write_time(scene.initial_file, none).time_since_epoch().count()));
  if (const Setting* mesh = scene.settings.find("lattice.mesh"))  // which may be a file
    if (const auto file = scene.settings.file().parent_path() / mesh->value; fs::is_regular_file(file, none))
      lines.push_back(fmt::format("{}", fs::last_write_time(file, none).time_since_epoch().count()));
  std::sort(lines.begin() + 1, lines.end());
  // FNV-1a: h ← (h ⊕ byte) · 1099511628211
  std::uint64_t hash = 14695981039346656037u;
  for (const std::string& line : lines)
    for (const char c : line + "\n") hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return fmt::format("{:016x}", hash);
}

SweepJournal::SweepJournal(const fs::path& file, bool keep_earlier) : file_(file) {
  std::error_code none;
  if (!keep_earlier) fs::remove(file_, none);
  std::ifstream in(file_);
  bool cut_short = false;
  for (std::string line; std::getline(in, line);) {
    cut_short = in.eof();  // no line break at its end
    const Json json = Json::parse(line, nullptr, false);
    if (!json.is_object() || !json.contains("fingerprint")) continue;
    SweepRow row{json["fingerprint"], json.value("status", ""), json.value("failure", ""), json.value("folder", ""),
                 json.value("summary", Json())};
    rows_[row.fingerprint] = std::move(row);
  }
  if (cut_short) std::ofstream(file_, std::ios::app) << '\n';
}

const SweepRow* SweepJournal::find(const std::string& fingerprint) const {
  const auto row = rows_.find(fingerprint);
  return row == rows_.end() ? nullptr : &row->second;
}

void SweepJournal::append(const SweepRow& row) {
  const Json json{{"fingerprint", row.fingerprint},
                  {"status", row.status},
                  {"failure", row.failure},
                  {"folder", row.folder},
                  {"summary", row.summary}};
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file_.c_str(), "ab"), std::fclose);
  std::string line = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  line += '\n';
  if (!out || std::fwrite(line.data(), 1, line.size(), out.get()) != line.size() || std::fflush(out.get()) != 0)
    throw SystemFailure(file_.string() + ": cannot be written to; check that its disk has room");
  rows_[row.fingerprint] = row;
}

}  // namespace delf

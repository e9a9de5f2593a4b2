// SPDX-License-Identifier: MIT
#include "tools/rows/recorded_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "lattice/index.hpp"
#include "tools/files/plain_rows.hpp"
#include "tools/scene/recorded_scene.hpp"

namespace delf {

namespace {

std::string counted(int n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

// A reader's errors name a key of a scene; here the file comes from the command line.
std::unique_ptr<RowsFile> opened(const std::filesystem::path& path, const std::string& place,
                                 const LatticeSystem& system) {
  std::string name = path.string();
  if (!std::filesystem::exists(path)) name = name.substr(0, name.rfind(":/"));
  if (!std::filesystem::exists(name))
    throw BadScene(place + ": no such file; name the fields.h5 of a run, or a file of the same layout");
  if (std::filesystem::is_directory(path)) throw BadScene(place + ": is a directory; name the file in it");
  if (path.extension() == ".gz") throw BadScene(place + ": is compressed; unpack it by gunzip");
  try {
    if (auto plain = open_plain_rows(path, system.lattice().sites(), system.fields())) return plain;
  } catch (const BadInput& bad) {
    throw BadScene(place + ": " + bad.what());
  }
  try {
    return std::make_unique<FieldsReader>(path);
  } catch (const BadInput& bad) {
    throw BadScene(place + ": " + bad.what() + ", or a file of the same layout");
  }
}

}  // namespace

RecordedSection::RecordedSection(const std::filesystem::path& path, const LatticeSystem& system,
                                 const std::vector<int>& back, double time_step, const char* option)
    : place_(fmt::format("command line: {} {}", option, path.string())),
      file_(opened(path, place_, system)),
      fields_(dynamic_cast<const FieldsReader*>(file_.get())) {
  std::array<int, all_roles.size()> count{};
  for (std::size_t c = 0; c < back.size(); ++c) {
    const Role role = system.all_components()[c].role;
    columns_.push_back({role, count[at(role)]++, back[c]});
  }
  if (const int here = file_->sites(), there = system.lattice().sites(); here != there)
    throw wrong(fmt::format("has {}, and the lattice has {}; use lattice.sites = {}, or another file",
                            counted(here, "site"), there, here));
  for (const Role role : all_roles)
    if (count[at(role)] > 0) check_shape(system, role);
  if (system.times()->uniform()) check_times(time_step);
  else system.times()->set(own_times());
  check_space(system);
}

FieldsReader::Shape RecordedSection::shape(Role role) const {
  if (fields_) return fields_->shape(role);
  return role == Role::field ? FieldsReader::Shape{file_->frames(), file_->sites(), file_->components()}
                             : FieldsReader::Shape{};
}

BadScene RecordedSection::wrong(const std::string& what) const { return BadScene(place_ + ": " + what); }

void RecordedSection::check_shape(const LatticeSystem& system, Role role) const {
  std::string names;
  int components = 0;
  for (const Component& c : system.all_components())
    if (c.role == role) names += (components++ == 0 ? "" : ", ") + c.name;
  const auto& [frames, sites, here] = shape(role);
  if (frames == rows() && sites == file_->sites() && here == components) return;
  if (role == Role::field)
    throw wrong(
        fmt::format("has {}, and the scheme has {} ({}); give as many", counted(here, "field"), components, names));
  const std::string needed =
      fmt::format("frames x sites x components = {} x {} x {} ({})", rows(), file_->sites(), components, names);
  if (here == 0)
    throw wrong(fmt::format("has no dataset /{}, which the scheme needs; write {}", to_string(role), needed));
  throw wrong(fmt::format("/{} is {} x {} x {}; write {}", to_string(role), frames, sites, here, needed));
}

/// A key of the scene in the file; empty if there is none.
std::string RecordedSection::recorded(const std::string& key) const {
  const auto keys = recorded_keys(scene());
  const auto found = keys.find(key);
  return found == keys.end() ? std::string() : found->second;
}

// The times of rows that chose their steps.
std::vector<double> RecordedSection::own_times() const {
  if (const std::string every = recorded("output.every"); !every.empty() && every != "1")
    throw wrong(
        fmt::format("was recorded with output.every = {}, and the equations read all rows; record every row "
                    "(output.every = 1)",
                    every));
  std::vector<double> times;
  for (int frame = 0; frame < rows(); ++frame) {
    const auto now = fields_ ? fields_->time(frame) : std::nullopt;
    if (!now) throw wrong("has no dataset /time; steps that rows choose need the time of each frame there");
    if (!times.empty() && !(*now > times.back()))
      throw wrong(fmt::format("frames {} and {} are not one after the other in /time", frame - 1, frame));
    times.push_back(*now);
  }
  if (times.size() < 2) throw wrong("has one frame; record more");
  return times;
}

void RecordedSection::check_times(double time_step) const {
  constexpr const char* layout = "write the time of each frame there";
  if (recorded("lattice.time_steps") == "reversible")
    throw wrong(
        "was made with lattice.time_steps = reversible, and its steps are not equal; use "
        "--lattice.time_steps=reversible");
  std::optional<double> before;
  for (int frame = 0; frame < rows(); ++frame) {
    std::optional<double> now;
    try {
      now = file_->time(frame);
    } catch (const BadInput& bad) {
      throw wrong(fmt::format("{}; {}", bad.what(), layout));
    }
    if (!now && !fields_) return;  // a plain array: its rows are taken as a time step apart
    if (!now) throw wrong(fmt::format("has no dataset /time; {}", layout));
    const double slack = 1e-9 * std::abs(time_step) + 1e-15 * std::abs(*now);  // times far from 0 are rounded
    const double steps = before ? (*now - *before) / time_step : 1;
    if (std::abs(steps - std::round(steps)) < 1e-6 && std::round(steps) > 1)
      throw wrong(fmt::format(
          "frames {} and {} are {:.10g} apart, and the time step is {:.10g}: of {} rows one was recorded, and the "
          "equations "
          "read all. Record every row (output.every = 1); or use lattice.time_step = {:.10g}, if that was the step",
          frame - 1, frame, *now - *before, time_step, std::lround(steps), *now - *before));
    if (before && !(std::abs(*now - *before - time_step) <= slack))
      throw wrong(
          fmt::format("frames {} and {} are {:.10g} apart, and the time step is {:.10g}; record every row "
                      "(output.every = 1), and use the same step",
                      frame - 1, frame, *now - *before, time_step));
    before = now;
  }
}

// Positions that are all the same say nothing.
void RecordedSection::check_space(const LatticeSystem& system) const {
  const auto x = fields_ ? fields_->positions() : std::nullopt;
  if (!x || x->size() < 2 || x->front() == x->back() || system.lattice().space() == Space::point || system.moves())
    return;
  const double there = (x->back() - x->front()) / static_cast<double>(x->size() - 1),
               here = system.lattice().space_step();
  if (std::abs(there - here) <= 1e-6 * std::abs(here)) return;
  throw wrong(
      fmt::format("has sites {:.10g} apart in /space, and the lattice has {:.10g}; use lattice.length = {:.10g}, or "
                  "correct /space",
                  there, here, there * system.lattice().cells()));
}

void RecordedSection::check_finite(const std::vector<double>& values, Role role, int frame) const {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw wrong(fmt::format("/{} is not finite in frame {} at site {}; leave out the frames from there on",
                              to_string(role), frame, i / at(shape(role).components)));
}

void RecordedSection::read(Role role, int back, std::int64_t j, std::vector<double>& row) const {
  if (j + back >= rows()) return;
  const int frame = static_cast<int>(j + back);
  std::vector<double> values;
  try {
    values = fields_ ? fields_->values(role, frame) : file_->row(frame);
  } catch (const BadInput& bad) {
    throw wrong(bad.what());
  }
  check_finite(values, role, frame);
  const std::size_t in_file = at(shape(role).components), all = columns_.size();
  for (std::size_t c = 0; c < all; ++c)
    if (const Column& column = columns_[c]; column.role == role && column.back == back)
      for (std::size_t i = 0; i * all < row.size(); ++i) row[i * all + c] = values[i * in_file + at(column.index)];
}

std::vector<double> RecordedSection::row(std::int64_t j) const {
  if (j < 0 || j >= rows())
    throw wrong(fmt::format("row {} is needed, and the file has {}; record more", j, counted(rows(), "frame")));
  std::vector<double> row(at(file_->sites()) * columns_.size());
  std::set<std::pair<Role, int>> reads;  // each frame of a dataset is read once
  for (const Column& column : columns_) reads.emplace(column.role, column.back);
  for (const auto& [role, back] : reads) read(role, back, j, row);
  return row;
}

}  // namespace delf

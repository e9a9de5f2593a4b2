// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "tools/figures/figure_form.hpp"
#include "tools/scene/settings.hpp"

namespace delf {

class Values;

/// A scene, read and resolved: nothing in it is left to guess, except what only the initial state knows.
struct Scene {
  explicit Scene(Settings given) : settings(std::move(given)) {}

  Settings settings;
  std::string name;                   ///< of its file, without the ending
  std::vector<std::string> warnings;  ///< lines for stderr: keys that have no effect

  Problem problem;       ///< [theory] [lattice] [scheme] run.threads; the winding is still to come from the state
  StateRequest initial;  ///< [initial]
  std::filesystem::path initial_file;  ///< absolute; empty unless the rows come from a file
  int initial_frame = 0;
  std::optional<StartRule> start;  ///< if the scene gives it
  std::int64_t steps = 0;          ///< after row 0
  std::optional<double> until;     ///< of steps that rows choose: see is_over(); `steps` is a guess then
  std::int64_t every = 1;          ///< 0: the last row only
  bool figures = true, fields = true;
  FigureForm figure_form;
  double checkpoint = 60;     ///< seconds from one to the next; 0: none
  std::string section;        ///< output.section as it is; empty: none
  std::vector<double> times;  ///< of the waveforms; empty: evenly spread

  bool from_file() const { return !initial_file.empty(); }
  /// True if row n, at time t, is the last: the first that is as late as `until`, or else the last of `steps`.
  bool is_over(std::int64_t n, double t) const { return until ? t >= *until * (1 - 1e-12) : n >= steps; }
  /// The last row of a run that has come to row n, which may be one beyond the steps asked for.
  std::int64_t last_row(std::int64_t n) const { return until && steps > 0 ? n : std::min(n, steps); }
  /// True if a row is recorded by a run that has come to row n at time t; next_record(n): the next one after n, if any.
  bool is_recorded(std::int64_t row, std::int64_t n, double t) const {
    return (is_over(n, t) && row == last_row(n)) || (every > 0 && row % every == 0);
  }
  std::int64_t next_record(std::int64_t n) const {
    const std::int64_t last = until ? std::numeric_limits<std::int64_t>::max() : steps;
    return every == 0 ? last : std::min(last, (n / every + 1) * every);
  }
  /// The time that the run is to end at.
  double end() const { return until ? *until : static_cast<double>(steps) * problem.time_step; }
};

/// lattice.time_steps = reversible: its s, lattice.step_control. Throws BadScene for that key where steps are others.
std::optional<double> read_step_control(const Settings&, const Values&);
/// output.format and output.titles. Throws BadScene.
FigureForm read_figure_form(const Settings&, const Values&);

/// Reads, checks and resolves the scene `file`; throws BadScene.
Scene read_scene(const std::filesystem::path& file, const std::vector<Setting>& on_command_line);
/// The scene of settings that are read.
Scene read_scene(Settings);

/// Why a key has no effect in this scene, or an empty string if it has one.
std::string why_without_effect(const Scene&, std::string_view key);

/// The first words of that text.
inline constexpr std::string_view resolved_scene_begins = "# All that was in force, as delf ";
/// The scene with all that is in force written out, to be run again to the same bits.
std::string resolved_text(const Scene&, StartRule in_force, const std::string& state_in_words);
/// Keys with their values as the sections of a scene; a key whose value is empty is left out.
std::string sections_of(const Settings&, const std::function<std::string(const Parameter&)>& value);

}  // namespace delf

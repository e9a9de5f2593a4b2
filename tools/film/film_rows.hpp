// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/complex/complex_scene.hpp"
#include "tools/files/fields_reader.hpp"
#include "tools/files/series_table.hpp"

namespace delf {

/// The recorded rows of a folder that a film shows: evenly spread over time, at most 25 a second.
class FilmRows {
 public:
  /// Throws BadScene for a folder without rows, or with one alone, and for what is no folder of a run. `keys` win over the scene.
  FilmRows(const std::filesystem::path& folder, const std::vector<Setting>& keys);

  /// The name of the scene that the folder is of.
  const std::string& name() const { return name_; }
  double seconds() const { return seconds_; }
  std::size_t frames() const { return chosen_.size(); }
  double time(std::size_t frame) const { return times_[frame]; }
  /// All recorded rows, for paths: their times, and the number of those up to a frame.
  const std::vector<double>& all_times() const { return all_times_; }
  std::size_t recorded_until(std::size_t frame) const { return at(chosen_[frame]) + 1; }
  std::vector<double> recorded_row(std::size_t n) const { return reader_->values(Role::field, static_cast<int>(n)); }
  std::optional<std::vector<double>> recorded_momenta(std::size_t n) const {
    return reader_->momenta(static_cast<int>(n));
  }
  /// All components of a row as they are, finite or not, [i·components + c].
  std::vector<double> row(std::size_t frame) const;
  /// One component of a row.
  std::vector<double> component(std::size_t frame, std::size_t component) const;
  /// The positions of the sites of a lattice, or of those of a mesh on a line.
  std::vector<double> places(std::size_t frame) const;

  const AnyScene& scene() const { return scene_; }
  const Scene& common() const;
  const FieldsReader& reader() const { return *reader_; }
  const SeriesTable& series() const { return series_; }
  /// The components of a row that are fields, and their symbols; where positions are a field, they are none of these.
  const std::vector<std::size_t>& fields() const { return fields_; }
  const std::vector<std::string>& symbols() const { return symbols_; }
  /// True if the fields are angles: they are shown as φ/2π.
  bool is_angle() const { return angle_; }

 private:
  std::string name_;
  AnyScene scene_;
  std::unique_ptr<FieldsReader> reader_;
  SeriesTable series_;
  double seconds_ = 0;
  std::vector<int> chosen_;
  std::vector<double> all_times_, times_;
  std::vector<std::size_t> fields_;
  std::vector<std::string> symbols_;
  std::optional<std::size_t> moving_;  ///< the component that is the position of sites that move
  bool angle_ = false;
};

}  // namespace delf

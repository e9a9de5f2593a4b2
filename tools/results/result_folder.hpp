// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/files/series_table.hpp"
#include "tools/outcome/findings_json.hpp"

namespace delf {

/// A folder of results: whatever is there, of a run that ended, failed, or was killed.
struct ResultFolder {
  /// Throws BadInput, in the name of a command, for what is no folder, or holds no results.
  ResultFolder(const std::filesystem::path&, const char* command);

  struct File {
    std::string name;  ///< in the folder
    std::uintmax_t bytes;
    std::string sha256;  ///< empty: not found
  };

  std::filesystem::path path;
  std::string name;                     ///< of the scene, or of the folder
  std::map<std::string, Json> results;  ///< by the name of the file without ending; objects
  std::set<std::string> damaged;        ///< names of files that are there and cannot be read
  std::filesystem::path scene_file;     ///< scene.ini, of a sweep that of its first run
  std::string scene;                    ///< its text
  std::map<std::string, std::string> keys;
  SeriesTable series;                ///< series.csv
  std::vector<File> files;           ///< of list_files()
  std::size_t further_files = 0;     ///< not among these: there are too many
  std::vector<std::string> figures;  ///< of list_files()
  std::vector<std::string> missing;  ///< in words

  /// A result by the name of its file; null if it is not there.
  const Json* result(const std::string& file) const;
  /// The results in the order in which a page shows them.
  static const std::vector<std::string>& kinds();
  bool has_file(const std::string& name) const;
  /// Lists all files, with the sums of what they hold, and says in `missing` what a page has not.
  void list_files();
};

/// A value of a result, if it is there and of this type.
std::optional<double> number_in(const Json*, const std::string& key);
std::string text_in(const Json*, const std::string& key);
bool is_true_in(const Json*, const std::string& key);
/// The value of `lattice.space` for mechanics, whose results have no sites.
inline constexpr const char* space_of_mechanics = "point";
/// The elements of a list; none if it is not there.
std::vector<Json> list_in(const Json*, const std::string& key);
/// Those of them that are texts.
std::vector<std::string> texts_in(const Json*, const std::string& key);

/// The text of a value: of a number six digits, of true and false yes and no; "" where it is none of these.
std::string value_text(const Json*, const std::string& key);
/// A number for a page: six digits; "" for none.
std::string number_text(std::optional<double>);
/// A file as text; empty if it cannot be read.
std::string file_text(const std::filesystem::path&);

}  // namespace delf

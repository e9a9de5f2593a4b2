// SPDX-License-Identifier: MIT
#include "tools/film/film_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "lattice/text_parts.hpp"
#include "schemes/theories/angles.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/outcome/findings_json.hpp"
#include "tools/report/failure.hpp"
#include "tools/report/field_symbol.hpp"
#include "tools/scene/values.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

constexpr double frames_a_second = 25;

AnyScene scene_of_folder(const fs::path& folder, const std::vector<Setting>& keys) {
  std::error_code none;
  const auto refuse = [&](const std::string& why) {
    throw BadScene(fmt::format("command line: film {}: {}", folder.string(), why));
  };
  if (!fs::is_directory(folder, none)) refuse("no such folder; name the folder of a run");
  if (!fs::exists(folder / "scene.ini", none)) refuse("has no scene.ini; name the folder of a run");
  if (!fs::exists(folder / "fields.h5", none))
    refuse("has no fields.h5, whose rows a film shows; run it with output.fields = on");
  return read_any_scene(read_settings(folder / "scene.ini", keys));
}

/// The name in summary.json, or that of the folder.
std::string name_of(const fs::path& folder) {
  std::ifstream in(folder / "summary.json");
  const Json summary = Json::parse(in, nullptr, false);
  if (summary.is_object() && summary.contains("scene") && summary["scene"].is_string()) return summary["scene"];
  std::error_code none;
  const fs::path whole = fs::weakly_canonical(folder, none);
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

std::unique_ptr<FieldsReader> reader_of(const fs::path& file) try {
  return std::make_unique<FieldsReader>(file);
} catch (const BadInput& bad) {  // it is not of a scene
  throw BadScene(fmt::format("{}: {}", file.string(), bad.what()));
}

}  // namespace

FilmRows::FilmRows(const fs::path& folder, const std::vector<Setting>& keys)
    : name_(name_of(folder)),
      scene_(scene_of_folder(folder, keys)),
      reader_(reader_of(folder / "fields.h5")),
      series_(folder / "series.csv"),
      seconds_(Values(common().settings).real("film.seconds")) {
  const int recorded = reader_->frames();
  const std::string file = (folder / "fields.h5").string();
  const auto* mesh = std::get_if<ComplexScene>(&scene_);
  if (mesh && mesh->is_one_problem())
    throw BadScene(
        fmt::format("{}: has no rows one after the other: the scene is solved at once; see its figures", file));
  const int sites = mesh ? mesh->sites() : common().problem.lattice.sites();
  if (sites != reader_->sites())
    throw BadScene(fmt::format("{}: has {} sites, and those of scene.ini are {}; put both files of one run here", file,
                               reader_->sites(), sites));
  if (recorded < 2)
    throw BadScene(fmt::format("{}: has {}: nothing moves in it; record more, by output.every", file,
                               recorded == 0 ? "no row" : "one row"));
  std::vector<double>& times = all_times_;
  for (int f = 0; f < recorded; ++f) times.push_back(reader_->time(f).value_or(f));
  const int count = std::clamp(static_cast<int>(seconds_ * frames_a_second), 2, recorded);
  for (int n = 0; n < count; ++n) {
    const double t = times.front() + (times.back() - times.front()) * n / (count - 1);
    const auto nearest = std::ranges::min_element(times, {}, [&](double other) { return std::abs(other - t); });
    chosen_.push_back(static_cast<int>(nearest - times.begin()));
    times_.push_back(*nearest);
  }

  std::vector<std::string> names = reader_->names();
  if (names.empty()) names.emplace_back("phi");
  if (mesh) names.resize(std::min(names.size(), mesh->fields.size()));
  for (std::size_t c = 0; c < std::min(names.size(), at(reader_->components())); ++c)
    if (!mesh && names[c] == "X" && names.size() > 1) moving_ = c;
    else fields_.push_back(c), symbols_.push_back(field_symbol(names[c]));
  const Problem& problem = common().problem;
  const auto named = problem.parameters.maybe<std::string>(angles_key);
  angle_ = problem.circle_valued || find_theory(problem.theory).angle ||
           (named && parts_of(*named).size() == fields_.size());
}

const Scene& FilmRows::common() const {
  const auto* mesh = std::get_if<ComplexScene>(&scene_);
  return mesh ? mesh->scene : std::get<Scene>(scene_);
}

std::vector<double> FilmRows::row(std::size_t frame) const { return reader_->values(Role::field, chosen_[frame]); }

std::vector<double> FilmRows::component(std::size_t frame, std::size_t component) const {
  const std::vector<double> all = row(frame);
  std::vector<double> values;
  for (std::size_t n = component; n < all.size(); n += at(reader_->components())) values.push_back(all[n]);
  return values;
}

std::vector<double> FilmRows::places(std::size_t frame) const {
  if (moving_) return component(frame, *moving_);
  if (auto moving = reader_->moving_positions(chosen_[frame])) return *moving;
  const auto x = reader_->coordinates();
  if (!x) throw BadScene("fields.h5: has no positions of its sites, /space; run it anew");
  return *x;
}

}  // namespace delf

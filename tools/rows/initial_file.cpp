// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "lattice/index.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/diagnosis/unwrap.hpp"
#include "tools/files/fields_reader.hpp"
#include "tools/files/plain_rows.hpp"
#include "tools/rows/frame_of.hpp"
#include "tools/rows/initial_rows.hpp"
#include "tools/scene/recorded_scene.hpp"

// Rows of a file are those of the scene: its space, its winding, its fields.

namespace delf {

namespace {

/// One field of a row around a circle that it may not close.
struct RowSeam {
  double step;         ///< from the last site to the first
  double largest = 0;  ///< step between neighbours elsewhere
  double least, most;  ///< values
  double gain;         ///< φ(L) − φ(0), with the last step once more

  RowSeam(const std::vector<double>& row, int components, int field) {
    const std::size_t d = components, a = delf::at(field);
    const std::size_t N = row.size() / d;
    const auto y = [&](std::size_t i) { return row[i * d + a]; };
    step = y(0) - y(N - 1);
    least = most = y(0);
    for (std::size_t i = 1; i < N; ++i) {
      largest = std::max(largest, std::abs(y(i) - y(i - 1)));
      least = std::min(least, y(i)), most = std::max(most, y(i));
    }
    gain = N > 1 ? 2 * y(N - 1) - y(N - 2) - y(0) : 0;
  }
};

/// The density reads x, so that it matters where sites lie.
bool is_placed(const Scene& scene) {
  return make_theory(find_theory(scene.problem.theory), scene.problem.parameters)->is_placed();
}

/// Rows as delf writes them, or as another program does.
std::unique_ptr<RowsFile> open_initial(const std::filesystem::path& path, int sites, int components) {
  if (path.extension() != ".csv")
    if (auto plain = open_plain_rows(path, sites, components)) return plain;
  return open_rows(path);
}

}  // namespace

void InitialRows::read_file() {
  const Settings& settings = scene_.settings;
  const Lattice& lattice = scene_.problem.lattice;
  file_ = open_initial(scene_.initial_file, lattice.sites(), scene_.initial.components);
  if (lattice.space() == Space::point && file_->sites() != 1)
    throw settings.error("lattice.space", fmt::format("the file {} has {} sites, and a point is one",
                                                      scene_.initial_file.string(), file_->sites()));
  if (file_->sites() != lattice.sites())
    throw settings.error("lattice.sites", fmt::format("the file {} has {} sites; use as many",
                                                      scene_.initial_file.string(), file_->sites()));
  for (const int frame : {frame_of(scene_, 0), frame_of(scene_, 1)})
    for (const double value : frame >= 0 && frame < file_->frames() ? file_->row(frame) : std::vector<double>())
      if (!std::isfinite(value))
        throw BadInput("initial.file", fmt::format("row {} holds what is no finite number; take earlier rows", frame));
  require_same_space();
  winding_ = winding_of_file();
  require_closed();
  take_own_step();
  if (scene_.start && scene_.start != StartRule::exact && scene_.start != rule())
    throw settings.error("initial.start",
                         "a file has rows, but no velocities; leave initial.start out, or give "
                         "initial.time_step, if the run has another step than the rows");
}

/// The file says where its sites lie, and on what.
void InitialRows::require_same_space() const {
  const auto* fields = dynamic_cast<const FieldsReader*>(file_.get());
  const Lattice& lattice = scene_.problem.lattice;
  if (!fields || lattice.space() == Space::point) return;
  const auto recorded = recorded_keys(fields->scene());
  const std::string here = lattice.is_circle() ? "circle" : "interval";
  if (const auto there = recorded.find("lattice.space"); there != recorded.end() && there->second != here)
    throw BadInput(
        "lattice.space",
        fmt::format("lattice.space = {}: the rows of {} lie on lattice.space = {}; use that, or leave out its "
                    "attribute scene",
                    here, scene_.initial_file.string(), there->second));
  const auto x = fields->positions();
  if (!x || x->size() < 2 || x->front() == x->back()) return;
  const double k = lattice.space_step(), first = is_placed(scene_) ? 0 : x->front();
  for (std::size_t i = 0; i < x->size(); ++i) {
    const double wanted = lattice.position(static_cast<int>(i)), found = (*x)[i] - first;
    if (std::abs(found - wanted) <= 1e-6 * k) continue;
    const double apart = (x->back() - x->front()) / static_cast<double>(x->size() - 1);
    throw BadInput(
        "lattice.length",
        fmt::format("lattice.length = {:.10g}: in {} site {} lies at {:.10g} of /space, and here at {:.10g}; "
                    "use lattice.length = {:.10g}, if its sites are evenly spaced, or correct /space",
                    lattice.length(), scene_.initial_file.string(), i, (*x)[i], wanted, apart * lattice.cells()));
  }
}

/// The scene or the file says it, or else the ends of the row do: where the step across the seam is longer than any other,
/// and a multiple of 2π takes it away.
int InitialRows::winding_of_file() const {
  if (!scene_.problem.lattice.is_circle()) return 0;
  const auto here = scene_.initial.winding, there = file_->winding();
  if (here && there && *here != *there)
    throw BadInput("boundary.winding",
                   fmt::format("boundary.winding = {}: the fields of {} wind {} times; use boundary.winding = {}, or "
                               "leave it out",
                               *here, scene_.initial_file.string(), *there, *there));
  if (here || there) return here.value_or(there.value_or(0));
  if (gain_of(scene_.problem.parameters) != 0) return 0;
  std::vector<double> row = file_->row(scene_.initial_frame);
  const int d = file_->components();
  if (scene_.problem.circle_valued) {
    unwrap_along(row, d);
    return static_cast<int>(std::lround(monodromy_of_row(row, d) / (2 * std::numbers::pi)));
  }
  constexpr double longer = 1.25;
  const RowSeam seam(row, d, 0);
  const double turns = std::round(-seam.step / (2 * std::numbers::pi));
  if (!(std::abs(seam.step) > longer * seam.largest) ||
      !(std::abs(seam.step + 2 * std::numbers::pi * turns) < 0.5 * std::abs(seam.step)))
    return 0;
  return static_cast<int>(turns);
}

/// A seam across which a field jumps is no circle. A tail that does not fit may be a small part of what the field spans.
void InitialRows::require_closed() const {
  if (!scene_.problem.lattice.is_circle() || scene_.problem.circle_valued) return;
  constexpr double largest_part = 0.01;
  const std::vector<double> row = file_->row(scene_.initial_frame);
  const int d = file_->components();
  double range = 0;  // of all fields: one of several may be small
  for (int a = 0; a < d; ++a) {
    const RowSeam seam(row, d, a);
    range = std::max(range, seam.most - seam.least);
  }
  for (int a = 0; a < d; ++a) {
    const RowSeam seam(row, d, a);
    const double jump = std::abs(seam.step + monodromy());
    const double rounding = 1e-12 * std::max(std::abs(seam.least), std::abs(seam.most));
    if (!(jump > 2 * seam.largest + std::max(largest_part * range, rounding))) continue;
    const double turns = seam.gain / (2 * std::numbers::pi);
    const bool winds = std::abs(turns - std::round(turns)) < 1e-2;
    const std::string field = d > 1 ? fmt::format("field {} of ", a) : std::string();
    throw BadInput("initial.file",
                   fmt::format("{}{} {} gains some {:.6g} around the circle, and with boundary.winding = {} it should "
                               "gain {:.6g}: it jumps at the seam by {:.3g}; use {}, or lattice.space = interval",
                               field, scene_.initial_file.extension() == ".csv" ? "row" : "frame", scene_.initial_frame,
                               seam.gain, winding_, monodromy(), jump,
                               winds ? fmt::format("boundary.winding = {:.0f}", std::round(turns))
                                     : fmt::format("boundary.gain = {:.6g} without boundary.winding", seam.gain)));
  }
}

/// Columns with the names of the scheme's fields are these fields; of other names the order tells.
std::vector<std::size_t> InitialRows::columns(const Simulation& simulation) const {
  std::vector<std::string> wanted;
  for (const Component& c : simulation.components())
    if (c.role == Role::field) wanted.push_back(c.name);
  std::vector<std::size_t> in_order(wanted.size());
  std::iota(in_order.begin(), in_order.end(), std::size_t{0});
  const std::vector<std::string> names = file_->names();
  if (names.size() != wanted.size()) return in_order;
  bool misplaced = false;
  std::vector<std::size_t> by_name;
  for (std::size_t a = 0; a < wanted.size(); ++a) {
    const std::size_t at = std::ranges::find(names, wanted[a]) - names.begin();
    misplaced = misplaced || (at < names.size() && at != a);
    by_name.push_back(at);
  }
  if (!misplaced) return in_order;
  if (std::ranges::count(by_name, names.size()) == 0) return by_name;
  throw scene_.settings.error("initial.file",
                              fmt::format("has the fields {}, and the scheme has {}; name its columns so",
                                          fmt::join(names, ", "), fmt::join(wanted, ", ")));
}

std::vector<double> InitialRows::in_order(const Simulation& simulation, const std::vector<double>& row) const {
  const std::vector<std::size_t> columns = this->columns(simulation);
  std::vector<double> ordered(row.size());
  for (std::size_t n = 0; n < row.size(); ++n)
    ordered[n] = row[n / columns.size() * columns.size() + columns[n % columns.size()]];
  return ordered;
}

/// Sites that move lie between the walls.
void InitialRows::require_positions(const Simulation& simulation) const {
  const Lattice& lattice = scene_.problem.lattice;
  if (lattice.space() != Space::interval) return;
  const std::size_t d = simulation.count(Role::field);
  const std::vector<double> row = file_row(simulation, 0);
  for (const Component& c : simulation.components()) {
    if (c.role != Role::field || !c.position) continue;
    const std::size_t a = c.field;
    const double first = row[a], last = row[row.size() - d + a], length = lattice.length();
    if (std::abs(first) <= 1e-9 * length && std::abs(last - length) <= 1e-9 * length) continue;
    throw scene_.settings.error(
        "lattice.length",
        fmt::format("the sites of {} lie from {} = {:.10g} to {:.10g}, and the walls at 0 and {:.10g}; "
                    "use lattice.length = {:.10g}, or move them to begin at 0",
                    scene_.initial_file.string(), c.name, first, last, length, last - first));
  }
}

/// The fields at the vertices, in the order of the scheme's.
std::vector<double> InitialRows::file_row(const Simulation& simulation, int row) const {
  return in_order(simulation, file_->row(frame_of(scene_, row)));
}

}  // namespace delf

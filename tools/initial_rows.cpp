// SPDX-License-Identifier: MIT
#include "tools/initial_rows.hpp"

#include <fmt/format.h>

#include <cmath>

namespace delf {

InitialRows::InitialRows(const Scene& scene) : scene_(scene) {
  const Settings& settings = scene.settings;
  try {
    if (scene.initial.name != "file") {
      state_ = make_state(scene.initial, scene.problem.lattice);
      if (rule() == StartRule::exact && !state_->knows_second_row())
        throw settings.error("initial.start", "the second row of this state is not known; use centred");
      return;
    }
    file_.emplace(scene.initial_file);
    if (scene.start == StartRule::centred)
      throw settings.error("initial.start", "a file has rows, but no velocities; leave initial.start out");
    if (file_->sites() != scene.problem.lattice.sites())
      throw settings.error("lattice.sites", fmt::format("the file {} has {} sites; use as many",
                                                        scene.initial_file.string(), file_->sites()));
  } catch (const BadInput& bad) {
    throw settings.located(bad);
  }
}

int InitialRows::winding() const {
  if (!scene_.problem.lattice.is_circle()) return 0;
  if (scene_.initial.winding) return *scene_.initial.winding;
  return state_ ? state_->winding() : file_->winding().value_or(0);
}

StartRule InitialRows::rule() const {
  if (file_) return StartRule::exact;
  return scene_.start.value_or(state_->knows_second_row() ? StartRule::exact : StartRule::centred);
}

std::string InitialRows::description() const {
  return state_ ? state_->description()
                : fmt::format("rows of {}, from frame {}", scene_.initial_file.string(), scene_.initial_frame);
}

std::vector<double> InitialRows::row0() const { return values(0); }

std::vector<double> InitialRows::values(int row) const {
  if (file_) return file_->row(scene_.initial_frame + row);
  const Lattice& lattice = scene_.problem.lattice;
  std::vector<double> out(static_cast<std::size_t>(lattice.sites()));
  state_->values(row * scene_.problem.time_step, lattice, out);
  return out;
}

void InitialRows::start(Simulation& simulation) const {
  const double h = scene_.problem.time_step;
  try {
    if (rule() == StartRule::centred) {
      const Lattice& lattice = scene_.problem.lattice;
      std::vector<double> velocity(static_cast<std::size_t>(lattice.sites()));
      state_->velocities(0, lattice, velocity);
      simulation.start_centred(values(0), velocity);
      return;
    }
    std::vector<std::vector<double>> rows;
    for (int j = 0; j < simulation.starting_rows(); ++j) {
      rows.push_back(values(j));
      if (!file_ || j == 0) continue;
      const int frame = scene_.initial_frame + j;
      const auto before = file_->time(frame - 1), after = file_->time(frame);
      if (before && after && !(std::abs(*after - *before - h) <= 1e-9 * h + 1e-15 * std::abs(*after)))
        throw BadInput("initial.frame", fmt::format("frames {} and {} of the file are {:.10g} apart, and the time step "
                                                    "is {:.10g}; record with output.every = 1, and use the same step",
                                                    frame - 1, frame, *after - *before, h));
    }
    simulation.start(rows);
  } catch (const BadInput& bad) {
    throw scene_.settings.located(bad);
  }
}

}  // namespace delf

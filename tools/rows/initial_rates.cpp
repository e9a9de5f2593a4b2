// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "lattice/index.hpp"
#include "schemes/theories/field_theory.hpp"
#include "tools/files/fields_reader.hpp"
#include "tools/rows/frame_of.hpp"
#include "tools/rows/initial_rows.hpp"
#include "tools/scene/values.hpp"

// Rows of a file that are another step apart than those of the run start by their values and rates.

namespace delf {

/// The step of the rows is initial.time_step, or that of their times. A table with times, and a scene with that key, mean
/// it: a run of another step starts by values and rates. Recorded rows of a run are gone on with.
void InitialRows::take_own_step() {
  if (scene_.problem.step_control) return;
  const double h = scene_.problem.time_step;
  auto given = Values(scene_.settings).maybe_real("initial.time_step");
  if (given) given = std::copysign(*given, h);
  const bool two = frame_of(scene_, 1) >= 0 && frame_of(scene_, 1) < file_->frames();
  const auto in_file = two ? step_in_file(1) : std::nullopt;
  const auto same = [&](double a, double b) {
    return std::abs(a - b) <= 1e-9 * std::abs(b) + 1e-15 * std::abs(file_->time(scene_.initial_frame).value_or(0));
  };
  if (in_file && given && !same(*in_file, *given))
    throw BadInput(
        "initial.time_step",
        fmt::format("initial.time_step = {:.10g}: rows {} and {} of the file are {:.10g} apart by its times; "
                    "leave it out",
                    *given, scene_.initial_frame, frame_of(scene_, 1), *in_file));
  const bool is_recorded = dynamic_cast<const FieldsReader*>(file_.get()) != nullptr;
  const auto step = given ? given : is_recorded ? std::nullopt : in_file;
  if (!step || same(*step, h)) return;
  if (!(*step * h > 0) || !std::isfinite(*step))
    throw BadInput("initial.file",
                   fmt::format("rows {} and {} are {:.10g} apart by their times; a row is later than the "
                               "one before it",
                               scene_.initial_frame, frame_of(scene_, 1), *step));
  own_step_ = step;
}

namespace {

/// The rate at the first of rows that are a step apart, of order 4 of five of them, and of as many as there are otherwise.
std::vector<double> rate_of(const std::vector<std::vector<double>>& rows, double step) {
  // φ_t(0) = Σ_j w_j φ(jh)/h, the derivative of Lagrange's polynomial
  const int n = static_cast<int>(rows.size());
  std::vector<double> rate(rows[0].size(), 0.0);
  for (int j = 1; j < n; ++j) {
    double weight = 1.0 / j;
    for (int m = 1; m < n; ++m)
      if (m != j) weight *= static_cast<double>(m) / (m - j);
    for (std::size_t i = 0; i < rate.size(); ++i) rate[i] += weight * (rows[j][i] - rows[0][i]) / step;
  }
  return rate;
}

constexpr int rows_of_rate = 5;

}  // namespace

/// The rows at their own step give φ_t; rows that the file has not are those of the scheme at that step.
void InitialRows::start_by_rates(Simulation& simulation) const {
  for (const Component& c : simulation.components())
    if (c.role == Role::trace || c.at.space != 0)
      throw BadInput("initial.time_step",
                     "initial.time_step: a file has no values at the nodes between the sites, which "
                     "this scheme starts from; choose another state");
  const std::size_t fields = simulation.count(Role::field);
  std::vector<std::vector<double>> rows;
  bool even = true;
  for (int j = 0; j < rows_of_rate && even && frame_of(scene_, j) >= 0 && frame_of(scene_, j) < file_->frames(); ++j) {
    const auto step = j > 0 ? step_in_file(j) : std::nullopt;
    even = !step || std::abs(*step - *own_step_) <= 1e-6 * std::abs(*own_step_);
    if (even) rows.push_back(file_row(simulation, j));
  }
  if (rows.size() < rows_of_rate) {
    Problem at_own_step = scene_.problem;
    at_own_step.time_step = *own_step_, at_own_step.winding = winding();
    Simulation own(at_own_step);
    if (own.count(Role::inner) > 0 || own.is_processed() || own.starting_rows() < 2)
      throw BadInput("initial.file", fmt::format("has {} rows a step apart, and the rates that this scheme starts from "
                                                 "take {}; give more",
                                                 rows.size(), rows_of_rate));
    std::vector<std::vector<double>> first;
    for (int j = 0; j < own.starting_rows(); ++j) first.push_back(section(own, j));
    own.start(first);
    rows.resize(own.starting_rows());
    while (rows.size() < rows_of_rate) {
      own.step();
      std::vector<double>& row = rows.emplace_back(at(scene_.problem.lattice.sites()) * fields);
      own.copy_row(0, row);
    }
  }
  const std::vector<double> rates = rate_of(rows, *own_step_), row0 = section(simulation, 0);
  const auto& components = simulation.components();
  std::vector<double> velocity(row0.size(), 0.0);
  for (std::size_t n = 0; n < velocity.size(); ++n) {
    const Component& c = components[n % components.size()];
    if (c.role == Role::field || c.role == Role::inner)
      velocity[n] = rates[n / components.size() * fields + at(c.field)];
  }
  if (rule() == StartRule::legendre) simulation.start_legendre(row0, velocity);
  else simulation.start_centred(row0, velocity);
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/scene/brick_rows.hpp"

#include <cmath>

#include "jets/tables/named_tables.hpp"
#include "schemes/methods/method_registry.hpp"
#include "tools/files/fields_reader.hpp"
#include "tools/scene/recorded_scene.hpp"

namespace delf {

namespace {

constexpr auto brick_key = "lattice.first_row";

bool is_brick_wall(const Problem& p) {
  if (!find_method(p.method).reads_stencil) return false;
  for (const NamedTable& stencil : named_tables())
    if (stencil.name == p.stencil) return stencil.table.pattern.placement == Placement::brick_wall;
  return false;
}

}  // namespace

void take_first_row(Scene& scene, const std::filesystem::path& file, int frame) {
  Problem& p = scene.problem;
  if (scene.settings.find(brick_key) || !is_brick_wall(p)) return;
  long long row = frame;
  try {
    const auto rows = open_rows(file);
    if (const auto time = rows->time(frame)) {
      const double steps = *time / p.time_step;
      if (std::abs(steps) < 1e15 && std::abs(steps - std::round(steps)) < 1e-3) row = std::llround(steps);
    }
    const auto* fields = dynamic_cast<const FieldsReader*>(rows.get());
    if (fields)
      if (const auto keys = recorded_keys(fields->scene()); keys.contains(brick_key) && keys.at(brick_key) == "1") ++row;
  } catch (const BadInput&) {
  }
  p.parameters[brick_key] = static_cast<int>(row & 1);
}

}  // namespace delf

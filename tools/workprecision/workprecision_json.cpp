// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "tools/files/csv_cell.hpp"
#include "tools/outcome/findings_json.hpp"
#include "tools/report/step_clock.hpp"
#include "tools/workprecision/workprecision_outcome.hpp"

namespace delf {

namespace {

Json json_of(const WorkPrecisionRun& r) {
  return {{"scheme", r.scheme},
          {"peer", r.peer},
          {"own", r.own},
          {"sites", r.sites},
          {"time_step", r.time_step},
          {"courant", r.time_step / r.space_step},
          {"steps", r.steps},
          {"error_linf", r.error_linf},
          {"error_l2", r.error_l2},
          {"energy_error_max", r.energy_error_max},
          {"forces_per_step", r.forces_per_step},
          {"position_error", r.position_error},
          {"velocity_error", r.velocity_error},
          {"seconds", r.seconds},
          {"seconds_min", r.seconds_min},
          {"seconds_max", r.seconds_max},
          {"seconds_setup", r.seconds_setup},
          {"repeats", r.repeats},
          {"on_envelope", r.on_envelope}};
}

Json winner(const WorkPrecisionOutcome& o, const std::optional<std::size_t>& index) {
  if (!index) return {};
  const WorkPrecisionRun& r = o.runs[*index];
  return {{"scheme", r.scheme},
          {"sites", r.sites},
          {"time_step", r.time_step},
          {"error_linf", r.error_linf},
          {"seconds", r.seconds}};
}

}  // namespace

std::string workprecision_json(const Scene& scene, const WorkPrecisionRequest& request, const WorkPrecisionOutcome& o) {
  Json json = json_head(scene);
  json["status"] = o.status;
  json["theory"] = scene.problem.theory;
  json["length"] = scene.problem.lattice.length();
  json["until"] = request.until;
  json["seed"] = request.seed;
  json["repeats"] = request.repeats;
  json["budget"] = request.budget;
  json["clock"] = time_of_steps(scene.problem.threads);
  json["unsteady"] = o.unsteady;
  json["reference"] = o.reference;
  json["reference_error"] = o.reference_error;
  json["seconds"] = o.seconds;
  json["tried"] = o.tried;
  json["runs"] = json_list(o.runs, [](const WorkPrecisionRun& run) { return json_of(run); });
  json["schemes"] = json_list(o.lines, [&](const WorkPrecisionLine& line) {
    return Json{
        {"scheme", line.scheme},
        {"peer", line.peer},
        {"own", line.own},
        {"slope", line.slope},
        {"order", line.order},
        {"forces_per_step", line.front.empty() ? WorkPrecisionRun::unknown : o.runs[line.front.back()].forces_per_step},
        {"front", line.front}};
  });
  json["cheapest"] = json_list(o.costs, [&](const WorkPrecisionCost& cost) {
    return Json{{"accuracy", cost.accuracy},
                {"engine", winner(o, cost.engine)},
                {"peer", winner(o, cost.peer)},
                {"ratio", cost.ratio},
                {"tuned", winner(o, cost.tuned)},
                {"tuned_ratio", cost.tuned_ratio},
                {"processed_peer", winner(o, cost.processed_peer)},
                {"processed_ratio", cost.processed_ratio}};
  });
  json["left_out"] =
      json_list(o.left_out, [](const auto& one) { return Json{{"scheme", one.scheme}, {"reason", one.reason}}; });
  return json_text(json);
}

std::string workprecision_csv(const WorkPrecisionOutcome& o) {
  std::string text =
      "scheme,peer,sites,time_step,steps,error_linf,error_l2,energy_error_max,position_error,velocity_error,seconds,"
      "seconds_min,seconds_max,seconds_setup,repeats,on_envelope,forces_per_step\n";
  for (const WorkPrecisionRun& r : o.runs)
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_cell(r.scheme), r.peer ? 1 : 0,
                        r.sites, r.time_step, r.steps, r.error_linf, r.error_l2, r.energy_error_max, r.position_error,
                        r.velocity_error, r.seconds, r.seconds_min, r.seconds_max, r.seconds_setup, r.repeats,
                        r.on_envelope ? 1 : 0, r.forces_per_step);
  return text;
}

}  // namespace delf

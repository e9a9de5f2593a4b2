// SPDX-License-Identifier: MIT
#include "tools/page/numbers.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string_view>

namespace delf {
namespace {

struct Meaning {
  const char *key, *name, *meaning, *worry;
  std::optional<double> most = {};  ///< an absolute value above it is worrying
};

const Meaning meanings[] = {
    {"energy_initial", "energy of row 0", "It is measured on the first rows.", ""},
    {"energy_final", "energy of the last row", "It is measured in the same way.", ""},
    {"energy_error_max", "largest relative change of the energy",
     "Variational schemes keep the energy within a band whose width goes as the square of the step, or a higher power.",
     "above 1 %, on a mesh 10 %, or where it grows all along", 0.01},
    {"energy_work", "work of the density", "The density reads t, and changes the energy by this.", ""},
    {"momentum_initial", "momentum of row 0", "It is conserved where the theory is the same at all x.", ""},
    {"momentum_final", "momentum of the last row", "The lattice breaks the symmetry: it is kept nearly.",
     "a steady drift"},
    {"charge_final", "winding of the last row", "(φ(L) − φ(0))/2π counts the kinks less the antikinks.",
     "a value that is not near a whole number, for a theory of angles"},
    {"residual_max", "largest residual of the equations",
     "It is divided by the sum of the absolute terms: 1e-16 is rounding.", "above 1e-10", 1e-10},
    {"iterations_mean", "iterations of a step", "A step that is solved at once has none.",
     "near scheme.max_iterations"},
    {"iterations_max", "most iterations of a step", "A step that is solved at once has none.",
     "near scheme.max_iterations"},
    {"constraint_max", "largest constraint", "The constraints G = 0 hold to this.", "above 1e-8", 1e-8},
    {"error_linf", "largest error of the last row", "It is the distance from the exact solution at one site.",
     "as large as the field itself"},
    {"error_l2", "error of the last row in L2", "√(k Σ e²), against the exact solution.",
     "as large as the field itself"},
    {"seconds", "seconds of all steps", "Files and figures are not counted.", ""},
    {"ns_per_site_step", "nanoseconds for a site and step", "It tells how fast the scheme is on this machine.", ""},
    {"bytes", "bytes of memory", "They hold rows, matrices and work space.", ""},
};

}  // namespace

std::vector<PageNumber> numbers_of(const ResultFolder& folder) {
  const Json* summary = folder.result("summary");
  const double coarse = text_in(summary, "space") == "complex" ? 10 : 1;  // meshes are, as their warnings allow for
  const bool on_point = text_in(summary, "space") == space_of_mechanics,
             is_static = number_in(summary, "steps").value_or(1) == 0 && !number_in(summary, "time_step");
  const std::string energy_of = text_in(summary, "energy_of");
  // what says nothing of mechanics, or of a problem without time
  const auto is_left_out = [&](const std::string& key) {
    return (on_point && (key.starts_with("momentum_") || key == "charge_final")) ||
           (is_static && (key == "energy_final" || key == "energy_error_max"));
  };
  std::vector<PageNumber> numbers;
  for (const Meaning& m : meanings)
    if (const auto value = number_in(summary, m.key); value && !is_left_out(m.key)) {
      numbers.push_back(
          {m.name, number_text(value), m.meaning, m.worry, m.most && std::abs(*value) > coarse * *m.most});
      if (std::string_view(m.key) != "energy_initial") continue;
      if (is_static) numbers.back() = {"energy", number_text(value), "It is that of the solution.", ""};
      else if (!energy_of.empty())
        numbers.back().meaning = fmt::format("It is measured on the first rows: {}.", energy_of);
    }
  for (const Json& sum : list_in(summary, "conserved")) {
    const auto error = number_in(&sum, "error_max");
    const bool at_walls = is_true_in(&sum, "at_walls");
    if (error)
      numbers.push_back({"largest change of " + text_in(&sum, "name"), number_text(error),
                         at_walls ? "The ends of space give or take this quantity."
                                  : "The scheme conserves it; the change is relative to the absolute terms of its sum.",
                         at_walls ? "" : "above 1e-10, unless it is known to a power of the step only"});
  }
  if (summary && summary->contains("measures") && (*summary)["measures"].is_object())
    for (const auto& [name, value] : (*summary)["measures"].items())
      if (value.is_number())
        numbers.push_back(
            {name, number_text(value.get<double>()), "The scene defines it as measure." + name + ".", ""});
  if (summary && summary->contains("error_estimate")) {
    const Json* estimate = &(*summary)["error_estimate"];
    numbers.push_back({"estimated error of the last row", number_text(number_in(estimate, "error")),
                       "Two more runs with halved steps give it.", "larger than the accuracy that is needed"});
  }
  return numbers;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/outcome/outcome.hpp"

#include <cmath>

#include "schemes/stepping/saved_state.hpp"

namespace delf {

void Conserved::take(double J, double terms) {
  final = J;
  if (std::isnan(J)) return;
  if (std::isnan(initial)) initial = J;
  const double error = std::abs(J - initial) / (terms > 0 ? terms : 1);
  if (!(error <= error_max)) error_max = error;
}

void Outcome::visit(SavedState& saved) {
  saved("limit", limit);
  saved("steps taken", steps_taken), saved("records", records), saved("seconds", seconds);
  saved("shortest step", shortest), saved("longest step", longest);
  saved("most iterations", iterations_max), saved("largest residual", residual_max);
  for (const Continued why : {Continued::stiff, Continued::slow, Continued::out_of_iterations, Continued::far}) {
    const auto found = continued.find(why);
    std::int64_t count = found == continued.end() ? 0 : found->second;
    saved("steps by continuation", count);
    if (count > 0) continued[why] = count;
  }
  saved("energy of row 0", energy_initial), saved("energy", energy_final);
  saved("momentum of row 0", momentum_initial), saved("momentum", momentum_final), saved("charge", charge_final);
  saved("largest constraint", constraint_max), saved("extremes of monitors", of_method);
  for (Conserved& c : conserved)
    saved("conserved at row 0", c.initial), saved("conserved", c.final), saved("change of conserved", c.error_max),
        saved("conserved but at walls", c.at_walls);
}

}  // namespace delf

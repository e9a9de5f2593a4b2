// SPDX-License-Identifier: MIT
#include "tools/warnings/waves_in_words.hpp"

#include <fmt/format.h>

#include <cmath>

#include "schemes/stability/linear_stability.hpp"
#include "schemes/stability/parasites.hpp"
#include "tools/warnings/vacuum_symbol.hpp"

namespace delf {

std::string waves_in_words(const Scene& scene, const Simulation& simulation) {
  const auto symbol = symbol_of(scene, simulation);
  if (!symbol) return {};
  const StabilityVerdict verdict = linear_stability(*symbol, symbol->size() > 1 ? 33 : 101);
  std::string words = verdict.stable ? "none grows exponentially"
                      : std::isfinite(verdict.amplification)
                          ? fmt::format("those near qk = {:.3g} grow by {:.4g} in each step", verdict.worst_theta,
                                        verdict.amplification)
                          : fmt::format("without walls no step determines those of qk = {:.3g}", verdict.worst_theta);
  for (const Ghost& ghost : verdict.ghosts) words += "\n" + ghost.words;
  for (const Parasite& parasite : parasites(*symbol))
    words += fmt::format("\n{} is a wave of the scheme ({} root{}), and none of the theory", parasite.wave,
                         parasite.roots, parasite.roots > 1 ? "s" : "");
  return fmt::format("about the field {:.6g}: {}", *stable_vacuum(scene, simulation), words);
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "jets/tables/splitting.hpp"

namespace delf {

/// A splitting as a scene names it. Every one is an explicit symplectic Nyström method of its order on an action whose
/// φ_t enters as ½φ_t² alone; `kicks` counts evaluations of the force a step.
struct NamedSplitting {
  std::string name;
  int order, kicks;
  Splitting (*make)();
  std::vector<std::string> sources = {};  ///< keys of tools/cite/references.bib
};
/// leapfrog; mclachlan-4, blanes-moan-4; okunbor-skeel-6, blanes-moan-6, blanes-moan-6a; kahan-li-8.
const std::vector<NamedSplitting>& named_splittings();

}  // namespace delf

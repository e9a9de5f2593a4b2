// SPDX-License-Identifier: MIT
#pragma once

namespace delf {

/// Energy and momentum of a row, summed over space.
struct EnergyMomentum {
  double energy = 0, momentum = 0;
};

}  // namespace delf

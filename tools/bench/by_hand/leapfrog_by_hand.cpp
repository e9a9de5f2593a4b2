// SPDX-License-Identifier: MIT
#include "tools/bench/by_hand/leapfrog_by_hand.hpp"

#include "jets/simd/pack_math.hpp"
#include "schemes/stepping/flush_denormals.hpp"

namespace delf::bench {

LeapfrogByHand::LeapfrogByHand(const Lattice& lattice, double h)
    : layout_(lattice, 1),
      rows_(layout_, 2),
      squared_ratio_(h * h / (lattice.space_step() * lattice.space_step())),
      squared_step_(h * h) {}

void LeapfrogByHand::start(const std::vector<double>& row0, const std::vector<double>& row1) {
  std::vector<double> increment(row1);
  for (std::size_t i = 0; i < increment.size(); ++i) increment[i] -= row0[i];
  layout_.scatter(row1, rows_.row(0));
  layout_.scatter(increment, rows_.row(1));
}

// Slots that hold the same site get the same value from the same neighbours: only halos are filled anew.
void LeapfrogByHand::step() {
  const FlushDenormals guard;
  double *y = rows_.row(0) + layout_.at(0), *v = rows_.row(1) + layout_.at(0);
  const double* const end = y + static_cast<std::ptrdiff_t>(layout_.packs()) * lanes;
  Pack left = Pack::load(y - lanes), here = Pack::load(y);
  for (; y != end; y += lanes, v += lanes) {
    const Pack right = Pack::load(y + lanes);
    const Pack increment =
        Pack::load(v) + (squared_ratio_ * ((right - here) - (here - left)) - squared_step_ * sin(here));
    increment.store(v);
    (here + increment).store(y);
    left = here;
    here = right;
  }
  layout_.fill_halo(rows_.row(0));
}

std::vector<double> LeapfrogByHand::row() const {
  std::vector<double> sites(layout_.sites());
  layout_.gather(rows_.row(0), sites);
  return sites;
}

}  // namespace delf::bench

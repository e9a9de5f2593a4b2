// SPDX-License-Identifier: MIT
#include "schemes/system/cell_jet.hpp"

#include <algorithm>
#include <limits>

#include "lattice/index.hpp"

namespace delf {

CellJets::CellJets(const BatchDensity& density, const Lattice& lattice, double time_step, double monodromy)
    : lattice_(lattice),
      components_(density.components()),
      time_step_(time_step),
      monodromy_(monodromy),
      second_order_(density.slots() > 3),
      jet_(delf::at(density.variables())) {}

double CellJets::value(std::span<const double> row, int site, int component) const {
  const int home = lattice_.home(site), turns = (site - home) / lattice_.sites();
  return row[home * components_ + component] + turns * monodromy_;
}

double CellJets::second_difference(std::span<const double> row, int site, int component) const {
  // an interval of two sites has no second differences
  if (lattice_.space() == Space::interval && lattice_.sites() > 2) site = std::clamp(site, 1, lattice_.sites() - 2);
  else if (!lattice_.is_circle()) return 0;
  return value(row, site - 1, component) - 2 * value(row, site, component) + value(row, site + 1, component);
}

const double* CellJets::at(int cell, std::span<const double> below, std::span<const double> above) {
  const double h = time_step_, k = lattice_.space_step();
  const int d = components_, next = lattice_.space() == Space::point ? cell : cell + 1;
  for (int a = 0; a < d; ++a) {
    const auto slot = [&](int s) -> double& { return jet_[s * d + a]; };
    const double y_0 = value(below, cell, a), y_1 = value(below, next, a);
    const double z_0 = value(above, cell, a), z_1 = value(above, next, a);
    slot(0) = 0.25 * (y_0 + y_1 + z_0 + z_1);
    slot(1) = (z_0 + z_1 - y_0 - y_1) / (2 * h);
    slot(2) = (y_1 + z_1 - y_0 - z_0) / (2 * k);
    if (!second_order_) continue;
    slot(3) = std::numeric_limits<double>::quiet_NaN();
    slot(4) = (z_1 - z_0 - y_1 + y_0) / (h * k);
    slot(5) = 0;
    for (const auto& row : {below, above})
      for (const int site : {cell, next}) slot(5) += 0.25 * second_difference(row, site, a) / (k * k);
  }
  return jet_.data();
}

}  // namespace delf

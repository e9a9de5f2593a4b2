// SPDX-License-Identifier: MIT
#include "schemes/system/assembled_row.hpp"

#include "schemes/system/assembly.hpp"

namespace delf {

void AssembledRow::equations(const Window& window, std::int64_t row, std::vector<LatticeSystem::Value>& values) {
  const int reach = system_->height(), parity = system_->placement() == Placement::brick_wall ? row & 1 : 0;
  auto& assembly = of_parity_[parity];
  if (!assembly) {
    std::vector<Node> all;
    for (int i = 0; i < system_->lattice().sites(); ++i)
      for (int c = 0; c < system_->components(); ++c) all.push_back({{0, i}, c});
    assembly = std::make_shared<const Assembly>(*system_, Assembly::Parts{.equations = std::move(all),
                                                                          .parity = parity,
                                                                          .past = reach,
                                                                          .future = reach,
                                                                          .monodromy = window.monodromy});
  }
  std::vector<double> E, absolute;
  assembly->residual(SectionRing(window, row - reach, row + reach), row, E, &absolute);
  values.resize(E.size());
  for (std::size_t n = 0; n < E.size(); ++n) values[n] = {E[n], absolute[n]};
}

}  // namespace delf

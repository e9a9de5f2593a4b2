// SPDX-License-Identifier: MIT
#include "schemes/system/assembled_row.hpp"

#include "schemes/system/assembly.hpp"

namespace delf {

bool AssembledRow::of_bricks() const { return system_->placement() == Placement::brick_wall; }

const Assembly& AssembledRow::assembly(int parity, double turn) {
  auto& found = of_parity_[static_cast<std::size_t>(parity)];
  if (found) return *found;
  const int reach = system_->height();
  std::vector<Node> all;
  for (int i = 0; i < system_->lattice().sites(); ++i)
    for (int c = 0; c < system_->components(); ++c) all.push_back({{0, i}, c});
  found = std::make_shared<const Assembly>(
      *system_,
      Assembly::Parts{.equations = std::move(all), .parity = parity, .past = reach, .future = reach, .turn = turn});
  return *found;
}

void AssembledRow::prepare(double turn) {
  for (int parity = 0; parity < (of_bricks() ? 2 : 1); ++parity) assembly(parity, turn);
}

std::size_t AssembledRow::bytes() const {
  std::size_t sum = 0;
  for (const auto& assembly : of_parity_)
    if (assembly) sum += assembly->bytes();
  return sum;
}

void AssembledRow::equations(const Window& window, std::int64_t row, std::vector<LatticeSystem::Value>& values) {
  const int reach = system_->height();
  const Assembly& of_row = assembly(of_bricks() ? static_cast<int>(row & 1) : 0, window.turn);
  std::vector<double> E, absolute;
  of_row.residual(SectionRing(window, row - reach, row + reach), row, E, &absolute);
  values.resize(E.size());
  for (std::size_t n = 0; n < E.size(); ++n) values[n] = {E[n], absolute[n]};
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/row_layout.hpp"

#include <algorithm>
#include <new>

namespace delf {

RowLayout::RowLayout(const Lattice& lattice, int halo, int aligned)
    : sites_(lattice.sites()), packs_((sites_ / aligned + lanes - 1) / lanes * aligned), halo_(halo) {
  for (int l = 0; l < lanes; ++l)
    start_.push_back(
        std::min(static_cast<int>(static_cast<long long>(l) * (sites_ / aligned) / lanes) * aligned, sites_ - packs_));
  for (int l = 0; l < lanes; ++l)
    for (int v = -halo_; v < packs_ + halo_; ++v) {
      const int i = start(l) + v, to = static_cast<int>(at(v)) + l;
      const bool inside = v >= 0 && v < packs_;
      if (inside) {
        if (slot(i) != to) overlap_copies_.push_back({to, slot(i), 0});
      } else if (lattice.is_circle()) {
        const int home = lattice.wrapped(i);
        halo_copies_.push_back({to, slot(home), (i - home) / sites_});
      } else {
        halo_copies_.push_back({to, slot(std::clamp(i, 0, sites_ - 1)), 0});
      }
    }
}

std::vector<int> RowLayout::slots_of(int i) const {
  std::vector<int> slots;
  for (int l = 0; l < lanes; ++l)
    if (i >= start(l) && i < start(l) + packs_) slots.push_back(static_cast<int>(at(i - start(l))) + l);
  return slots;
}

void RowLayout::scatter(std::span<const double> sites, double* row, double turn) const {
  for (int l = 0; l < lanes; ++l)
    for (int v = 0; v < packs_; ++v) row[at(v) + l] = sites[static_cast<std::size_t>(start(l) + v)];
  fill_halo(row, turn);
}

void RowLayout::gather(const double* row, std::span<double> sites) const {
  for (int l = 0; l < lanes; ++l)
    for (int v = 0; v < packs_; ++v) sites[static_cast<std::size_t>(start(l) + v)] = row[at(v) + l];
}

RowBuffer::RowBuffer(const RowLayout& layout, int rows) : RowBuffer(layout.doubles(), rows) {}

RowBuffer::RowBuffer(std::size_t stride, int rows) : stride_(stride), rows_(rows) {
  constexpr std::size_t line = 64;
  stride_ = (stride_ + 7) / 8 * 8;
  if (rows == 0) return;
  const std::size_t bytes = stride_ * sizeof(double) * static_cast<std::size_t>(rows);
  auto* p = static_cast<double*>(std::aligned_alloc(line, (bytes + line - 1) / line * line));
  if (!p) throw std::bad_alloc();
  data_.reset(p);
  std::fill_n(p, stride_ * static_cast<std::size_t>(rows), 0.0);
}

}  // namespace delf

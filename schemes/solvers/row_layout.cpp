// SPDX-License-Identifier: MIT
#include "schemes/solvers/row_layout.hpp"

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <algorithm>
#include <new>

#include "lattice/index.hpp"

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
        // A point stands in all lanes, which find the same.
        if (slot(i) != to && sites_ > 1) overlap_copies_.push_back({to, slot(i), 0});
      } else if (lattice.is_circle()) {
        const int home = lattice.wrapped(i);
        halo_copies_.push_back({to, slot(home), (i - home) / sites_});
      } else if (sites_ > 1) {
        halo_copies_.push_back({to, slot(std::clamp(i, 0, sites_ - 1)), 0});
      }
    }
  if (lattice.is_circle()) find_halo_packs();
}

void RowLayout::fill_halo_turned(double* row, double monodromy) const {
  if (sites_ == 1) {
    const Pack point = Pack::load(row + at(0));
    for (int v = -halo_; v <= halo_; ++v) point.store(row + at(v));
    return;
  }
  if (!by_packs_) {
    for (const Copy& c : halo_copies_) row[c.to] = row[c.from] + c.turns * monodromy;
    return;
  }
  for (std::ptrdiff_t by = 0; by < at(0); by += lanes) {
    const std::ptrdiff_t back = -(by + lanes);
    (before_.pack(row, back) + monodromy * turns_before_).store(row + before_.to + back);
    (after_.pack(row, by) + monodromy * turns_after_).store(row + after_.to + by);
  }
}

/// Arc l overlaps the one before it by b_l sites: beside its first pack stands pack M − b_l − 1 of that arc, beside its
/// last one pack b_{l+1} of the next. Where more than two b_l occur, or arcs are shorter than halos, slots are copied
/// one by one.
void RowLayout::find_halo_packs() {
  int overlap[lanes];
  for (int l = 0; l < lanes; ++l)
    overlap[l] = packs_ - (start(l) - (l == 0 ? start(lanes - 1) - sites_ : start(l - 1)));
  const auto [least, most] = std::ranges::minmax(overlap);
  by_packs_ = std::ranges::all_of(overlap, [&](int b) { return b == least || b == most; }) && least >= 0 && halo_ > 0 &&
              most + halo_ <= packs_;
  if (!by_packs_) return;
  // Set by copy_overlaps() are the last b_{l+1} packs of arc l: no halo is taken from these where arcs are long enough.
  halos_come_first_ = 2 * most + halo_ <= packs_;
  before_ = {.to = at(0), .from = at(packs_ - least), .from_others = at(packs_ - most)};
  after_ = {.to = at(packs_), .from = at(least), .from_others = at(most)};
  for (int l = 0; l < lanes; ++l) {
    before_.is_other.v[l] = overlap[(l + 1) % lanes] == most ? 1 : 0;
    after_.is_other.v[l] = overlap[l] == most ? 1 : 0;
  }
  turns_before_.v[0] = -1;
  turns_after_.v[lanes - 1] = 1;
}

std::vector<int> RowLayout::slots_of(int i) const {
  std::vector<int> slots;
  for (int l = 0; l < lanes; ++l)
    if (i >= start(l) && i < start(l) + packs_) slots.push_back(static_cast<int>(at(i - start(l))) + l);
  return slots;
}

void RowLayout::scatter(std::span<const double> sites, double* row, double monodromy) const {
  for (int l = 0; l < lanes; ++l)
    for (int v = 0; v < packs_; ++v) row[at(v) + l] = sites[start(l) + v];
  fill_halo(row, monodromy);
}

void RowLayout::gather(const double* row, std::span<double> sites) const {
  for (int l = 0; l < lanes; ++l)
    for (int v = 0; v < packs_; ++v) sites[start(l) + v] = row[at(v) + l];
}

RowBuffer::RowBuffer(const RowLayout& layout, int rows) : RowBuffer(layout.doubles(), rows) {}

RowBuffer::RowBuffer(std::size_t doubles, int rows) : stride_(stride_of(doubles)), rows_(rows) {
  constexpr std::size_t line = 64, huge_page = 1 << 21;
  if (rows == 0) return;
  const std::size_t bytes = stride_ * sizeof(double) * at(rows);
  // Rows that come from memory come a tenth faster by pages of 2 MB, which Linux gives to those who ask.
  const std::size_t alignment = bytes < 8 * huge_page ? line : huge_page;
  auto* p = static_cast<double*>(std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment));
  if (!p) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  if (alignment == huge_page) madvise(p, bytes, MADV_HUGEPAGE);  // if it may not, pages are small
#endif
  data_.reset(p);
  std::fill_n(p, stride_ * at(rows), 0.0);
}

}  // namespace delf

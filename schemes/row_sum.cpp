// SPDX-License-Identifier: MIT
#include "schemes/row_sum.hpp"

#include <cmath>
#include <stdexcept>

namespace delf {

void RowSum::add(const double* row, std::ptrdiff_t shift, double coefficient, double alternating, bool difference) {
  auto& entries = alternating != 0 ? alternating_entries_ : difference ? difference_entries_ : plain_entries_;
  std::size_t& count = alternating != 0 ? alternating_ : difference ? differences_ : plain_;
  if (count == most) throw std::length_error("delf: raise RowSum::most for a stencil of this many terms");
  entries[count++] = {row, shift, coefficient, alternating, difference};
}

template <int count>
void RowSum::plain_pass(const RowLayout& layout, const Entry* e, double constant, double* out) {
  const double* p[count];
  double c[count];
  for (int i = 0; i < count; ++i) p[i] = e[i].row + e[i].shift, c[i] = e[i].coefficient;
  for (int v = 0; v < layout.packs(); ++v) {
    const std::ptrdiff_t at = layout.at(v);
    Pack sum = Pack::load(out + at) + constant;
    for (int i = 0; i < count; ++i) sum += c[i] * Pack::load(p[i] + at);
    sum.store(out + at);
  }
}

template <int count>
void RowSum::difference_pass(const RowLayout& layout, const Entry* e, double* out) {
  const double *p[count], *own[count];
  double c[count];
  for (int i = 0; i < count; ++i) own[i] = e[i].row, p[i] = e[i].row + e[i].shift, c[i] = e[i].coefficient;
  for (int v = 0; v < layout.packs(); ++v) {
    const std::ptrdiff_t at = layout.at(v);
    Pack sum = Pack::load(out + at);
    for (int i = 0; i < count; ++i) sum += c[i] * (Pack::load(p[i] + at) - Pack::load(own[i] + at));
    sum.store(out + at);
  }
}

void RowSum::evaluate(const RowLayout& layout, double constant, double constant_alternating, const double* signs,
                      double* out, double* absolute) const {
  const Entry* e = plain_entries_.data();
  std::size_t left = plain_;
  for (; left >= 4; left -= 4, e += 4, constant = 0) plain_pass<4>(layout, e, constant, out);
  if (left == 3) plain_pass<3>(layout, e, constant, out), constant = 0;
  if (left == 2) plain_pass<2>(layout, e, constant, out), constant = 0;
  if (left == 1) plain_pass<1>(layout, e, constant, out), constant = 0;
  e = difference_entries_.data();
  for (left = differences_; left >= 2; left -= 2, e += 2) difference_pass<2>(layout, e, out);
  if (left == 1) difference_pass<1>(layout, e, out);

  if (alternating_ == 0 && constant == 0 && constant_alternating == 0 && !absolute) return;
  for (int v = 0; v < layout.packs(); ++v) {
    const std::ptrdiff_t at = layout.at(v);
    const Pack sign = signs ? Pack::load(signs + at) : Pack(0.0);
    Pack sum = constant + constant_alternating * sign, size(0.0);
    const auto term = [at, sign](const Entry& t) {
      const Pack own = t.difference ? Pack::load(t.row + at) : Pack(0.0);
      return (t.coefficient + t.alternating * sign) * (Pack::load(t.row + t.shift + at) - own);
    };
    for (std::size_t i = 0; i < alternating_; ++i) {
      const Pack x = term(alternating_entries_[i]);
      sum += x;
      size += abs(x);
    }
    (Pack::load(out + at) + sum).store(out + at);
    if (!absolute) continue;
    for (std::size_t i = 0; i < plain_; ++i) size += abs(term(plain_entries_[i]));
    for (std::size_t i = 0; i < differences_; ++i) size += abs(term(difference_entries_[i]));
    (Pack::load(absolute + at) + size).store(absolute + at);
  }
}

}  // namespace delf

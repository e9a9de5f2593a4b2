// SPDX-License-Identifier: MIT
#include "schemes/solvers/row_sum.hpp"

namespace delf {
namespace {

struct Store {
  double* out;
  void operator()(std::ptrdiff_t at, Pack sum) const { sum.store(out + at); }
};
struct StoreDense {
  double* out;
  void operator()(std::ptrdiff_t, Pack sum) { sum.store(out), out += lanes; }
};

}  // namespace

void RowSum::evaluate(const double* const* rows, std::ptrdiff_t from, std::ptrdiff_t to, std::ptrdiff_t stride,
                      double* out) const {
  Store sink{out};
  if (stride == lanes) pass<lanes>(rows, from, to, sink);
  else pass<2 * lanes>(rows, from, to, sink);
}
void RowSum::evaluate_dense(const double* const* rows, std::ptrdiff_t from, std::ptrdiff_t to, std::ptrdiff_t stride,
                            double* out) const {
  StoreDense sink{out};
  if (stride == lanes) pass<lanes>(rows, from, to, sink);
  else pass<2 * lanes>(rows, from, to, sink);
}

}  // namespace delf

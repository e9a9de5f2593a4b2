// SPDX-License-Identifier: MIT
#include "schemes/families/residual_family.hpp"

#include "schemes/theories/phi4.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "schemes/families/vu_quoc_li.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double h = 0.2, k = 0.3;
constexpr int N = 19;

/// The largest difference between E of (5.14) at the rows of four, and its linear part with what stencils centred there
/// and a row below share; `of_below` times the latter.
template <class Theory>
double shared_defect(const Theory& theory, double of_below) {
  using Stencil = VuQuocLi<Theory>;
  const ResidualFamily<Stencil> family(Stencil{theory}, h, k);
  const RowKernel& kernel = *family.row_kernel();
  const Lattice ring = Lattice::circle(N, N * k);
  const RowLayout layout(ring, 1);
  Random random(7);
  std::vector<Row> y;
  RowBuffer rows(layout, 4), out(layout, 2);
  for (int r = 0; r < 4; ++r) {
    y.push_back(random_row(random, N, 2));
    layout.scatter(y.back(), rows.row(r));
  }
  for (int below = 0; below < 2; ++below) {  // centred at the row 2, at the row 1
    const double* const slab[] = {rows.row(1 - below), rows.row(2 - below), rows.row(3 - below)};
    double* const outputs[] = {out.row(below)};
    kernel.evaluate({&layout, slab, nullptr, 0, h, k}, outputs);
  }
  std::vector<double> stencil(9), r(9), J(81), r0(9);
  const Cell cell{h, k, 0, 0};
  kernel.linear_part(cell, J, r0);
  double worst = 0;
  for (int i = 0; i < N; ++i) {
    double sum = r0[Stencil::centre];
    for (int l = 0; l < 9; ++l) {
      const Site at = Stencil::shape.vertex(l);
      const double value =
          y[static_cast<std::size_t>(2 + at.time)][static_cast<std::size_t>(ring.wrapped(i + at.space))];
      stencil[static_cast<std::size_t>(l)] = value;
      sum += J[static_cast<std::size_t>(9 * Stencil::centre + l)] * value;
    }
    const int slot = layout.slot(i);
    sum += kernel.weight(0, 4) * out.row(0)[slot] + of_below * kernel.weight(0, 7) * out.row(1)[slot];
    family.residual(cell, stencil, r);
    worst = std::max(worst, std::abs(sum - r[Stencil::centre]));
  }
  return worst;
}

}  // namespace

TEST_CASE("(5.14) is its linear part and the halves of one quotient that two rows share") {
  CHECK(shared_defect(SineGordon{1.3}, 1) < 1e-15);
  CHECK(shared_defect(PhiFour{}, 1) < 1e-15);
  for (double of_below : {0.0, -1.0, 0.99}) CHECK(shared_defect(SineGordon{1.3}, of_below) > 1e-5);
}

TEST_CASE("no vertex but these two has a share of it") {
  const ResidualFamily<VuQuocLi<SineGordon>> family({{1}}, h, k);
  for (int l = 0; l < 9; ++l) CHECK(family.weight(0, l) == (l == 4 || l == 7 ? 0.5 * h * k : 0));
  CHECK(family.outputs_read_until() == 1);
}

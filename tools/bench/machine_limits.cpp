// SPDX-License-Identifier: MIT
#include "tools/bench/machine_limits.hpp"

#include <cmath>

#include "jets/simd/pack_math.hpp"
#include "schemes/solvers/row_layout.hpp"
#include "tools/bench/pairing.hpp"
#include "tools/bench/textbook/textbook_autovectorised.hpp"

namespace delf::bench {

namespace {

Side repeated(std::function<void()> work) {
  return {[] {},
          [work = std::move(work)](long times) {
            for (long n = 0; n < times; ++n) work();
          }};
}

}  // namespace

Sines time_sines(int repeats) {
  constexpr int count = 4096;
  const RowLayout layout(Lattice::circle(count, 1), 0);
  RowBuffer rows(layout, 2);
  double *x = rows.row(0), *out = rows.row(1);
  for (int i = 0; i < count; ++i) x[i] = 7. * i / count;  // from one vacuum beyond the next
  const auto each = [&](std::function<void()> work) {
    return alone(repeated(std::move(work)), repeats).median / count;
  };
  return {each([=] {
            for (int i = 0; i < count; i += lanes) sin(Pack::load(x + i)).store(out + i);
          }),
          each([=] {
            for (int i = 0; i < count; ++i) out[i] = std::sin(x[i]);
          }),
          each([=] { autovectorised_sine(x, out, count); })};
}

double time_traffic(int sites, int repeats) {
  const RowLayout layout(Lattice::circle(sites, 1), 0);
  RowBuffer rows(layout, 2);
  double *y = rows.row(0), *v = rows.row(1);
  for (int i = 0; i < sites; ++i) y[i] = 1;
  const int slots = layout.packs() * lanes;
  const Side stream = repeated([=] {
    for (int i = 0; i < slots; i += lanes) {
      const Pack here = Pack::load(y + i), increment = Pack::load(v + i) - 1e-9 * here;  // y keeps swinging about 0
      increment.store(v + i);
      (here + increment).store(y + i);
    }
  });
  return alone(stream, repeats).median / sites;
}

}  // namespace delf::bench

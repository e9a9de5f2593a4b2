// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>
#include <vector>

#include "jets/simd/scratch_rows.hpp"
#include "lattice/index.hpp"
#include "schemes/methods/energies.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {
namespace {

/// N(φ) = ℓ(φ, 0, 0) and Q(a, b)_c = (N(a) − N(b))/(a − b) at every site, of rows [i·d + c].
class Potential {
 public:
  explicit Potential(const BatchDensity& density) : density_(density), d_(density.components()) {}

  std::vector<double> values(const std::vector<double>& y) const {
    std::vector<double> N(y.size() / at(d_));
    each_batch(y, y, density_.variables(), 1, [&](const JetBatch& jets, double* const* out, std::size_t first, int n) {
      density_.value(jets, out[0]);
      std::copy_n(out[0], n, N.begin() + static_cast<std::ptrdiff_t>(first));
    });
    return N;
  }
  std::vector<double> quotients(const std::vector<double>& a, const std::vector<double>& b) const {
    std::vector<double> Q(a.size());
    each_batch(a, b, 2 * d_, d_, [&](const JetBatch& pairs, double* const* out, std::size_t first, int n) {
      density_.difference_quotient(pairs, out);
      for (int i = 0; i < n; ++i)
        for (int c = 0; c < d_; ++c) Q[(first + at(i)) * at(d_) + at(c)] = out[c][i];
    });
    return Q;
  }

 private:
  /// Calls use(inputs, outputs, first site, sites) for packs of sites; inputs are a, then b, then zeros.
  template <class Use>
  void each_batch(const std::vector<double>& a, const std::vector<double>& b, int inputs, int outputs,
                  const Use& use) const {
    const std::size_t sites = a.size() / at(d_);
    const ScratchRows in(inputs, lanes), out(outputs, lanes);
    for (int row = 0; row < inputs; ++row) std::fill_n(in[row], lanes, 0.0);
    for (std::size_t first = 0; first < sites; first += lanes) {
      const int n = static_cast<int>(std::min<std::size_t>(lanes, sites - first));
      for (int i = 0; i < lanes; ++i)
        for (int c = 0; c < d_; ++c) {
          const std::size_t from = (first + at(std::min(i, n - 1))) * at(d_) + at(c);
          in[c][i] = a[from];
          if (inputs == 2 * d_) in[d_ + c][i] = b[from];
        }
      use(JetBatch{lanes, in.data()}, out.data(), first, n);
    }
  }

  const BatchDensity& density_;
  int d_;
};

/// Σ_cells (∂_k y)(∂_k z)
double gradients(const RowsInTime& rows, std::int64_t j, std::int64_t l) {
  double sum = 0;
  const Window& y = rows.rows;
  for (int i = 0; i < rows.system.lattice().cells(); ++i)
    for (int c = 0; c < y.components; ++c) sum += (y(j, i + 1, c) - y(j, i, c)) * (y(l, i + 1, c) - y(l, i, c));
  return sum;
}

/// Sites of fixed walls have no equation, and do not move; natural ends have no energy of this form.
bool has_energy(const FieldTheory& theory, const Lattice& lattice) {
  const bool natural =
      lattice.space() == Space::interval && (lattice.left() == Wall::natural || lattice.right() == Wall::natural);
  return !natural && !theory.is_placed();
}

/// E = k Σ ½(∂_h y/h)² + ½(∂_k y_j)(∂_k y_{j+1})/k² − ½(N(y_j) + N(y_{j+1}))     the energy that (5.15) conserves
double guo(const RowsInTime& rows) {
  const double h = rows.time_step, k = rows.system.lattice().space_step();
  const std::vector<double>&y = rows.rows.rows.front(), &above = rows.rows.rows.back();
  const Potential potential(rows.theory.density());
  double kinetic = 0, N = 0;
  for (std::size_t n = 0; n < y.size(); ++n) kinetic += (above[n] - y[n]) * (above[n] - y[n]) / (h * h);
  for (const auto* row : {&y, &above})
    for (const double value : potential.values(*row)) N += value;
  return 0.5 * k * (kinetic + gradients(rows, rows.newest - 1, rows.newest) / (k * k) - N);
}

/// (5.14) is (v₊ − v)/h = ½D²(y + y₊) + Q(y₊, y), ½(v + v₊) = (y₊ − y)/h without v. So v₊ = (y₊ − y)/h + ½h(…), and
///
///     E = k Σ ½v² + ½(∂_k y)²/k² − N(y)
double vu_quoc_li(const RowsInTime& rows) {
  const double h = rows.time_step, k = rows.system.lattice().space_step();
  const Lattice& lattice = rows.system.lattice();
  const Window& w = rows.rows;
  const std::vector<double>&y = w.rows.front(), &above = w.rows.back();
  const Potential potential(rows.theory.density());
  const std::vector<double> Q = potential.quotients(above, y);
  const std::int64_t j = rows.newest;
  double kinetic = 0, N = 0;
  for (int i = 0; i < lattice.sites(); ++i) {
    if (lattice.is_fixed(i)) continue;
    for (int c = 0; c < w.components; ++c) {
      double D = 0;  // ½D²(y + y₊)
      for (const std::int64_t row : {j - 1, j}) D += 0.5 * (w(row, i + 1, c) - 2 * w(row, i, c) + w(row, i - 1, c));
      const std::size_t n = at(i * w.components + c);
      const double v = (above[n] - y[n]) / h + 0.5 * h * (D / (k * k) + Q[n]);
      kinetic += v * v;
    }
  }
  for (const double value : potential.values(above)) N += value;
  return k * (0.5 * kinetic + 0.5 * gradients(rows, j, j) / (k * k) - N);
}

template <double (*energy)(const RowsInTime&)>
EnergyOfRows comparator_energy(const FieldTheory& theory, const LatticeSystem& system, const Problem&) {
  if (!has_energy(theory, system.lattice())) return nullptr;
  return [](const RowsInTime& rows) { return EnergyMomentum{energy(rows)}; };
}

}  // namespace

extern const EnergyEntry guo_energy, vu_quoc_li_energy;
const EnergyEntry guo_energy{
    "energy of (5.15)",
    "E = k sum (dy/h)^2/2 + (Dy)(Dy+)/2 - (N + N+)/2, dy = y+ - y, D over a cell by k: kept to round-off",
    "Guo and others, (5.15)", "guo", comparator_energy<guo>};
const EnergyEntry vu_quoc_li_energy{
    "energy of (5.14)",
    "E = k sum v^2/2 + (Dy)^2/2 - N, v = (y+ - y)/h + (h/2)(D2(y + y+)/2 + (N+ - N)/(y+ - y)) at y+: kept to round-off",
    "Vu-Quoc and Li, (5.14)", "vu-quoc-li", comparator_energy<vu_quoc_li>};

}  // namespace delf

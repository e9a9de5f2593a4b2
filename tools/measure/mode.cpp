// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "lattice/error.hpp"
#include "schemes/states/modes.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "tools/measure/entries.hpp"

namespace delf {

namespace {

/// The part that mode n has in a row, over the sites x_i of one space: the standing mode X_n of the walls, or the wave
/// exp(i q_n x) of a circle, without what the field gains around it.
///
///     a_n = Σ' φ_i X_n(x_i)/Σ' X_n(x_i)²,      on a circle a_n = |2 Σ φ_i exp(−i q_n x_i)|/N
///
/// Σ': the ends of an interval count half, so that modes are orthogonal on the lattice too.
class Mode : public Measurement {
 public:
  Mode(const MeasuredField& field, const std::vector<double>& numbers) : field_(field), modes_(field.lattice) {
    n_ = numbers[0];
    if (field.lattice.space() == Space::point) throw BadInput("", "a point has no modes; use value(0)");
    if (!(n_ == std::round(n_) && n_ >= 1 && n_ <= modes_.most()))
      throw BadInput("", "modes are 1, 2, ... as far as the sites resolve; choose one of them");
  }
  void see(const MeasuredRow& row) override { now_ = amplitude(row.row), before_ = amplitude(row.other); }
  void visit(SavedState& state) override { state("amplitude", now_), state("amplitude before", before_); }

 protected:
  double amplitude(std::span<const double> row) const {
    const Lattice& lattice = field_.lattice;
    double sum = 0, sine = 0, norm = 0;
    if (lattice.is_circle()) {
      for (int i = 0; i < lattice.sites(); ++i) {
        const double phi = field_.at(row, i) - field_.monodromy * i / lattice.sites();
        const double angle = 2 * std::numbers::pi * n_ * i / lattice.sites();
        sum += phi * std::cos(angle), sine += phi * std::sin(angle);
      }
      return (2 * n_ == lattice.sites() ? 1 : 2) * std::hypot(sum, sine) / lattice.sites();
    }
    for (int i = 0; i < lattice.sites(); ++i) {
      const double share = i == 0 || i + 1 == lattice.sites() ? 0.5 : 1.0;
      const double X = modes_.standing(n_, lattice.position(i));
      sum += share * X * field_.at(row, i), norm += share * X * X;
    }
    return sum / norm;
  }

  MeasuredField field_;
  double now_ = unknown, before_ = unknown;

 private:
  initial::Modes modes_;
  double n_ = 1;
};

class ModeAmplitude final : public Mode {
  using Mode::Mode;
  double value() const override { return now_; }
};

/// (a_n(t) − a_n(t − h))/h: da_n/dt half a step before the last row
class ModeRate final : public Mode {
  using Mode::Mode;
  double value() const override { return (now_ - before_) / field_.time_step; }
};

/// The largest |a_n| after a time, or when it is: how far, and when, a mode comes back.
template <bool of_time>
class ModeReturn final : public Mode {
 public:
  ModeReturn(const MeasuredField& field, const std::vector<double>& numbers)
      : Mode(field, numbers), after_(numbers[1]) {}
  void see(const MeasuredRow& row) override {
    if (row.time < after_) return;
    const double size = std::abs(amplitude(row.row));
    if (std::isnan(now_) || size > now_) now_ = size, before_ = row.time;
  }
  double value() const override { return of_time ? before_ : now_; }

 private:
  double after_;
};

}  // namespace

const MeasurementEntry mode_measurement{
    "mode",
    "n",
    "the amplitude of the standing mode n between walls, or of the n-th wave around a circle, in the last row",
    1,
    1,
    make_measurement<ModeAmplitude>};
const MeasurementEntry mode_rate_measurement{"mode_rate", "n", "how fast mode(n) changes, half a step before that",
                                             1,           1,   make_measurement<ModeRate>};

const MeasurementEntry mode_return_measurement{
    "mode_return",
    "n, after",
    "the largest |mode(n)| of the recorded rows after a time: how far it comes back",
    2,
    2,
    make_measurement<ModeReturn<false>>};
const MeasurementEntry mode_return_time_measurement{"mode_return_time",
                                                    "n, after",
                                                    "when |mode(n)| is largest after that time",
                                                    2,
                                                    2,
                                                    make_measurement<ModeReturn<true>>};

}  // namespace delf

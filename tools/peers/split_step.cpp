// SPDX-License-Identifier: MIT
#ifdef DELF_HAS_FFTW
#include "tools/peers/split_step.hpp"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "lattice/index.hpp"
#include "tools/peers/flush_to_zero.hpp"
#include "tools/peers/force.hpp"
#include "tools/peers/row.hpp"

namespace delf::peers {
namespace {

// Each number of a pack of modes twice, for the real and the imaginary part.
template <int from, int... l>
Pack doubled(Pack a, std::integer_sequence<int, l...>) {
  return {__builtin_shufflevector(a.v, a.v, (from + l / 2)...)};
}

/// The factors of a flow of one length t: cos κt, sin(κt)/κ and −κ sin κt of every mode.
struct FlowFactors {
  explicit FlowFactors(std::size_t modes) : cosine(modes), sinc(modes), slope(modes) {}

  void prepare(double t, const Row& kappa, const Row& inverse) {
    for (std::size_t j = 0; j < kappa.size(); j += lanes) {
      const Pack k = Pack::load(&kappa[j]), s = sin(k * t);
      cos(k * t).store(&cosine[j]);
      (s * Pack::load(&inverse[j])).store(&sinc[j]);
      (-k * s).store(&slope[j]);
    }
    if (kappa[0] == 0) sinc[0] = t;
  }

  Row cosine, sinc, slope;
};

class FftwPlan {
 public:
  explicit FftwPlan(fftw_plan plan) : plan_(plan) {
    if (!plan) throw std::runtime_error("FFTW has no plan for this number of sites");
  }
  ~FftwPlan() { fftw_destroy_plan(plan_); }
  FftwPlan(const FftwPlan&) = delete;
  FftwPlan& operator=(const FftwPlan&) = delete;
  void execute() const { fftw_execute(plan_); }

 private:
  fftw_plan plan_;
};

struct NoKick : NoForce {
  static constexpr bool mass_in_flow = false;
};
struct KleinGordonFlow : NoForce {
  static constexpr bool mass_in_flow = true;
};
template <class Force>
struct Kick : Force {
  static constexpr bool mass_in_flow = false;
};
/// −m²(sin φ − φ)
struct SineKickBeyondMass : SineForce {
  static constexpr bool mass_in_flow = true;
  static Pack shape(Pack phi) { return sin(phi) - phi; }
  static Pack slope(Pack phi) { return cos(phi) - 1.0; }
};

// The solution is kept in Fourier space, divided by N, so that c2r gives φ: a kick is two transforms of one real row,
// not four.
template <class Force>
class SplitStep final : public Peer {
 public:
  SplitStep(const WaveEquation& equation, const Splitting& splitting)
      : splitting_(splitting),
        sites_(at(equation.sites)),
        ramp_(whole_packs(sites_)),
        values_(whole_packs(sites_)),
        kappa_(whole_packs(sites_ / 2 + 1)),
        inverse_(kappa_.size()),
        field_(2 * kappa_.size()),
        speed_(field_.size()),
        spectrum_(field_.size()),
        forward_(fftw_plan_dft_r2c_1d(equation.sites, values_.data(), complex(spectrum_), FFTW_MEASURE)),
        backward_(fftw_plan_dft_c2r_1d(equation.sites, complex(spectrum_), values_.data(), FFTW_MEASURE)) {
    for (std::size_t i = 0; i < sites_; ++i)
      ramp_[i] = equation.monodromy * static_cast<double>(i) / static_cast<double>(sites_);
    turns_ = equation.monodromy != 0;
    for (std::size_t j = 0; j <= sites_ / 2; ++j) {
      kappa_[j] = std::hypot(2 * std::numbers::pi / equation.length * static_cast<double>(j),
                             Force::mass_in_flow ? equation.mass : 0.0);
      inverse_[j] = kappa_[j] > 0 ? 1 / kappa_[j] : 0;
    }
    strength_ = Force::strength(equation) / static_cast<double>(sites_);
    plan_flows();
  }

  void start(std::span<const double> phi, std::span<const double> phi_t) override {
    if (phi.size() != sites_ || phi_t.size() != sites_) throw std::invalid_argument("a row has the wrong length");
    transform(phi_t, speed_, false);
    transform(phi, field_, true);
    processed_ = false;
    if (kicked && !splitting_.flows_first) force_here(kernel_gradient());
  }

  void advance(double h, std::int64_t steps) override {
    const FlushToZero guard;
    prepare(h);
    if (!splitting_.processor.empty() && !std::exchange(processed_, true)) {
      process(1);
      if (!splitting_.flows_first) force_here(kernel_gradient());
    }
    if (steps <= 0) return;
    if constexpr (!kicked) {
      for (std::int64_t n = 0; n < steps; ++n) sweep<false>(0, flows_.back());
    } else if (splitting_.flows_first) {
      flow_first(steps);
    } else {
      kick_first(steps);
    }
  }

  void copy(std::span<double> phi, std::span<double> phi_t) const override {
    if (phi.size() != sites_ || phi_t.size() != sites_) throw std::invalid_argument("a row has the wrong length");
    // The spectrum may be that of the force, which the next kick wants, and c2r destroys what it reads.
    const Row kept = spectrum_, kept_field = field_, kept_speed = speed_;
    if (processed_) process(-1);
    const auto back = [&](const Row& modes, std::span<double> row) {
      spectrum_ = modes;
      backward_.execute();
      std::copy_n(values_.begin(), sites_, row.begin());
    };
    back(field_, phi);
    back(speed_, phi_t);
    spectrum_ = kept, field_ = kept_field, speed_ = kept_speed;
    for (std::size_t i = 0; i < sites_; ++i) phi[i] += ramp_[i];
  }

 private:
  static constexpr bool kicked = !std::is_base_of_v<NoForce, Force>;

  static fftw_complex* complex(Row& row) { return reinterpret_cast<fftw_complex*>(row.data()); }

  // Palindromes have each length twice: factors are kept once. The last one is that of the whole step, or, of two flows
  // merged between steps.
  void plan_flows() {
    const auto index = [&](double weight) {
      const auto found = std::find(lengths_.begin(), lengths_.end(), weight);
      if (found != lengths_.end()) return at(found - lengths_.begin());
      lengths_.push_back(weight);
      return lengths_.size() - 1;
    };
    if (!kicked) {
      index(1);
    } else if (splitting_.flows_first) {
      for (const double a : splitting_.outer) stages_.push_back(index(a));
      merged_ = index(2 * splitting_.outer.front());
    } else {
      for (const double a : splitting_.inner) stages_.push_back(index(a));
    }
    flows_.assign(lengths_.size(), FlowFactors(kappa_.size()));
    process_.assign(splitting_.processor.drifts.size(), FlowFactors(kappa_.size()));
    undo_ = process_;
  }

  void prepare(double h) {
    if (h == step_) return;
    for (std::size_t f = 0; f < flows_.size(); ++f) flows_[f].prepare(lengths_[f] * h, kappa_, inverse_);
    for (std::size_t i = 0; i < process_.size(); ++i) {
      process_[i].prepare(splitting_.processor.drifts[i] * h, kappa_, inverse_);
      undo_[i].prepare(-splitting_.processor.drifts[i] * h, kappa_, inverse_);
    }
    step_ = h;
  }

  /// Once forwards, or back on what is a copy.
  void process(int sign) const {
    if constexpr (!kicked) return;
    const auto& kicks = splitting_.processor.kicks;
    const std::size_t last = kicks.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
      const std::size_t which = sign > 0 ? i : last - i;
      if (kicks[which] != 0) {
        force_here(0);
        const double c = sign * strength_ * step_ * kicks[which];
        for (std::size_t j = 0; j < speed_.size(); ++j) speed_[j] += c * spectrum_[j];
      }
      if (i < last) sweep<false>(0, sign > 0 ? process_[which] : undo_[which - 1]);
    }
  }
  /// 2g h², times the strength that a force is in units of.
  double kernel_gradient() const {
    return 2 * splitting_.gradient * step_ * step_ * strength_ * static_cast<double>(sites_);
  }
  void force_here(double gradient) const {
    spectrum_ = field_;
    find_force(gradient);
  }

  void flow_first(std::int64_t steps) {
    const auto& kicks = splitting_.inner;
    const double scale = strength_ * step_, gradient = kernel_gradient();
    sweep<false>(0, flows_[stages_[0]]);
    for (std::int64_t n = 0; n < steps; ++n) {
      for (std::size_t i = 0; i + 1 < kicks.size(); ++i) {
        find_force(gradient);
        sweep<true>(scale * kicks[i], flows_[stages_[i + 1]]);
      }
      find_force(gradient);
      sweep<true>(scale * kicks.back(), flows_[n + 1 < steps ? merged_ : stages_[0]]);
    }
  }

  // The force at the end of a step is that at the beginning of the next, in the next call too.
  void kick_first(std::int64_t steps) {
    const auto& kicks = splitting_.outer;
    const double scale = strength_ * step_;
    for (std::int64_t n = 0; n < steps; ++n) {
      for (std::size_t i = 0; i < stages_.size(); ++i) {
        const double weight = i > 0 ? kicks[i] : n > 0 ? 2 * kicks[0] : kicks[0];
        sweep<true>(scale * weight, flows_[stages_[i]]);
        find_force(0);
      }
    }
    for (std::size_t j = 0; j < speed_.size(); ++j) speed_[j] += scale * kicks.back() * spectrum_[j];
  }

  // A kick with the force whose spectrum there is, and the flow after it:
  //     φ̂_t += c F̂,   (φ̂, φ̂_t) ← (cos κt φ̂ + sin(κt)/κ φ̂_t, −κ sin κt φ̂ + cos κt φ̂_t);
  // a second copy of φ̂ takes the place of F̂, for the inverse transform to destroy.
  template <bool kick>
  void sweep(double c, const FlowFactors& flow) const {
    constexpr auto all = std::make_integer_sequence<int, lanes>();
    double *u = field_.data(), *v = speed_.data(), *f = spectrum_.data();
    const auto half = [&](Pack cosine, Pack sinc, Pack slope) {
      const Pack a = Pack::load(u), b = kick ? Pack::load(v) + c * Pack::load(f) : Pack::load(v);
      const Pack flown = cosine * a + sinc * b;
      flown.store(u);
      if (kicked) flown.store(f);
      (slope * a + cosine * b).store(v);
      u += lanes, v += lanes, f += lanes;
    };
    for (std::size_t j = 0; j < kappa_.size(); j += lanes) {
      const Pack cosine = Pack::load(&flow.cosine[j]), sinc = Pack::load(&flow.sinc[j]),
                 slope = Pack::load(&flow.slope[j]);
      half(doubled<0>(cosine, all), doubled<0>(sinc, all), doubled<0>(slope, all));
      half(doubled<lanes / 2>(cosine, all), doubled<lanes / 2>(sinc, all), doubled<lanes / 2>(slope, all));
    }
  }

  /// The spectrum of φ becomes that of the force, F + gradient F′F in units of the strength.
  void find_force(double gradient) const {
    backward_.execute();
    double* const y = values_.data();
    if (gradient != 0) {
      for (std::size_t i = 0; i < values_.size(); i += lanes) {
        const Pack phi = turns_ ? Pack::load(y + i) + Pack::load(&ramp_[i]) : Pack::load(y + i);
        const Pack force = Force::shape(phi);
        (force + gradient * (Force::slope(phi) * force)).store(y + i);
      }
    } else if (turns_) {
      for (std::size_t i = 0; i < values_.size(); i += lanes)
        Force::shape(Pack::load(y + i) + Pack::load(&ramp_[i])).store(y + i);
    } else {
      for (std::size_t i = 0; i < values_.size(); i += lanes) Force::shape(Pack::load(y + i)).store(y + i);
    }
    forward_.execute();
  }

  void transform(std::span<const double> row, Row& modes, bool ramped) {
    for (std::size_t i = 0; i < sites_; ++i) values_[i] = row[i] - (ramped ? ramp_[i] : 0);
    forward_.execute();
    for (std::size_t j = 0; j < modes.size(); ++j) modes[j] = spectrum_[j] / static_cast<double>(sites_);
  }

  Splitting splitting_;
  std::size_t sites_;
  bool turns_;
  double strength_, step_ = 0;
  Row ramp_;
  mutable Row values_;
  Row kappa_, inverse_;
  mutable Row field_, speed_, spectrum_;  ///< a copy is processed in them
  FftwPlan forward_, backward_;
  std::vector<double> lengths_;      ///< of flows, over h; no two alike
  std::vector<FlowFactors> flows_;   ///< of those lengths
  std::vector<std::size_t> stages_;  ///< the flows of a step, one after the other
  std::size_t merged_ = 0;
  std::vector<FlowFactors> process_, undo_;  ///< the flows of the processor, and back
  bool processed_ = false;
};

template <class Force>
std::unique_ptr<Peer> made(const WaveEquation& equation, const Splitting& splitting) {
  return std::make_unique<SplitStep<Force>>(equation, splitting);
}

template <Splitting splitting(), int order, MassIn mass>
PeerInfo info(const char* source) {
  const char* const kernel = splitting().gradient != 0       ? ", processed gradient"
                             : splitting().processor.empty() ? ""
                                                             : ", processed";
  return {"Fourier split-step " + std::to_string(order) + kernel + (mass == MassIn::flow ? ", mass in the flow" : ""),
          order,
          0,
          0,
          splitting().inner.size(),
          [](const WaveEquation& equation) { return make_split_step(equation, splitting(), mass); },
          !splitting().processor.empty(),
          {source, "frigo-johnson-2005"}};
}

}  // namespace

std::unique_ptr<Peer> make_split_step(const WaveEquation& equation, const Splitting& splitting, MassIn mass) {
  using enum WaveEquation::Potential;
  equation.check(1);
  if (mass == MassIn::flow && (equation.potential == phi4 || equation.monodromy != 0))
    throw std::invalid_argument("a mass in the flow needs its vacuum at 0 and a field that does not wind");
  switch (equation.potential) {
    case quadratic:
      return made<KleinGordonFlow>(equation, splitting);
    case sine_gordon:
      return mass == MassIn::flow ? made<SineKickBeyondMass>(equation, splitting)
                                  : made<Kick<SineForce>>(equation, splitting);
    case phi4:
      return made<Kick<DoubleWellForce>>(equation, splitting);
    case none:
      break;
  }
  return made<NoKick>(equation, splitting);
}

// No Courant number is known for these: flows are exact, and kicks resonate where κh is near a multiple of π, weakly.
std::vector<PeerInfo> split_step_peers() {
  return {info<strang, 2, MassIn::kick>("strang-1968"),
          info<blanes_moan_4, 4, MassIn::kick>("blanes-moan-2002"),
          info<blanes_moan_6b, 6, MassIn::kick>("blanes-moan-2002"),
          info<kahan_li_8_kicks, 8, MassIn::kick>("kahan-li-1997"),
          info<processed_ti4, 4, MassIn::kick>("takahashi-imada-1984"),
          info<processed_b6, 6, MassIn::kick>("delf"),
          info<processed_ti4, 4, MassIn::flow>("takahashi-imada-1984"),
          info<processed_b6, 6, MassIn::flow>("delf"),
          info<strang, 2, MassIn::flow>("strang-1968"),
          info<blanes_moan_4, 4, MassIn::flow>("blanes-moan-2002"),
          info<blanes_moan_6a, 6, MassIn::flow>("blanes-moan-2002"),
          info<kahan_li_8_flows, 8, MassIn::flow>("kahan-li-1997")};
}

}  // namespace delf::peers
#endif

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/stepping/composition_stepper.hpp"
#include "schemes/stepping/flush_denormals.hpp"

// The processor of a CompositionStepper.

namespace delf {

/// Kicks and drifts by turns are sub-steps: kick b h F, then drift a h. The kicks of a whole step sum to h F.
void CompositionStepper::prepare_processor() {
  const Processor& p = options_.processor;
  const double h = system_.time_step();
  SubStep whole{std::vector(steps_[0].linear.size(), 0.0), std::vector(steps_[0].nonlinear.size(), 0.0)};
  for (const SubStep& s : steps_) {
    for (std::size_t j = 0; j < s.linear.size(); ++j) whole.linear[j] += s.linear[j];
    for (std::size_t a = 0; a < s.nonlinear.size(); ++a) whole.nonlinear[a] += s.nonlinear[a];
  }
  const auto sub_step_of = [&](double kick, double drift, double time) {
    SubStep step = whole;
    for (double& g : step.linear) g *= kick;
    for (double& b : step.nonlinear) b *= kick;
    step.stride = drift * h, step.time = time * h;
    return step;
  };
  double time = 0;
  for (std::size_t i = 0; i < p.kicks.size(); ++i) {
    const double drift = i < p.drifts.size() ? p.drifts[i] : 0;
    process_.push_back(sub_step_of(p.kicks[i], drift, time));
    time += drift;
  }
  for (std::size_t i = p.kicks.size(); i-- > 0;) {
    const double drift = i > 0 ? -p.drifts[i - 1] : 0;
    undo_.push_back(sub_step_of(-p.kicks[i], drift, time));
    time += drift;
  }
  observed_ = RowBuffer(delf::at(d_) * size_, 2);
  observed_differences_ = RowBuffer(delf::at(d_) * size_, 2);
}

/// The momenta below an older row are those above it, less its kick.
void CompositionStepper::observe(int back, std::vector<double>& fields, std::vector<double>* rates) const {
  require(back);
  const std::size_t doubles = delf::at(d_) * size_;
  double *const y = observed_.row(0), *const u = observed_.row(1);
  const FlushDenormals guard;
  std::copy_n(back == 0 ? newest_row() : node(n_ - back, 0), doubles, y);
  find_differences(y, observed_differences_.row(0));
  if (back == 0) std::copy_n(velocity_.row(0), doubles, u);
  else {
    const double* const next = S_ > 1 ? node(n_ - back, 1) : back > 1 ? node(n_ - back + 1, 0) : newest_row();
    for (std::size_t at = 0; at < doubles; ++at) u[at] = (next[at] - y[at]) / steps_[0].stride;
    SubStep less = steps_[0];
    for (double& g : less.linear) g = -g;
    for (double& b : less.nonlinear) b = -b;
    less.stride = 0, less.gradient = -less.gradient;
    sub_step(n_ - back, less, y, observed_differences_.row(0), y, observed_differences_.row(1), u);
  }
  undo_processor(n_ - back, rates != nullptr);
  const std::size_t d = d_;
  std::vector<double> site(layout_.sites());
  for (const auto& [from, to] : {std::pair{y, &fields}, {u, rates}}) {
    if (!to) continue;
    to->resize(site.size() * d);
    for (std::size_t a = 0; a < d; ++a) {
      layout_.gather(from + a * size_, site);
      for (std::size_t i = 0; i < site.size(); ++i) (*to)[i * d + a] = site[i];
    }
  }
}

/// The last of its kicks is for the rates alone.
void CompositionStepper::undo_processor(std::int64_t n, bool with_rates) const {
  double *const y = observed_.row(0), *const u = observed_.row(1);
  int at = 0;
  for (const SubStep& s : undo_) {
    if (&s == &undo_.back() && s.stride == 0 && !with_rates) break;
    sub_step(n, s, y, observed_differences_.row(at), y, observed_differences_.row(1 - at), u);
    at = 1 - at;
  }
}

}  // namespace delf

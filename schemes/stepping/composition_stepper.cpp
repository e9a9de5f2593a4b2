// SPDX-License-Identifier: MIT
#include "schemes/stepping/composition_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include "jets/simd/scratch_rows.hpp"
#include "lattice/index.hpp"
#include "schemes/stepping/flush_denormals.hpp"
#include "schemes/stepping/pair_strips.hpp"
#include "schemes/stepping/saved_state.hpp"

namespace delf {

namespace {

int reach_of(const StencilFamily& family) {
  const auto [least, most] = std::ranges::minmax(family.pattern().vertices, {}, &Site::space);
  return most.space - least.space;
}

bool is_of_mirror(const std::shared_ptr<const StencilFamily>& family) {
  const Placement at = family->pattern().placement;
  return at == Placement::left_mirror || at == Placement::right_mirror;
}

/// Rows lie in memory as those of a circle do: halos between arcs are packs then, and beyond walls there are images.
Lattice closed(const Lattice& lattice) { return Lattice::circle(lattice.sites(), lattice.length()); }

}  // namespace

std::unique_ptr<CompositionStepper> CompositionStepper::make(const LatticeSystem& system, const StepOptions& options) {
  if (options.fibre == Fibre::circle || system.families().empty()) return nullptr;
  const int mirrors = static_cast<int>(std::ranges::count_if(system.families(), is_of_mirror));
  if (system.lattice().space() == Space::interval ? mirrors == 0 : !system.lattice().is_circle()) return nullptr;
  const StencilFamily& family = *system.families()[0];
  if (!family.sources()) return nullptr;
  // The source terms at a node are those of its own value.
  for (const SourceTerms::Group& group : family.sources()->groups)
    for (const SourceTerms::QuadratureValue& value : group.inputs)
      if (value.size() != 1 || value[0].weight != 1) return nullptr;
  const int whole = static_cast<int>(system.families().size()) - mirrors;
  if (whole < 1 || whole > 2 || is_of_mirror(system.families()[0])) return nullptr;
  if (whole == 2 && (is_of_mirror(system.families()[1]) ||
                     !read_gradient(family, *system.families()[1], system.lattice().space_step())))
    return nullptr;
  std::unique_ptr<CompositionStepper> stepper(new CompositionStepper(system, options));
  return stepper->assemble() ? std::move(stepper) : nullptr;
}

CompositionStepper::CompositionStepper(const LatticeSystem& system, const StepOptions& options)
    : system_(system),
      options_(options),
      family_(*system.families()[0]),
      d_(system.fields()),
      S_(system.components() / system.fields()),
      reach_(reach_of(family_)),
      layout_(closed(system.lattice()), std::max(1, reach_)),
      ends_(closed(system.lattice()), 1),
      size_(layout_.doubles()),
      now_(delf::at(d_)),
      out_(delf::at(3 * d_)),
      before_(delf::at(d_), Pack(0.0)) {}

/// The numbers of the equation at node s, from the elements that read it: all of them, or those above it alone.
CompositionStepper::SubStep CompositionStepper::read_sub_step(int s, bool from_below, bool& fits) const {
  const StencilFamily& family = family_;
  const Cell cell{system_.time_step(), system_.lattice().space_step(), 0, 0};
  const std::size_t n = family.size(), d = delf::at(d_);
  const auto part = family.constant_part(cell);
  if (!part) return fits = false, SubStep{};
  const std::vector<double>& J = part->J;
  const SourceTerms& sources = *family.sources();

  SubStep step{std::vector(d * delf::at(reach_), 0.0), std::vector(d, 0.0), 0,
               system_.component(s * d_).at.time * cell.time_step,
               gradient_.density && s == 0 ? (from_below ? 1.0 : 0.5) : 0.0};
  for (const SourceTerms::Group& group : sources.groups)
    if (const Site at = group.inputs[0][0].vertex; at.time == 0 && at.node == s)
      step.time = group.time * cell.time_step;
  std::vector<double> above(d, 0.0), sum(d, 0.0), size(d, 0.0);
  std::vector<double> left(step.linear);
  std::map<std::pair<int, int>, double> stray;  // what must cancel
  for (int i = 0; i < family.size(); ++i) {
    const auto [vertex, component] = family.values()[i];
    if (component / d_ != s || (!from_below && family.site(i).time != 0)) continue;
    const std::size_t a = component % d_;
    for (int c = 0; c < sources.outputs(); ++c)
      step.nonlinear[a] += cell.time_step * cell.space_step * sources.weight(c, i);
    for (int j = 0; j < family.size(); ++j) {
      const double entry = J[delf::at(i) * n + delf::at(j)];
      if (entry == 0) continue;
      const int other = family.values()[j].component;
      const int rows = (family.site(j).time - family.site(i).time) * S_ + other / d_ - s;
      const int shift = family.site(j).space - family.site(i).space;
      sum[a] += entry, size[a] += std::abs(entry);
      if (rows == 0 && shift != 0 && other % d_ == component % d_)
        (shift > 0 ? step.linear : left)[a * delf::at(reach_) + delf::at(std::abs(shift) - 1)] += entry;
      else if (rows == 1 && shift == 0 && other % d_ == component % d_) above[a] += entry;
      else if (!(rows <= 0 && rows >= -1 && shift == 0 && other % d_ == component % d_))
        stray[{rows * 64 + shift, static_cast<int>(a) * system_.components() + other}] += entry;
    }
  }
  const double largest = *std::ranges::max_element(size);
  for (std::size_t a = 0; a < d; ++a) {
    // Differences alone: what is left of a constant is the nonlinear part's.
    fits = fits && std::abs(sum[a]) <= 1e-12 * size[a] && above[a] != 0 && above[a] == above[0];
  }
  for (std::size_t m = 0; m < left.size(); ++m) fits = fits && std::abs(left[m] - step.linear[m]) <= 1e-12 * largest;
  for (const auto& [where, entry] : stray) fits = fits && std::abs(entry) <= 1e-12 * largest;
  if (fits) step.stride = -1 / above[0];
  const std::size_t reach = reach_;
  for (std::size_t a = 0; a < d; ++a)
    for (std::size_t j = reach - 1; j-- > 0;) step.linear[a * reach + j] += step.linear[a * reach + j + 1];
  return step;
}

bool CompositionStepper::assemble() {
  if (S_ * d_ != system_.components() || reach_ < 1 || reach_ > widest_pair) return false;
  for (int c = 0; c < system_.components(); ++c) {
    // sub-step by sub-step, the fields first
    const Component& component = system_.component(c);
    if (component.role != (c < d_ ? Role::field : Role::inner) || component.field != c % d_) return false;
    if (component.at.space != 0) return false;
  }
  bool fits = true;
  if (system_.families().size() > 1 && !is_of_mirror(system_.families()[1])) {
    gradient_ = *read_gradient(family_, *system_.families()[1], system_.lattice().space_step());
    fits = static_cast<int>(gradient_.weights.size()) <= layout_.halo();
  }
  for (int s = 0; s < S_; ++s) steps_.push_back(read_sub_step(s, true, fits));
  first_ = read_sub_step(0, false, fits);
  if (!fits) return false;
  if (system_.lattice().space() == Space::interval) find_mirrors();

  // K: the strides of a step add up to h.
  double strides = 0;
  for (const SubStep& s : steps_) strides += s.stride;
  scale_ = system_.time_step() / strides;
  for (SubStep* step : [&] {
         std::vector<SubStep*> all{&first_};
         for (SubStep& s : steps_) all.push_back(&s);
         return all;
       }()) {
    for (double& g : step->linear) g /= scale_;
    for (double& b : step->nonlinear) b /= scale_;
    step->stride *= scale_;
  }
  gradient_.kick *= system_.time_step() * system_.lattice().space_step() / scale_;
  if (gradient_.density) squares_ = RowBuffer(delf::at(d_) * size_, 3);
  if (!options_.processor.empty()) prepare_processor();
  newest_ = RowBuffer(delf::at(d_) * size_);
  differences_ = RowBuffer(delf::at(d_) * size_, 2);
  velocity_ = RowBuffer(delf::at(d_) * size_);
  slabs_ = RowBuffer(delf::at(d_) * size_, slabs_held * S_);
  saved_ = RowBuffer(delf::at(d_) * size_, 2);
  if (system_.families()[0]->is_placed()) {
    std::vector<double> site(layout_.sites());
    for (int i = 0; i < layout_.sites(); ++i) site[i] = system_.lattice().position(i);
    positions_ = RowBuffer(layout_, 1);
    layout_.scatter(site, positions_.row(0));
  }
  return true;
}

/// Beyond a wall at site w, with D(i) = y(i + 1) − y(i), of an odd image and of an even one,
///
///     D(w + j) = ± D(w − 1 − j),    f(w + j) = ∓ f(w − j)      for what is odd or even with y, as the force is.
///
void CompositionStepper::find_mirrors() {
  const Lattice& lattice = system_.lattice();
  const int last = lattice.sites() - 1;
  const auto odd = [&](bool left) { return (left ? lattice.left() : lattice.right()) == Wall::fixed; };
  for (int l = 0; l < lanes; ++l)
    for (int v = -layout_.halo(); v < layout_.packs() + layout_.halo(); ++v) {
      const int i = layout_.start(l) + v, to = static_cast<int>(layout_.at(v)) + l;
      if (i < 0) {
        differences_beyond_.push_back({to, layout_.slot(-1 - i), odd(true) ? 1.0 : -1.0});
        values_beyond_.push_back({to, layout_.slot(-i), odd(true) ? -1.0 : 1.0});
      }
      if (i >= last) differences_beyond_.push_back({to, layout_.slot(2 * last - 1 - i), odd(false) ? 1.0 : -1.0});
      if (i > last) values_beyond_.push_back({to, layout_.slot(2 * last - i), odd(false) ? -1.0 : 1.0});
    }
  for (const int wall : {0, last}) {
    if (lattice.is_fixed(wall))
      for (const int slot : layout_.slots_of(wall == 0 ? 0 : last - 1))
        differences_at_walls_.push_back(
            {slot, layout_.slot(wall == 0 ? 1 : last), layout_.slot(wall == 0 ? 0 : last - 1)});
    for (const int slot : layout_.slots_of(wall)) {
      if (lattice.is_fixed(wall)) held_.push_back({slot, std::vector<double>(d_)});
      else natural_.push_back(slot);
    }
  }
}
void CompositionStepper::mirror_differences(double* D) const {
  for (const Image& image : differences_beyond_) D[image.to] = image.sign * D[image.from];
}
/// A fixed wall keeps its value to the bit, whatever force there is.
void CompositionStepper::hold_walls(double* y, double* D, double* velocity, int a) const {
  for (const Held& held : held_) y[held.slot] = held.value[a], velocity[held.slot] = 0;
  for (const AtWall& d : differences_at_walls_) D[d.slot] = y[d.above] - y[d.below];
}

/// One sub-step of a row, with D(i) = y(i + 1) − y(i):
///
///     u += Σ_m g_m (y(i + m) − 2y(i) + y(i − m)) + nonlinear ∂ℓ/∂φ(y(i)),    next = y + stride u
///
/// where the sum is Σ_j linear(j) (D(i + j) − D(i − 1 − j)): half the operations, and still differences only. Returns the
/// largest |next|.
double CompositionStepper::sub_step(std::int64_t n, const SubStep& step, const double* from, const double* differences,
                                    double* to, double* next_differences, double* velocity) const {
  constexpr int strip = 32;
  // A processor may have a drift without a kick.
  const bool has_sources =
      !family_.sources()->groups.empty() && std::ranges::any_of(step.nonlinear, [](double b) { return b != 0; });
  const ScratchRows slopes(d_, strip * lanes);
  const bool has_gradient = step.gradient != 0 && gradient_.density;
  if (has_gradient) add_gradient(n, step, from, differences, velocity);
  const auto row = [this](int a) { return static_cast<std::ptrdiff_t>(a) * static_cast<std::ptrdiff_t>(size_); };
  Pack largest(0.0);
  std::ranges::fill(before_, Pack(0.0));
  for (int first = 0; first < layout_.packs(); first += strip) {
    const int packs = std::min(strip, layout_.packs() - first);
    const std::ptrdiff_t begin = layout_.at(first);
    for (int a = 0; a < d_; ++a) now_[a] = from + row(a) + begin;
    if (has_sources && !has_gradient)
      family_.evaluate_sources(0,
                               {packs * lanes, now_.data(), static_cast<double>(n) * system_.time_step() + step.time,
                                positions_.rows() ? positions_.row(0) + begin : nullptr},
                               slopes.data());
    for (int a = 0; a < d_; ++a) {
      const auto at = row(a) + begin;
      const PairStrip rows{packs,
                           step.linear.data() + static_cast<std::ptrdiff_t>(a) * reach_,
                           step.nonlinear[a],
                           step.stride,
                           differences + at,
                           from + at,
                           has_gradient  ? squares_.row(2) + at
                           : has_sources ? slopes[a]
                                         : nullptr,
                           velocity + at,
                           to + at,
                           next_differences + at};
      with_reach(reach_, [&]<int R>(std::integral_constant<int, R>) { step_strip<R>(rows, before_[a], largest); });
    }
  }
  const std::ptrdiff_t last = layout_.at(layout_.packs() - 1);
  for (int a = 0; a < d_; ++a) {
    double *const y = to + row(a), *const D = next_differences + row(a);
    fill_ends(y);
    (Pack::load(y + last + lanes) - Pack::load(y + last)).store(D + last);
    hold_walls(y, D, velocity + row(a), a);
    layout_.fill_halo(D);
    mirror_differences(D);
  }
  return max_or_nan(largest);
}

void CompositionStepper::find_differences(const double* row, double* differences) const {
  for (int a = 0; a < d_; ++a) {
    const double* const y = row + delf::at(a) * size_;
    double* const D = differences + delf::at(a) * size_;
    for (int v = 0; v < layout_.packs(); ++v)
      (Pack::load(y + layout_.at(v + 1)) - Pack::load(y + layout_.at(v))).store(D + layout_.at(v));
    layout_.fill_halo(D);
    mirror_differences(D);
  }
}

/// The sub-steps from row n on; in place if no one looks. Returns the largest |y| of the new row.
double CompositionStepper::advance(const SubStep& first, bool looked_at) {
  const std::size_t doubles = delf::at(d_) * size_;
  double* const newest = newest_row();
  if (looked_at) std::copy_n(newest, doubles, node(n_, 0));
  double largest = 0;
  for (int s = 0; s < S_; ++s, at_ = 1 - at_) {
    const double* const from = looked_at ? node(n_, s) : newest;
    double* const to = looked_at && s + 1 < S_ ? node(n_, s + 1) : newest;
    largest = sub_step(n_, s == 0 ? first : steps_[s], from, differences_.row(at_), to, differences_.row(1 - at_),
                       velocity_.row(0));
  }
  return largest;
}

/// The fields of a section, by lanes.
void CompositionStepper::set(RowBuffer& rows, const std::vector<double>& section, double monodromy) {
  std::vector<double> site(layout_.sites());
  for (int a = 0; a < d_; ++a) {
    for (std::size_t i = 0; i < site.size(); ++i) site[i] = section[i * delf::at(system_.components()) + delf::at(a)];
    if (std::ranges::any_of(site, [](double x) { return overflowed(std::abs(x)); }))
      throw NotFinite("the rows of the start are not finite");
    layout_.scatter(site, rows.row(0) + delf::at(a) * size_, monodromy);
  }
  if (&rows != &newest_) return;
  for (Held& held : held_)
    for (int a = 0; a < d_; ++a) held.value[a] = rows.row(0)[delf::at(a) * size_ + delf::at(held.slot)];
}

void CompositionStepper::start(const std::vector<std::vector<double>>& rows) {
  if (S_ > 1)
    throw BadInput("initial.start",
                   "the rows between the sub-steps of a composition follow from row 0 and its momenta alone; use "
                   "initial.start = legendre and a state that knows its velocity");
  const std::size_t doubles = delf::at(d_) * size_;
  n_ = static_cast<std::int64_t>(rows.size()) - 1;
  set(newest_, rows[rows.size() - 2], options_.monodromy);
  std::copy_n(newest_row(), doubles, node(n_ - 1, 0));
  set(newest_, rows.back(), options_.monodromy);
  // u = (y₁ − y₀)/stride
  for (std::size_t at = 0; at < doubles; ++at)
    velocity_.row(0)[at] = (newest_row()[at] - node(n_ - 1, 0)[at]) / steps_[0].stride;
  find_differences(newest_row(), differences_.row(at_));
  known_ = 1;
  save();
}

void CompositionStepper::start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) {
  set(newest_, row0, options_.monodromy);
  set(velocity_, momenta, 0);
  // A natural wall has half a cell, and half of its momentum; steps take the equation of a whole one.
  for (const int slot : natural_)
    for (int a = 0; a < d_; ++a) velocity_.row(0)[delf::at(a) * size_ + delf::at(slot)] *= 2;
  for (std::size_t at = 0; at < delf::at(d_) * size_; ++at) velocity_.row(0)[at] /= scale_;
  n_ = 0;
  known_ = 0;
  const FlushDenormals guard;
  find_differences(newest_row(), differences_.row(at_));
  for (const SubStep& s : process_) {
    sub_step(0, s, newest_row(), differences_.row(at_), newest_row(), differences_.row(1 - at_), velocity_.row(0));
    at_ = 1 - at_;
  }
  if (overflowed(advance(process_.empty() ? first_ : steps_[0], true)))
    throw NotFinite(
        "step 1: the field is no longer finite: the scheme is unstable here; reduce lattice.courant or "
        "lattice.time_step");
  n_ = known_ = 1;
  save();
}

void CompositionStepper::step(bool looked_at) {
  constexpr std::int64_t steps_between = 64;
  const FlushDenormals guard;
  if (n_ >= saved_row_ + steps_between) save();
  if (overflowed(advance(steps_[0], looked_at))) fail();
  known_ = looked_at ? std::min(known_ + 1, slabs_held - 1) : 0;
  ++n_;
}

void CompositionStepper::save() {
  const std::size_t doubles = delf::at(d_) * size_;
  std::copy_n(newest_row(), doubles, saved_.row(0));
  std::copy_n(velocity_.row(0), doubles, saved_.row(1));
  saved_row_ = n_;
}

/// Goes back to the saved row, and from there to the last good one: its bits are the same.
void CompositionStepper::fail() {
  const std::size_t doubles = delf::at(d_) * size_;
  std::vector<double> bad(newest_row(), newest_row() + doubles);
  const std::int64_t last = n_;
  std::copy_n(saved_.row(0), doubles, newest_row());
  std::copy_n(saved_.row(1), doubles, velocity_.row(0));
  find_differences(newest_row(), differences_.row(at_));
  // The row saved is itself good, and so is all that follows up to the last one. A slab is held of it where there is one.
  for (n_ = saved_row_; n_ < last; ++n_) {
    advance(steps_[0], n_ + 1 >= last - 1);
    known_ = n_ + 1 >= last - 1 ? std::min(known_ + 1, slabs_held - 1) : 0;
  }
  int site = 0;
  const auto fine = [&](int i) {
    for (int a = 0; a < d_; ++a)
      if (overflowed(std::abs(bad[delf::at(a) * size_ + delf::at(layout_.slot(i))]))) return false;
    return true;
  };
  while (site + 1 < layout_.sites() && fine(site)) ++site;
  throw NotFinite(
      fmt::format("step {}, t = {:.6g}, site {}: the field is no longer finite: the scheme is unstable here; "
                  "reduce lattice.courant or lattice.time_step, or choose an implicit stencil",
                  last + 1, static_cast<double>(last + 1) * system_.time_step(), site));
}

void CompositionStepper::require(int slabs) const {
  if (slabs > known_)
    throw std::logic_error("delf: rows before the newest were written over by step(false), or not stepped yet");
}

/// Components first_component … + d − 1 of a section, from a row of nodes.
void CompositionStepper::copy_components(const double* rows, int first_component, std::vector<double>& section) const {
  std::vector<double> site(layout_.sites());
  for (int a = 0; a < d_; ++a) {
    layout_.gather(rows + delf::at(a) * size_, site);
    for (std::size_t i = 0; i < site.size(); ++i)
      section[i * delf::at(system_.components()) + delf::at(first_component + a)] = site[i];
  }
}

/// Nodes as they were found together with the row; before there are any, the row itself.
std::vector<double> CompositionStepper::row(int back) const {
  require(back);
  std::vector<double> section(layout_.sites() * system_.components());
  const double* const fields = back == 0 ? newest_row() : node(n_ - back, 0);
  copy_components(fields, 0, section);
  for (int s = 1; s < S_; ++s) copy_components(back < known_ ? node(n_ - back - 1, s) : fields, s * d_, section);
  return section;
}

Window CompositionStepper::window(int rows) const {
  require(rows - 1);
  std::vector<std::vector<double>> sections;
  for (std::int64_t r = n_ - rows + 1; r <= n_; ++r) {
    sections.emplace_back(delf::at(layout_.sites() * system_.components()));
    for (int s = 0; s < S_; ++s) copy_components(r == n_ ? newest_row() : node(r, s), s * d_, sections.back());
  }
  return system_.window(n_ - rows + 1, std::move(sections), options_.monodromy);
}

/// E/K = (y_s − y_{s−1})/stride_{s−1} + w_s − (y_{s+1} − y_s)/stride_s over the nodes of the newest slab.
double CompositionStepper::residual() const {
  const int first = known_ >= 2 ? 0 : 1;
  if (known_ == 0) return std::numeric_limits<double>::quiet_NaN();
  const std::size_t doubles = delf::at(d_) * size_;
  if (!scratch_.rows() && scratch_rows() > 0) scratch_ = RowBuffer(doubles, scratch_rows());
  // The next step that is checked writes over these.
  const auto room = [&](int r) {
    return r < S_ ? slabs_.row(static_cast<int>(n_ % slabs_held) * S_ + r) : scratch_.row(r - S_);
  };
  double *const w = room(0), *const differences = room(1), *const to = room(2);
  double worst = 0, size = 0;
  for (int s = first; s < S_; ++s) {
    const double* const before = s > 0 ? node(n_ - 1, s - 1) : node(n_ - 2, S_ - 1);
    const double *const here = node(n_ - 1, s), *const next = s + 1 < S_ ? node(n_ - 1, s + 1) : newest_row();
    std::fill_n(w, doubles, 0.0);
    find_differences(here, differences);
    sub_step(n_ - 1, steps_[s], here, differences, to, differences_.row(1 - at_), w);
    const double below = steps_[s > 0 ? s - 1 : S_ - 1].stride, above = steps_[s].stride;
    for (int a = 0; a < d_; ++a)
      for (int v = 0; v < layout_.packs(); ++v)
        for (int l = 0; l < lanes; ++l) {
          const std::size_t at = delf::at(a) * size_ + delf::at(layout_.at(v) + l);
          const double from_below = (here[at] - before[at]) / below, to_above = (next[at] - here[at]) / above;
          worst = larger_or_nan(std::abs(from_below + w[at] - to_above), worst);
          size = larger_or_nan(std::abs(from_below) + std::abs(w[at]) + std::abs(to_above), size);
        }
  }
  return size != 0 ? worst / size : 0;
}

void CompositionStepper::visit(SavedState& state) {
  const auto visit_rows = [&](std::string_view name, RowBuffer& rows) {
    for (int r = 0; r < rows.rows(); ++r) state.numbers(name, rows.row(r), delf::at(d_) * size_);
  };
  visit_rows("y", newest_), visit_rows("velocity", velocity_), visit_rows("differences", differences_);
  visit_rows("slabs", slabs_), visit_rows("saved", saved_);
  for (Held& held : held_) state.numbers("wall", held.value.data(), held.value.size());
  state("which differences", at_), state("newest row", n_), state("row saved", saved_row_), state("slabs held", known_);
}

StepReport CompositionStepper::report(bool residual) const {
  StepReport report{.iterates = false, .matrix_free = true, .solver = "explicit sub-steps, row by row"};
  report.behind.assign(S_ * d_, 1);
  std::fill_n(report.behind.begin(), d_, 0);
  if (!options_.processor.empty()) report.solver += "; rows of a kernel, processed where they are recorded";
  const std::size_t work = saved_.bytes() + squares_.bytes() + observed_.bytes() + observed_differences_.bytes() +
                           scratch_.bytes() + positions_.bytes() + layout_.bytes() + ends_.bytes();
  report.bytes = newest_.bytes() + velocity_.bytes() + differences_.bytes() + slabs_.bytes() + work;
  if (residual && !scratch_.rows()) report.bytes_to_come = RowBuffer::bytes_of(delf::at(d_) * size_, scratch_rows());
  report.memory = fmt::format(
      "rows of the field {} B, differences {} B, momenta {} B, rows between sub-steps {} B, work space {} B",
      newest_.bytes(), differences_.bytes(), velocity_.bytes(), slabs_.bytes(), work + report.bytes_to_come);
  return report;
}

}  // namespace delf

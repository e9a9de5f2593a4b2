// SPDX-License-Identifier: MIT
#include "schemes/system/lattice_system.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/stencil.hpp"
#include "schemes/system/assembled_row.hpp"
#include "schemes/system/assembly.hpp"

namespace delf {
namespace {

Cell cell_at(const Lattice& lattice, const StencilFamily& family, std::int64_t row, int i, double time_step) {
  if (family.listed()) return {time_step, lattice.space_step(), static_cast<double>(row) * time_step, 0, i};
  const int home = lattice.home(i);
  return {time_step, lattice.space_step(), static_cast<double>(row) * time_step, lattice.position(home)};
}

/// The equations see sites beside walls as fixed or natural: what walls keep beside φ is in terms of the action there.
Lattice with_free_neighbours(const Lattice& lattice) {
  const auto kept = [](Wall wall) { return wall == Wall::clamped ? Wall::fixed : wall; };
  if (kept(lattice.left()) == lattice.left() && kept(lattice.right()) == lattice.right()) return lattice;
  return Lattice::interval(lattice.sites(), lattice.length(), kept(lattice.left()), kept(lattice.right()));
}

}  // namespace

std::vector<Component> fields(int d) {
  std::vector<Component> result;
  for (int a = 0; a < d; ++a)
    result.push_back({d == 1 ? "phi" : "phi" + std::to_string(a + 1), Role::field, {}, false, a});
  return result;
}

double Window::operator()(std::int64_t row, int i, int a) const {
  const auto& values = rows[delf::at(std::clamp(row, first_row, last_row()) - first_row)];
  if (!lattice->is_circle()) return values[i * components + a];
  const int home = lattice->wrapped(i);
  const double value = values[home * components + a];
  return value + (i - home) / lattice->sites() * (monodromies.empty() ? monodromy : monodromies[a]);
}

double Window::low_part(std::int64_t row, int i, int a) const {
  if (!has_low()) return 0;
  const int home = lattice->is_circle() ? lattice->wrapped(i) : i;
  return low[delf::at(std::clamp(row, first_row, last_row()) - first_row)][delf::at(home * components + a)];
}

LatticeSystem::LatticeSystem(const Lattice& lattice, std::vector<std::shared_ptr<const StencilFamily>> families,
                             double time_step, std::vector<Component> components)
    : lattice_(with_free_neighbours(lattice)),
      families_(std::move(families)),
      time_step_(time_step),
      times_(std::make_shared<RowTimes>(time_step)),
      names_(std::move(components)) {
  int read = 0;
  for (const auto& family : families_) {
    for (const VertexValue& value : family->values()) read = std::max(read, value.component + 1);
    if (family->pattern().placement == Placement::brick_wall) placement_ = Placement::brick_wall;
    const auto [least, most] = std::ranges::minmax(family->pattern().vertices, {}, &Site::space);
    if (!family->listed()) width_ = std::max(width_, most.space - least.space);
    const auto [low, high] = std::ranges::minmax(family->pattern().vertices, {}, &Site::time);
    height_ = std::max(height_, high.time - low.time);
    if (!lattice_.is_circle() && !family->listed() && most.space - least.space >= lattice_.sites())
      throw BadInput(
          "lattice.stencil",
          lattice_.space() == Space::point
              ? "lattice.stencil: this stencil has sites side by side, and on lattice.space = point there is "
                "one; use midpoint, trapezoidal or vertex"
              : "lattice.stencil: the interval is shorter than the stencil; raise lattice.sites");
  }
  if (names_.empty()) names_ = delf::fields(read);
  int field = 0;
  for (Component& component : names_)
    if (component.role == Role::field) component.field = field++;
  if (read > this->components())
    throw BadInput("lattice.stencil", "lattice.stencil: a stencil reads component " + std::to_string(read - 1) +
                                          " of " + std::to_string(this->components()) + "; name every component");
  require_closing(lattice_, placement_);
}

bool is_variational(const LatticeSystem& system) {
  return std::ranges::all_of(system.families(), [](const auto& family) { return family->is_variational(); });
}

int LatticeSystem::fields() const {
  return static_cast<int>(std::ranges::count(names_, Role::field, &Component::role));
}

int LatticeSystem::field_component(int a) const {
  const auto at =
      std::ranges::find_if(names_, [a](const Component& c) { return c.role == Role::field && c.field == a; });
  if (at == names_.end()) throw std::logic_error("the system has no field " + std::to_string(a));
  return static_cast<int>(at - names_.begin());
}

bool LatticeSystem::moves() const { return std::ranges::any_of(names_, &Component::position); }

double LatticeSystem::monodromy_of(int component, double monodromy) const {
  const Role role = this->component(component).role;
  return role == Role::multiplier || role == Role::slaved ? 0.0 : monodromy;
}

std::vector<LatticeSystem::Touch> LatticeSystem::touching(const Lattice& lattice, Site site, int component) const {
  std::vector<Touch> result;
  for (std::size_t f = 0; f < families_.size(); ++f) {
    const StencilFamily& family = *families_[f];
    for (int i = 0; i < family.size(); ++i) {
      if (family.values()[i].component != component || !family.is_varied(i)) continue;
      if (const ListedStencils* const listed = family.listed()) {
        for (const auto& [stencil, place] : listed->touching(site.space))
          if (place == family.site(i).space)
            result.push_back({&family, {-family.site(i).time, stencil}, i, static_cast<int>(f)});
        continue;
      }
      const Site vertex = family.site(i), offset{-vertex.time, -vertex.space}, anchor = site + offset;
      if (delf::has_stencil(lattice, family.pattern(), anchor))
        result.push_back({&family, offset, i, static_cast<int>(f)});
    }
  }
  return result;
}

std::vector<Coefficient> LatticeSystem::linearised(const Lattice& lattice, Site site, int component) const {
  if (lattice.is_fixed(site.space) && this->component(component).at.space == 0) return {};
  // Fields of order one suit most densities; where one is not defined there (a root, a logarithm), smaller ones do.
  for (double amplitude = 2; amplitude > 1e-8; amplitude /= 10)
    if (auto coefficients = linearised(lattice, site, component, amplitude)) return *coefficients;
  throw BadInput("theory.name",
                 "the density has no finite second derivatives near the field 0, nor near 1; shift the field so that "
                 "zero is a state of the theory");
}

std::optional<std::vector<Coefficient>> LatticeSystem::linearised(const Lattice& lattice, Site site, int component,
                                                                  double amplitude) const {
  struct Sum {
    double scale = 0, at[3] = {0, 0, 0};
    void add(int s, double J) { at[s] += J, scale += std::abs(J); }
    double most() const { return *std::max_element(at, at + 3); }
    double least() const { return *std::min_element(at, at + 3); }
    double round_off() const { return 1e-13 * scale; }
    bool is_constant() const { return most() - least() <= round_off(); }
  };
  // On fine lattices what varies is of the size of h² beside constants, and soon of that of rounding: it is looked for on
  // a cell of the same shape whose longer side is 1 too. Derivatives' part is the same there.
  struct Sample {
    double constant = 0;
    Sum here, wide;
  };
  const auto around = [&](double centre) -> std::optional<std::vector<Coefficient>> {
    std::map<std::tuple<Site, int>, Sample> samples;
    std::mt19937_64 engine(20250901);
    const auto number = [&] {
      return centre + amplitude * (2.0 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1.0);
    };
    // One random value for each unknown near the site, the same for all stencils that contain it.
    std::map<std::tuple<Site, int>, std::array<double, 3>> field;
    std::map<const StencilFamily*, std::optional<ConstantPart>> constant_parts;
    for (const Touch& touch : touching(lattice, site, component)) {
      const int size = touch.family->size();
      std::vector<double> y(size), J(y.size());
      // Anchors of the bulk are all alike: the place matters to a placed density only, and there any place will do.
      const int anchor = touch.family->listed() ? touch.anchor.space : site.space + touch.anchor.space;
      const Cell cell = cell_at(lattice, *touch.family, site.time + touch.anchor.time, anchor, time_step_);
      const double widened = 1 / std::min(1.0, std::max(cell.time_step, cell.space_step));
      Cell wide = cell;
      wide.time_step *= widened, wide.space_step *= widened;
      const auto key = [&](int m) {
        const Site vertex = touch.family->site(m);
        return std::tuple{Site{touch.anchor.time + vertex.time, touch.family->column(anchor, m) - site.space},
                          touch.family->values()[m].component};
      };
      const auto [part, first] = constant_parts.try_emplace(touch.family);
      if (first || touch.family->listed()) part->second = touch.family->constant_part(cell);
      if (part->second)
        for (int m = 0; m < size; ++m) samples[key(m)].constant += part->second->J[touch.index * size + m];
      for (int s = 0; s < 3; ++s) {
        for (int m = 0; m < size; ++m) {
          auto [where, fresh] = field.try_emplace(key(m));
          if (fresh) where->second = {number(), number(), number()};
          y[m] = where->second[s];
        }
        touch.family->jacobian_row(touch.index, cell, y, J);
        for (int m = 0; m < size; ++m) samples[key(m)].here.add(s, J[m]);
        if (widened != 1) touch.family->jacobian_row(touch.index, wide, y, J);
        for (int m = 0; m < size; ++m) samples[key(m)].wide.add(s, J[m]);
      }
    }
    std::vector<Coefficient> result;
    for (const auto& [where, sample] : samples) {
      const Sum& here = sample.here;
      if (!std::isfinite(here.scale)) return std::nullopt;
      const bool constant = here.is_constant() && (sample.wide.is_constant() || !std::isfinite(sample.wide.scale));
      if (constant && std::max(std::abs(here.least()), std::abs(here.most())) <= here.round_off()) continue;
      const double value = std::abs(sample.constant) <= here.round_off() ? 0.0 : sample.constant;
      result.push_back(
          {std::get<0>(where), std::get<1>(where), value, constant ? Dependence::linear : Dependence::nonlinear});
    }
    return result;
  };
  // A density that is not defined around 0 (a logarithm) may be so around 1.
  auto found = around(0);
  return found ? found : around(1);
}

SystemPattern LatticeSystem::pattern() const {
  SystemPattern pattern;
  pattern.components = components();
  pattern.width = lattice_.space() == Space::mesh ? lattice_.sites() : std::max(width_, 1);
  pattern.placement = placement_;
  for (const Component& component : names_) pattern.names.push_back(component.name);
  // Round a circle the sites are alike, but for their parity in a brick wall.
  using Known = std::map<std::pair<int, int>, std::vector<Coupling>>;
  // The families of a mesh differ in the numbers of their stencils alone: one that keeps no value stands for all.
  int any = 0;
  while (lattice_.space() == Space::mesh && any + 1 < lattice_.sites() && lattice_.is_fixed(any)) ++any;
  pattern.equations = [this, any, known = std::make_shared<Known>()](const Lattice& lattice, Site site, int component) {
    if (lattice.space() == Space::mesh) site.space = any;
    const auto find = [&] {
      std::vector<Coupling> couplings;
      for (const Coefficient& c : linearised(lattice, site, component))
        couplings.push_back({c.offset, c.component, c.dependence});
      return couplings;
    };
    // between walls sites differ; round a circle and on a point all are alike
    if (lattice.space() == Space::interval) return find();
    const bool bricks = placement_ == Placement::brick_wall;
    const auto [at, fresh] = known->try_emplace({component, bricks ? (site.time + site.space) & 1 : 0});
    if (fresh) at->second = find();
    return at->second;
  };
  return pattern;
}

Window LatticeSystem::window(std::int64_t first_row, std::vector<std::vector<double>> rows, double monodromy) const {
  Window window{&lattice_, components(), monodromy, first_row, std::move(rows)};
  for (int c = 0; c < components(); ++c) window.monodromies.push_back(monodromy_of(c, monodromy));
  return window;
}

bool LatticeSystem::has_stencil(const StencilFamily& family, std::int64_t row, int site) const {
  return family.listed() || delf::has_stencil(lattice_, family.pattern(), {static_cast<int>(row & 1), site});
}

void LatticeSystem::equations(const Window& window, std::int64_t row, std::vector<Value>& values) const {
  AssembledRow(*this).equations(window, row, values);
}

void LatticeSystem::jacobian(const Window& window, std::int64_t row, int site, int component, std::int64_t unknown_row,
                             double time_step, std::vector<Entry>& entries) const {
  std::vector<Node> unknowns;
  for (int i = 0; i < lattice_.sites(); ++i)
    for (int c = 0; c < components(); ++c) unknowns.push_back({{static_cast<int>(unknown_row - row), i}, c});
  Assembly assembly(*this, {.equations = {{{0, site}, component}},
                            .unknowns = std::move(unknowns),
                            .parity = static_cast<int>(row & 1),
                            .past = height_,
                            .future = height_,
                            .monodromy = window.monodromy});
  assembly.set_time_step(time_step);
  std::vector<double> values;
  assembly.jacobian(SectionRing(window, row - height_, row + height_), row, values);
  for (std::size_t n = 0; n < values.size(); ++n)
    if (values[n] != 0) entries.push_back({site * components() + component, assembly.places()[n].unknown, values[n]});
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <queue>
#include <random>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "jets/tables/rectangle_jet.hpp"
#include "jets/tables/spacetime_element.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/families/vertex_constraint.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/system/slab_extent.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "schemes/theories/wave_map.hpp"
#include "schemes/verify/form_check.hpp"
#include "schemes/verify/wrong_sign.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/families/random_stencil.hpp"
#include "tests/verification/patch.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double round_off = 1e-13, k = 0.5, h = 0.2;

/// Values of a test case, which are reported with it: how much room its bounds have.
struct Extremes {
  double least = INFINITY, most = 0;
  int count = 0;
  void operator()(double value) { least = std::min(least, value), most = std::max(most, value), ++count; }
};

/// Circles and intervals of 12 to 24 sites, walls of either sort.
Lattice lattice_of(int seed) {
  const int N = 12 + seed % 13;
  if (seed % 3 == 0) return Lattice::circle(N, N * k);
  const Wall wall = seed % 3 == 1 ? Wall::natural : Wall::fixed;
  return Lattice::interval(N, (N - 1) * k, wall, wall);
}

Family random_lagrangian(int seed) {
  return std::make_shared<LagrangianFamily<RandomStencil>>(RandomStencil(static_cast<std::uint64_t>(seed)));
}

/// Nothing where the stencils cannot be stepped on this lattice.
std::optional<SolvePlan> plan_if_any(const LatticeSystem& system) {
  try {
    return make_plan(system.lattice(), system.pattern());
  } catch (const BadInput&) {
    return std::nullopt;
  }
}

/// A residual that is no gradient, on the same stencils: rⁱ = Σ_j a_ij yʲ + c_i (yⁱ⁺¹)² yⁱ, and a is not symmetric.
class RandomResidual final : public StencilFamily {
 public:
  RandomResidual(int seed, bool says_variational)
      : StencilFamily(RandomStencil(static_cast<std::uint64_t>(seed)).pattern(),
                      RandomStencil(static_cast<std::uint64_t>(seed)).values(), says_variational),
        n_(delf::at(pattern_.size())) {
    Random random(static_cast<std::uint64_t>(5000 + seed));
    for (std::size_t n = 0; n < n_ * n_; ++n) linear_.push_back(random(-1, 1));
    for (std::size_t n = 0; n < n_; ++n) cubic_.push_back(random(-0.3, 0.3));
  }
  void residual(const Cell&, std::span<const double> y, std::span<double> r) const override {
    for (std::size_t i = 0; i < n_; ++i) {
      r[i] = cubic_[i] * y[next(i)] * y[next(i)] * y[i];
      for (std::size_t j = 0; j < n_; ++j) r[i] += linear_[i * n_ + j] * y[j];
    }
  }
  void jacobian(const Cell&, std::span<const double> y, std::span<double> J) const override {
    std::ranges::copy(linear_, J.begin());
    for (std::size_t i = 0; i < n_; ++i) {
      J[i * n_ + i] += cubic_[i] * y[next(i)] * y[next(i)];
      J[i * n_ + next(i)] += 2 * cubic_[i] * y[next(i)] * y[i];
    }
  }

 private:
  std::size_t next(std::size_t i) const { return (i + 1) % n_; }
  std::size_t n_;
  std::vector<double> linear_, cubic_;
};

/// Circles, and intervals with fixed walls: a residual stencil gives no equation at a natural wall.
Lattice lattice_without_natural_walls(int seed) { return lattice_of(seed % 3 == 1 ? seed + 1 : seed); }

/// A random section on a region of the kind, with room for stencils that reach two rows and two columns; nothing where
/// the lattice has no room.
std::optional<Patch> draw(RegionKind kind, const Lattice& lattice, const FamilyList& families,
                          std::mt19937_64& random) {
  RegionFrame frame{{2, 10}, 2, 2};
  for (const Family& family : families)
    for (const Site v : family->pattern().vertices) frame.nodes = std::max(frame.nodes, v.node + 1);
  const auto centres = draw_centres(kind, lattice, frame, random);
  if (centres.empty()) return std::nullopt;
  Patch patch(lattice, families, h, centres);
  REQUIRE(patch.U().regular());
  patch.y = random_values(random, patch.on.nodes());
  return patch;
}

Window random_window(const LatticeSystem& system, int rows, std::mt19937_64& random) {
  std::vector<std::vector<double>> values;
  for (int r = 0; r < rows; ++r)
    values.push_back(random_values(random, delf::at(system.lattice().sites() * system.components())));
  return system.window(0, std::move(values), 0);
}

std::vector<RegionRequest> every_kind() {
  std::vector<RegionRequest> requests;
  for (const RegionKind kind : region_kinds()) requests.push_back({to_string(kind), kind});
  return requests;
}

/// int U has two sites over one another: equations that feel each other across rows, which are not symmetric there.
bool has_two_rows(const Patch& patch) {
  return std::ranges::any_of(patch.U().interior(), [&](Site b) {
    return patch.U().in_interior(b + Site{1, 0}) && !patch.system->is_held(b.space, 0);
  });
}

}  // namespace

TEST_CASE(
    "verify: random Lagrangians on random stencils keep form formula and local identity on regions of every kind") {
  Extremes form, local;
  std::array<int, 6> drawn{};
  for (int seed = 0; seed < 45; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    for (const RegionKind kind : region_kinds()) {
      const auto patch = draw(kind, lattice_of(seed), {random_lagrangian(seed)}, random);
      if (!patch || patch->on.equations().empty()) continue;
      ++drawn[delf::at(kind)];
      const auto pair = patch->variations(random);
      CAPTURE(seed, to_string(kind), patch->y.size());
      form(patch->form_formula(pair).relative());
      local(patch->on.local_identity(patch->y, pair).balance.relative());
      CHECK(patch->form_formula(pair).relative() <= round_off);
      CHECK(patch->on.local_identity(patch->y, pair).balance.relative() <= round_off);
      CHECK(patch->form_formula(pair).count > 0);
    }
  }
  CAPTURE(form.most, local.most);
  CHECK(form.most > 0);  // something was summed
  CHECK(local.most > 0);
  for (const int count : drawn) CHECK(count >= 20);
}

TEST_CASE("verify: first variations that are evolved by a random stencil's plan keep the form formula") {
  Extremes largest;
  int planned = 0, evolved = 0;
  for (int seed = 0; seed < 45; ++seed) {
    const LatticeSystem system(lattice_of(seed), {random_lagrangian(seed)}, h);
    const std::optional<SolvePlan> plan = plan_if_any(system);
    if (!plan) continue;
    ++planned;
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const int rows = FormCheck::rows_wanted(system, *plan, every_kind());
    FormCheck check(system, *plan, rows, {.regions = every_kind()});
    check.at(random_window(system, rows, random), random);
    evolved += std::ranges::any_of(check.points(), [](const FormCheck::Point& point) { return !point.local; });
    CHECK(check.checks().size() >= 5);
    for (const Check& one : check.checks()) {
      CAPTURE(seed, one.name, one.region, one.failure);
      largest(one.value);
      CHECK(one.value <= round_off);
    }
  }
  CAPTURE(planned, evolved, largest.most);
  CHECK(planned > 20);
  CHECK(evolved > 20);
  CHECK(largest.most > 0);
}

TEST_CASE(
    "verify: on its solved rows an evolved variation solves every linearised equation, on the rows before it does "
    "not") {
  Extremes inside, before;
  for (int seed = 0; seed < 45; ++seed) {
    const Lattice lattice = lattice_of(seed);
    const LatticeSystem system(lattice, {random_lagrangian(seed)}, h);
    const std::optional<SolvePlan> plan = plan_if_any(system);
    if (!plan) continue;
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const int rows = Tangent::least_rows(system, *plan) + 4, N = lattice.sites();
    Tangent tangent(system, *plan, rows, 0);
    const Range on = Tangent::solved_rows(system, *plan, rows);
    const Window y = random_window(system, rows, random);
    const Window V = tangent.evolve(y, 1, random).front();
    const RegionSystem all(system, Region::rectangle(lattice, patterns_of(system), {0, rows - 1}, {0, N - 1}));
    const auto left = all.linearised(all.restricted(y), all.restricted(V));
    for (std::size_t n = 0; n < left.size(); ++n) {
      const int row = all.node(all.equations()[n]).site.time;
      const bool solved = row >= on.first && row <= on.last;
      if (row < 2 || row > rows - 3) continue;  // some of its stencils are not here
      CAPTURE(seed, row, rows, on.first, on.last);
      if (solved) inside(left[n].relative());
      else if (row < on.first) before(left[n].relative());
      if (solved) CHECK(left[n].relative() <= round_off);
    }
  }
  CAPTURE(inside.count, inside.most, before.most);
  CHECK(inside.count > 1000);
  CHECK(before.most > 0.1);
}

TEST_CASE("verify: a wrong sign of any one residual is found on regions of every kind") {
  const StencilTable nodes = spacetime_element(2, 2, TimeQuadrature::gauss);
  std::vector<FamilyList> schemes{
      {jet_family(nodes, SineGordon{})},
      {jet_family(stencil_table(rectangle.table), WaveMap{}),
       std::make_shared<LagrangianFamily<VertexConstraint<WaveMap>>>(VertexConstraint<WaveMap>{})}};
  for (const SchemeName& scheme : variational_schemes) schemes.push_back({make_family("sine-gordon", scheme)});
  const std::size_t named = schemes.size();
  for (int seed = 0; seed < 12; ++seed) schemes.push_back({random_lagrangian(seed)});

  Extremes value;
  int same = 0;
  for (std::size_t s = 0; s < schemes.size(); ++s) {
    const Lattice lattice = s < named ? Lattice::circle(14, 14 * k) : lattice_of(static_cast<int>(s - named));
    std::mt19937_64 random(s);
    for (std::size_t f = 0; f < schemes[s].size(); ++f)
      for (int wrong = 0; wrong < schemes[s][f]->size(); ++wrong) {
        FamilyList families = schemes[s];
        families[f] = std::make_shared<WrongSign>(families[f], wrong);
        // A node in the middle of an element has one residual, which is its equation: with either sign it is the same.
        const NodePosition at = nodes.nodes[families[f]->site(wrong).node];
        const bool equivalent = s == 0 && at.time > 0 && at.space > 0;
        for (const RegionKind kind : region_kinds()) {
          const auto patch = draw(kind, lattice, families, random);
          if (!patch) continue;
          const auto pair = patch->variations(random);
          const double form = patch->form_formula(pair).relative(),
                       local = patch->on.local_identity(patch->y, pair).balance.relative();
          CAPTURE(s, f, wrong, to_string(kind), form, local);
          if (equivalent) {
            ++same;
            CHECK(form < round_off);
            // at V and W that are no first variations it shows
            const RegionSystem::Pair any{random_values(random, patch->y.size()),
                                         random_values(random, patch->y.size())};
            CHECK(patch->on.local_identity(patch->y, any).balance.relative() > 1e-9);
            continue;
          }
          value(std::max(form, local));
          CHECK(std::max(form, local) > 1e-9);
        }
      }
  }
  CAPTURE(value.count, value.least);
  CHECK(value.count > 600);
  CHECK(same == 5);  // one such node, and on a circle there are no walls
}

TEST_CASE("verify: a variation that is changed at one node of the boundary is found on regions of every kind") {
  Extremes value;
  for (int seed = 0; seed < 45; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(300 + seed));
    for (const RegionKind kind : region_kinds()) {
      const auto patch = draw(kind, lattice_of(seed), {random_lagrangian(seed)}, random);
      if (!patch || patch->on.equations().empty()) continue;
      auto pair = patch->variations(random);
      const auto node = patch->on.coupling_node(patch->y);
      REQUIRE(node);
      pair.V[*node] += 0.01;
      CAPTURE(seed, to_string(kind), patch->form_formula(pair).relative());
      value(patch->form_formula(pair).relative());
      CHECK(patch->form_formula(pair).relative() > 1e-8);
    }
  }
  CAPTURE(value.count, value.least);
  CHECK(value.count > 120);
}

TEST_CASE("verify: the words of a failed form formula name a row and a site next to the changed one") {
  Extremes value;
  for (int seed = 0; seed < 12; ++seed) {
    const LatticeSystem system(lattice_of(seed), {random_lagrangian(seed)}, h);
    const std::optional<SolvePlan> plan = plan_if_any(system);
    if (!plan) continue;
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const int N = system.lattice().sites();
    for (const RegionKind kind : region_kinds()) {
      const auto centres = draw_centres(kind, system.lattice(), {{2, 8}, 2, 2}, random);
      if (centres.empty()) continue;
      // given by its sites, the region is the same every time, and so is the node that is changed
      RegionRequest given{"given", {}, region_around(system.lattice(), patterns_of(system), centres).sites()};
      const int first = given.sites.front().time;
      for (Site& site : given.sites) site.time -= first;
      const int rows = FormCheck::rows_wanted(system, *plan, {given});
      FormCheck check(system, *plan, rows, {.regions = {given}, .break_variation = true});
      const Window y = random_window(system, rows, random);
      const auto region = RegionDrawer(system, check.solved_rows()).draw(given, random);
      if (!region) continue;
      const RegionSystem on(system, *region, y.first_row);
      const auto changed = on.coupling_node(on.restricted(y));
      if (!changed) continue;
      check.at(y, random);

      const Check form = check.checks().front();
      CAPTURE(seed, to_string(kind), form.value, form.region, form.failure);
      CHECK(form.value > 1e-8);
      value(form.value);
      const auto words = form.failure.find("no first variation: at row ");
      REQUIRE(words != std::string::npos);
      int row = 0, site = 0;
      REQUIRE(std::sscanf(form.failure.c_str() + words, "no first variation: at row %d, site %d", &row, &site) == 2);
      const Site here = on.node(*changed).site;
      const int apart = system.lattice().is_circle() ? std::min(system.lattice().wrapped(site - here.space),
                                                                system.lattice().wrapped(here.space - site))
                                                     : std::abs(site - here.space);
      CAPTURE(here.time + on.origin(), here.space, N);
      CHECK(std::abs(row - static_cast<int>(here.time + on.origin())) <= 2);
      CHECK(apart <= 2);
    }
  }
  CAPTURE(value.count, value.least);
  CHECK(value.count > 40);
}

TEST_CASE("verify: comparators fail on every region of two rows, unless their theory is linear") {
  const std::vector<SchemeName> named{{"", "vu-quoc-li"}, {"", "guo"}, {"", "damped"}};
  Extremes nonlinear, linear;
  for (const char* theory : {"sine-gordon", "phi4", "double-sine-gordon", "klein-gordon"})
    for (const SchemeName& scheme : named)
      for (int seed = 0; seed < 8; ++seed) {
        const bool passes = theory == std::string("klein-gordon") && scheme.method != "damped";
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        for (const RegionKind kind : region_kinds()) {
          const auto patch = draw(kind, lattice_without_natural_walls(seed), {make_family(theory, scheme)}, random);
          if (!patch || !has_two_rows(*patch)) continue;
          const double value = patch->form_formula(patch->variations(random)).relative();
          CAPTURE(theory, scheme.method, seed, to_string(kind), value);
          (passes ? linear : nonlinear)(value);
          if (passes) CHECK(value <= round_off);
          else CHECK(value > 1e-9);
        }
      }
  CAPTURE(nonlinear.count, nonlinear.least, linear.count, linear.most);
  CHECK(nonlinear.count > 200);
  CHECK(linear.count > 40);
}

TEST_CASE("verify: random residuals that are no gradients fail, whether they say so or not") {
  Extremes silent, boastful;
  for (int seed = 0; seed < 40; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    for (const RegionKind kind : region_kinds()) {
      for (const bool says_variational : {false, true}) {
        const auto patch =
            draw(kind, lattice_of(seed), {std::make_shared<RandomResidual>(seed, says_variational)}, random);
        if (!patch) continue;
        CAPTURE(seed, to_string(kind), says_variational);
        if (says_variational) {
          const auto pair = patch->variations(random);
          boastful(patch->on.local_identity(patch->y, pair).balance.relative());
          CHECK(patch->on.local_identity(patch->y, pair).balance.relative() > 1e-9);
          continue;
        }
        const auto pair = patch->on.least_mutual(patch->y);
        if (!pair) continue;  // no two equations of int U feel one another
        const double value = patch->form_formula(patch->variations(random)).relative();
        silent(value);
        CHECK(value > 1e-9);
        CHECK(std::abs(pair->b_by_a - pair->a_by_b) > 1e-9);
      }
    }
  }
  CAPTURE(silent.count, silent.least, boastful.count, boastful.least);
  CHECK(silent.count > 100);
  CHECK(boastful.count > 100);
}

// ---- first variations and runs side by side

namespace {

/// Rows 0 … count − 1 of a run from these rows, every component at its own row.
std::vector<std::vector<double>> rows_of_run(const Problem& problem, const std::vector<std::vector<double>>& start,
                                             int count) {
  Simulation simulation(problem);
  simulation.start(start);
  const Evolution& evolution = simulation.evolution();
  const int behind = std::ranges::max(slab_extent(evolution.system(), evolution.plan()).behind);
  std::vector<std::vector<double>> rows;
  for (int row = 0; row < count; ++row) {
    while (simulation.newest() - behind < row) simulation.step();
    rows.push_back(evolution.stepper().window(static_cast<int>(simulation.newest()) - row + 1).rows.front());
  }
  return rows;
}

/// Smooth rows to start from: the angle θ(t, x), or the point of the unit sphere at that angle on a tilted great
/// circle.
std::vector<std::vector<double>> smooth_start(const Problem& problem) {
  const Simulation simulation(problem);
  const auto& components = simulation.components();
  const int fields = simulation.count(Role::field);
  std::vector<std::vector<double>> rows;
  for (int r = 0; r < simulation.starting_rows(); ++r) {
    rows.emplace_back();
    for (int i = 0; i < problem.lattice.sites(); ++i)
      for (std::size_t c = 0; c < components.size(); ++c) {
        const double t = (r + components[c].at.time) * problem.time_step;
        const double x = (i + components[c].at.space) / problem.lattice.cells();
        const double angle = 0.8 * std::sin(2 * std::numbers::pi * x + 0.3) * std::cos(t) + 0.4 * t;
        if (components[c].role == Role::multiplier) rows.back().push_back(0);
        else if (fields == 1) rows.back().push_back(angle);
        else rows.back().push_back(c == 0 ? std::cos(angle) : (c == 1 ? 0.6 : 0.8) * std::sin(angle));
      }
  }
  return rows;
}

/// max |V − (y(+ε) − y(−ε))/2ε| / max |V| over the rows where V solves the linearised equations, for y(±ε) that start
/// from y ± εV; V is multiplied by `factor` there.
double derivative_error(const Problem& problem, double factor, int& rows_compared) {
  constexpr double epsilon = 1e-6;
  const Simulation simulation(problem);
  const LatticeSystem& system = simulation.evolution().system();
  const SolvePlan& plan = simulation.evolution().plan();
  const int rows = Tangent::least_rows(system, plan) + 8;
  const auto start = smooth_start(problem);
  const auto y = rows_of_run(problem, start, rows);

  Tangent tangent(system, plan, rows, 0);
  const Range on = Tangent::solved_rows(system, plan, rows);
  std::mt19937_64 random(3);
  const auto V = tangent.evolve(system.window(0, y, 0), 2, random).back().rows;
  const auto nearby = [&](double by) {
    auto moved = start;
    for (std::size_t r = 0; r < start.size(); ++r)
      for (std::size_t n = 0; n < start[r].size(); ++n) moved[r][n] += by * V[r][n];
    return rows_of_run(problem, moved, rows);
  };
  const auto above = nearby(epsilon), below = nearby(-epsilon);
  double error = 0, size = 0;
  rows_compared = 0;
  for (int r = on.first; r <= on.last; ++r, ++rows_compared)
    for (std::size_t n = 0; n < y.front().size(); ++n) {
      const std::size_t row = r;
      error = std::max(error, std::abs(factor * V[row][n] - (above[row][n] - below[row][n]) / (2 * epsilon)));
      size = std::max(size, std::abs(V[row][n]));
    }
  return error / size;
}

}  // namespace

TEST_CASE("verify: an evolved first variation is the derivative of the engine's own run") {
  std::vector<Problem> problems(4);
  problems[0].stencil = "rectangle-symmetric", problems[0].lattice = Lattice::circle(24, 12);
  problems[1] = problems[0], problems[1].lattice = Lattice::interval(25, 12);
  problems[2].theory = "wave-map", problems[2].stencil = "rectangle", problems[2].lattice = Lattice::circle(24, 12);
  problems[3].method = "spacetime", problems[3].lattice = Lattice::circle(12, 12);
  for (Problem& p : problems) {
    p.time_step = 0.4 * p.lattice.space_step();
    int rows = 0;
    const double error = derivative_error(p, 1, rows), wrong = derivative_error(p, 1 + 1e-4, rows);
    CAPTURE(p.theory, p.method, p.lattice.is_circle(), rows, error, wrong);
    CHECK(error < 1e-6);
    CHECK(wrong > 1e-5);  // the comparison can fail
    CHECK(rows >= 6);
  }
}

// ---- the regions themselves

namespace {

/// Sites that can be reached from one of them, going up, down, left and right; a circle closes.
std::set<Site> reached_from(const Lattice& lattice, Site start, const std::set<Site>& allowed) {
  std::set<Site> reached{start};
  std::queue<Site> next({start});
  while (!next.empty()) {
    const Site at = next.front();
    next.pop();
    for (const Site step : {Site{0, 1}, Site{0, -1}, Site{1, 0}, Site{-1, 0}}) {
      Site to = at + step;
      if (lattice.is_circle()) to.space = lattice.wrapped(to.space);
      if (allowed.contains(to) && reached.insert(to).second) next.push(to);
    }
  }
  return reached;
}
bool connected(const Lattice& lattice, const std::vector<Site>& sites) {
  const std::set<Site> all(sites.begin(), sites.end());
  return reached_from(lattice, *all.begin(), all).size() == all.size();
}

/// A site that is not in U and from which every way out goes through U; beyond the walls of an interval is out.
bool has_hole(const Lattice& lattice, const Region& U) {
  const int first = U.sites().front().time - 1, last = U.sites().back().time + 1;
  const int left = lattice.is_circle() ? 0 : -1, right = lattice.is_circle() ? lattice.sites() - 1 : lattice.sites();
  std::set<Site> outside;
  for (int j = first; j <= last; ++j)
    for (int i = left; i <= right; ++i)
      if (i < 0 || i >= lattice.sites() || !U.contains(Site{j, i})) outside.insert({j, i});
  std::set<Site> reached = reached_from(lattice, {first, 0}, outside);
  reached.merge(reached_from(lattice, {last, 0}, outside));
  return reached.size() < outside.size();
}

bool is_rectangle(const Region& U) {
  std::set<int> rows, columns;
  for (const Site site : U.sites()) rows.insert(site.time), columns.insert(site.space);
  return U.sites().size() == rows.size() * columns.size();
}

std::vector<StencilPattern> rectangles() { return {StencilPattern(shapes::rectangle)}; }

}  // namespace

TEST_CASE("verify: regions of every kind are regular and look as their names say") {
  std::array<int, 6> drawn{};
  for (int seed = 0; seed < 200; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const Lattice lattice = lattice_of(seed);
    const RegionFrame frame{{3, 9}, 1, 1};
    for (const RegionKind kind : region_kinds()) {
      const auto centres = draw_centres(kind, lattice, frame, random);
      CAPTURE(seed, lattice.sites(), to_string(kind), centres.size());
      if (centres.empty()) {
        CHECK((kind == RegionKind::wall && lattice.is_circle()));
        continue;
      }
      ++drawn[delf::at(kind)];
      const Region U = region_around(lattice, rectangles(), centres);
      std::set<int> columns;
      for (const Site site : U.sites()) columns.insert(site.space);
      const bool everywhere = static_cast<int>(columns.size()) == lattice.sites();
      CHECK(U.regular());
      CHECK(!U.boundary().empty());
      CHECK(std::ranges::all_of(centres, [&](Site centre) { return U.in_interior(centre); }));
      CHECK(std::ranges::all_of(centres,
                                [&](Site c) { return c.time >= frame.rows.first && c.time <= frame.rows.last; }));
      CHECK(connected(lattice, U.sites()));
      CHECK(has_hole(lattice, U) >= (kind == RegionKind::hole));
      if (kind != RegionKind::random) CHECK(has_hole(lattice, U) == (kind == RegionKind::hole));
      if (kind == RegionKind::box || kind == RegionKind::wall || kind == RegionKind::slab) CHECK(is_rectangle(U));
      if (kind == RegionKind::staircase || kind == RegionKind::hole) CHECK(!is_rectangle(U));
      if (kind == RegionKind::wall) CHECK((columns.contains(0) || columns.contains(lattice.sites() - 1)));
      if (kind == RegionKind::slab) CHECK(everywhere);
      if (kind != RegionKind::slab && lattice.is_circle()) CHECK(!everywhere);
      if (kind == RegionKind::random) {
        std::vector<Site> home = centres;
        for (Site& site : home)
          if (lattice.is_circle()) site.space = lattice.wrapped(site.space);
        CHECK(connected(lattice, home));
      }
    }
  }
  for (const int count : drawn) CHECK(count >= 100);
}

TEST_CASE("verify: regions of every kind are regular for random stencils too") {
  for (int seed = 0; seed < 200; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const StencilPattern pattern = RandomStencil(static_cast<std::uint64_t>(seed)).pattern();
    for (const RegionKind kind : region_kinds()) {
      const auto centres = draw_centres(kind, lattice_of(seed), {{2, 10}, 2, 2}, random);
      if (centres.empty()) continue;
      const Region U = region_around(lattice_of(seed), {pattern}, centres);
      CAPTURE(seed, to_string(kind));
      CHECK(U.regular());
      CHECK(!U.boundary().empty());
    }
  }
}

TEST_CASE("verify: no region is drawn where there is no room for it") {
  const auto drawn = [](RegionKind kind, const Lattice& lattice, Range rows) {
    bool any = false;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      std::mt19937_64 random(seed);
      any = any || !draw_centres(kind, lattice, {rows, 1, 1}, random).empty();
    }
    return any;
  };
  using enum RegionKind;
  const Range rows{1, 8};
  for (const RegionKind kind : region_kinds()) {
    CAPTURE(to_string(kind));
    CHECK(drawn(kind, Lattice::point(), rows) == (kind == slab));  // N = 1
    // a stencil's width on either side of a centre, and nothing is left out of U
    for (const int N : {2, 3}) CHECK(drawn(kind, Lattice::circle(N, 1), rows) == (kind == slab));
    CHECK_FALSE(drawn(kind, Lattice::circle(32, 1), {3, 2}));  // no rows
    CHECK_FALSE(drawn(kind, Lattice::interval(32, 1), {3, 2}));
  }
  for (const int N : {2, 3, 4}) {
    CHECK_FALSE(drawn(hole, Lattice::interval(N, 1), rows));
    CHECK(drawn(wall, Lattice::interval(N, 1), rows));
    CHECK(drawn(staircase, Lattice::interval(N, 1), rows) == (N > 2));
  }
  CHECK_FALSE(drawn(wall, Lattice::circle(32, 1), rows));
  CHECK_FALSE(drawn(hole, Lattice::circle(32, 1), {1, 4}));  // a ring of one site and its stencils: five rows
  CHECK(drawn(hole, Lattice::circle(32, 1), {1, 5}));
}

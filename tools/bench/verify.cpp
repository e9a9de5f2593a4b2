// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <random>

#include "schemes/stepping/evolution.hpp"
#include "schemes/verify/equation_check.hpp"
#include "schemes/verify/form_check.hpp"
#include "tools/bench/commands.hpp"
#include "tools/bench/sides.hpp"
#include "tools/bench/table.hpp"

namespace delf::bench {

namespace {

/// Steps that one check is timed against, so that both last about as long.
constexpr int steps_at_once = 100;

Side many_steps(const Collision& collision) {
  Side side = engine_side(collision);
  side.advance = [advance = side.advance](long times) { advance(times * steps_at_once); };
  return side;
}

template <class Look>
Side looking(Look look) {
  return {[] {},
          [look](long times) {
            for (long n = 0; n < times; ++n) look();
          }};
}

std::vector<RegionRequest> all_regions() {
  std::vector<RegionRequest> regions;
  for (const RegionKind kind : region_kinds()) regions.push_back({to_string(kind), kind, {}});
  return regions;
}

/// The first rows of the collision, as many as regions of all kinds take.
Window first_rows(const Collision& collision, Simulation& simulation) {
  const LatticeSystem& system = simulation.evolution().system();
  const int wanted = FormCheck::rows_wanted(system, simulation.evolution().plan(), all_regions());
  std::vector<std::vector<double>> rows = collision.rows();
  simulation.start(rows);
  while (static_cast<int>(rows.size()) < wanted) {
    simulation.step();
    std::vector<double> row(rows[0].size());
    simulation.copy_row(0, row);
    rows.push_back(std::move(row));
  }
  return system.window(0, std::move(rows), 0);
}

/// The form formula (5.6) on all of space, between the rows that have equations, with one pair of first variations.
/// They may be any numbers: the sum takes as long.
class FormFormula {
 public:
  FormFormula(const Evolution& evolution, const Window& rows, std::mt19937_64& random)
      : region_(evolution.system(), slab(evolution, rows, random), rows.first_row), y_(region_.restricted(rows)) {
    std::normal_distribution<double> normal;
    for (auto* variation : {&pairs_.front().V, &pairs_.front().W})
      for (std::size_t n = 0; n < region_.nodes(); ++n) variation->push_back(normal(random));
  }
  double look() const { return region_.form_formula(y_, pairs_).front().sum; }
  double stencils() const { return static_cast<double>(region_.stencils()); }

 private:
  // Tangent says on which rows first variations, and with them the formula, would hold.
  static Region slab(const Evolution& evolution, const Window& rows, std::mt19937_64& random) {
    const Range solved = Tangent::solved_rows(evolution.system(), evolution.plan(), static_cast<int>(rows.rows.size()));
    return *RegionDrawer(evolution.system(), solved).draw({"slab", RegionKind::slab, {}}, random);
  }
  RegionSystem region_;
  RegionSystem::Values y_;
  std::vector<RegionSystem::Pair> pairs_{1};
};

std::string over(Spread ratio, double factor) {
  return in_words({ratio.median * factor, ratio.least * factor, ratio.most * factor});
}

}  // namespace

void time_verify(const Request& request) {
  fmt::print(
      "ns per stencil: a step; the field equations checked; the form formula (5.6) summed for one pair V, W; with\n"
      "their ratios to a step; tolerance 1e-13\n\n");
  const Table table(
      {{"scheme", 20}, {"N", 8}, {"step", 8}, {"equations", 9}, {"ratio", 24}, {"forms", 9}, {"ratio", 24}});
  for (const std::string& scheme : request.schemes_or(textbook_schemes()))
    for (const int sites : request.sites_or({255, 4095})) {
      const Collision collision{scheme, suited_sites(scheme, sites)};
      const auto simulation = engine(collision);
      const Evolution& evolution = simulation->evolution();
      const Window rows = first_rows(collision, *simulation);
      const double in_a_row = scheme == "hexagon" ? collision.sites / 2. : collision.sites;
      const double stepped = steps_at_once * in_a_row;
      const Side step = many_steps(collision);

      EquationCheck equations(evolution.system(), evolution.plan(), 1e-13);
      const Pairing asked = pair(looking([&] { equations.at(rows, equations.reach()); }), step, request.repeats);
      std::mt19937_64 random(1);
      const FormFormula form(evolution, rows, random);
      volatile double seen = 0;  // so that the compiler removes no sum
      const Pairing summed = pair(looking([&] { seen = form.look(); }), step, request.repeats);

      table.row({scheme, fmt::to_string(collision.sites), number(asked.b / stepped), number(asked.a / in_a_row),
                 over(asked.ratio, stepped / in_a_row), number(summed.a / form.stencils()),
                 over(summed.ratio, stepped / form.stencils())});
    }
}

}  // namespace delf::bench

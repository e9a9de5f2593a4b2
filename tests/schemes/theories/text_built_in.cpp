// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "jets/simd/scratch_rows.hpp"
#include "jets/tables/named_tables.hpp"
#include "lattice/error.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "schemes/theories/theory_text.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;

namespace {

/// A built-in theory, and what a scene would write in its place.
struct Pair {
  std::string name, density, fields, parameters, constraint, symmetry;
  int components;
  double size;  ///< of the motion that it starts with
};

/// Those of second order in time, with their parameters at the fallbacks.
std::vector<Pair> second_order(bool point) {
  std::vector<Pair> pairs;
  for (const TheoryText& text : theory_texts()) {
    const bool is_of_point = text.density.find("_x^2") == std::string::npos;
    if (is_of_point != point || text.density.find("_t^2") == std::string::npos) continue;
    std::string parameters;
    for (const auto& [name, key] : text.parameters)
      for (const Parameter& p : find_theory(text.theory).parameters)
        if (p.key == key)
          parameters += (parameters.empty() ? "" : ", ") + name + " = " + std::to_string(std::get<double>(p.fallback));
    pairs.push_back({text.theory, text.density, text.fields, parameters, text.constraint, text.symmetry,
                     1 + static_cast<int>(std::ranges::count(text.fields, ',')),
                     text.theory == "henon-heiles" ? 0.3 : 1});
  }
  return pairs;
}

const std::vector<Pair>& on_a_circle() {
  static const std::vector<Pair> pairs = second_order(false);
  return pairs;
}
const std::vector<Pair>& on_a_point() {
  static const std::vector<Pair> pairs = second_order(true);
  return pairs;
}

Problem problem(const Pair& pair, const std::string& stencil, bool as_text, bool point, bool planted = false) {
  Problem p;
  p.stencil = stencil;
  p.lattice = point ? Lattice::point() : Lattice::circle(24, 6);
  p.time_step = point ? 0.05 : 0.4 * p.lattice.space_step();
  p.theory = as_text ? "text" : pair.name;
  if (!as_text) return p;
  const auto set = [&](const char* key, const std::string& text) {
    if (!text.empty()) p.parameters[key] = text;
  };
  set("theory.density",
      !planted ? pair.density : pair.density + " + 0.01*cos(" + pair.fields.substr(0, pair.fields.find(',')) + ")");
  set("theory.fields", pair.fields);
  set("theory.parameters", pair.parameters);
  set("theory.constraint", pair.constraint);
  if (!planted) set("theory.symmetry", pair.symmetry);
  return p;
}

/// Two rows of a smooth motion; of unit length where there is a constraint.
std::vector<std::vector<double>> start(const Problem& p, const Pair& pair) {
  const int d = pair.components, C = d + (pair.constraint.empty() ? 0 : 1), N = p.lattice.sites();
  std::vector<std::vector<double>> rows(2, std::vector<double>(N * C));
  for (int r = 0; r < 2; ++r)
    for (int i = 0; i < N; ++i) {
      const double angle = 2 * std::numbers::pi * i / N, t = r * p.time_step;
      double* const y = &rows[r][i * C];
      double length = 0;
      for (int a = 0; a < d; ++a) {
        y[a] = (a == 0 ? 0.9 : 0.1) + 0.3 * std::sin(angle + a) + 0.2 * t * std::cos(angle + 2 * a) + (a == 1 ? t : 0);
        y[a] *= pair.size;
        length += y[a] * y[a];
      }
      if (!pair.constraint.empty())
        for (int a = 0; a < d; ++a) y[a] /= std::sqrt(length);
    }
  return rows;
}

struct Result {
  std::string plan;
  std::vector<double> row;
  std::vector<double> conserved;
  double energy = 0;
};

Result result(const Problem& p, const Pair& pair, int steps) {
  Simulation simulation(p);
  simulation.start(start(p, pair));
  simulation.steps(steps);
  simulation.step();
  std::vector<double> row(p.lattice.sites() * pair.components);
  simulation.copy_row(0, row);
  const auto monitors = simulation.monitors();
  return {simulation.solve_summary(), row, monitors.conserved, monitors.energy};
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, a[i] == b[i] ? 0 : std::abs(a[i] - b[i]));
  return worst;
}

void compare(const Pair& pair, const std::string& stencil, bool point, int steps) {
  INFO(pair.name << " on " << stencil);
  const Result built_in = result(problem(pair, stencil, false, point), pair, steps);
  const Result text = result(problem(pair, stencil, true, point), pair, steps);
  CHECK(text.plan == built_in.plan);
  CHECK(distance(text.row, built_in.row) < 1e-12);
  CHECK(distance(text.conserved, built_in.conserved) < 1e-12);
  CHECK(text.energy == Approx(built_in.energy).epsilon(1e-12).margin(1e-12));
  CHECK(distance(result(problem(pair, stencil, true, point, true), pair, std::min(steps, 50)).row,
                 result(problem(pair, stencil, false, point), pair, std::min(steps, 50)).row) > 1e-7);  // it can fail
}

bool fits(const NamedTable& table, bool point) { return table.is_for_point() == point; }

/// As long as rounding is below what is compared. Staggered waves grow from it, on an even circle linearly and off the
/// sphere like e^t, and the phase of a planet is off by its square.
int steps_of(const Pair& pair, const std::string& stencil) {
  if (stencil == "rectangle-symmetric" || stencil == "nine-tuple") return pair.constraint.empty() ? 300 : 30;
  return pair.density.find("/sqrt") != std::string::npos ? 300 : 1000;
}

}  // namespace

TEST_CASE("built-in theories written as text have the same plan, rows, energy and momenta") {
  for (const Pair& pair : on_a_circle())
    compare(pair, pair.constraint.empty() ? "rectangle-symmetric" : "rectangle", false, 10);
  for (const Pair& pair : on_a_point()) compare(pair, "midpoint", true, 10);
}

TEST_CASE("every built-in theory as text steps like the compiled one on every stencil", "[slow]") {
  for (const NamedTable& table : named_tables()) {
    for (const Pair& pair : on_a_circle())
      if (fits(table, false)) compare(pair, table.name, false, steps_of(pair, table.name));
    for (const Pair& pair : on_a_point())
      if (fits(table, true)) compare(pair, table.name, true, steps_of(pair, table.name));
  }
}

namespace {

/// ℓ and its gradient at jets in which logarithms and roots have values, one after the other.
std::vector<double> at_random_jets(const BatchDensity& density) {
  constexpr int count = 8 * lanes;
  testing::Random random(11);
  const ScratchRows slots(density.variables(), count), results(density.variables() + 1, count), x(1, count);
  for (int i = 0; i < count; ++i) {
    for (int a = 0; a < density.variables(); ++a) slots[a][i] = random(0.3, 0.9) + 0.2 * a;
    x[0][i] = random(-2, 2);
  }
  density.gradient({count, slots.data(), 0.3, x[0]}, results.data(), results[density.variables()]);
  return {results[0], results[density.variables()] + count};
}

/// Parameters that are no fallbacks, and a choice.
ParameterValues unusual(const TheoryText& text) {
  ParameterValues values;
  double next = 1.3;
  for (const auto& [name, key] : text.parameters) values[key] = next += 0.25;
  if (!text.choice.first.empty()) values[text.choice.first] = text.choice.second;
  return values;
}

/// The largest difference of the text and the compiled density, over the largest value.
double difference(const TheoryText& text, const std::string& planted = "") {
  const ParameterValues values = unusual(text);
  const auto compiled = make_theory(find_theory(text.theory), values);
  auto written = text_of(text.theory, values);
  REQUIRE(written);
  REQUIRE(written->components() == compiled->density().components());
  if (!planted.empty()) written = expression(written->text() + planted, written->names());
  const std::vector<double> a = at_random_jets(*written), b = at_random_jets(compiled->density());
  double largest = 0;
  for (const double y : b) largest = std::max(largest, std::abs(y));
  return distance(a, b) / largest;
}

}  // namespace

TEST_CASE("every theory of the registry has a text, which is its density") {
  for (const TheoryEntry* entry : theory_entries()) {
    if (entry->name == "text" || entry->name == "solar-system") continue;
    INFO(entry->name);
    CHECK(std::ranges::count(theory_texts(), entry->name, &TheoryText::theory) > 0);
  }
  for (const TheoryText& text : theory_texts()) {
    INFO(text.theory << ": " << text.density);
    CHECK(difference(text) < 1e-13);
    CHECK(difference(text, " + 1e-6*" + text.fields.substr(0, text.fields.find(',')) + "^2") > 1e-9);  // it can fail
    const auto compiled = make_theory(find_theory(text.theory), unusual(text));
    CHECK((compiled->constraint() != nullptr) == !text.constraint.empty());
  }
}

TEST_CASE("a density in units of its own has no text") {
  CHECK(text_of("sine-gordon", {}));
  ParameterValues scaled;
  scaled["theory.scale"] = 2.0;
  CHECK(!text_of("sine-gordon", scaled));
}

TEST_CASE("constraints and symmetries that are none are refused with the key") {
  const auto refusal = [](const std::string& key, const std::string& text) {
    Problem p = problem(*std::ranges::find(on_a_circle(), "wave-map", &Pair::name), "rectangle", true, false);
    p.parameters[key] = text;
    try {
      Simulation{p};
    } catch (const BadInput& bad) {
      CHECK(bad.key() == key);
      return std::string(bad.what());
    }
    return std::string("accepted");
  };
  const auto says = [](const std::string& message, const std::string& part) {
    INFO(message);
    CHECK(message.find(part) != std::string::npos);
  };
  says(refusal("theory.constraint", "3"), "is a number and no condition on the fields");
  says(refusal("theory.constraint", "u_t^2 - 1"), "unknown name u_t");
  says(refusal("theory.symmetry", "1, 0, 0"), "is no symmetry: it leads off the constraint");
  says(refusal("theory.symmetry", "0, -w, v; w, 0, u"), "is no symmetry: the density changes along it");
  CHECK(refusal("theory.symmetry", "0, -w, v") == "accepted");
}

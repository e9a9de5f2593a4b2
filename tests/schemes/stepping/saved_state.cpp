// SPDX-License-Identifier: MIT
#include "schemes/stepping/saved_state.hpp"

#include <cmath>
#include <cstring>
#include <numbers>

#include "lattice/index.hpp"
#include "schemes/stepping/evolution.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;

namespace {

class Memory final : public SavedState {
 public:
  bool restores() const override { return restoring; }
  bool restoring = false;
  std::size_t at = 0;
  std::vector<char> kept;

 private:
  void transfer(void* bytes, std::size_t count) override {
    if (!restoring) kept.insert(kept.end(), static_cast<char*>(bytes), static_cast<char*>(bytes) + count);
    else if (at + count > kept.size()) throw BadInput("", "too short");
    else if (count > 0) std::memcpy(bytes, kept.data() + at, count), at += count;
  }
  std::uint64_t most_items() const override { return kept.size() - at; }
};

// A wave, by whichever start the scheme knows.
void start(Simulation& simulation, const Problem& p) {
  const auto C = simulation.components().size();
  std::vector<double> row(delf::at(p.lattice.sites()) * C), velocity(row);
  for (std::size_t i = 0; i < row.size(); ++i) {
    const double x = 2 * std::numbers::pi * static_cast<double>(i / C) / p.lattice.sites();
    row[i] = 2 * std::sin(x), velocity[i] = std::cos(x) + 0.3;
  }
  try {
    simulation.start_legendre(row, velocity);
  } catch (const BadInput&) {
    std::vector<std::vector<double>> rows{row};
    while (static_cast<int>(rows.size()) < simulation.starting_rows()) {
      rows.push_back(rows.back());
      for (std::size_t i = 0; i < row.size(); ++i) rows.back()[i] += p.time_step * velocity[i];
    }
    simulation.start(rows);
  }
}

struct End {
  std::vector<double> row;
  double residual;
  int iterations;
};
End end_of(Simulation& simulation, int steps, const Problem& p) {
  for (int n = 0; n < steps; ++n) simulation.step(n + 1 == steps);
  End end{std::vector<double>(p.lattice.sites() * simulation.count(Role::field)), simulation.residual(),
          simulation.iterations()};
  simulation.copy_row(0, end.row);
  return end;
}

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

// Saved after so many steps, the last of which is checked or not, and restored into another simulation.
void check_restored(const Problem& p, int steps, bool looked_at) {
  Simulation whole(p);
  start(whole, p);
  for (int n = 0; n < steps; ++n) whole.step(looked_at);
  Memory memory;
  whole.visit(memory);
  const End end = end_of(whole, 9, p);

  Simulation again(p);
  memory.restoring = true;
  again.visit(memory);
  CHECK(memory.at == memory.kept.size());
  const End other = end_of(again, 9, p);
  CHECK(same(end.row, other.row));
  CHECK(end.residual == other.residual);
  CHECK(end.iterations == other.iterations);
}

Problem small(const char* theory = "sine-gordon") {
  Problem p;
  p.theory = theory;
  p.lattice = Lattice::circle(18, 6);
  p.time_step = 0.1;
  return p;
}

}  // namespace

TEST_CASE("a saved simulation goes on with the same bits, by every scheme") {
  int schemes = 0;
  for (const NamedScheme& scheme : named_schemes(small())) {
    INFO(scheme.name);
    try {
      check_restored(scheme.problem, 13, false);
      ++schemes;
    } catch (const BadInput&) {  // not for this lattice
    }
  }
  CHECK(schemes > 20);
}

TEST_CASE("long rows are saved while steps write them over each other") {
  Problem p = small();
  p.lattice = Lattice::circle(40001, 4000);
  p.time_step = 0.02;
  const auto stencil = GENERATE(as<std::string>(), "triangle-vertex", "rectangle-symmetric");
  p.stencil = stencil;
  INFO(stencil);
  check_restored(p, 11, false);
  check_restored(p, 3, true);
}

TEST_CASE("a saved state that is of another scheme, or cut short, is refused") {
  Problem p = small();
  Simulation simulation(p);
  start(simulation, p);
  Memory memory;
  simulation.visit(memory);
  memory.restoring = true;
  p.stencil = "triangle-vertex";
  Simulation other(p);
  CHECK_THROWS_AS(other.visit(memory), BadInput);
  memory.at = 0;
  memory.kept.resize(memory.kept.size() - 8);
  CHECK_THROWS_AS(simulation.visit(memory), BadInput);
}

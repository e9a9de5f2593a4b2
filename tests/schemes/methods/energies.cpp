// SPDX-License-Identifier: MIT
#include "schemes/methods/energies.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using delf::testing::Row;

namespace {

constexpr int N = 31;
constexpr double L = 2 * std::numbers::pi * 3, k = L / N;

Problem problem(const std::string& theory, const std::string& method, const std::string& stencil = "rectangle",
                Lattice lattice = Lattice::circle(N, L)) {
  Problem p;
  p.theory = theory, p.method = method, p.stencil = stencil, p.lattice = lattice, p.time_step = k / 4;
  return p;
}

Row row_at(const Lattice& lattice, double t) {
  Row row;
  for (int i = 0; i < lattice.sites(); ++i) {
    const double x = lattice.position(i);
    row.push_back(lattice.is_fixed(i) ? 0.3 : 0.3 + std::sin(x / 3 - 0.7 * t) + 0.4 * std::cos(x - t));
  }
  return row;
}

struct History {
  std::string name;
  std::vector<double> own, measured;
  double swing() const {
    const auto [least, most] = std::ranges::minmax(own);
    return (most - least) / std::abs(own[0]);
  }
};

History run(const Problem& p, int steps = 200) {
  Simulation s(p);
  if (s.components().size() > 1) {
    Row zero(at(p.lattice.sites()) * s.components().size(), 0.0), row = zero;
    const Row first = row_at(p.lattice, 0);
    for (std::size_t i = 0; i < first.size(); ++i) row[i * s.components().size()] = first[i];
    s.start_legendre(row, zero);
    s.step();
  } else {
    s.start({row_at(p.lattice, 0), row_at(p.lattice, p.time_step)});
  }
  const auto own = own_energy(s, p);
  History history;
  if (!own) return history;
  history.name = own->entry->name;
  for (int j = 0; j < steps; ++j) {
    history.own.push_back(newest_own_energy(*own, s));
    history.measured.push_back(s.monitors().energy);
    s.step();
  }
  return history;
}

}  // namespace

TEST_CASE("a linear scheme keeps the quadratic invariant of its own equations") {
  const Lattice fixed = Lattice::interval(N, L, Wall::fixed, Wall::natural);
  for (const char* theory : {"wave", "klein-gordon"})
    for (const char* stencil : {"triangle", "triangle-vertex", "rectangle", "rectangle-symmetric"})
      for (const Lattice& lattice : {Lattice::circle(N, L), fixed}) {
        const History h = run(problem(theory, "multisymplectic", stencil, lattice));
        INFO(theory << " " << stencil << (lattice.is_circle() ? "" : ", walls"));
        CHECK(h.name == "quadratic invariant");
        CHECK(h.swing() < 1e-12);
        if (std::string(stencil) != "rectangle-symmetric") {  // what all schemes are measured by is not theirs
          CHECK(std::abs(h.measured[100] / h.measured[0] - 1) > 1e-6);
          continue;
        }
        // for (5.12) the energy of footnote 4
        for (std::size_t j = 0; j < h.own.size(); ++j) CHECK(h.own[j] == Approx(h.measured[j]).epsilon(1e-12));
      }
  CHECK(run(problem("sine-gordon", "multisymplectic")).name.empty());
  CHECK(run(problem("klein-gordon", "damped")).name.empty());
}

TEST_CASE("comparators keep the energies that they are made for, and no other's") {
  for (const char* theory : {"sine-gordon", "phi4", "klein-gordon"})
    for (const char* method : {"guo", "vu-quoc-li"})
      for (const Lattice& lattice : {Lattice::circle(N, L), Lattice::interval(N, L, Wall::fixed, Wall::fixed)}) {
        const History h = run(problem(theory, method, "", lattice));
        INFO(theory << " " << method);
        CHECK(h.name == (std::string(method) == "guo" ? "energy of (5.15)" : "energy of (5.14)"));
        CHECK(h.swing() < 1e-11);
        CHECK(std::abs(h.measured[100] / h.measured[0] - 1) > 1e-5);
      }
  // the energy of one of them swings on rows of the other
  const Problem guo = problem("sine-gordon", "guo");
  Simulation of_guo(guo), other(problem("sine-gordon", "vu-quoc-li"));
  const auto own = own_energy(of_guo, guo);
  other.start({row_at(guo.lattice, 0), row_at(guo.lattice, guo.time_step)});
  std::vector<double> E;
  for (int j = 0; j < 100; ++j, other.step()) E.push_back(newest_own_energy(*own, other));
  const auto [least, most] = std::ranges::minmax(E);
  CHECK((most - least) / E[0] > 1e-5);
}

TEST_CASE("a composition has the energy of its own pairs, to the order of its steps") {
  for (const Lattice& lattice : {Lattice::circle(N, L), Lattice::interval(N, L, Wall::natural, Wall::natural)}) {
    std::vector<double> swings;
    for (const int halved : {0, 1}) {
      Problem p = problem("sine-gordon", "composition", "", lattice);
      p.parameters["scheme.order"] = 4, p.parameters["lattice.space_order"] = 8;
      p.time_step = 0.4 * k / (1 << halved);
      const History h = run(p, 60 << halved);
      CHECK(h.name == "H(q, p) of the composition");
      swings.push_back(h.swing());
      // what all schemes are compared by is of order 2
      CHECK(std::abs(h.measured[40] / h.measured[0] - 1) > 100 * h.swing());
    }
    const double order = std::log2(swings[0] / swings[1]);
    CHECK(order > 3.5);
    CHECK(order < 5);
  }
}

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf::testing;

namespace {

nlohmann::json summary(const Folder& folder, const std::string& arguments) {
  const Ran ran = delf_program(folder, "run " + arguments + " --output.figures=off --out out");
  INFO(arguments << "\n" << ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(read(folder / "out/summary.json"));
}

/// Camassa–Holm in place, by Fourier's method on the circle 2π with the classical method of Runge and Kutta:
///
///     u_t = −u u_x − ∂_x (1 − ∂_xx)⁻¹ (u² + ½u_x²),    and particles η_t = u(t, η).
///
class EulerianCamassaHolm {
 public:
  EulerianCamassaHolm(double (*u)(double), int particles) : state_(modes + delf::at(particles)) {
    std::vector<double> values;
    for (int i = 0; i < points; ++i) values.push_back(u(x(i)));
    const auto coefficients = transform(values);
    std::ranges::copy(coefficients, state_.begin());
    for (int i = 0; i < particles; ++i) state_[modes + delf::at(i)] = 2 * std::numbers::pi * i / particles;
  }

  void step(double h) {
    const State k1 = rate(state_), k2 = rate(moved(k1, h / 2)), k3 = rate(moved(k2, h / 2)), k4 = rate(moved(k3, h));
    for (std::size_t i = 0; i < state_.size(); ++i) state_[i] += h / 6 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
  }
  double particle(std::size_t i) const { return state_[modes + i].real(); }

 private:
  using Complex = std::complex<double>;
  using State = std::vector<Complex>;
  static constexpr int points = 64, most = points / 3;  // a third is left out, for the products
  static constexpr std::size_t modes = most + 1;

  static double x(int i) { return 2 * std::numbers::pi * i / points; }
  static Complex wave(std::size_t q, double at) { return std::polar(1.0, static_cast<double>(q) * at); }
  static State transform(const std::vector<double>& values) {
    State c(modes);
    for (std::size_t q = 0; q < modes; ++q)
      for (int i = 0; i < points; ++i) c[q] += values[i] * std::conj(wave(q, x(i))) / 64.0;
    return c;
  }
  static double at(const State& c, double place, int derivative) {
    double sum = derivative == 0 ? c[0].real() : 0;
    for (std::size_t q = 1; q < modes; ++q) {
      const Complex slope = derivative == 0 ? 1.0 : Complex(0, static_cast<double>(q));
      sum += 2 * (slope * c[q] * wave(q, place)).real();
    }
    return sum;
  }
  State moved(const State& by, double h) const {
    State other = state_;
    for (std::size_t i = 0; i < other.size(); ++i) other[i] += h * by[i];
    return other;
  }
  State rate(const State& y) const {
    std::vector<double> carried, pressure;
    for (int i = 0; i < points; ++i) {
      const double u = at(y, x(i), 0), u_x = at(y, x(i), 1);
      carried.push_back(u * u_x), pressure.push_back(u * u + 0.5 * u_x * u_x);
    }
    const State a = transform(carried), p = transform(pressure);
    State r(y.size());
    for (std::size_t q = 0; q < modes; ++q) {
      const auto k = static_cast<double>(q);
      r[q] = -a[q] - Complex(0, k) / (1 + k * k) * p[q];
    }
    for (std::size_t i = modes; i < y.size(); ++i) r[i] = at(y, y[i].real(), 0);
    return r;
  }

  State state_;
};

}  // namespace

TEST_CASE("beam, Boussinesq, KdV and NLS have their exact solutions to second order") {
  const Folder folder;
  struct Case {
    std::string run;
    int sites;  // of the coarse run; the fine one halves h and k
    double step;
  };
  for (const Case& c :
       {Case{"beam --run.until=1", 64, 0.05}, Case{"beam --lattice.stencil=nine-tuple --run.until=1", 64, 0.05},
        Case{"boussinesq --run.until=2", 121, 0.125}, Case{"kdv --run.until=2", 161, 0.0625},
        Case{"kdv --lattice.stencil=nine-tuple --run.until=1", 161, 0.0625},
        Case{"nls --run.until=0.25 --scheme.space=lumped", 80, 0.0125}}) {
    const bool walls = c.run.starts_with("kdv") || c.run.starts_with("bou");
    const auto error = [&](int halved) {
      const int cells = (walls ? c.sites - 1 : c.sites) << halved;
      return summary(folder, c.run + " --lattice.sites=" + std::to_string(cells + (walls ? 1 : 0)) +
                                 " --lattice.time_step=" + std::to_string(c.step / (1 << halved)))["error_linf"]
          .get<double>();
    };
    const double coarse = error(0), fine = error(1);
    INFO(c.run << ": " << coarse << ", " << fine);
    CHECK(coarse / fine > 3.6);
    CHECK(coarse / fine < 4.4);
  }
}

TEST_CASE("Camassa-Holm's particles go where the equation in place carries them, to second order") {
  constexpr int particles = 32;
  EulerianCamassaHolm reference([](double x) { return 0.6 + 0.3 * std::cos(x); }, particles);
  for (int n = 0; n < 40; ++n) reference.step(0.025);
  const Folder folder;
  double error[2];
  for (const int fine : {0, 1}) {
    const int sites = particles << fine;
    const auto json =
        summary(folder, "camassa-holm --lattice.sites=" + std::to_string(sites) +
                            " --lattice.time_step=" + std::to_string(0.05 / (1 << fine)) + " --run.until=1");
    CHECK(json["energy_error_max"].get<double>() < 1e-3);
    CHECK(json["conserved"][0]["error_max"].get<double>() < 1e-11);
    const delf::FieldsReader fields(folder / "out/fields.h5");
    const auto row = fields.row(fields.frames() - 1);
    error[fine] = 0;
    for (std::size_t i = 0; i < particles; ++i)
      error[fine] = std::max(error[fine], std::abs(row[i << fine] - reference.particle(i)));
  }
  INFO(error[0] << ", " << error[1]);
  CHECK(error[0] / error[1] > 3.6);
  CHECK(error[0] / error[1] < 4.4);
}

TEST_CASE("equations of second order and NLS are verified, and a planted fault is found") {
  const Folder folder;
  for (const std::string scene :
       {"beam", "boussinesq", "kdv --lattice.stencil=nine-tuple --lattice.courant=0.05", "camassa-holm", "nls",
        "nls --scheme.method=multisymplectic --lattice.stencil=rectangle-symmetric"}) {
    const std::string run =
        "verify " + scene +
        " --lattice.sites=41 --run.steps=14 --output.figures=off --verify.checks=forms,noether,equations" +
        " --lattice.length=" +
        (scene[0] == 'n'   ? "12"
         : scene[0] == 'c' ? "2*pi"
                           : "40");
    const Ran right = delf_program(folder, run), wrong = delf_program(folder, run + " --verify.fault=sign");
    INFO(run << "\n" << right.out << right.err);
    CHECK(right.code == 0);
    CHECK(wrong.code == 1);
    CHECK(contains(right.out, "form formula, slab"));
    // phase rotations of psi change the density by a divergence; the one-sided flux of the element by more
    if (scene.starts_with("nls ")) CHECK(contains(right.out, "Noether, symmetry"));
    else if (scene == "nls") CHECK(contains(right.out, "the density has it up to a divergence"));
  }
}

TEST_CASE("plans name the wave (-1)^j of KdV, and clamped walls ask for second derivatives") {
  const Folder folder;
  const Ran kdv = delf_program(folder, "plan kdv"), boussinesq = delf_program(folder, "plan boussinesq");
  CHECK(contains(kdv.out, "(-1)^j is a wave of the scheme (1 root), and none of the theory"));
  CHECK_FALSE(contains(boussinesq.out, "(-1)^j is"));
  check_refused(delf_program(folder, "run kink --lattice.space=interval --boundary.left=clamped"),
                {"boundary.left", "second derivatives"});
  check_refused(delf_program(folder, "run boussinesq --lattice.stencil=hexagon --lattice.sites=242"),
                {"lattice.stencil", "three columns"});
  const Ran limits = delf_program(folder, "stability beam --stability.schemes=nine-tuple --stability.steps=300");
  CHECK(limits.code == 0);
  CHECK(contains(limits.out, "2 limits compared"));
  check_refused(
      delf_program(folder, "stability kdv"),
      {"not applicable, there is no limit to find: six-tuple: on a circle no step determines the waves of theta = 0"});
}

TEST_CASE("ends of beams, and densities that read t and x on triangles and sub-steps, are verified") {
  const Folder folder;
  folder.write("beam.ini",
               "[theory]\ndensity = 0.5*phi_t^2 - 0.5*phi_xx^2\n[lattice]\nspace = interval\nlength = 1\nsites = 21\n"
               "time_step = 0.002\n[initial]\nphi = 0.5*x + x^2*(1 - x)^2\n[run]\nsteps = 14\n");
  folder.write("placed.ini",
               "[theory]\ndensity = 0.5*(1.5 + 0.5*sin(x))*phi_t^2 - 0.5*(1.2 + 0.4*cos(x))*phi_x^2 - 0.25*phi^4\n"
               "[lattice]\nspace = circle\nlength = 2*pi\nsites = 20\ncourant = 0.4\n[initial]\nphi = sin(x)\n"
               "[run]\nsteps = 14\n");
  for (const std::string scene :
       {"beam.ini --lattice.stencil=six-tuple --boundary.left=clamped --boundary.right=natural",
        "beam.ini --lattice.stencil=nine-tuple --boundary.left=fixed --boundary.right=clamped",
        "placed.ini --lattice.stencil=triangle '--theory.density=exp(0.4*t)*(0.5*phi_t^2 - 0.5*phi_x^2 - 0.5*phi^2)'",
        "placed.ini --lattice.stencil=triangle", "placed.ini --lattice.stencil=triangle-vertex",
        "placed.ini --lattice.stencil=triangle --lattice.space=interval --boundary.left=natural",
        "placed.ini --scheme.method=composition"}) {
    const std::string run = "verify " + scene + " --output.figures=off";
    const Ran right = delf_program(folder, run), wrong = delf_program(folder, run + " --verify.fault=sign");
    INFO(run << "\n" << right.out << right.err);
    CHECK(right.code == 0);
    CHECK(wrong.code == 1);
    CHECK(contains(right.out, "form formula"));
  }
}

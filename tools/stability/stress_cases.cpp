// SPDX-License-Identifier: MIT
#include "tools/stability/stress_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "schemes/monodromy.hpp"

namespace delf {

namespace {

// A stress case before it has a scheme.
struct Draft : StressCase {
  std::string theory = "sine-gordon";
  double mass = 1, lambda = 1;
  int sites = 64;
  double length = 40;
  double courant = 0.5;
  bool circle_valued = false;

  Draft() {
    state.name = "noise";
    steps = 1000;
  }
};

StressCase stress_case_of(const std::string& group, const Draft& d, const NamedScheme& scheme) {
  StressCase c = d;
  c.group = group;
  c.scheme = scheme.name;
  c.problem = scheme.problem;
  c.problem.theory = d.theory;
  c.problem.parameters["theory.mass"] = d.mass;
  c.problem.parameters["theory.lambda"] = d.lambda;
  c.problem.circle_valued = d.circle_valued;
  c.problem.winding = 0, c.problem.parameters[gain_key] = 0.0;
  c.problem.lattice = Lattice::circle(d.sites, d.length);
  c.problem.time_step = d.courant * c.problem.lattice.space_step();
  c.state.theory = d.theory;
  c.state.values["theory.mass"] = d.mass;
  c.state.values["theory.lambda"] = d.lambda;
  for (const TheoryInfo& theory : theories())
    if (theory.name == d.theory) c.state.components = theory.components;
  return c;
}

// Stiff: smooth noise of size 1, h/k = 1/2, m so that mh is what it is.
std::vector<Draft> stiff() {
  std::vector<Draft> all;
  for (const double mass_step : {0.1, 1.0, 3.0, 10.0, 100.0, 1000.0}) {
    Draft d;
    d.name = fmt::format("mh = {:g}", mass_step);
    d.mass = mass_step / (d.courant * d.length / d.sites);
    d.state.values["initial.amplitude"] = 1;
    d.growth_bound = 100;
    d.steps = 400;
    all.push_back(d);
  }
  return all;
}

// A breather of sine-Gordon, k = 0.16, or 0.3.
std::vector<Draft> courant() {
  std::vector<Draft> all;
  for (const double r : {0.01, 0.1, 0.5, 0.9, 0.99, 1.0, 1.01, 2.0, 10.0}) {
    Draft d;
    d.name = fmt::format("h/k = {:g}", r);
    d.courant = r;
    d.state.name = "breather";
    d.state.values["initial.frequency"] = 0.6;
    d.sites = r < 2 ? 256 : 128;  // steps that must be followed from small h are dear
    d.steps = std::clamp<std::int64_t>(std::llround(15 / (r * d.length / d.sites)), 40, 10000);
    all.push_back(d);
  }
  return all;
}

// A kink of width 1/γ on a circle of forty widths, for a third of its way to the seam.
std::vector<Draft> fast_kinks() {
  std::vector<Draft> all;
  for (const double v : {0.9, 0.99, 0.999, 0.9999})
    for (const double width : {0.05, 0.5, 2.0}) {
      const double gamma = 1 / std::sqrt(1 - v * v);
      Draft d;
      d.name = fmt::format("v = {:g}, k gamma = {:g}", v, width);
      d.state.name = "kink";
      d.state.values["initial.speed"] = v;
      d.length = 40 / gamma;
      d.sites = 2 * static_cast<int>(std::lround(20 / width));
      d.steps = std::lround(d.sites / 3.0 * 0.9);
      all.push_back(d);
    }
  return all;
}

std::vector<Draft> amplitudes() {
  struct Start {
    const char *theory, *state;
    std::int64_t steps;
  };
  std::vector<Draft> all;
  for (const auto& [theory, state, steps] :
       {Start{"klein-gordon", "plane-wave", 60}, Start{"sine-gordon", "noise", 500}})
    for (const double A : {1e-300, 1e-100, 1e-8, 1e3, 1e9}) {
      Draft d;
      d.name = fmt::format("{}, A = {:g}", theory, A);
      d.theory = theory;
      d.state.name = state;
      d.state.values["initial.amplitude"] = A;
      d.sites = 128;
      d.growth_bound = 100;
      d.steps = steps;
      all.push_back(d);
    }
  return all;
}

// k = 0.3 however many there are.
std::vector<Draft> sizes() {
  std::vector<Draft> all;
  for (const int N : {3, 4, 5, 63, 64, 100001, 1000000}) {
    Draft d;
    d.name = fmt::format("N = {}", N);
    d.sites = N;
    d.length = 0.3 * N;
    if (N < 60) d.state.values["initial.amplitude"] = 0.5;  // noise
    else d.state.name = "breather", d.state.values["initial.frequency"] = 0.6;
    d.energy_bound = N < 60 ? 1 : 0.1;
    d.growth_bound = 100;
    d.steps = N > 1000 ? 40 : 100;
    all.push_back(d);
  }
  return all;
}

std::vector<Draft> long_runs() {
  Draft d;
  d.name = "breather, 10^6 steps";
  d.state.name = "breather";
  d.state.values["initial.frequency"] = 0.6;
  d.steps = 1000000;
  d.patience = 5;
  d.error_bound = std::numeric_limits<double>::infinity();  // phases drift
  return {d};
}

// λh² ≫ 1: the kink of double sine-Gordon, of width 1/√(m² + 2λ).
std::vector<Draft> stiff_second_terms() {
  std::vector<Draft> all;
  for (const double lambda : {1.0, 100.0, 10000.0}) {
    Draft d;
    d.name = fmt::format("noise, lambda h^2 = {:g}", lambda);
    d.theory = "double-sine-gordon";
    const double h = d.courant * d.length / d.sites;
    d.lambda = lambda / (h * h);
    d.state.values["initial.amplitude"] = 0.5;
    d.growth_bound = 100;
    d.steps = 400;
    all.push_back(d);
  }
  for (const double width : {0.2, 1.0, 5.0}) {
    Draft d;
    d.name = fmt::format("kink, k sqrt(m^2 + 2 lambda) = {:g}", width);
    d.theory = "double-sine-gordon";
    d.state.name = "kink";
    const double k = d.length / d.sites;
    d.lambda = 0.5 * (width * width / (k * k) - 1);
    if (d.lambda < 0) d.mass = 0.1, d.lambda = 0.5 * (width * width / (k * k) - 0.01);
    d.steps = 400;
    all.push_back(d);
  }
  return all;
}

// u_y passes 0, where |u|² − 1 does not determine it, or stays there (A → 0).
std::vector<Draft> wave_maps() {
  std::vector<Draft> all;
  for (const double A : {1e-8, 1e-3, 1.0, 3.0}) {
    Draft d;
    d.name = fmt::format("great circle, A = {:g}", A);
    d.theory = "wave-map";
    d.state.name = "great-circle";
    d.state.values["initial.amplitude"] = A;
    d.length = 2 * std::numbers::pi;
    d.steps = 200;
    all.push_back(d);
  }
  return all;
}

// A wave that turns by π, or by what the element's own resonance is, in one step.
std::vector<Draft> resonances() {
  std::vector<Draft> all;
  for (const double z : {0.99 * std::numbers::pi, std::numbers::pi, 2 * std::numbers::pi}) {
    Draft d;
    d.name = fmt::format("omega h = {:g} pi", z / std::numbers::pi);
    d.theory = "klein-gordon";
    d.state.name = "plane-wave";
    d.state.values["initial.wavenumber"] = 1;
    const double h = d.courant * d.length / d.sites, q = 2 * std::numbers::pi / d.length;
    d.mass = std::sqrt(z * z / (h * h) - q * q);
    d.growth_bound = 100;
    d.steps = 400;
    all.push_back(d);
  }
  return all;
}

// Angles are wrapped into the circle: what overflows on the line stays finite here.
std::vector<Draft> angles() {
  std::vector<Draft> all;
  for (const double r : {0.5, 1.2}) {
    Draft d;
    d.name = fmt::format("values in S1, h/k = {:g}", r);
    d.state.name = "breather";
    d.state.values["initial.frequency"] = 0.6;
    d.sites = 256;
    d.courant = r;
    d.circle_valued = true;
    d.steps = 150;
    all.push_back(d);
  }
  return all;
}

struct Group {
  const char* name;
  std::vector<Draft> (*drafts)();
};
constexpr Group groups[] = {
    {"stiff", stiff},          {"courant", courant}, {"fast-kink", fast_kinks},           {"amplitude", amplitudes},
    {"size", sizes},           {"long", long_runs},  {"second-term", stiff_second_terms}, {"wave-map", wave_maps},
    {"resonance", resonances}, {"angle", angles}};

}  // namespace

const std::vector<std::string>& stress_groups() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Group& g : groups) all.emplace_back(g.name);
    return all;
  }();
  return names;
}

std::vector<StressCase> stress_cases(const std::string& group, const std::vector<NamedScheme>& schemes) {
  std::vector<StressCase> all;
  for (const Group& g : groups)
    if (group == g.name)
      for (const Draft& draft : g.drafts())
        for (const NamedScheme& scheme : schemes) all.push_back(stress_case_of(group, draft, scheme));
  return all;
}

}  // namespace delf

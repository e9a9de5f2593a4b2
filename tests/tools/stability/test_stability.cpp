// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "lattice/error.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"
#include "tools/scene/keys.hpp"
#include "tools/scene/shipped_scenes.hpp"
#include "tools/stability/linear_theory.hpp"
#include "tools/stability/observed_limit.hpp"
#include "tools/stability/stability.hpp"
#include "tools/stability/stability_figures.hpp"
#include "tools/stability/stability_map.hpp"
#include "tools/stability/stress_cases.hpp"

using namespace delf;
using Json = nlohmann::json;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

Problem scheme(const std::string& name) { return chosen_schemes({name}, Problem{}).front().problem; }

Problem noisy(const std::string& name, double courant, double mass_step = 0.5, int sites = 64) {
  return LinearWaves{scheme(name), mass_step}.on_circle(courant, sites);
}

Growth growth(const std::string& name, double courant, double mass_step = 0.5, int sites = 64) {
  return observe_growth(noisy(name, courant, mass_step, sites), 2000, 1).kind;
}

LimitRequest quick() {
  LimitRequest request;
  request.most = 1.6;
  request.steps = 1000;
  return request;
}

StressCase stress_case(const std::string& group, const std::string& name, const std::string& of) {
  for (StressCase& c : stress_cases(group, chosen_schemes({of}, Problem{})))
    if (c.name == name) return c;
  FAIL("no stress case " << name);
  return {};
}

StabilityRequest small_request() {
  StabilityRequest request;
  request.schemes = chosen_schemes({"triangle-vertex", "hexagon"}, Problem{});
  request.mass_steps = {1};
  request.limit = quick();
  request.stress_cases = {"angle"};
  request.map = false;
  return request;
}

Problem coarse() {
  Problem p;
  p.lattice = Lattice::circle(32, 10);
  p.time_step = 0.1;
  return p;
}

}  // namespace

TEST_CASE("own waves are refused where there is no field 0 to be waves about") {
  const testing::Folder folder;
  testing::check_refused(
      testing::delf_program(folder, "stability liouville --stability.waves=own --out out"),
      {"--stability.waves = own: own waves are those about the field 0, which does not solve the field equations",
       "use stability.waves = klein-gordon"});
}

TEST_CASE("limits found by the symbol are those that are known, to 1e-6") {
  // (5.8): r² + m²h²/36 ≤ 1; leapfrog: r² + m²h²/4 ≤ 1; (5.15): r² ≤ 1 + m²h²/4; the others always
  const double mu = 0.7 * 0.7;
  const auto limit = [](const char* name) { return linear_theory({scheme(name), 0.7}, 2, 40).first_limit(2); };
  CHECK(std::abs(limit("triangle") - std::sqrt(1 - mu / 36)) < 1e-6);
  CHECK(std::abs(limit("triangle-vertex") - std::sqrt(1 - mu / 4)) < 1e-6);
  CHECK(std::abs(limit("guo") - std::sqrt(1 + mu / 4)) < 1e-6);
  for (const char* name : {"rectangle", "rectangle-symmetric", "vu-quoc-li"}) CHECK(limit(name) == infinite);
}

TEST_CASE("limits of a theory's own waves are those at its own space step") {
  // leapfrog: r² + m²h²/4 ≤ 1 with h = rk, so r = 1/√(1 + m²k²/4)
  Problem p = scheme("triangle-vertex");
  p.theory = "klein-gordon";
  p.parameters["theory.mass"] = 3.0;
  p.lattice = Lattice::circle(32, 16);
  const LinearWaves own{p, std::nullopt};
  CHECK(std::abs(linear_theory(own, 2, 40).first_limit(2) - 1 / std::sqrt(1 + 9.0 / 16)) < 1e-6);
  const Limit limit = find_limit("triangle-vertex", own, quick());
  CHECK(limit.agrees());
  CHECK(std::abs(limit.observed / limit.theory - 1) < 0.01);
  LimitRequest faulty = quick();
  faulty.theory_factor = 1.05;
  CHECK_FALSE(find_limit("triangle-vertex", own, faulty).agrees());
}

TEST_CASE("limits of own waves are found at the theory's own speed, frequency or stiffness") {
  // leapfrog: ω_max h ≤ 2 with ω_max² = 4c²/k² + m² + 16κ²/k⁴, L = 10 and N = 200
  const double k = 0.05;
  const testing::Folder folder;
  const auto limit_of = [&](double c, double m, double kappa, const char* stencil) {
    const std::string terms = kappa > 0 ? fmt::format(" - 0.5*{:e}*phi_xx^2", kappa * kappa) : "";
    const std::string density =
        fmt::format("0.5*phi_t^2 - 0.5*{:e}*phi_x^2 - 0.5*{:e}*phi^2{}", c * c, m * m, terms);
    folder.write("own.ini",
                 fmt::format("[theory]\ndensity = {}\n[lattice]\nspace = circle\nlength = 10\nsites = 200\ncourant = 0.5\n"
                             "stencil = {}\n[initial]\nphi = 0\nphi_t = 0\n[run]\nsteps = 1\n[stability]\nwaves = own\n"
                             "steps = 400\n",
                             density, stencil));
    const Scene scene = read_scene(folder.path() / "own.ini", {});
    const StabilityRequest request = read_stability_request(scene);
    const Limit limit = find_limit(request.schemes[0].name, {request.schemes[0].problem, std::nullopt}, request.limit);
    CAPTURE(c, m, kappa, limit.theory, limit.observed);
    CHECK(limit.agrees());
    return limit.theory;
  };
  for (const double c : {1e-3, 1.0, 340.0, 3e8})
    CHECK(std::abs(limit_of(c, 0, 0, "triangle-vertex") * c - 1) < 1e-6);
  CHECK(std::abs(limit_of(1, 1e4, 0, "triangle-vertex") * k * std::sqrt(4 / (k * k) + 1e8) / 2 - 1) < 1e-6);
  CHECK(std::isinf(limit_of(340, 0, 0, "rectangle")));
}

TEST_CASE("limits found by running are those of the symbol, to one in a hundred") {
  const std::string name = GENERATE("triangle", "triangle-vertex", "guo", "hexagon", "rectangle", "composition (4,4)");
  INFO(name);
  const Limit limit = find_limit(name, {scheme(name), 1}, quick());
  INFO(limit.theory << " " << limit.observed << " " << limit.left_out);
  CHECK(limit.left_out.empty());
  CHECK(limit.disagreements.empty());
  CHECK(limit.probes.size() >= 20);
  if (name == "rectangle") CHECK(limit.observed == infinite);
  else CHECK(std::abs(limit.observed / limit.theory - 1) < 0.01);
}

TEST_CASE("a wrong limit is detected") {
  LimitRequest request = quick();
  request.theory_factor = 1.05;
  const Limit limit = find_limit("triangle-vertex", {scheme("triangle-vertex"), 1}, request);
  CHECK_FALSE(limit.disagreements.empty());
}

TEST_CASE("narrow tongues of slow waves are seen on the circle that suits them: composition (6,12)") {
  // Beyond 1.166 all that grows are waves of some 1e-4 of all θ, by 4.4e-4 a step: those of 64 sites do not.
  LimitRequest request;
  request.most = 1.8;
  request.samples = 9;
  request.grid = 4;
  const Problem p = scheme("composition (6,12)");
  const Limit limit = find_limit("composition (6,12)", {p, 0.5}, request);
  INFO(limit.theory << " " << limit.observed << " " << limit.left_out);
  for (const std::string& d : limit.disagreements) INFO(d);
  CHECK(limit.agrees());
  CHECK(limit.unresolved.empty());
  CHECK(std::abs(limit.observed / limit.theory - 1) < 0.003);
  int on_their_circle = 0;
  for (const Probe& probe : limit.probes) on_their_circle += !probe.theory_stable && probe.sites != request.sites;
  CHECK(on_their_circle > 0);

  // Theory that has no tongue there, and theory whose waves are not the scheme's, are found out by the same runs.
  LinearTheory denied = limit.symbol;
  denied.stable.push_back({1.5, 1.7});
  request.grid = 1;
  const Limit wrong = compare_with_runs("composition (6,12)", {p, 0.5}, denied, request);
  REQUIRE_FALSE(wrong.agrees());
  CHECK(wrong.disagreements.front().find("h/k = 1.6: stable by theory, grows exponentially") != std::string::npos);
  request.waves_factor = 1.05;
  CHECK_FALSE(compare_with_runs("composition (6,12)", {p, 0.5}, limit.symbol, request).agrees());
}

TEST_CASE("a tongue that theory invents or misses is detected, however narrow") {
  const Problem leapfrog = scheme("triangle-vertex");
  LinearTheory invented = linear_theory({leapfrog, 1}, 1.6, 20);
  REQUIRE(invented.stable.size() == 1);
  CHECK(compare_with_runs("triangle-vertex", {leapfrog, 1}, invented, quick()).agrees());
  invented.stable = {{0, 0.5}, {0.501, invented.stable[0].to}};
  const Limit limit = compare_with_runs("triangle-vertex", {leapfrog, 1}, invented, quick());
  REQUIRE_FALSE(limit.agrees());
  CHECK(limit.disagreements.front().find("h/k = 0.5005: unstable by theory, bounded") != std::string::npos);
  CHECK_FALSE(limit.limit_unresolved);

  // Limits that are right, and waves that are not
  LimitRequest wrong_waves = quick();
  wrong_waves.waves_factor = 1.05;
  const Limit waves = find_limit("hexagon", {scheme("hexagon"), 1}, wrong_waves);
  CHECK_FALSE(waves.agrees());
}

TEST_CASE("a wave that grows too slowly to be seen is reported as unresolved, and decides nothing") {
  LimitRequest request = quick();
  request.most = 2;
  request.steps = 300;
  request.work = 1;
  const Limit limit = find_limit("hexagon", {scheme("hexagon"), 0.5}, request);
  CHECK(limit.agrees());
  CHECK(limit.theory == Approx(1.40436).epsilon(1e-5));
  CHECK(limit.observed == infinite);
  CHECK(limit.limit_unresolved);
  REQUIRE(limit.unresolved.size() >= 5);
  for (const Unresolved& u : limit.unresolved) {
    CHECK(u.courant > limit.theory);
    CHECK(u.growth > 0);
    CHECK(u.growth < request.least_growth());
    CHECK(u.steps * u.sites > request.work * request.steps * request.sites);
  }
  StabilityFindings f;
  f.limits = {limit};
  CHECK(f.passed());
  CHECK(f.unresolved() == static_cast<std::int64_t>(limit.unresolved.size()));
  const Scene scene(Settings("test.ini", {}, {}));
  const Json json = Json::parse(stability_json(scene, f));
  CHECK(json["limits"][0]["agrees"].is_null());
  CHECK(json["limits"][0]["unresolved"].size() == limit.unresolved.size());
  CHECK(stability_report(scene, f).find("neither for nor against theory") != std::string::npos);
  // With all the work that a run may be the same limit is found.
  request.work = LimitRequest{}.work;
  request.steps = LimitRequest{}.steps;
  CHECK(find_limit("hexagon", {scheme("hexagon"), 0.5}, request).unresolved.empty());
  // And what is not so slow is not excused, be it a limit that is none.
  LinearTheory none = limit.symbol;
  none.stable = {{0, request.most}};
  CHECK_FALSE(compare_with_runs("hexagon", {scheme("hexagon"), 0.5}, none, request).agrees());
  request.theory_factor = 0.9;
  request.work = 1;
  request.steps = 300;
  CHECK_FALSE(find_limit("triangle-vertex", {scheme("triangle-vertex"), 0.5}, request).agrees());
}

TEST_CASE("the circle that suits a wave best has a wave where theory wants it") {
  const WaveGrowth waves({scheme("composition (4,4)"), 0.5}, 1.4);
  REQUIRE(waves.of_all().rate() > 0);
  const int sites = waves.best_circle(64, 1024, 1), even = waves.best_circle(64, 1024, 2);
  CHECK(even % 2 == 0);
  for (const int n : {sites, even}) {
    const WorstWave wave = waves.on_circle(n);
    const double number = wave.theta * n / (2 * std::numbers::pi);
    CHECK(std::abs(number - std::round(number)) < 1e-9);
    CHECK(wave.amplification <= waves.of_all().amplification * (1 + 1e-9));
    CHECK(n / wave.rate() <= 64 / waves.on_circle(64).rate());
  }
  CHECK(WaveGrowth({scheme("composition (4,4)"), 0.5}, 1.3).on_circle(64).rate() == 0);
}

TEST_CASE("above its limit noise grows exponentially, below it does not") {
  CHECK(growth("triangle-vertex", 0.9) == Growth::bounded);
  CHECK(growth("triangle-vertex", 1.05) == Growth::exponential);
  CHECK(growth("damped", 0.9) == Growth::bounded);
  CHECK(growth("damped", 1.05) == Growth::exponential);
  CHECK(growth("rectangle", 10) == Growth::bounded);
}

TEST_CASE("the ghost of the symmetric rectangle on an even circle is named, and grows like the number of steps") {
  const LinearTheory theory = linear_theory({scheme("rectangle-symmetric"), 0.5}, 2, 20);
  REQUIRE(theory.ghosts.size() == 1);
  CHECK(theory.ghosts[0].theta == Approx(std::numbers::pi));
  CHECK(std::abs(theory.ghosts[0].z + 1.0) < 1e-6);
  CHECK(theory.ghosts[0].words.find("even N") != std::string::npos);
  CHECK(growth("rectangle-symmetric", 0.5, 0.5, 64) == Growth::linear);
  CHECK(growth("rectangle-symmetric", 0.5, 0.5, 63) == Growth::bounded);
  CHECK(linear_theory({scheme("rectangle"), 0.5}, 2, 20).ghosts.empty());
  CHECK(growth("rectangle", 0.5, 0.5, 64) == Growth::bounded);
}

TEST_CASE("a scheme that cannot be built is refused, without a verdict") {
  const ObservedGrowth odd = observe_growth(noisy("hexagon", 0.5, 0.5, 63), 100, 1);
  CHECK(odd.kind == Growth::refused);
  CHECK_FALSE(odd.reason.empty());
}

TEST_CASE("stress cases end in the right verdicts") {
  SECTION("stable") {
    const StressResult r = run_stress_case(stress_case("fast-kink", "v = 0.99, k gamma = 0.05", "triangle-vertex"), 10);
    CHECK(r.verdict == StressVerdict::stable);
    CHECK(r.error_linf < 0.01);
    CHECK(std::isnan(r.diverged_at));
  }
  SECTION("bounded but wrong") {
    const StressResult r = run_stress_case(stress_case("fast-kink", "v = 0.9, k gamma = 2", "rectangle"), 10);
    CHECK(r.verdict == StressVerdict::wrong);
    CHECK(r.error_linf > 0.1);
    CHECK_FALSE(r.reason.empty());
  }
  SECTION("bounded but wrong: leapfrog just beyond its limit") {
    const StressResult r = run_stress_case(stress_case("courant", "h/k = 1.01", "triangle-vertex"), 10);
    CHECK(r.verdict == StressVerdict::wrong);
    CHECK(std::isnan(r.diverged_at));
    CHECK(r.error_linf > 0.3);
  }
  SECTION("diverged") {
    const StressResult angle = run_stress_case(stress_case("angle", "values in S1, h/k = 1.2", "triangle-vertex"), 10);
    CHECK(angle.verdict == StressVerdict::diverged);
    CHECK(angle.diverged_at > 0);
    const StressResult line = run_stress_case(stress_case("courant", "h/k = 2", "triangle-vertex"), 10);
    CHECK(line.verdict == StressVerdict::diverged);
    CHECK(line.diverged_at > 0);
  }
  SECTION("refused") {
    const StressResult odd = run_stress_case(stress_case("size", "N = 5", "hexagon"), 10);
    CHECK(odd.verdict == StressVerdict::refused);
    CHECK(odd.reason.find("brick wall") != std::string::npos);
    const StressResult stiff = run_stress_case(stress_case("stiff", "mh = 1000", "rectangle-symmetric"), 10);
    CHECK(stiff.verdict == StressVerdict::refused);
  }
  SECTION("cut") {
    StressCase c = stress_case("long", "breather, 10^6 steps", "triangle-vertex");
    c.patience = 1;
    const StressResult r = run_stress_case(c, 0.01);
    CHECK(r.cut_at > 0);
    CHECK(r.steps < c.steps);
  }
}

TEST_CASE("a stress case in a process of its own ends as it does here") {
  for (const char* name : {"values in S1, h/k = 0.5", "values in S1, h/k = 1.2"}) {
    const StressCase c = stress_case("angle", name, "triangle-vertex");
    const StressResult here = run_stress_case(c, 10), apart = run_stress_case_apart(c, 10);
    CHECK(apart.verdict == here.verdict);
    CHECK(apart.reason == here.reason);
    CHECK((apart.diverged_at == here.diverged_at || std::isnan(here.diverged_at)));
    CHECK(apart.error_linf == here.error_linf);
    CHECK(apart.steps == here.steps);
  }
}

TEST_CASE("a stress case whose steps outlast its budget is cut, with what there was before") {
  StressCase c = stress_case("size", "N = 1000000", "rectangle");
  c.problem.lattice = Lattice::circle(300001, 0.3 * 300001);
  c.problem.time_step = 0.15;
  c.state.name = "noise", c.state.values["initial.amplitude"] = 1.0;
  c.problem.parameters["theory.mass"] = 30.0;  // mh = 4.5: steps are followed, at seconds each
  const StressResult r = run_stress_case_apart(c, 0.05);
  CHECK_FALSE(must_not_be(r.verdict));
  CHECK(std::isfinite(r.cut_at));
  CHECK(r.steps < c.steps);
}

TEST_CASE("every stress case of every group names keys that a scene has") {
  for (const std::string& group : stress_groups()) {
    const auto all = stress_cases(group, chosen_schemes({}, Problem{}));
    CHECK_FALSE(all.empty());
    for (const StressCase& c : all)
      for (const Setting& key : keys_of(c)) CHECK(find_key(key.key) != nullptr);
  }
  CHECK(stress_cases("no such group", chosen_schemes({}, Problem{})).empty());
}

TEST_CASE("schemes are chosen by their names") {
  CHECK(chosen_schemes({"all"}, Problem{}).size() > 10);
  CHECK_THROWS_AS(chosen_schemes({"triangel"}, Problem{}), BadInput);
}

TEST_CASE("findings pass, and numbers that are not finite are reported as null") {
  const StabilityFindings f = find_stability(small_request(), coarse());
  CHECK(f.passed());
  const Scene scene(Settings("test.ini", {}, {}));
  const std::string text = stability_json(scene, f);
  CHECK(text.find("nan") == std::string::npos);
  CHECK(text.find(": inf") == std::string::npos);
  const Json json = Json::parse(text);
  CHECK(json["passed"] == true);
  REQUIRE(json["limits"].size() == 2);
  for (const char* name : {"scheme", "mass_step", "courant_theory", "courant_observed", "ghosts"})
    CHECK(json["limits"][0].contains(name));
  REQUIRE(json["corners"].size() == 4);
  for (const char* name : {"name", "parameters", "verdict", "error_linf", "energy_error_max", "diverged_at"})
    CHECK(json["corners"][0].contains(name));
  CHECK(stability_report(scene, f).find("passed: 2 limits") != std::string::npos);
}

TEST_CASE("where nothing can be compared, nothing has passed") {
  StabilityFindings f;
  Limit limit;
  limit.left_out = "no symbol";
  f.limits.push_back(limit);
  CHECK_FALSE(f.passed());
  CHECK(stability_report(Scene(Settings("test.ini", {}, {})), f).find("nothing could be compared") !=
        std::string::npos);
  f.limits.emplace_back();
  CHECK(f.passed());
}

TEST_CASE("a theory without limits on a circle is not applicable: one line, exit code 2, and no results") {
  const testing::Folder folder;
  testing::check_refused(
      testing::delf_program(folder, "stability kdv --out out"),
      {"kdv.ini: stability.waves: not applicable, there is no limit to find: six-tuple: on a circle no "
       "step determines the waves of theta = 0"});
  CHECK_FALSE(std::filesystem::exists(folder.path() / "out"));
  // an interrupted search, and one that has found a ghost under a constraint, are results
  StabilityFindings f;
  CHECK(f.not_applicable());
  f.constraints.push_back({"rectangle-symmetric", "grows"});
  CHECK_FALSE(f.not_applicable());
  f.constraints.clear(), f.status = "interrupted";
  CHECK_FALSE(f.not_applicable());
}

TEST_CASE("the scene's own scheme has limits too, or the report says why not") {
  const testing::Folder folder;
  const auto requested = [&](const std::string& scene, const std::vector<Setting>& keys = {}) {
    return read_stability_request(read_scene(find_scene(scene), keys));
  };
  const auto has = [](const StabilityRequest& request, const std::string& name) {
    return std::ranges::count(request.schemes, name, &NamedScheme::name) == 1;
  };
  const StabilityRequest moving = requested("soliton-bounce");
  CHECK(moving.schemes.size() == 8);
  CHECK(moving.own_left_out.starts_with("not applicable to the scene's own scheme (r-adaptive, multiplier, lobatto3"));
  CHECK(moving.own_left_out.ends_with("the mesh moves between two fixed walls"));
  StabilityFindings f;
  f.own_left_out = moving.own_left_out;
  const Scene scene(Settings("test.ini", {}, {}));
  CHECK(stability_report(scene, f).find("not applicable to the scene's own scheme") != std::string::npos);
  CHECK(Json::parse(stability_json(scene, f))["own_scheme_left_out"] == moving.own_left_out);

  const StabilityRequest wide = requested("collision", {{"scheme.method", "composition"}});
  CHECK(wide.own_left_out.empty());
  CHECK(wide.schemes.size() == 9);
  CHECK(wide.schemes.back().problem.method == "composition");
  CHECK(requested("collision").schemes.size() == 8);
  CHECK(requested("spacetime-element").schemes.size() == 8);  // one of the eight by another name
  CHECK(has(requested("soliton-bounce", {{"stability.schemes", "triangle"}}), "triangle"));
  CHECK(requested("soliton-bounce", {{"stability.schemes", "triangle"}}).own_left_out.empty());
}

TEST_CASE("a map is of an odd circle, without the ghost of even N, where the scheme closes on it") {
  const StabilityMap odd = make_stability_map({"rectangle-symmetric", scheme("rectangle-symmetric")}, 1, 1);
  CHECK(odd.sites == 33);
  CHECK(std::ranges::count(odd.grows, Growth::bounded) == std::ssize(odd.grows));
  CHECK(observe_growth(noisy("rectangle-symmetric", 0.5, 1, 32), 400, 1).kind == Growth::linear);
  const StabilityMap bricks = make_stability_map({"hexagon", scheme("hexagon")}, 1, 1);
  CHECK(bricks.sites == 32);
  CHECK(std::ranges::count(bricks.grows, Growth::refused) == 0);
}

TEST_CASE("under the constraint of the scene's theory a staggered wave that grows is named, with its scheme") {
  StabilityRequest request = small_request();
  request.schemes = chosen_schemes({"rectangle-symmetric", "rectangle", "triangle-vertex"}, Problem{});
  for (NamedScheme& one : request.schemes)
    one.problem.theory = "wave-map", one.problem.lattice = coarse().lattice, one.problem.time_step = 0.1;
  request.mass_steps.clear(), request.stress_cases.clear();
  const StabilityFindings f = find_stability(request, coarse());
  REQUIRE(f.constraints.size() == 1);
  CHECK(f.constraints[0].scheme == "rectangle-symmetric");
  const Scene scene(Settings("test.ini", {}, {}));
  CHECK(stability_report(scene, f).find("rectangle-symmetric: waves near theta = pi, z = -1") != std::string::npos);
  CHECK(Json::parse(stability_json(scene, f))["constraint_ghosts"].size() == 1);
  // none without a constraint
  for (NamedScheme& one : request.schemes) one.problem.theory = "wave";
  CHECK(find_stability(request, coarse()).constraints.empty());
}

TEST_CASE("findings fail when theory is wrong, or a stress case ends in a forbidden verdict") {
  StabilityRequest request = small_request();
  request.schemes.pop_back();
  request.stress_cases.clear();
  request.limit.theory_factor = 1.05;
  StabilityFindings f = find_stability(request, coarse());
  CHECK_FALSE(f.passed());
  CHECK(f.disagreements() > 0);
  const Scene scene(Settings("test.ini", {}, {}));
  CHECK(stability_report(scene, f).find("FAILED: theory and runs disagree") != std::string::npos);

  f.limits.assign(1, Limit{});
  CHECK(f.passed());
  StressCase c = stress_case("angle", "values in S1, h/k = 0.5", "triangle-vertex");
  for (const StressVerdict verdict : {StressVerdict::unsolved, StressVerdict::silent, StressVerdict::failed,
                                      StressVerdict::crashed, StressVerdict::hung}) {
    StressResult r;
    r.verdict = verdict;
    f.stress_cases = {{c, r}};
    CHECK_FALSE(f.passed());
    CHECK(Json::parse(stability_json(scene, f))["passed"] == false);
  }
  StressResult refused;
  refused.verdict = StressVerdict::refused;
  f.stress_cases = {{c, refused}};
  CHECK(f.passed());
}

TEST_CASE("the map and the dispersion relation are drawn") {
  REQUIRE(std::system("command -v gnuplot > /dev/null") == 0);  // tools/setup installs it
  const delf::testing::Folder folder;
  StabilityFindings f;
  StabilityMap map{"triangle-vertex", 33, {0.5, 1, 1.5}, {0.1, 1}, {}, {0.1}, {{0.999}}};
  map.grows = {Growth::bounded, Growth::bounded, Growth::exponential,
               Growth::linear,  Growth::refused, Growth::exponential};
  f.maps = std::vector<StabilityMap>(maps_in_a_figure + 1, map);
  f.dispersion = {{"guo", {{0, 0.1, 0.1}, {1, 0.9, 1.0}, {3, 2, 3}}}};
  CHECK(draw_stability(f, "test", {}, folder.path()) == "");
  for (const std::string& name : stability_figure_names(f.maps.size()))
    for (const char* ending : {".png", ".svg"})
      CHECK(std::filesystem::file_size(folder.path() / "figures" / (name + ending)) > 2000);
}

TEST_CASE("what takes long is announced with its duration, and what is short is not") {
  const testing::Folder folder;
  const testing::Ran cut =
      testing::shell(folder, "'" + testing::program_path() +
                                 "' stability collision --out out & p=$!; sleep 1; kill -TERM $p; wait $p");
  CHECK(testing::contains(cut.err, "24 limits, 8 maps and "));
  CHECK(testing::contains(cut.err, "stress cases, about "));
  CHECK_FALSE(testing::contains(
      testing::delf_program(folder,
                            "stability collision --stability.schemes=triangle-vertex --stability.mass_steps=1 "
                            "--stability.steps=100 --stability.corners=none --stability.map=off --out out")
          .err,
      "limits, "));
}

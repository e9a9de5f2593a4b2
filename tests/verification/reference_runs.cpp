// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/catch.hpp"
#include "tests/verification/experiment.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

// Marsden–Patrick–Shkoller, §5.2: space a circle of length 40, N = 255, h = k/8, 1 − κ = 1e-6. Computed in
// quadruple precision by another program; the energy is the sum of footnote 4, without the factor k.
constexpr std::array<std::size_t, 6> sites{0, 20, 32, 64, 128, 200};
struct Snapshot {
  int row;
  double energy_sum;
  std::array<double, 6> y;
};
struct ReferenceRun {
  SchemeName scheme;
  std::vector<Snapshot> snapshots;
};
const std::vector<ReferenceRun> reference_runs{
    {{"triangle"},  // (5.8)
     {{10, 161.90082507679725,
       {0.00010755770291407418, 0.16244570966089986, 2.7224797112131327,
        6.282731570751808, 6.283185307179586, 6.267344724358103}},
      {100, 161.8994423147544,
       {0.0011529390330817513, 0.016891970854085, 0.363249749159364,
        6.267737515746274, 6.283185307179586, 6.142005819027942}},
      {1000, 161.7440052028307,
       {-0.0005887068567692645, -0.00010609509251195387, 0.00010659955606536484,
        -0.00015847265257488372, -2.7256895598670083, -0.0010326306870439875}}}},
    {{"rectangle"},  // (5.10)
     {{10, 161.90080938713996,
       {0.00010374715381499814, 0.1624371668122492, 2.7224739052584543,
        6.282734253001203, 6.283185307179586, 6.267344730002279}},
      {100, 161.89959667663655,
       {0.001156533433525321, 0.016777651004601418, 0.3631381909183988,
        6.2677575398471035, 6.283185307179586, 6.142009562302654}},
      {1000, 161.76143164545715,
       {-0.0005906177269023307, -0.00013455426630720502, 0.0001080650686667512,
        -0.00017865588751436083, -2.730180515007592, -0.0010156251990809627}}}},
    {{"rectangle-symmetric"},  // (5.12)
     {{10, 161.9006823639168,
       {0.00016726872815999818, 0.16237600536697053, 2.7227467137081933,
        6.282656508245841, 6.2831861319591615, 6.2672951735966835}},
      {100, 161.90080103174773,
       {0.0010163924077943652, 0.018274931786435022, 0.36447543042615893,
        6.268025193623784, 6.2831802522258915, 6.1440322464203385}},
      {1000, 161.89986661737802,
       {0.00026569001166557255, 0.00019189563467723677, 0.0002999584995331634,
        0.0007721158185348999, -3.073597446699777, 0.0007433278738511224}}}},
    {{"", "vu-quoc-li"},  // (5.14)
     {{10, 161.90119545746367,
       {0.00010756293141632486, 0.16248629495833158, 2.7223901930462913,
        6.282731984746107, 6.283185307179586, 6.267341046916472}},
      {100, 161.89832717635858,
       {0.0012269398169457947, 0.017533508112043558, 0.36427142014462754,
        6.267613282688446, 6.283185307179586, 6.140653084889634}},
      {1000, 161.56854843762937,
       {-0.0006187885909460819, -0.00029366047337864846, -9.197316401708409e-05,
        -0.00037836072324548537, -2.6390485605811693, -0.0012101211117046345}}}},
    {{"", "guo"},  // (5.15)
     {{10, 161.90117558035445,
       {0.00011088283107169878, 0.16248467012629303, 2.7223934410958583,
        6.2827297119478, 6.283185307179586, 6.267341170360975}},
      {100, 161.89860564126707,
       {0.0012151450039401893, 0.017526703183218143, 0.36426122052901616,
        6.26762360718558, 6.283185307179586, 6.1406960851292185}},
      {1000, 161.57936393073052,
       {-0.0006300252339063898, -0.0002606051959686623, -7.597450848708747e-05,
        -0.0003486258677778651, -2.6450080222360945, -0.0011723712161047747}}}},
};

struct Deviation {
  double y = 0;       // largest |y − y_reference|
  double energy = 0;  // largest |H/(kΣ) − 1|
};

Deviation deviation(const ReferenceRun& reference, const SchemeName& scheme, double epsilon) {
  const Lattice lattice = Lattice::circle(255, 40);
  const Problem p = problem_for(scheme, "sine-gordon", lattice, 0.125);
  StateRequest request;
  request.name = "mps-collision", request.theory = "sine-gordon", request.values["initial.epsilon"] = epsilon;
  const auto state = make_state(request, lattice);
  Simulation simulation(p);
  start(simulation, p, *state, Start::exact);

  Deviation largest;
  for (const Snapshot& snapshot : reference.snapshots) {
    while (simulation.newest() < snapshot.row) simulation.step();
    const Row y = newest(simulation, lattice);
    for (std::size_t n = 0; n < sites.size(); ++n)
      largest.y = std::max(largest.y, std::abs(y[sites[n]] - snapshot.y[n]));
    const double energy = lattice.space_step() * snapshot.energy_sum;
    largest.energy = std::max(largest.energy, std::abs(simulation.monitors().energy / energy - 1));
  }
  return largest;
}

bool agrees(const Deviation& d) { return d.y < 1e-10 && d.energy < 1e-10; }

}  // namespace

TEST_CASE("the collision of section 5.2 agrees with another program in quadruple precision, up to row 1000") {
  for (const ReferenceRun& reference : reference_runs) {
    const Deviation d = deviation(reference, reference.scheme, 1e-6);
    CAPTURE(reference.scheme.text(), d.y, d.energy);
    CHECK(agrees(d));
  }
}

TEST_CASE("the comparison can fail: data that differ by 1e-9, and a triangle with the other nonlinear term") {
  for (const ReferenceRun& reference : reference_runs) {
    const Deviation d = deviation(reference, reference.scheme, 1e-6 + 1e-9);
    CAPTURE(reference.scheme.text(), d.y, d.energy);
    CHECK_FALSE(agrees(d));
  }
  CHECK_FALSE(agrees(deviation(reference_runs.front(), {"triangle-vertex"}, 1e-6)));
}

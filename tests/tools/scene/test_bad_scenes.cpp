// SPDX-License-Identifier: MIT
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"

using namespace delf::testing;

TEST_CASE("errors in a scene name file, line, key, value, reason and remedy") {
  struct Bad {
    const char *line, *key, *reason;
  };
  const Bad bad = GENERATE(values<Bad>({
      {"[lattice]\nsitez = 3", "lattice.sitez", "did you mean lattice.sites?"},
      {"[latice]\nsites = 3", "latice.sites", "did you mean lattice.sites?"},
      {"[qwertyuiop]\nasdf = 3", "qwertyuiop.asdf", "unknown key"},
      {"[lattice]\nsites = 32", "lattice.sites = 32", "line 5 gives it already"},
      {"[lattice]\ntime_step = 1", "lattice.time_step = 1", "lattice.courant is given too"},
      {"[run]\nuntil = 1", "run.until = 1", "run.steps is given too"},
      {"[theory]\nmass = abc", "theory.mass = abc", "not a number"},
      {"[theory]\nmass = 1e", "theory.mass = 1e", "not a number"},
      {"[theory]\nmass = 1 2", "theory.mass = 1 2", "not a number"},
      {"[theory]\nmass = 0x10", "theory.mass = 0x10", "not a number"},
      {"[theory]\nmass = nan", "theory.mass = nan", "not a finite number"},
      {"[theory]\nmass = -inf", "theory.mass = -inf", "not a finite number"},
      {"[theory]\nmass = 1e999", "theory.mass = 1e999", "outside the range"},
      {"[theory]\nmass =", "theory.mass =", "no value"},
      {"[theory]\nfibre = S2", "theory.fibre = S2", "not known"},
      {"[scheme]\nmethod = gou", "scheme.method = gou", "did you mean guo?"},
      {"[scheme]\nseed_order = 9", "scheme.seed_order = 9", "at most 8"},
      {"[scheme]\nseed_order = 2.5", "scheme.seed_order = 2.5", "not an integer"},
      {"[scheme]\ntolerance = 0", "scheme.tolerance = 0", "above 0"},
      {"[scheme]\ntolerance = 1", "scheme.tolerance = 1", "at most 0.01; lower"},
      {"[initial]\nspeed = 1", "initial.speed = 1", "slower than light"},
      {"[initial]\nstart = legendre", "initial.start = legendre",
       "needs scheme.method = radau-iia or r-adaptive or cgvi or spacetime or processed or composition"},
      {"[scheme]\nquadrature = simpson", "scheme.quadrature = simpson", "not known"},
      {"[output]\nfields = maybe", "output.fields = maybe", "on or off"},
      {"[output]\ntimes = 1, x", "output.times = 1, x", "not a number"},
      {"[output]\nevery = -1", "output.every = -1", "at least 0"},
      {"[run]\nthreads = 0", "run.threads = 0", "at least 1"},
      {"[run]\nthreads = 1025", "run.threads = 1025", "at most 1024"},
      {"[run]\nwhat is this", "what is this", "neither a [section] nor key = value"},
  }));
  const Folder folder;
  const std::string file = folder.write("bad.ini", small_scene(bad.line));
  check_refused(delf_program(folder, "run bad.ini"), {"bad.ini:14: ", bad.key, bad.reason});
  CHECK_FALSE(std::filesystem::exists(folder / "results"));
}

TEST_CASE("what overflows, does not fit, or comes twice is named") {
  const Folder folder;
  const auto [command, reason] = GENERATE(table<const char*, const char*>({
      {"run soliton-bounce --mesh.alpha=1e300", "--mesh.alpha = 1e300: the field equations overflow"},
      {"run soliton-bounce --mesh.monitor=-1", "--mesh.monitor = -1: must be positive"},
      {"run soliton-bounce --mesh.monitor=0", "--mesh.monitor = 0: must be positive"},
      {"run wave-packet --initial.width=100", "does not fit on a circle of length 80; choose a width of at most 20"},
      {"run kink --out one --out two", "--out two: is a second one, after --out one"},
      {"run soliton-bounce --lattice.time_steps=reversibel", "lattice.time_steps = reversibel: must be reversible"},
      {"stability soliton-bounce --lattice.time_steps=reversible", "limits are of equal steps"},
      {"stability static-kink", "limits are those of rows"},
      {"workprecision static-kink", "lattice.space = complex: works with run, resume, plan, verify, sweep, convergence"},
      {"run cr.ini", "cr.ini: its lines end in CR alone"},
  }));
  std::string scene = small_scene();
  for (char& c : scene)
    if (c == '\n') c = '\r';
  folder.write("cr.ini", scene);
  check_refused(delf_program(folder, command), {reason});
}

TEST_CASE("help lists the keys of one command, and a position beyond the circle is on it") {
  const Folder folder;
  CHECK_FALSE(contains(delf_program(folder, "help run").out, "sweep.jobs"));
  CHECK(contains(delf_program(folder, "help sweep").out, "sweep.jobs"));
  CHECK(contains(delf_program(folder, "run kink --initial.position=-30 --run.steps=2 --output.figures=off").out,
                 "x0 = 10,"));
}

TEST_CASE("errors on the command line name key, value, reason and remedy") {
  struct Bad {
    const char *argument, *reason;
  };
  const Bad bad = GENERATE(values<Bad>({
      {"--lattice.si=5", "--lattice.si: unknown key; did you mean lattice.sites?"},
      {"--lattice.si 5", "--lattice.si: unknown key; did you mean lattice.sites?"},
      {"--sites=5", "did you mean lattice.sites?"},
      {"--lattice.sites=0", "--lattice.sites = 0: must be at least 2; raise lattice.sites"},
      {"--lattice.sites=1", "--lattice.sites = 1: must be at least 2"},
      {"--lattice.sites 1", "--lattice.sites = 1: must be at least 2"},
      {"--lattice.sites=99999999999", "--lattice.sites = 99999999999: must be at most"},
      {"--lattice.sites=1e999999", "not an integer"},
      {"--lattice.sites=99999999999999999999", "too large"},
      {"--lattice.length=-1", "--lattice.length = -1: must be above 0"},
      {"--lattice.length=0", "must be above 0"},
      {"--lattice.length=1e-320", "double precision"},
      {"--lattice.courant=0", "--lattice.courant = 0: must be above 0"},
      {"--lattice.courant=-0.5", "must be above 0"},
      {"--lattice.courant=nan", "--lattice.courant = nan: is not a finite number"},
      {"--lattice.courant 0.5 --lattice.time_step 0.1", "lattice.courant is given too"},
      {"--lattice.stencil=triangel", "did you mean triangle?"},
      {"--lattice.stencil=leapfrogg", "did you mean leapfrog?"},
      {"--lattice.stencil=stoermer-verlet", "did you mean stormer-verlet?"},
      {"--lattice.stencil=hexagon --lattice.sites=63", "--lattice.sites = 63"},
      {"--theory.name=sin-gordon", "--theory.name = sin-gordon: is not known; did you mean sine-gordon?"},
      {"--initial.state=breathr", "did you mean breather?"},
      {"--initial.speed -1.5", "--initial.speed = -1.5"},
      {"--initial.speed=nan", "not a finite number"},
      {"--run.until=-1", "--run.until = -1: is before t = 0"},
      {"--run.until=1e300", "more than can be counted"},
      {"--run.steps=3 --run.steps=4", "--run.steps = 4: given twice"},
      {"--run.steps=", "run.steps"},
      {"--run.steps", "run.steps"},
      {"--out", "--out"},
      {"-v", "-v: unknown option"},
      {"another", "another: one word too many"},
      {"--initial.file='a#b' --initial.state=file", "--initial.file: a value holds neither #"},
  }));
  const Folder folder;
  folder.write("good.ini", small_scene());
  INFO(bad.argument);
  check_refused(delf_program(folder, std::string("run good.ini ") + bad.argument), {"command line: ", bad.reason});
}

TEST_CASE("missing keys of a scene are reported") {
  const Folder folder;
  const auto refused = [&](const std::string& text, const std::string& reason) {
    folder.write("bad.ini", text);
    check_refused(delf_program(folder, "run bad.ini"), {"bad.ini: ", reason});
  };
  refused("[run]\nsteps = 1\n[lattice]\nsites = 9\nlength = 1\n[initial]\nstate = kink\n",
          "neither lattice.courant nor lattice.time_step");
  refused("[lattice]\nsites = 9\nlength = 1\ncourant = 1\n[initial]\nstate = kink\n",
          "neither run.until nor run.steps");
  refused("[run]\nsteps = 1\n[lattice]\nlength = 1\ncourant = 1\n[initial]\nstate = kink\n",
          "lattice.sites: must be given");
  refused("[run]\nsteps = 1\n[lattice]\nsites = 9\nlength = 1\ncourant = 1\n", "initial.state: must be given");
  refused("", "the scene is empty");
  refused("# only this\n\n", "the scene is empty");
}

TEST_CASE("a file that is no scene is refused in one line") {
  const Folder folder;
  std::filesystem::create_directory(folder / "directory");
  folder.write("zeros", std::string(100, '\0'));
  folder.write("latin", "name = caf\xe9\n");
  folder.write("huge", std::string(2 << 20, '#'));
  check_refused(delf_program(folder, "run directory"), {"directory: is a directory"});
  check_refused(delf_program(folder, "run zeros"), {"zeros: is a binary file"});
  check_refused(delf_program(folder, "run latin"), {"latin: is a binary file"});
  check_refused(delf_program(folder, "run huge"), {"huge: is too large"});
  check_refused(delf_program(folder, "run missing/scene.ini"), {"missing/scene.ini: no such file"});
  check_refused(delf_program(folder, "run colision"),
                {"colision: no such file or shipped scene; did you mean collision?"});
  check_refused(delf_program(folder, "run collision.ini"), {"did you mean collision?"});
  check_refused(delf_program(folder, "run qwertyuiop"),
                {"known: asynchronous, beam, born-infeld, boussinesq, breather"});
  check_refused(delf_program(folder, "run ''"), {"command line: run what? Name a scene"});
}

TEST_CASE("a choice that the library refuses is reported with its line of the scene") {
  const Folder folder;
  folder.write("odd.ini", small_scene("[lattice]\nstencil = hexagon\n") + "");
  folder.write("fast.ini", small_scene("[initial]\nfrequency = 1.5\n"));
  check_refused(delf_program(folder, "run odd.ini --lattice.sites=65"), {"command line: --lattice.sites = 65: "});
  check_refused(delf_program(folder, "run fast.ini"), {"fast.ini:14: initial.frequency = 1.5: "});
  check_refused(delf_program(folder, "plan fast.ini"), {"fast.ini:14: initial.frequency = 1.5: "});
}

// SPDX-License-Identifier: MIT
#include "tools/commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <utility>
#include <variant>

#include "schemes/methods/energies.hpp"
#include "schemes/methods/method_registry.hpp"
#include "tools/cite/cite.hpp"
#include "tools/command_line.hpp"
#include "tools/complex/mesh_run.hpp"
#include "tools/convergence/convergence.hpp"
#include "tools/files/plain_rows.hpp"
#include "tools/files/text_file.hpp"
#include "tools/film/make_film.hpp"
#include "tools/help.hpp"
#include "tools/list.hpp"
#include "tools/page/page.hpp"
#include "tools/plan.hpp"
#include "tools/reproduce/reproduce.hpp"
#include "tools/results/result_folder.hpp"
#include "tools/resume.hpp"
#include "tools/rows/initial_rows.hpp"
#include "tools/run/kept_results.hpp"
#include "tools/run/run.hpp"
#include "tools/scene/scene.hpp"
#include "tools/scene/shipped_scenes.hpp"
#include "tools/scene/suggestion.hpp"
#include "tools/scene/values.hpp"
#include "tools/stability/mesh_stability.hpp"
#include "tools/stability/stability.hpp"
#include "tools/sweep/sweep.hpp"
#include "tools/verify/verify.hpp"
#include "tools/workprecision/workprecision.hpp"
#include "tools/xdmf.hpp"

namespace delf {

namespace {

std::string only_word(const Arguments& arguments, const char* otherwise) {
  if (arguments.words.size() > 2)
    throw BadScene(fmt::format("command line: {}: one word too many; give one thing at a time", arguments.words[2]));
  const bool none = arguments.words.size() < 2 || arguments.words[1].empty();
  if (none && otherwise == nullptr)
    throw BadScene(
        fmt::format("command line: {} what? Name a scene file or a shipped scene, such as `delf {} "
                    "collision`",
                    arguments.words[0], arguments.words[0]));
  return none ? otherwise : arguments.words[1];
}

std::filesystem::path file_of(const Arguments& arguments) {
  check_command_line(arguments.keys);
  return find_scene(only_word(arguments, nullptr));
}

Settings settings_of(const Arguments& arguments) {
  Settings settings = read_settings(file_of(arguments), arguments.keys);
  for (const std::string& line : keys_of_other_commands(arguments.words[0], arguments.keys))
    std::fputs(("command line: --" + line + "\n").c_str(), stderr);
  return settings;
}

void say_warnings(const Scene& scene) {
  for (const std::string& warning : scene.warnings) std::fputs((warning + "\n").c_str(), stderr);
}

/// Reads a scene, on a lattice or on a mesh, and carries out what `work` does with it in the folder of its results.
template <class Work>
ExitCode with_scene(Settings settings, const Arguments& arguments, const Work& work) {
  AnyScene any = read_any_scene(std::move(settings));
  return std::visit(
      [&](auto& scene) {
        const Scene& common = common_part(scene);
        say_warnings(common);
        return work(scene, arguments.out.value_or("results/" + common.name));
      },
      any);
}

void refuse(const Arguments& arguments, bool keys) {
  if (keys && !arguments.keys.empty())
    throw BadScene(fmt::format("command line: --{}: `{}` reads no scene; leave it out", arguments.keys[0].key,
                               arguments.words[0]));
  if (arguments.out)
    throw BadScene(fmt::format("command line: --out: `{}` writes no files; leave it out", arguments.words[0]));
}

std::string resolved_of(const Scene& scene) {
  const InitialRows initial(scene);
  return resolved_text(scene, initial.rule(), initial.description());
}
std::string resolved_of(const ComplexScene& mesh) { return resolved_text(mesh); }

const Scene& scene_of(const Scene& scene) { return scene; }
const Scene& scene_of(const ComplexScene& mesh) { return mesh.scene; }

/// The scene for the folder of a command that does not write it itself: what is in force, or of rows that are read from a
/// file, and have no start, what is given.
template <class SomeScene>
std::string scene_for_page(const SomeScene& scene) try {
  return resolved_of(scene);
} catch (const BadInput&) {
  const Settings& settings = scene_of(scene).settings;
  return sections_of(settings, [&](const Parameter& key) {
    const Setting* given = settings.find(key.key);
    return given ? given->value : std::string();
  });
}

/// The scene.ini of a folder stays, where a run wrote it with its rows, or somebody by hand.
bool is_kept(const std::filesystem::path& folder) {
  std::error_code none;
  const std::filesystem::path file = folder / "scene.ini";
  if (!std::filesystem::exists(file, none)) return false;
  for (const char* of_run : {"summary.json", "series.csv", "fields.h5"})
    if (std::filesystem::exists(folder / of_run, none)) return true;
  return !file_text(file).starts_with(resolved_scene_begins);
}

/// Carries out `work`, and makes the page of its results, where the scene asks for it; of a run that fails, too.
ExitCode with_page(bool wanted, const std::filesystem::path& folder, const std::function<ExitCode()>& work,
                   const std::function<std::string()>& scene) {
  if (!wanted) return work();
  const auto make_page = [&] {
    try {
      if (scene && !is_kept(folder)) write_text_file(folder / "scene.ini", scene());
      write_page({folder}, std::nullopt);
    } catch (const std::exception& error) {
      std::fputs(fmt::format("delf: no page: {}\n", error.what()).c_str(), stderr);
    }
  };
  ExitCode code = ExitCode::done;
  try {
    code = work();
  } catch (const BadInput&) {  // nothing was begun
    throw;
  } catch (const std::exception&) {
    make_page();
    throw;
  }
  make_page();
  return code;
}

/// Carries out what writes results, and makes their page if output.report is on.
template <class Work>
ExitCode with_results(Settings settings, const Arguments& arguments, const Work& work) {
  return with_scene(std::move(settings), arguments, [&](const auto& scene, const std::string& folder) {
    return with_page(
        Values(scene_of(scene).settings).toggle("output.report"), folder, [&] { return work(scene, folder); },
        [&] { return scene_for_page(scene); });
  });
}

/// Runs a scene in a folder, whose earlier run is kept unless the folder is named, or --overwrite given.
template <class SomeScene>
ExitCode run_keeping(const Arguments& arguments, const SomeScene& scene, const std::filesystem::path& folder) {
  std::optional<KeptResults> earlier;
  if (std::error_code none;
      !arguments.out && !arguments.overwrite && std::filesystem::exists(folder / "scene.ini", none))
    earlier.emplace(folder, resolved_of(scene));
  return run(scene, folder);
}

/// Makes the film of a run that is over, where its scene asks for one. A film that fails does not fail the run.
ExitCode with_film(const Settings& settings, const std::filesystem::path& folder, const std::vector<Setting>& keys,
                   ExitCode of_run) {
  const Values values(settings);
  if (!values.toggle("output.film")) return of_run;
  if (!values.toggle("output.fields") || of_run != ExitCode::done) {
    std::fputs(
        fmt::format("delf: no film: {}\n", !values.toggle("output.fields")
                                               ? "it is made of the recorded rows; set output.fields = on"
                                               : fmt::format("the run did not come to its end; `delf film {}` makes "
                                                             "one of the rows that are there",
                                                             folder.string()))
            .c_str(),
        stderr);
    return of_run;
  }
  try {
    return make_film(folder, keys);
  } catch (const std::exception& error) {
    std::fputs((error_line(error) + "\n").c_str(), stderr);
  }
  return of_run;
}

/// The keys of films among those of a command line.
std::vector<Setting> keys_of_film(std::vector<Setting> keys) {
  std::erase_if(keys, [](const Setting& s) { return section_of(s.key) != find_command("film").section; });
  return keys;
}

ExitCode carry_out_run(const Arguments& arguments) {
  return with_results(settings_of(arguments), arguments, [&](const auto& scene, const std::string& folder) {
    return with_film(scene_of(scene).settings, folder, keys_of_film(arguments.keys),
                     run_keeping(arguments, scene, folder));
  });
}

ExitCode carry_out_resume(const Arguments& arguments) {
  if (arguments.words.size() < 2)
    throw BadScene("command line: resume what? Name the folder of a run, such as `delf resume results/collision`");
  if (arguments.out) throw BadScene("command line: --out: a run is resumed in its own folder; leave it out");
  check_command_line(arguments.keys);
  const std::filesystem::path folder = only_word(arguments, nullptr);
  std::optional<Settings> settings;
  if (std::error_code none; std::filesystem::exists(folder / "scene.ini", none))
    settings = read_settings(folder / "scene.ini", arguments.keys);
  const auto work = [&] {
    const ExitCode code = resume(folder, arguments.keys);
    return settings ? with_film(*settings, folder, keys_of_film(arguments.keys), code) : code;
  };
  return with_page(settings && Values(*settings).toggle("output.report"), folder, work, {});
}

ExitCode carry_out_xdmf(const Arguments& arguments) {
  if (arguments.words.size() < 2)
    throw BadScene("command line: xdmf what? Name the folder of a run, such as `delf xdmf results/collision`");
  if (arguments.out)
    throw BadScene("command line: --out: XDMF is written beside the rows that it points into; leave it out");
  if (!arguments.keys.empty())
    throw BadScene(fmt::format("command line: --{}: `xdmf` reads no scene; leave it out", arguments.keys[0].key));
  return write_xdmf(only_word(arguments, nullptr));
}

ExitCode carry_out_film(const Arguments& arguments) {
  if (arguments.words.size() < 2)
    throw BadScene("command line: film what? Name the folder of a run, such as `delf film results/collision`");
  if (arguments.out) throw BadScene("command line: --out: a film is made in the folder of its run; leave it out");
  check_command_line(arguments.keys);
  for (const Setting& s : arguments.keys)
    if (section_of(s.key) != find_command("film").section)
      throw BadScene(fmt::format("command line: --{}: the rows are recorded already; leave it out", s.key));
  return make_film(only_word(arguments, nullptr), arguments.keys);
}

ExitCode carry_out_report(const Arguments& arguments) {
  if (!arguments.keys.empty())
    throw BadScene(fmt::format("command line: --{}: `report` reads no scene; leave it out", arguments.keys[0].key));
  if (arguments.words.size() < 2)
    throw BadScene("command line: report what? Name a folder of results, such as `delf report results/collision`");
  return write_page({arguments.words.begin() + 1, arguments.words.end()}, arguments.out);
}

ExitCode plan_modified(const ComplexScene&, int, bool) {
  throw BadScene("command line: --modified: is for lattices, and this scene is on a mesh; leave it out");
}

ExitCode carry_out_cite(const Arguments& arguments) {
  if (arguments.words.size() < 2)
    throw BadScene(
        "command line: cite what? Name a scene, or a folder of results, such as `delf cite results/collision`");
  return cite(only_word(arguments, nullptr), arguments.keys, arguments.out);
}

ExitCode carry_out_plan(const Arguments& arguments) {
  refuse(arguments, false);
  return with_scene(settings_of(arguments), arguments, [&](const auto& scene, const std::string&) {
    return arguments.modified ? plan_modified(scene, *arguments.modified, arguments.latex)
                              : plan(scene, arguments.latex);
  });
}

ExitCode carry_out_verify(const Arguments& arguments) {
  Settings settings = settings_of(arguments);
  if (std::error_code none; arguments.fields && !std::filesystem::exists(file_of_rows(*arguments.fields), none))
    throw BadScene(fmt::format("command line: --fields {}: no such file; check the path", *arguments.fields));
  if (arguments.fields && !is_on_mesh(settings)) imply_rows(settings, *arguments.fields);
  return with_results(std::move(settings), arguments, [&](const auto& scene, const std::string& folder) {
    return verify(scene, folder, arguments.fields, arguments.nearby);
  });
}

ExitCode sweep_with_page(const Arguments& arguments, SweepKind kind) {
  const std::filesystem::path scene = file_of(arguments);
  const std::string ending = kind == SweepKind::compare ? "-compare" : "-sweep";
  return with_page(Values(read_settings(scene, arguments.keys)).toggle("output.report"),
                   arguments.out.value_or("results/" + scene.stem().string() + ending),
                   [&] { return sweep(scene, arguments.keys, arguments.out, kind); }, {});
}
ExitCode carry_out_sweep(const Arguments& arguments) { return sweep_with_page(arguments, SweepKind::sweep); }
ExitCode carry_out_compare(const Arguments& arguments) { return sweep_with_page(arguments, SweepKind::compare); }

ExitCode carry_out_convergence(const Arguments& arguments) {
  return with_results(settings_of(arguments), arguments,
                      [](const auto& scene, const std::string& folder) { return convergence(scene, folder); });
}

ExitCode carry_out_workprecision(const Arguments& arguments) {
  const Scene scene = read_scene(settings_of(arguments));
  say_warnings(scene);
  const std::string folder = arguments.out.value_or("results/" + scene.name);
  return with_page(
      Values(scene.settings).toggle("output.report"), folder, [&] { return workprecision(scene, folder); },
      [&] { return scene_for_page(scene); });
}

ExitCode carry_out_stability(const Arguments& arguments) {
  return with_results(settings_of(arguments), arguments,
                      [](const auto& scene, const std::string& folder) { return stability(scene, folder); });
}

ExitCode carry_out_reproduce(const Arguments& arguments) {
  return reproduce({arguments.words.begin() + 1, arguments.words.end()}, arguments.keys, arguments.out, run_program);
}

ExitCode carry_out_list(const Arguments& arguments) {
  refuse(arguments, true);
  return list(only_word(arguments, ""));
}

ExitCode carry_out_help(const Arguments& arguments) {
  refuse(arguments, true);
  return help(only_word(arguments, ""));
}

// The methods that do not take the energy of all others.
std::string own_energies() {
  std::vector<std::string> names;
  for (const MethodEntry* method : method_entries())
    if (method->energy) names.push_back(method->name);
  return names.empty() ? "" : fmt::format(" Methods with one of their own: {}.", fmt::join(names, ", "));
}

// The definition of energy_own.
std::string own_energies_of_rows() {
  std::string text =
      "\nThe rows of some schemes have an energy of their own: energy_own of series.csv, and in `delf verify`.";
  for (const EnergyEntry* entry : energy_entries())
    if (!entry->rows.empty()) text += fmt::format("\n  {}: {}", entry->rows, entry->formula);
  return text;
}

const std::vector<Command>& table() {
  static const std::vector<Command> all{
      {"run",
       "delf run SCENE [--out DIR] [--KEY=VALUE ...]",
       "step a scene, and record it",
       "Steps a scene. Into DIR (results/NAME of the scene, if not given) go scene.ini, which runs again to the same\n"
       "bits; series.csv, one line for each recorded row; summary.json; fields.h5, the recorded rows; and figures.\n"
       "Ctrl-C ends a run early, with all so far written.\n\n"
       "  --overwrite  keep no earlier run: without it, and without --out, another run that is in\n"
       "               results/NAME becomes results/NAME~1, or the next number that is free\n\n" +
           std::string("The energy of a run is\n  E = ") + energy_formula +
           ".\nIt is measured, not conserved, and known to second order for schemes of higher order too." +
           own_energies() + own_energies_of_rows() +
           "\n\n"
           "Keys, with what holds if they are not given (a key on the command line wins over the file):",
       true,
       carry_out_run,
       {},
       false,
       false,
       true,
       "film"},
      {"resume",
       "delf resume DIR [--run.until=T] [--KEY=VALUE ...]",
       "go on with a run that was ended early",
       "Goes on with the run of the folder DIR from its last checkpoint, and leaves what the run would have given "
       "without "
       "a\n"
       "break: the rows, series.csv and summary.json are the same to the bit, but for timings. Checkpoints are written "
       "every\n"
       "output.checkpoint seconds, at the end, and on SIGINT (Ctrl-C), SIGTERM and SIGHUP. A finished run goes on if "
       "run.until\n"
       "(from time 0) or run.steps is raised. The keys are those that the run began with; besides these two, "
       "run.threads,\n"
       "output.checkpoint, output.format, output.titles, output.report and output.film may change. It takes the same version of delf, on a "
       "processor with the same instructions.",
       false,
       carry_out_resume,
       {},
       false,
       false,
       false,
       "film"},
      {"plan",
       "delf plan SCENE [--latex] [--modified[=ORDER]] [--KEY=VALUE ...]",
       "what a run would solve, how, and at what cost",
       "Prints what would be solved and how, what it costs, what would be written and what is left out. For a theory "
       "that\n"
       "is given as text these are formulas: its density, its field equations, and those of the stencil.\n\n"
       "  --latex          these formulas in LaTeX, and nothing else\n"
       "  --modified[=4]   the modified Lagrangian instead, up to order 2, 4 or 6; with --latex too\n\n"
       "Rows of a variational scheme are rows of a smooth solution of the modified Lagrangian\n"
       "l + h^2 l_20 + h k l_11 + k^2 l_02 + ..., up to what is beyond its order. It is of first order in\n"
       "t, with derivatives in x; divergences are left out (M. Vermeeren, Numer. Math. 137 (2017) 1001).\n\nThe keys are those of `delf run`:",
       true,
       carry_out_plan,
       {},
       false,
       true},
      {"verify", "delf verify SCENE [--fields FILE] [--KEY=VALUE ...]", "whether its rows are what theory promises",
       "Steps a scene, or reads the rows that another program made of it, and checks the field equations at every "
       "site, the\n"
       "discrete multisymplectic form formula (5.6) on regions of all kinds, Noether's theorem (5.7), time reversal, "
       "the\n"
       "generated derivatives and Newton's method; energy and momentum balances are measured. Prints a table; into "
       "DIR\n"
       "(results/NAME of the scene, if not given) go verify.json and figures; severity.csv of rows of a file, |E| of "
       "each\n"
       "site beside its force; and energy_own.csv, where the rows have an energy of their own (`delf help run`). Exit "
       "code\n"
       "1 if a check fails.\n\n"
       "  --fields FILE      verify these rows, every row recorded, instead of stepping: a fields.h5, a table in .csv, "
       ".txt\n"
       "                     or .dat, or an array in .npy or .npz, a line (or a column) for each row; with momenta "
       "if\n"
       "                     it has them. Where the equations fail, a diagnosis says what the rows do solve. The "
       "scene\n"
       "                     needs no [initial] and no [run]\n"
       "  --dataset NAME     the data set of an HDF5 file that holds them, frames x sites (x fields); or "
       "FILE.h5:/NAME\n"
       "  --nearby FILE.h5   given twice: two solutions of the same program from nearby data, whose differences stand "
       "for\n"
       "                     first variations; further pairs of other sizes are extrapolated to size zero\n\n"
       "The keys of its own section; all others are those of `delf help run`:",
       true, carry_out_verify, "verify", true},
      {"sweep", "delf sweep SCENE [--out DIR] --KEY=a,b,c [--KEY=from:to:step ...]",
       "a scene for many values of its keys, side by side",
       "Runs a scene for every value of the keys that are given several: a,b,c or from:to:step, which ends at `to` or "
       "before it.\n"
       "Several keys give all their pairs. Each run is a process of its own; one that fails is a row with its status.\n"
       "Into DIR (results/NAME-sweep, if not given) go sweep.csv and sweep.json, a row for each run with its numbers;\n"
       "sweep.rows, from which the same command goes on after Ctrl-C or worse; runs/, the folder of each run; and a\n"
       "figure of one number over one or two keys, or of energies and errors over time where all values are words.\n"
       "Runs draw figures of their own only if output.figures=on is given\n"
       "here. Exit code 4, 3 or 2 if a run failed: of the system, its numerics, or its input.\n\n"
       "  delf sweep collision --scheme.method=multisymplectic,vu-quoc-li --lattice.courant=0.125:0.5:0.125\n"
       "  delf sweep phi4-collision --sweep.bisect=initial.speed=0.255:0.265 --sweep.level=1.25\n\n"
       "Numbers are those of summary.json, and the measures of the scene: `delf help measures`.\n\n"
       "The keys of its own section; all others are those of `delf help run`:",
       true, carry_out_sweep, "sweep"},
      {"compare", "delf compare SCENE [--out DIR] --KEY=a,b,c [--KEY=VALUE ...]",
       "energies and errors of a few runs, side by side",
       "Runs a scene for every value of the keys that are given several, as `delf sweep` does, and prints a table of\n"
       "errors, energy errors and cost. The figure has the energy error of each run over time and, where the exact\n"
       "solution is known, the error of each recorded row. Into DIR (results/NAME-compare, if not given) go the files\n"
       "of `delf sweep`; the same command again draws and prints without running.\n\n"
       "  delf compare kink --lattice.stencil=triangle,rectangle,rectangle-symmetric\n"
       "  delf compare collision --scheme.method=multisymplectic,vu-quoc-li,guo --output.every=1\n\n"
       "The keys of its own section, which `delf sweep` shares; all others are those of `delf help run`:",
       true, carry_out_compare, "sweep"},
      {"convergence", "delf convergence SCENE [--out DIR] [--KEY=VALUE ...]",
       "errors and their order, at steps halved again and again",
       "Runs a scene at its own steps, and at half, a quarter, ... of both h and k, and prints N, k, h, the error, the "
       "order\n"
       "and the time of each, with the scene's measures. Errors are those of the last row against the exact solution, "
       "or\n"
       "without one differences from the next line. Into DIR (results/NAME of the scene, if not given) go\n"
       "convergence.json, convergence.csv and, with output.figures, figures/convergence: the errors against N, and the\n"
       "slope of the order. Exit code 1 if the last two lines miss the order of the scheme, where it is known, or have\n"
       "another than convergence.order. Where errors are not the scheme's (rounding, ends of the lattice, a formula that\n"
       "is no solution), the order is not measured, which is said, with exit code 0; unstable steps: 3. On a mesh its\n"
       "sides are halved, and the order is that of L2.\n\n"
       "The keys of its own section; all others are those of `delf help run`:",
       true, carry_out_convergence, "convergence"},
      {"workprecision", "delf workprecision SCENE [--out DIR] [--KEY=VALUE ...]",
       "error against run time, for many schemes and resolutions",
       "Runs a scene with every scheme that can, and with other programs (peers) where they have its equation, over a\n"
       "ladder of resolutions; times the steps in turn, and prints what each accuracy costs. Errors are those of the "
       "last\n"
       "row against the exact solution, or without one against a much finer run. h is until/steps, so that the end is\n"
       "met exactly. Into DIR (results/NAME of the scene, if not given) go workprecision.json, workprecision.csv, a "
       "table by\n"
       "scheme as workprecision.md and .tex, and a figure. Ctrl-C leaves what is done.\n\n"
       "The keys of its own section; all others are those of `delf help run`:",
       true, carry_out_workprecision, "workprecision"},
      {"stability", "delf stability SCENE [--out DIR] [--KEY=VALUE ...]",
       "where schemes are stable, by theory and by running",
       "Stability limits from the symbol of each scheme and from runs, compared; stiff and extreme stress cases, each "
       "run\n"
       "with a verdict. Into DIR (results/NAME of the scene, if not given) go stability.json and figures. Exit code 1 "
       "if\n"
       "runs disagree with theory, or a stress case crashes, hangs, or reports a wrong result as valid.\n"
       "On lattice.space = point: limits in wh on q_tt = -w^2 q, with the order and the cost of each method of "
       "mechanics,\n"
       "as a table, stability.json and methods.md.\n\n"
       "The keys of its own section; all others are those of `delf help run`:",
       true, carry_out_stability, "stability"},
      {"report", "delf report DIR [DIR ...] [--out FILE]", "a page of results, in one file",
       "Makes a page of HTML of a folder of results: the verdict; the theory and its equations; the scheme; numbers, with "
       "what\n"
       "they mean; figures, with what is found in them; verification, monitors; the scene and the command that runs it "
       "again;\n"
       "machine, compiler and seeds; files with their SHA-256 (by sha256sum). Several folders are shown side by side.\n"
       "Nothing is computed again: it is made of the files that are there, of a run that failed or was killed, too, and "
       "says\n"
       "what is missing. The page is DIR/report.html, or FILE; of several folders it is report.html in the current one. It\n"
       "has no script, loads nothing, and takes a million bytes at most. output.report = on makes it with the results of a\n"
       "command.",
       false, carry_out_report},
      {"cite", "delf cite DIR|SCENE [--out DIR] [--KEY=VALUE ...]",
       "the methods section of a paper, with its references",
       "Prints a methods section for a paper: the theory with its field equation and density, the discretisation with its "
       "order\n"
       "and what it conserves, the discrete equations, lattice and step with the limit of linear theory, the start, the "
       "solution\n"
       "of a step; of a folder of results the numbers of its run, and of its checks, orders, limits or study; version and "
       "machine.\n"
       "Every source that these rest on is cited, and is an entry of references.bib with the record that it was checked "
       "against.\n\n"
       "  --out DIR   writes methods.tex, methods.md and references.bib there instead\n\nThe keys of its own section; for a "
       "scene all others are those of `delf help run`:",
       true, carry_out_cite, "cite"},
      {"film", "delf film DIR [--film.seconds=S]", "a film of recorded rows, beside their energy",
       "Makes a film of the recorded rows of the folder DIR, beside the energy error: curves over a line, maps of a mesh, the\n"
       "orbit of two or three coordinates, else coordinates over time. Axes are the same in all frames. It is DIR/film.mp4,\n"
       "made by ffmpeg, or DIR/film.gif of gnuplot where ffmpeg is missing, and figures/film.png, a frame that a page of\n"
       "results shows with a link to it. The run may go on still, or have been killed. output.film = on makes it at the end of\n"
       "a run.\n\n"
       "The keys of its own section:",
       false, carry_out_film, "film"},
      {"xdmf", "delf xdmf DIR", "what ParaView opens recorded rows by",
       "Writes fields.xdmf, a series of rows, and on a lattice surface.xdmf, over x and t, beside the fields.h5 of the folder\n"
       "DIR, as output.xdmf = on does at the end of a run. They and frames.h5 point into fields.h5 and copy nothing. The run may\n"
       "have been killed: its fields.h5 is then marked closed, after its last whole rows, so that any program opens it. While\n"
       "the run goes on, nothing is written.",
       false, carry_out_xdmf},
      {"reproduce", "delf reproduce [ID ...] [--out DIR] [--KEY=VALUE ...]", "published results, computed again",
       "Computes numbers and equations that papers print, each by a command of its own, and says which come out: reproduced;\n"
       "misprint, where the correction holds; differs, with the reason; or failed. ID is one of `delf list results`, or the\n"
       "name of a paper there, for all of its results; without one all results that take little time are computed. Into DIR\n"
       "(results/reproduce, if not given) go results.json, results.csv, report.html, and runs/ID, the results of each\n"
       "command. Keys of a scene go to every command: `delf reproduce phi4-critical-speed --lattice.sites=3200`. Exit code 1\n"
       "if one failed; Ctrl-C keeps those that have ended.\n\n"
       "The keys of its own section:",
       false, carry_out_reproduce, "reproduce"},
      {"list", "delf list [theories|stencils|schemes|states|scenes|results]", "what there is",
       "Lists what a scene can name, with formulas; everything if no kind is given.", false, carry_out_list},
      {"help", "delf help [COMMAND]", "this, or the details of a command", "Explains a command.", false,
       carry_out_help}};
  return all;
}

}  // namespace

std::span<const Command> commands() { return table(); }

std::vector<std::string> keys_of_other_commands(const std::string& command, const std::vector<Setting>& keys) {
  std::vector<std::string> warnings;
  for (const Setting& s : keys) {
    const std::string_view section = section_of(s.key);
    if (section == find_command(command).section || section == find_command(command).also) continue;
    std::vector<std::string> readers;
    for (const Command& other : commands())
      if (section == other.section) readers.push_back(fmt::format("`delf {}`", other.name));
    if (!readers.empty())
      warnings.push_back(fmt::format("{} = {}: warning: only {} reads it", s.key, s.value, fmt::join(readers, " or ")));
  }
  return warnings;
}

const Command& find_command(const std::string& name) {
  std::vector<std::string> names;
  for (const Command& c : table()) {
    if (c.name == name) return c;
    names.push_back(c.name);
  }
  for (const ShippedScene& scene : shipped_scenes())
    if (name == scene.name)
      throw BadScene(
          fmt::format("command line: {}: is a scene, not a command; did you mean `delf run {}`?", name, name));
  throw BadScene(fmt::format("command line: {}: no such command{}", name, suggestion(name, names)));
}

}  // namespace delf

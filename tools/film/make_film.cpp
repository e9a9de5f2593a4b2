// SPDX-License-Identifier: MIT
#include "tools/film/make_film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "tools/complex/mesh_summary.hpp"
#include "tools/figures/figure_style.hpp"
#include "tools/figures/gnuplot.hpp"
#include "tools/files/awaited_program.hpp"
#include "tools/files/text_file.hpp"
#include "tools/film/film_view.hpp"
#include "tools/outcome/outcome.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/progress.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

constexpr auto png = "set terminal pngcairo size 1280,720 font 'DejaVu Sans,14' fontscale 1.1 linewidth 1.3\n";
constexpr std::size_t most_of_gif = 120;  // frames: all of them are in memory, and on the disk, together

/// The energy error beside the view: all of it pale, and dark up to the time of the frame.
class EnergyPanel {
 public:
  EnergyPanel(const FilmRows& rows, const fs::path& scratch)
      : begin_(rows.time(0)), end_(rows.time(rows.frames() - 1)) {
    const auto *times = rows.series().column("time"), *errors = rows.series().column("energy_error");
    if (!times || !errors) return;
    double largest = 0, first = 0;
    for (std::size_t n = 0; n < errors->size(); ++n) {
      if (!std::isfinite(errors->at(n))) continue;
      is_there_ = true;
      largest = std::max(largest, std::abs(errors->at(n)));
      if (10 * n < errors->size()) first = std::max(first, std::abs(errors->at(n)));
    }
    // as the figure of the energy has it
    grown_ = largest > 10 || (first > 0 && largest > 1e4 * std::max(first, 1e-16));
    power_ = largest > 0 ? std::floor(std::log10(largest)) : -16;
    std::string table;
    constexpr std::size_t most_rows = 2000;
    const std::size_t apart = errors->size() / most_rows + 1;
    for (std::size_t n = 0; n < errors->size(); n += apart) {
      const double error = errors->at(n);
      table += fmt::format("{} {}\n", times->at(n),
                           grown_ ? std::max(std::abs(error), 1e-17) : error / std::pow(10, power_));
    }
    write_text_file(scratch / "energy", table);
  }
  bool is_there() const { return is_there_; }
  std::string draw(double time) const {
    const std::string label = grown_ ? "|E − E_0| / |E_0|" : fmt::format("(E − E_0) / |E_0|   in 10^{{{}}}", power_);
    return fmt::format(
        "set lmargin at screen 0.77\nset rmargin at screen 0.965\nset xrange [{0}:{1}]\nset xlabel 'time t'\nset ylabel '{2}'\n"
        "set grid lc rgb '#e4e4e4' lt 1 lw 0.7\n{3}{4}"
        "plot 'energy' using 1:2 with lines lw 1.2 lc rgb '#c4c4c4', 'energy' using 1:($1<={5}?$2:NaN) with lines lw 1.8 lc rgb "
        "'{6}'\n",
        begin_, end_, label,
        grown_ ? "set logscale y\nset format y '10^{%T}'\n" : "set xzeroaxis lc rgb '#999999' lt 1\n",
        panel_tics(begin_, end_, 0.19), time, line_colour);
  }

 private:
  double begin_, end_, power_ = 0;
  bool is_there_ = false, grown_ = false;
};

std::string subject_in_words(const FilmRows& rows) {
  const auto* mesh = std::get_if<ComplexScene>(&rows.scene());
  const Problem& problem = rows.common().problem;
  return problem.theory + ", " + (mesh ? scheme_in_words(*mesh) : scheme_in_words(problem));
}

/// The gnuplot commands of a frame.
std::string frame_of(const FilmRows& rows, const FilmView& view, const Panel& panel, const EnergyPanel& energy,
                     std::size_t n, const fs::path& scratch) {
  const std::string begin =
      "reset\n" + gnuplot_style() +
      fmt::format("set bmargin at screen {}\nset tmargin at screen {}\n", panel.bottom, panel.top);
  return "set multiplot\n" + begin +
         fmt::format(
             "set label 91 {} at screen 0.03,0.95 left font ',18' noenhanced\n"
             "set label 92 {} at screen 0.03,0.895 left font ',11' textcolor rgb '#555555' noenhanced\n"
             "set label 93 't = {:.6g}' at screen 0.98,0.95 right font ',18'\n"
             "set lmargin at screen {}\nset rmargin at screen {}\n",
             gnuplot_quoted(fmt::format("{}: {}", rows.name(), view.about)), gnuplot_quoted(subject_in_words(rows)),
             rows.time(n), panel.left, panel.right) +
         view.draw(n, scratch) + (energy.is_there() ? begin + energy.draw(rows.time(n)) : "") + "unset multiplot\n";
}

std::string run_gnuplot_for_film(const fs::path& scratch, const std::string& script) {
  constexpr auto limit = std::chrono::minutes(5);
  write_text_file(scratch / "script", script);
  return run_program({{"gnuplot", "-d", "script"}, "could not draw", gnuplot_is_missing, limit, true}, scratch);
}

/// Throws SystemFailure where a program failed; true if it was interrupted.
bool is_interrupted(const std::string& complaint) {
  if (Interrupt::asked()) return true;
  if (!complaint.empty()) throw SystemFailure("no film: " + complaint);
  return false;
}

std::string picture(std::size_t n) { return fmt::format("f{:05}.png", n); }

void require_file(const fs::path& file) {
  std::error_code none;
  if (!fs::exists(file, none) || fs::file_size(file, none) == 0)
    throw SystemFailure(
        fmt::format("no film: gnuplot ended well, and left no {}: the disk may be full", file.filename().string()));
}

}  // namespace

ExitCode make_film(const fs::path& folder, const std::vector<Setting>& keys) {
  const Interrupt interrupt;
  const FilmRows rows(folder, keys);
  const ScratchFolder scratch(folder);
  const fs::path& here = scratch.path();
  const EnergyPanel energy(rows, here);
  const Panel panel{0.09, energy.is_there() ? 0.65 : 0.96, 0.13, 0.81};
  const FilmView view = film_view(rows, panel, here);
  const bool as_mp4 = is_installed("ffmpeg");

  // The frames of a GIF are thinned.
  std::vector<std::size_t> shown;
  const std::size_t apart = as_mp4 ? 1 : (rows.frames() + most_of_gif - 1) / most_of_gif;
  for (std::size_t n = 0; n < rows.frames(); n += apart) shown.push_back(n);
  const double rate = static_cast<double>(shown.size()) / rows.seconds();
  const std::string name = as_mp4 ? "film.mp4" : "film.gif", poster = picture(shown.size() / 2);

  Progress progress(static_cast<std::int64_t>(shown.size()), "frame");
  const auto draw = [&](std::size_t begin, std::size_t end) {
    std::string script = png;
    for (std::size_t n = begin; n < end; ++n)
      script += fmt::format("set output '{}'\n", picture(n)) + frame_of(rows, view, panel, energy, shown[n], here);
    const std::string complaint = run_gnuplot_for_film(here, script + "unset output\n");
    if (is_interrupted(complaint)) return false;
    for (std::size_t n = begin; n < end; ++n) require_file(here / picture(n));
    for (const char* data : {"rows", "exact", "map"})
      for (std::size_t n = begin; n < end; ++n) fs::remove(here / fmt::format("{}{}", data, shown[n]));
    progress.at(static_cast<std::int64_t>(end));
    return true;
  };
  bool whole = true;
  if (as_mp4) {
    constexpr std::size_t at_once = 25;
    for (std::size_t begin = 0; whole && begin < shown.size(); begin += at_once)
      whole = draw(begin, std::min(begin + at_once, shown.size()));
    if (whole)
      whole = !is_interrupted(
          run_program({{"ffmpeg", "-loglevel", "error", "-y", "-framerate", fmt::format("{:.0f}/1000", 1000 * rate),
                        "-i", "f%05d.png", "-r", fmt::format("{:.0f}/1000", 1000 * std::max(rate, 10.0)), "-c:v",
                        "libx264", "-pix_fmt", "yuv420p", "-crf", "20", "-movflags", "+faststart", name},
                       "could not make the film",
                       "ffmpeg is missing: install the package ffmpeg",
                       std::chrono::minutes(10),
                       true},
                      here));
  } else {
    std::string script = fmt::format(
        "set terminal gif animate delay {:.0f} loop 0 size 960,540 font 'DejaVu Sans,10' fontscale 1.1\nset output 'film.gif'\n",
        std::max(2.0, 100 / rate));
    for (const std::size_t n : shown) script += frame_of(rows, view, panel, energy, n, here);
    whole = !is_interrupted(run_gnuplot_for_film(here, script + "unset output\n"));
    if (whole) whole = draw(shown.size() / 2, shown.size() / 2 + 1);
  }
  if (!whole) {
    std::fputs(fmt::format("delf: interrupted: there is no new film in {}\n", folder.string()).c_str(), stderr);
    return ExitCode::interrupted;
  }
  require_file(here / name);
  fs::create_directories(folder / "figures");
  fs::rename(here / name, folder / name);
  fs::rename(here / poster, folder / "figures/film.png");
  std::error_code none;
  fs::remove(folder / (as_mp4 ? "film.gif" : "film.mp4"), none);  // of an earlier film
  fmt::print("{}: {} frames in {:.3g} s, {} bytes{}\n", (folder / name).string(), shown.size(), rows.seconds(),
             fs::file_size(folder / name),
             as_mp4 ? "" : "; ffmpeg, which is missing, would make an MP4 of more frames");
  return ExitCode::done;
}

}  // namespace delf

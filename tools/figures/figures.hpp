// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "lattice/lattice.hpp"
#include "schemes/state.hpp"
#include "tools/figures/figure_form.hpp"
#include "tools/figures/thinned_rows.hpp"
#include "tools/figures/trace.hpp"
#include "tools/files/row_names.hpp"

namespace delf {

/// A Poincaré section: its table with a heading, what it is, and the columns that show it, from 1; 0: none do.
struct DrawnSection {
  std::string table = {}, title = {};
  std::array<int, 2> columns{0, 0};
};

/// Rows at all their sites, whose waves are drawn, and the waves that there may be: (k, ω), of the lattice and of the field
/// equations, linearised about a constant field.
struct DrawnSpectrum {
  std::vector<double> first_row, last_row;
  double last_time = 0;
  std::vector<std::array<double, 2>> lattice = {}, continuum = {};
  std::string about = {};  ///< "φ = 0", where the waves are known
};

/// The data that the figures of a run are drawn from.
struct FigureSource {
  std::string scene, theory;
  std::string scheme;  ///< one line: stencil, method, sites, steps
  bool angle;          ///< the field is an angle, and is shown as φ/2π
  const Lattice& lattice;
  int winding;
  const ThinnedRows& thinned;
  const Trace& energy_errors;
  std::vector<double> times;  ///< of the waveforms; empty: evenly spread
  RowNames names = {};
  std::string energy = {};  ///< one line: what the energy is
  DrawnSection section = {};
  FigureForm form = {};
  const State* exact = nullptr;             ///< that waveforms are compared with, as long as it says that it can be
  std::string energy_rows = {};             ///< over which rows the energy is the least and the largest
  double gain = 0;                          ///< what the fields gain around a circle beside 2π·winding
  const ThinnedRows* momenta = nullptr;     ///< on a point, p of each frame
  const DrawnSpectrum* spectrum = nullptr;  ///< figures.spectrum
};

/// The theory and the scheme, and whether frames are too far apart for what moves in it.
std::string subtitle(const FigureSource&);

/// Draws the space–time map and the waveforms, or on a point the trajectory and the orbit, and the energy error into
/// `folder`/figures, in all formats. Returns what is missing, in one line, or an empty string.
std::string draw_figures(const FigureSource&, const std::filesystem::path& folder);

/// The positions that are drawn: those of the thinned rows, and on a circle the first site once more, at x = L; where the mesh
/// is a field, some 400 evenly spaced ones.
std::vector<double> drawn_space(const FigureSource&);
/// A component of a frame at those positions, in units of 2π if it is an angle. On a mesh that is a field itself the
/// values are those of the piecewise linear function.
std::vector<double> drawn_frame(const FigureSource&, int frame, std::size_t component = 0);
/// A component at every site of the thinned rows, and on a circle at the first one once more.
std::vector<double> drawn_sites(const FigureSource&, int frame, std::size_t component);
/// The symbol of the component.
std::string drawn_name(const FigureSource&, std::size_t component);

/// The number of frames, from the first one, that have not blown up: a scale made for the others would hide these.
int tame_frames(const FigureSource&);

/// The names of the figures of a run on a lattice or on a mesh, without ending.
std::vector<std::string> figure_names();

}  // namespace delf

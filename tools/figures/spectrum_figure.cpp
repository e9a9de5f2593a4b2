// SPDX-License-Identifier: MIT
#include "tools/figures/spectrum_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "lattice/index.hpp"
#include "tools/figures/figure_style.hpp"
#include "tools/figures/gnuplot.hpp"
#include "tools/files/text_file.hpp"

namespace delf {

namespace {

using Amplitude = std::complex<double>;
constexpr double full_turn = 2 * std::numbers::pi;

std::size_t least_factor(std::size_t n) {
  for (std::size_t p = 2; p * p <= n; ++p)
    if (n % p == 0) return p;
  return n;
}

/// out_n = Σ_i in[i·stride] e^{−2πi n i/N}, by the parts of every p-th value, p the least prime factor of N:
/// out_{n + mM} = Σ_r e^{−2πi r(n + mM)/N} part_r,n, M = N/p                               Cooley and Tukey (1965)
void transform(const double* in, std::size_t stride, std::span<Amplitude> out) {
  const std::size_t N = out.size();
  if (N == 1) {
    out[0] = in[0];
    return;
  }
  const std::size_t p = least_factor(N), M = N / p;
  std::vector<Amplitude> parts(N);
  for (std::size_t r = 0; r < p; ++r) transform(in + r * stride, stride * p, std::span(parts).subspan(r * M, M));
  for (std::size_t n = 0; n < N; ++n) {
    out[n] = 0;
    for (std::size_t r = 0; r < p; ++r)
      out[n] +=
          std::polar(1.0, -full_turn * static_cast<double>(r * n % N) / static_cast<double>(N)) * parts[r * M + n % M];
  }
}

}  // namespace

std::vector<double> mode_sizes(const std::vector<double>& row) {
  constexpr double most_terms = 2e8;
  const std::size_t N = row.size();
  std::size_t largest = 1;
  for (std::size_t n = N; n > 1; n /= least_factor(n)) largest = std::max(largest, least_factor(n));
  if (N == 0 || static_cast<double>(N) * static_cast<double>(largest) > most_terms) return {};
  std::vector<Amplitude> all(N);
  transform(row.data(), 1, all);
  std::vector<double> sizes;
  for (std::size_t n = 0; n <= N / 2; ++n) sizes.push_back(std::abs(all[n]) / static_cast<double>(N));
  return sizes;
}

std::string spectrum_figure(const FigureSource& source, const std::filesystem::path& scratch) {
  if (!source.spectrum || !source.lattice.is_circle() || source.names.drawn_mesh()) return {};
  const DrawnSpectrum& spectrum = *source.spectrum;
  const std::size_t N = at(source.lattice.sites()), d = source.thinned.components();
  const double L = source.lattice.length();
  const auto sizes_of = [&](const std::vector<double>& row, std::size_t c) {
    std::vector<double> values;
    // less the part that does not close: φ(x + L) = φ(x) + 2π·winding + gain
    for (std::size_t i = 0; i < N && i * d + c < row.size(); ++i)
      values.push_back(row[i * d + c] -
                       (source.winding * full_turn + source.gain) * static_cast<double>(i) / static_cast<double>(N));
    return mode_sizes(values);
  };
  std::string table;
  double most = 0, least = 1;
  for (const auto* row : {&spectrum.first_row, &spectrum.last_row})
    for (std::size_t c = 0; c < d; ++c) {
      const std::vector<double> sizes = sizes_of(*row, c);
      if (sizes.empty()) return {};
      // the mean is no wave
      for (std::size_t n = 1; n < sizes.size(); ++n) {
        if (std::isfinite(sizes[n])) most = std::max(most, sizes[n]);
        if (sizes[n] > 0) least = std::min(least, sizes[n]);
        table += fmt::format("{} {}\n", full_turn * static_cast<double>(n) / L, sizes[n]);
      }
      table += "\n\n";
    }
  if (!(most > 0)) return {};
  write_text_file(scratch / "spectrum", table);
  std::string waves;
  for (const auto* branch : {&spectrum.lattice, &spectrum.continuum}) {
    for (const auto& [k, omega] : *branch) waves += fmt::format("{} {}\n", k, omega);
    waves += "\n\n";
  }
  write_text_file(scratch / "waves", waves);
  const bool has_waves = !spectrum.lattice.empty();
  const double last_wave = full_turn * static_cast<double>(N / 2) / L, floor = std::max(1e-17 * most, 0.3 * least);
  std::string body =
      figure_title(fmt::format("{}: the waves of the field, |{}(k)| over the wave number k", source.scene,
                               d == 1 ? drawn_name(source, 0) : "φ"),
                   fmt::format("{}; grey: t = 0, in colour: t = {:.4g}", subtitle(source), spectrum.last_time)) +
      fmt::format(
          "set multiplot\nset lmargin at screen 0.105\nset rmargin at screen 0.97\nset grid lc rgb '#e4e4e4' lt 1 lw 0.7\n"
          "set xrange [0:{}]\nset tmargin at screen (top-0.02)\nset bmargin at screen {}\n"
          "set logscale y\nset format y '10^{{%T}}'\nset ylabel 'size of a wave'\nset yrange [{}:*]\n{}{}",
          last_wave, has_waves ? "0.47" : "0.12", floor, panel_tics(0, last_wave, 0.865),
          has_waves ? "set format x ''\n" : "set xlabel 'wave number k'\n") +
      key_of_curves(
          d, [&](std::size_t c) { return drawn_name(source, c); }, std::vector<std::vector<double>>(d));
  for (std::size_t c = 0; c < d; ++c)
    body += fmt::format("{} 'spectrum' index {} using 1:($2>{}?$2:{}) with lines lw 2.5 lc rgb '#bbbbbb'",
                        c == 0 ? "plot" : ",", c, floor, floor);
  for (std::size_t c = 0; c < d; ++c)
    body += fmt::format(", 'spectrum' index {} using 1:($2>{}?$2:{}) with lines lw 1.3 lc rgb '{}'", d + c, floor,
                        floor, component_colour(c));
  body += "\nunset label\n";
  if (has_waves)
    body += fmt::format(
                "unset logscale\nset format '%h'\nset tmargin at screen 0.4\nset bmargin at screen 0.12\n"
                "set xlabel 'wave number k'\nset ylabel 'frequency'\nset yrange [0:*]\n"
                "set label 106 {} at graph 0.01,0.9 left font ',10' textcolor rgb '#666666' noenhanced\nplot ",
                gnuplot_quoted(fmt::format("waves about {}; blue: of the lattice{}", spectrum.about,
                                           spectrum.continuum.empty() ? "" : ", grey: of the field equation"))) +
            (spectrum.continuum.empty() ? "" : "'waves' index 1 using 1:2 with points pt 7 ps 0.3 lc rgb '#999999', ") +
            fmt::format("'waves' index 0 using 1:2 with points pt 7 ps 0.3 lc rgb '{}'\n", line_colour);
  return body + "unset multiplot\n";
}

}  // namespace delf

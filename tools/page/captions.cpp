// SPDX-License-Identifier: MIT
#include "tools/page/captions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <sstream>

#include "lattice/index.hpp"
#include "tools/figures/spectrum_figure.hpp"
#include "tools/files/fields_reader.hpp"
#include "tools/page/markup.hpp"
#include "tools/report/field_symbol.hpp"

namespace delf {
namespace {

/// At most `most` of the numbers 0 … count − 1, evenly spread, with both ends.
std::vector<std::size_t> spread(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen;
  const std::size_t taken = std::min(count, most);
  for (std::size_t n = 0; n < taken; ++n) chosen.push_back(taken == 1 ? 0 : n * (count - 1) / (taken - 1));
  return chosen;
}

/// The rows of fields.h5; null where they cannot be read.
std::unique_ptr<FieldsReader> rows_of(const ResultFolder& folder) try {
  auto rows = std::make_unique<FieldsReader>(folder.path / "fields.h5");
  return rows->frames() > 0 && rows->sites() > 0 ? std::move(rows) : nullptr;
} catch (const std::exception&) {
  return nullptr;
}

std::vector<double> component_of(const FieldsReader& rows, std::size_t frame, std::size_t component) {
  const std::vector<double> row = rows.row(static_cast<int>(frame));
  std::vector<double> values;
  for (std::size_t i = component; i < row.size(); i += at(rows.components())) values.push_back(row[i]);
  return values;
}

std::string time_of(const FieldsReader& rows, std::size_t frame) {
  return number_text(rows.time(static_cast<int>(frame)).value_or(static_cast<double>(frame)));
}

/// The name of a component, as figures write it: φ, or q on a point, unless the theory has names of its own.
std::string name_of(const FieldsReader& rows, std::size_t component) {
  const std::vector<std::string> names = rows.names();
  const std::string name = component < names.size() ? names[component] : "phi";
  if (rows.sites() == 1 && name.starts_with("phi"))
    return rows.components() == 1 ? "q" : fmt::format("q{}", component + 1);
  return field_symbol(name);
}

/// The places where a row changes fastest: where |Δφ| is greatest among its neighbours, and half of the largest or more.
std::string fronts(const std::vector<double>& row, const std::vector<double>& x) {
  std::vector<double> slope;
  for (std::size_t i = 0; i + 1 < row.size(); ++i) slope.push_back(std::abs(row[i + 1] - row[i]));
  const double largest = slope.empty() ? 0 : *std::ranges::max_element(slope);
  std::vector<std::string> places;
  for (std::size_t i = 0; i < slope.size(); ++i)
    if (largest > 0 && slope[i] >= 0.5 * largest && (i == 0 || slope[i] > slope[i - 1]) &&
        (i + 1 == slope.size() || slope[i] >= slope[i + 1]))
      places.push_back(fmt::format("{:.3g}", 0.5 * (x[i] + x[i + 1])));
  if (places.empty()) return "nowhere";
  if (places.size() > 4) return fmt::format("at {} places", places.size());
  return "near x = " + fmt::format("{}", fmt::join(places, " and "));
}

/// "φ is between 0 and 6.28" in these frames.
std::string range_of(const FieldsReader& rows, std::size_t component, const std::vector<std::size_t>& frames) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const std::size_t frame : frames)
    for (const double value : component_of(rows, frame, component))
      least = std::min(least, value), most = std::max(most, value);
  return fmt::format("{} is between {:.4g} and {:.4g}", name_of(rows, component), least, most);
}

/// The ranges of the first components over the run, in sentences.
std::string ranges_of(const FieldsReader& rows) {
  constexpr std::size_t most_values = 4000000;  // read in a moment
  const auto values_of_row = at(rows.sites()) * at(rows.components());
  const auto frames = spread(at(rows.frames()), std::clamp<std::size_t>(most_values / values_of_row, 2, 400));
  std::string sentences;
  for (std::size_t c = 0; c < std::min<std::size_t>(4, at(rows.components())); ++c)
    sentences += range_of(rows, c, frames) + ". ";
  return sentences;
}

/// Some rows, at some sites, of the first component; sites without one position each have their numbers.
std::string rows_table(const FieldsReader& rows, const std::optional<std::vector<double>>& x) {
  PageTable t{fmt::format("{} at some {}sites", name_of(rows, 0), rows.frames() > 1 ? "times and " : ""), {"t"}, {}};
  const std::vector<std::size_t> sites = spread(at(rows.sites()), 13);
  for (const std::size_t i : sites)
    t.headings.push_back(x ? fmt::format("x = {:.4g}", x->at(i)) : fmt::format("site {}", i));
  for (const std::size_t frame : spread(at(rows.frames()), 11)) {
    const std::vector<double> row = component_of(rows, frame, 0);
    t.rows.push_back({time_of(rows, frame)});
    for (const std::size_t i : sites) t.rows.back().push_back(fmt::format("{:.5g}", row.at(i)));
  }
  return table(t);
}

/// The positions of the sites in a frame: of sites that move their component X, if they are a field, else nothing.
std::optional<std::vector<double>> places_of(const ResultFolder& folder, const FieldsReader& rows, std::size_t frame) {
  const std::vector<std::string> names = rows.names();
  if (const auto X = std::ranges::find(names, "X"); X != names.end())
    return component_of(rows, frame, at(X - names.begin()));
  const Json* summary = folder.result("summary");
  return summary && summary->contains("mesh_min_spacing") ? std::nullopt : rows.positions();
}

FigureCaption of_rows(const ResultFolder& folder, const std::string& title) {
  FigureCaption caption{title, {}, {}};
  const auto rows = rows_of(folder);
  if (!rows) return caption;
  const std::size_t last = at(rows->frames()) - 1;
  caption.finding = ranges_of(*rows);
  const auto first_places = places_of(folder, *rows, 0), last_places = places_of(folder, *rows, last);
  caption.table = rows_table(*rows, first_places);
  if (!first_places || !last_places || rows->sites() < 2) return caption;
  if (last == 0) {  // of a problem without time
    caption.finding +=
        fmt::format("{} changes fastest {}.", name_of(*rows, 0), fronts(component_of(*rows, 0, 0), *first_places));
    return caption;
  }
  caption.finding += fmt::format("{} changes fastest {} at t = {}", name_of(*rows, 0),
                                 fronts(component_of(*rows, 0, 0), *first_places), time_of(*rows, 0));
  caption.finding +=
      fmt::format(", and {} at t = {}.", fronts(component_of(*rows, last, 0), *last_places), time_of(*rows, last));
  return caption;
}

FigureCaption of_waveforms(const ResultFolder& folder) {
  FigureCaption caption = of_rows(folder, "The field over space, at some times");
  const auto rows = rows_of(folder);
  if (!rows) return caption;
  const std::size_t last = at(rows->frames()) - 1;
  if (last == 0) caption.title = "The field over space";
  else
    caption.finding = fmt::format("At t = {} {}, at t = {} {}.", time_of(*rows, 0), range_of(*rows, 0, {0}),
                                  time_of(*rows, last), range_of(*rows, 0, {last}));
  if (const auto error = number_in(folder.result("summary"), "error_linf"))
    caption.finding += fmt::format(" The last row is within {:.2g} of the exact solution.", *error);
  return caption;
}

FigureCaption of_point(const ResultFolder& folder, const std::string& title) {
  FigureCaption caption{title, {}, {}};
  const auto rows = rows_of(folder);
  if (!rows) return caption;
  const std::size_t d = std::min<std::size_t>(8, at(rows->components()));
  PageTable t{"Coordinates at some times", {"t"}, {}};
  caption.finding = ranges_of(*rows);
  for (std::size_t c = 0; c < d; ++c) t.headings.push_back(name_of(*rows, c));
  for (const std::size_t frame : spread(at(rows->frames()), 21)) {
    t.rows.push_back({time_of(*rows, frame)});
    for (std::size_t c = 0; c < d; ++c)
      t.rows.back().push_back(fmt::format("{:.6g}", component_of(*rows, frame, c).at(0)));
  }
  caption.table = table(t);
  return caption;
}

FigureCaption of_phase(const ResultFolder& folder) {
  FigureCaption caption = of_point(folder, "Phase portrait: the momentum over its coordinate");
  if (const auto error = number_in(folder.result("summary"), "energy_error_max"))
    caption.finding +=
        fmt::format("The energy, whose levels the motion stays on, is kept to {:.2g} of itself.", *error);
  return caption;
}

FigureCaption of_error(const ResultFolder& folder) {
  FigureCaption caption{"The error against the exact solution, over space and time", {}, {}};
  const Json* summary = folder.result("summary");
  const auto largest = number_in(summary, "error_linf"), mean = number_in(summary, "error_l2");
  if (largest && mean)
    caption.finding = fmt::format("At t = {} the error is {:.2g} where it is largest, and {:.2g} in L2.",
                                  value_text(summary, "time"), *largest, *mean);
  else caption.finding = "The solution can be compared with for a part of the run only.";
  caption.table = table_of("Errors of the last row",
                           {{"time", "time"}, {"largest error", "error_linf"}, {"error in L2", "error_l2"}},
                           summary ? std::vector<Json>{*summary} : std::vector<Json>());
  return caption;
}

/// The largest wave of a row, and how much of all is in waves shorter than four cells.
FigureCaption of_spectrum(const ResultFolder& folder) {
  FigureCaption caption{
      "The waves of the field: their size over the wave number, and the frequencies on the lattice", {}, {}};
  const auto rows = rows_of(folder);
  const auto x = rows ? rows->positions() : std::nullopt;
  if (!x || x->size() < 4) return caption;
  const std::size_t N = x->size(), last = at(rows->frames()) - 1;
  const double pi = std::acos(-1.0), L = (x->at(1) - x->at(0)) * static_cast<double>(N);
  PageTable t{fmt::format("The largest waves of {}", name_of(*rows, 0)), {"t", "wave number", "size"}, {}};
  for (const std::size_t frame : {std::size_t{0}, last}) {
    std::vector<double> row = component_of(*rows, frame, 0);
    for (std::size_t i = 0; i < row.size(); ++i)
      row[i] -= 2 * pi * rows->winding().value_or(0) * static_cast<double>(i) / static_cast<double>(N);
    std::vector<double> sizes = mode_sizes(row);
    if (sizes.size() < 2) return caption;
    sizes[0] = 0;
    const auto largest = std::ranges::max_element(sizes);
    double all = 0, shortest = 0;
    for (std::size_t n = 1; n < sizes.size(); ++n) (4 * n > N ? shortest : all) += sizes[n] * sizes[n];
    all += shortest;
    caption.finding += fmt::format(
        "At t = {} the largest wave has k = {:.3g}; waves shorter than four cells hold {:.2g} of all. ",
        time_of(*rows, frame), 2 * pi * static_cast<double>(largest - sizes.begin()) / L, all > 0 ? shortest / all : 0);
    std::vector<std::size_t> order(sizes.size());
    for (std::size_t n = 0; n < order.size(); ++n) order[n] = n;
    std::ranges::sort(order, std::greater(), [&](std::size_t n) { return sizes[n]; });
    for (std::size_t n = 0; n < std::min<std::size_t>(8, order.size()); ++n)
      t.rows.push_back({time_of(*rows, frame), fmt::format("{:.4g}", 2 * pi * static_cast<double>(order[n]) / L),
                        fmt::format("{:.4g}", sizes[order[n]])});
  }
  caption.table = table(t);
  return caption;
}

FigureCaption of_film(const ResultFolder& folder) {
  const auto rows = rows_of(folder);
  FigureCaption caption = rows && rows->sites() == 1 ? of_point(folder, "") : of_rows(folder, "");
  caption.title = "A frame of the film, the energy error beside it";
  if (rows)
    caption.finding = fmt::format("The film goes from t = {} to t = {}. ", time_of(*rows, 0),
                                  time_of(*rows, at(rows->frames()) - 1)) +
                      caption.finding;
  return caption;
}

double largest_of(const std::vector<double>& values, std::size_t begin, std::size_t end, std::size_t* where = nullptr) {
  double largest = 0;
  for (std::size_t n = begin; n < end; ++n)
    if (std::abs(values[n]) > largest) {
      largest = std::abs(values[n]);
      if (where) *where = n;
    }
  return largest;
}

FigureCaption of_energy(const ResultFolder& folder) {
  FigureCaption caption{"The relative change of the energy over time", {}, csv_table(folder, "series.csv", 41)};
  const auto *error = folder.series.column("energy_error"), *time = folder.series.column("time");
  if (!error || !time) return caption;
  const std::size_t n = error->size(), part = std::max<std::size_t>(1, n / 10);
  std::size_t where = 0;
  const double all = largest_of(*error, 0, n, &where), first = largest_of(*error, 0, part),
               last = largest_of(*error, n - part, n);
  caption.finding =
      fmt::format("In the recorded rows the energy is kept to {:.2g} of itself; it is farthest off at t = {:.4g}.", all,
                  (*time)[where]);
  if (n >= 20)
    caption.finding +=
        fmt::format(" In the first tenth of the run it is off by {:.2g}, in the last by {:.2g}.", first, last);
  return caption;
}

/// The checks of a verification whose names begin so.
FigureCaption of_checks(const ResultFolder& folder, const std::string& title, const std::string& begin) {
  FigureCaption caption{title, {}, {}};
  std::vector<Json> shown;
  double largest = -1;
  for (const char* key : {"checks", "measured"})
    for (const Json& check : list_in(folder.result("verify"), key)) {
      if (!text_in(&check, "name").starts_with(begin)) continue;
      shown.push_back(check);
      const auto value = number_in(&check, "value"), tolerance = number_in(&check, "tolerance");
      if (!value || !tolerance || *value <= largest) continue;
      largest = *value;
      caption.finding =
          fmt::format("The largest is {:.2g}, {}, where {:.2g} is tolerated: the check {}.", *value,
                      text_in(&check, "region"), *tolerance, is_true_in(&check, "passed") ? "passes" : "fails");
    }
  caption.table = table_of(
      title, {{"check", "name"}, {"largest", "value"}, {"tolerance", "tolerance"}, {"where", "region"}}, shown);
  return caption;
}

FigureCaption of_convergence(const ResultFolder& folder) {
  const std::vector<Json> levels = list_in(folder.result("convergence"), "levels");
  FigureCaption caption{"Errors at halved steps", {}, {}};
  caption.table = table_of("Errors of the last row",
                           {{"N", "sites"},
                            {"k", "space_step"},
                            {"h", "time_step"},
                            {"largest error", "error_linf"},
                            {"error in L2", "error_l2"},
                            {"order", "order"}},
                           levels);
  if (levels.size() > 1)
    caption.finding = fmt::format("The largest error goes from {} to {} while the steps are halved {} times.",
                                  value_text(&levels.front(), "error_linf"), value_text(&levels.back(), "error_linf"),
                                  levels.size() - 1);
  return caption;
}

FigureCaption of_sweep(const ResultFolder& folder) {
  const Json* sweep = folder.result("sweep");
  const std::string number = text_in(sweep, "number");
  PageTable t{"The runs of the sweep", {}, {}};
  const std::vector<std::string> keys = texts_in(sweep, "keys");
  t.headings = keys;
  t.headings.insert(t.headings.end(), {number, "status"});
  const std::vector<Json> runs = list_in(sweep, "runs");
  for (const std::size_t n : spread(runs.size(), 100)) {
    const Json& run = runs[n];
    const Json settings = run.value("settings", Json::object()), summary = run.value("summary", Json::object());
    t.rows.emplace_back();
    for (const std::string& key : keys) t.rows.back().push_back(text_in(&settings, key));
    const Json measures = summary.is_object() ? summary.value("measures", Json::object()) : Json::object();
    const auto value = number_in(&summary, number);
    t.rows.back().push_back(number_text(value ? value : number_in(&measures, number)));
    t.rows.back().push_back(text_in(&run, "status"));
  }
  FigureCaption caption{number + " of each run", {}, table(t)};
  if (t.rows.size() > 1 && !keys.empty())
    caption.finding = fmt::format("{} is {} for {} = {}, and {} for {}.", number, t.rows.front()[keys.size()], keys[0],
                                  t.rows.front()[0], t.rows.back()[keys.size()], t.rows.back()[0]);
  return caption;
}

FigureCaption of_workprecision(const ResultFolder& folder) {
  FigureCaption caption{"Error against run time", {}, {}};
  std::vector<Json> reached;
  for (const Json& goal : list_in(folder.result("workprecision"), "cheapest"))
    if (Json engine = goal.value("engine", Json()); engine.is_object()) {
      engine["accuracy"] = number_in(&goal, "accuracy").value_or(NAN);
      caption.finding =
          fmt::format("The smallest error that was asked for and reached, {}, costs {} seconds, by {}.",
                      value_text(&engine, "accuracy"), value_text(&engine, "seconds"), value_text(&engine, "scheme"));
      reached.push_back(std::move(engine));
    }
  caption.table = table_of("The cheapest scheme for each accuracy",
                           {{"largest error below", "accuracy"},
                            {"scheme", "scheme"},
                            {"N", "sites"},
                            {"error", "error_linf"},
                            {"seconds", "seconds"}},
                           reached);
  return caption;
}

FigureCaption of_stability(const ResultFolder& folder, const std::string& title) {
  const std::vector<Json> limits = list_in(folder.result("stability"), "limits");
  const auto agree = std::ranges::count_if(limits, [](const Json& limit) { return is_true_in(&limit, "agrees"); });
  return {title, fmt::format("Theory and runs agree on {} of {} limits.", agree, limits.size()),
          table_of("Limits of h/k; none is left empty",
                   {{"scheme", "scheme"},
                    {"waves", "waves"},
                    {"by theory", "courant_theory"},
                    {"by runs", "courant_observed"},
                    {"they agree", "agrees"}},
                   limits)};
}

}  // namespace

std::string csv_table(const ResultFolder& folder, const std::string& file, std::size_t most) {
  std::istringstream text(file_text(folder.path / file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);)
    if (!line.empty() && line.front() != '#') lines.push_back(line);
  if (lines.size() < 2) return {};
  const auto cells = [](const std::string& line) {
    std::vector<std::string> all;
    std::istringstream parts(line);
    for (std::string cell; std::getline(parts, cell, ',');) {
      char* end = nullptr;
      const double value = std::strtod(cell.c_str(), &end);
      all.push_back(*end == '\0' ? number_text(value) : cell);
    }
    return all;
  };
  const std::size_t count = lines.size() - 1;
  const std::vector<std::size_t> chosen = spread(count, most);
  PageTable t{chosen.size() == count ? file : fmt::format("{} of the {} rows of {}", chosen.size(), count, file),
              cells(lines[0]),
              {}};
  for (const std::size_t n : chosen) t.rows.push_back(cells(lines[n + 1]));
  return table(t);
}

FigureCaption caption_of(const ResultFolder& folder, const std::string& figure) try {
  static const std::map<std::string, FigureCaption (*)(const ResultFolder&)> all{
      {"spacetime", [](const auto& f) { return of_rows(f, "The field over space and time"); }},
      {"waveforms", of_waveforms},
      {"field",
       [](const auto& f) {
         const auto rows = rows_of(f);
         return of_rows(f,
                        rows && rows->frames() == 1 ? "The field on its mesh" : "The field on its mesh, at some times");
       }},
      {"trajectory", [](const auto& f) { return of_point(f, "The coordinates over time"); }},
      {"orbit", [](const auto& f) { return of_point(f, "The orbit"); }},
      {"section",
       [](const auto& f) {
         return FigureCaption{"The crossings of the Poincaré section", "Each point is a crossing.",
                              csv_table(f, "section.csv", 21)};
       }},
      {"phase", of_phase},
      {"error", of_error},
      {"spectrum", of_spectrum},
      {"film", of_film},
      {"energy", of_energy},
      {"levels",
       [](const auto&) {
         return FigureCaption{"The levels in which the sites are solved", {}, {}};
       }},
      {"updates",
       [](const auto&) {
         return FigureCaption{"The times at which cells are stepped, each by its own step", {}, {}};
       }},
      {"residual-map",
       [](const auto& f) {
         return of_checks(f, "The residual of the field equations over space and time", "field equations");
       }},
      {"severity-map",
       [](const auto& f) {
         return of_checks(f, "The error of the equations beside the force there", "field equations");
       }},
      {"residual-region",
       [](const auto& f) { return of_checks(f, "The form formula on regions of all kinds", "form formula"); }},
      {"worst-region",
       [](const auto& f) { return of_checks(f, "The region where the form formula holds worst", "form formula"); }},
      {"time-reversal",
       [](const auto& f) {
         return of_checks(f, "The distance from the start after steps forth and back", "time reversal");
       }},
      {"energy-own",
       [](const auto& f) { return of_checks(f, "The energy that the scheme itself conserves", "energy"); }},
      {"convergence", of_convergence},
      {"sweep", of_sweep},
      {"workprecision", of_workprecision},
      {"dispersion", [](const auto& f) { return of_stability(f, "The frequency of waves over their wave number"); }},
      {"stability-map",
       [](const auto& f) { return of_stability(f, "The steps at which runs from noise stay bounded"); }}};
  const auto found = all.find(figure.starts_with("stability-map") ? "stability-map" : figure);
  return found == all.end() ? FigureCaption{figure, {}, {}} : found->second(folder);
} catch (const std::exception&) {  // rows or results of a shape that nobody expects
  return {figure, {}, {}};
}

}  // namespace delf

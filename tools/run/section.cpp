// SPDX-License-Identifier: MIT
#include "tools/run/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <optional>

#include "jets/tables/line_basis.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/read_number.hpp"
#include "lattice/text_parts.hpp"
#include "schemes/stepping/saved_state.hpp"

namespace delf {

namespace {

constexpr std::size_t rows_around = 8;
constexpr double turn = 2 * std::numbers::pi;

// "q", "p" of one coordinate; "q1", "q2", … of several
std::string name_of(std::size_t place, std::size_t coordinates) {
  const std::string letter = place < coordinates ? "q" : "p";
  return coordinates == 1 ? letter : letter + std::to_string(place % coordinates + 1);
}

/// "q1 = 0, p1 > 0"
std::string example(std::size_t coordinates) {
  return fmt::format("{} = 0, {} > 0", name_of(0, coordinates), name_of(coordinates, coordinates));
}

SectionRequest::Term term_of(const std::string& text, std::size_t coordinates) {
  const auto refuse = [&](const std::string& why) {
    return BadInput("output.section",
                    fmt::format("output.section: \"{}\" {}; write one like {}", text, why, example(coordinates)));
  };
  const auto at = text.find_first_of("=<>");
  if (at == std::string::npos) throw refuse("has none of =, < and >");
  const std::string name = trimmed(text.substr(0, at));
  const auto value = read_finite(trimmed(text.substr(at + 1)));
  if (!value) throw refuse("has no number at its right");
  for (std::size_t place = 0; place < 2 * coordinates; ++place)
    if (name == name_of(place, coordinates)) return {place, text[at], *value};
  throw refuse(
      fmt::format("begins with none of {} to {}", name_of(0, coordinates), name_of(2 * coordinates - 1, coordinates)));
}

}  // namespace

SectionRequest::SectionRequest(const std::string& text, int coordinates) : surface{} {
  std::vector<Term> terms;
  for (const std::string& part : parts_of(text)) terms.push_back(term_of(part, delf::at(coordinates)));
  const auto is_surface = [](const Term& term) { return term.relation == '='; };
  if (std::ranges::count_if(terms, is_surface) != 1)
    throw BadInput("output.section",
                   fmt::format("output.section = {}: a section has one =, and conditions with < or >; "
                               "write one like {}",
                               text, example(delf::at(coordinates))));
  surface = *std::ranges::find_if(terms, is_surface);
  std::ranges::copy_if(terms, std::back_inserter(conditions), [&](const Term& term) { return !is_surface(term); });
}

Section::Section(const std::string& text, int coordinates, double time_step, const std::vector<int>& angles)
    : title_(text),
      request_(text, coordinates),
      coordinates_(delf::at(coordinates)),
      time_step_(time_step),
      is_angle_(2 * coordinates_, 0) {
  for (const int field : angles) is_angle_[field] = 1;
}

void Section::see(std::vector<double> point) {
  ++newest_;
  rows_.push_back(std::move(point));
  if (rows_.size() > rows_around) rows_.pop_front(), --crossed_;
  // up to the one in the middle: later ones wait for the rows after them
  if (rows_.size() == rows_around)
    while (crossed_ < rows_around / 2) cross(crossed_++);
}

void Section::visit(SavedState& state) {
  state("rows around", rows_), state("newest row", newest_), state("intervals crossed", crossed_);
  state("points", points_), state("lines", lines_);
}

void Section::finish() {
  while (crossed_ + 1 < rows_.size()) cross(crossed_++);
}

/// The points between rows_[first] and the next one: one where q passes the value of the surface, and of an angle one for
/// each of value + 2πn that it passes.
void Section::cross(std::size_t first) {
  const auto [place, relation, value] = request_.surface;
  const double before = rows_[first][place], after = rows_[first + 1][place];
  if (!is_angle_[place]) return cross(first, value);
  constexpr double most_turns = 1000;  // more than any motion that eight rows can follow
  const double least = (std::min(before, after) - value) / turn, most = (std::max(before, after) - value) / turn;
  if (!(most - least < most_turns)) return;
  std::vector<double> levels;
  for (double n = std::floor(least); n <= most; ++n) levels.push_back(value + n * turn);
  if (before > after) std::ranges::reverse(levels);
  for (const double level : levels) cross(first, level);
}

void Section::cross(std::size_t first, double level) {
  const auto off = [&](const std::vector<double>& point) { return point[request_.surface.place] - level; };
  const double before = off(rows_[first]), after = off(rows_[first + 1]);
  if ((before < 0) == (after < 0)) return;
  std::vector<double> nodes;
  for (std::size_t n = 0; n < rows_.size(); ++n) nodes.push_back(static_cast<double>(n));
  const LagrangeBasis psi(std::move(nodes));
  const auto at = [&](double s) {
    const std::vector<double> weights = psi.values(s);
    std::vector<double> point(2 * coordinates_, 0.0);
    for (std::size_t n = 0; n < rows_.size(); ++n)
      for (std::size_t a = 0; a < point.size(); ++a) point[a] += weights[n] * rows_[n][a];
    return point;
  };
  const double low = static_cast<double>(first);
  double s = low + (before == 0 ? 0 : 1);
  if (before != 0 && after != 0) {
    std::uintmax_t iterations = 100;
    const auto [left, right] =
        boost::math::tools::toms748_solve([&](double x) { return off(at(x)); }, low, low + 1, before, after,
                                          boost::math::tools::eps_tolerance<double>(52), iterations);
    s = std::midpoint(left, right);
  }
  std::vector<double> point = at(s);
  for (std::size_t place = 0; place < point.size(); ++place)
    if (place == request_.surface.place) point[place] += request_.surface.value - level;
    else if (is_angle_[place]) point[place] = std::remainder(point[place], turn);
  for (const SectionRequest::Term& term : request_.conditions)
    if (!(term.relation == '<' ? point[term.place] < term.value : point[term.place] > term.value)) return;
  ++points_;
  lines_ += fmt::format("{}", (static_cast<double>(newest_) + s - static_cast<double>(rows_.size() - 1)) * time_step_);
  for (const double x : point) lines_ += fmt::format(",{}", x);
  lines_ += "\n";
}

std::string Section::table() const {
  std::string heading = "time";
  for (std::size_t place = 0; place < 2 * coordinates_; ++place) heading += "," + name_of(place, coordinates_);
  return heading + "\n" + lines_;
}

std::array<int, 2> Section::drawn_columns() const {
  for (std::size_t a = 0; points_ > 0 && a < coordinates_; ++a)
    if (a != request_.surface.place % coordinates_)
      return {static_cast<int>(a) + 2, static_cast<int>(a + coordinates_) + 2};
  return {0, 0};
}

}  // namespace delf

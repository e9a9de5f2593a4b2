// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace delf {

class SavedState;

/// A Poincaré section as output.section has it: "q1 = 0, p1 > 0", a coordinate or momentum that has a value, and what else
/// holds there.
struct SectionRequest {
  struct Term {
    std::size_t place;  ///< in (q, p)
    char relation;      ///< '=', '<' or '>'
    double value;
  };
  Term surface;
  std::vector<Term> conditions;

  /// Throws BadInput with the key output.section.
  SectionRequest(const std::string& text, int coordinates);
};

/// The points where a motion crosses the section, either way unless a condition tells. Between two rows (q, p) is the
/// polynomial through the eight rows around them, of degree 7, in the middle of which they lie but at the ends of a run.
/// An angle crosses its value modulo 2π, and has values from −π to π in conditions and in the table.
class Section {
 public:
  Section(const std::string& text, int coordinates, double time_step, const std::vector<int>& angles = {});

  /// (q, p) of the next row, from row 0 on.
  void see(std::vector<double> point);
  void visit(SavedState&);
  /// Draws what is between the last rows.
  void finish();

  /// section.csv: time,q1,…,p1,… of every point; q, p for one coordinate.
  std::string table() const;
  std::size_t points() const { return points_; }
  const std::string& title() const { return title_; }
  /// Columns of the table, from 1, that show it: a pair q, p that the surface leaves free; 0 if there is none.
  std::array<int, 2> drawn_columns() const;

 private:
  void cross(std::size_t first);
  void cross(std::size_t first, double level);

  std::string title_;
  SectionRequest request_;
  std::size_t coordinates_;
  double time_step_;
  std::vector<char> is_angle_;            ///< of (q, p)
  std::deque<std::vector<double>> rows_;  ///< the newest, eight at most
  std::int64_t newest_ = -1;
  std::size_t crossed_ = 0;  ///< intervals between rows_ that are done
  std::size_t points_ = 0;
  std::string lines_;
};

}  // namespace delf

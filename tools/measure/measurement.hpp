// SPDX-License-Identifier: MIT
#pragma once
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lattice/lattice.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {

class SavedState;

/// The field that measurements are made on.
struct MeasuredField {
  Lattice lattice;
  double time_step;
  double monodromy;  ///< φ(x + L) − φ(x) on a circle
  bool angle;        ///< values 2π apart are the same
  int fields;        ///< in a row [i·fields + a]; the first is measured
  std::shared_ptr<const FieldTheory> theory;

  /// φ at site i, beyond the seam of a circle too.
  double at(std::span<const double> row, int i) const;
  /// φ at x, by Lagrange's polynomial through the four sites around it.
  double at(std::span<const double> row, double x) const;
  /// x, if it is a place of this space: within the walls of an interval, anywhere on a circle. Throws BadInput.
  double place(double x) const;
};

/// A row, and, where it is recorded, the row one step before it (the next one, for row 0).
struct MeasuredRow {
  double time;
  std::span<const double> row, other;
  double energy_error = std::numeric_limits<double>::quiet_NaN();  ///< relative to row 0
  double energy = std::numeric_limits<double>::quiet_NaN();
};

/// One number of a run. It sees the recorded rows, or the rows of all steps, in their order, and keeps no more of them
/// than it needs.
class Measurement {
 public:
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  virtual ~Measurement() = default;
  /// True if it sees the rows of all steps: what passes between two records is not lost.
  virtual bool sees_steps() const { return false; }
  virtual void see(const MeasuredRow&) = 0;
  /// The answer; not a number where there is none.
  virtual double value() const = 0;
  /// Visits what it keeps of the rows that it has seen.
  virtual void visit(SavedState&) = 0;
};

/// A measurement that measure.NAME can name, with its numbers between brackets.
struct MeasurementEntry {
  const char *name, *arguments, *help;
  std::size_t least, most;  ///< how many numbers
  /// Throws BadInput, with no key, for numbers that it cannot take.
  std::unique_ptr<Measurement> (*make)(const MeasuredField&, const std::vector<double>& numbers);
  bool reads_field = true;  ///< at places, so that sites must stay where they are
};

template <class Kind>
std::unique_ptr<Measurement> make_measurement(const MeasuredField& field, const std::vector<double>& numbers) {
  return std::make_unique<Kind>(field, numbers);
}

/// All measurements: a new one is a file and a line there.
std::span<const MeasurementEntry> measurements();

}  // namespace delf

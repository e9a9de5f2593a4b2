// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "jets/fibre.hpp"
#include "jets/tables/splitting.hpp"
#include "lattice/error.hpp"
#include "schemes/solvers/row_layout.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

class SavedState;
class StepMethod;

struct StepOptions {
  double tolerance = 1e-14;  ///< of the last change, relative to the largest |y| of the last three rows
  int predictor_order = 8;   ///< rows that the seed of an implicit step is extrapolated from
  int max_iterations = 50;
  Fibre fibre = Fibre::real;
  double monodromy = 0;  ///< φ(x + L) − φ(x)
  int threads = 1;       ///< that explicit steps are shared by; the bits are the same for any number
  Processor processor =
      {};  ///< rows are those of a kernel: it gives the first, and is undone on copies that are observed
  bool steps_vary = false;  ///< steps have lengths of their own (LatticeSystem::times): slab by slab alone
  /// Makes the stepper, where the scheme has one of its own; none: the plan says which.
  std::function<std::unique_ptr<StepMethod>(const LatticeSystem&)> own_stepper = {};
};

/// Rounding allows no smaller one: Stepper takes this in its place.
inline constexpr double smallest_tolerance = 4 * std::numeric_limits<double>::epsilon();

/// Tolerances below this ask for all that rounding allows: to what it leaves of y.
inline constexpr double smallest_estimated = 0.99e-13;

/// Beyond this squares overflow, and with them every energy: nothing that could be reported is a number any more.
inline constexpr double largest_finite = 1e150;
inline bool overflowed(double largest_value) { return !(largest_value <= largest_finite); }

/// Why a step was solved by Newton's method, at a hundred times the cost, or, where there may be several roots or it
/// failed, by continuation, its root followed from a small time step, at a thousand times the cost.
enum class Continued { no, stiff, slow, out_of_iterations, far };
inline const char* in_words(Continued why) {
  return why == Continued::stiff  ? "the equations are stiff, and may have several roots"
         : why == Continued::slow ? "the simplified Newton method does not contract"
         : why == Continued::far  ? "Newton's method went to a root that leaves the motion of the rows before"
                                  : "scheme.max_iterations was reached";
}

/// The state of a stepper between steps.
struct StepState {
  std::int64_t newest = -1;  ///< row of the fields
  int iterations = 0;        ///< of the last step: evaluations of the nonlinear part; 0 if it was solved at once
  Continued continued = Continued::no;  ///< of the last step
  int held = 2;  ///< newest rows that are there at least: a step that is not checked leaves fewer
  std::int64_t updates = 0;  ///< of cells with steps of their own; 0 where all sites step together
};

/// The properties of a stepper.
struct StepReport {
  int starting_rows = 2;
  std::vector<int> behind = {};  ///< of each component, rows before the newest that its newest is; none: 0
  bool iterates = true, matrix_free = false;
  bool follows_plan = true;                  ///< false: the plan is that of steps which all sites take together
  int sites_of_an_arc = 0;                   ///< threads share rows by arcs of so many at least; 0: they do not
  std::string solver = {};                   ///< in words
  const RowLayout* layout = nullptr;         ///< of rows by lanes; null when stepped slab by slab
  std::size_t bytes = 0, bytes_to_come = 0;  ///< allocated now; on top while it steps, and by residual() if asked for
  std::string memory = {};                   ///< both, in parts
};

/// The interface of steppers: by whole rows (RowStepper), by sub-steps (CompositionStepper, KickStepper), slab by slab
/// (SlabStepper) or cell by cell (AsynchronousStepper). Stepper, which chooses one, says what the functions do.
class StepMethod {
 public:
  virtual ~StepMethod() = default;

  virtual void start(const std::vector<std::vector<double>>& rows) = 0;
  virtual void start_centred(const std::vector<double>&, const std::vector<double>&) {
    throw BadInput("initial.start",
                   "initial.start = centred: not for schemes with constraints or inner nodes; use exact");
  }
  virtual void start_legendre(const std::vector<double>&, const std::vector<double>&) {
    throw BadInput("initial.start", "initial.start = legendre: only for elements; use exact or centred");
  }
  virtual void step(bool looked_at) = 0;

  virtual StepState state() const = 0;
  virtual std::vector<double> row(int back) const = 0;
  virtual Window window(int rows) const = 0;
  virtual void observe(int /*back*/, std::vector<double>& /*fields*/, std::vector<double>* /*rates*/) const {
    throw std::logic_error("delf: these rows have no processor");
  }
  virtual double residual() const = 0;
  virtual void newest_pair(const double** /*rows*/) const {}
  /// The momenta at the newest row, [i·C + c], where they are no halves of equations between rows; empty: they are.
  virtual std::vector<double> own_momenta() const { return {}; }
  /// The time at which each site was updated last; empty: that of the newest row.
  virtual std::span<const double> site_times() const { return {}; }
  virtual StepReport report(bool residual) const = 0;
  /// All that the next steps depend on, to the bit.
  virtual void visit(SavedState&) = 0;
};

}  // namespace delf

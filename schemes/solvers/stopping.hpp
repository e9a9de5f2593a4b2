// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <limits>

namespace delf {

/// Why an iteration ends, or `no`: it goes on.
enum class Stop {
  no,
  converged,
  rounding,
  stalls,
  diverges,
  out_of_iterations,
  singular,
  far_from_predictor,
  doubtful_root,
  other_root,
  leaps,
  tangled
};
inline bool has_root(Stop stop) { return stop == Stop::converged || stop == Stop::rounding; }
inline const char* in_words(Stop stop) {
  return stop == Stop::singular             ? "their Jacobian is singular"
         : stop == Stop::diverges           ? "Newton's method diverges"
         : stop == Stop::far_from_predictor ? "the predictor is far away"
         : stop == Stop::doubtful_root || stop == Stop::other_root || stop == Stop::leaps
             ? "Newton's method finds no root but one that leaves the motion of the rows before"
             : "Newton's method does not converge";
}

/// An iteration y ← y − δ after its last correction δ.
struct NewtonProgress {
  static constexpr double unknown = std::numeric_limits<double>::infinity();
  int iteration = 0;
  double correction = unknown, before = unknown;  ///< max |δ|, and that of the correction before
  double size = 0;                                ///< max |y|
  double left = unknown;                          ///< a bound on the error that is left, where one is known
  double travelled = 0, steepest = 0;             ///< Σ max |δ|; the largest ratio of two corrections above rounding
  bool finite = true;

  double ratio() const { return correction / before; }
  inline void take(double largest_correction, double largest_value);
};

// Criteria: functions of NewtonProgress. Each is asked after every correction, in the order in which they are passed.

/// Corrections that no longer shrink are rounding below this part of |y|: 512 ε leaves room for a Jacobian of condition 100.
inline constexpr double rounding_of_corrections = 512 * std::numeric_limits<double>::epsilon();

/// |δ| ≤ tolerance.
struct Converged {
  double relative = 4 * std::numeric_limits<double>::epsilon();  ///< to |y|: by less than this no value changes
  double absolute = 0;
  Stop operator()(const NewtonProgress& at) const {
    return at.correction <= std::max(absolute, relative * at.size) ? Stop::converged : Stop::no;
  }
};
/// The error that is left, by the estimate of who iterates, is below the tolerance.
struct LittleLeft {
  double relative;
  Stop operator()(const NewtonProgress& at) const { return at.left <= relative * at.size ? Stop::converged : Stop::no; }
};
/// Corrections no longer shrink, and are small.
struct Rounding {
  double most = rounding_of_corrections;
  double ratio = 0.25;  ///< an iteration that gains less than two bits is not one that converges
  Stop operator()(const NewtonProgress& at) const {
    return at.correction > ratio * at.before && at.correction <= most * at.size ? Stop::rounding : Stop::no;
  }
};
/// Corrections no longer shrink as they have to, and are not rounding.
struct Stalls {
  double ratio;
  double rounding = rounding_of_corrections;
  Stop operator()(const NewtonProgress& at) const {
    return at.correction > ratio * at.before && at.correction > rounding * at.size ? Stop::stalls : Stop::no;
  }
};
/// Values are not finite. It is asked first, for others compare with them.
struct Overflows {
  Stop operator()(const NewtonProgress& at) const { return at.finite ? Stop::no : Stop::diverges; }
};
/// Corrections still grow when the iteration should long have ended: six that square a relative error of a half reach rounding.
struct Diverges {
  int after = 8;
  Stop operator()(const NewtonProgress& at) const {
    return at.iteration > after && at.correction > at.before ? Stop::diverges : Stop::no;
  }
};
struct OutOfIterations {
  int most;
  Stop operator()(const NewtonProgress& at) const { return at.iteration >= most ? Stop::out_of_iterations : Stop::no; }
};
/// The first correction goes so far that another root may be nearer.
struct FarFromPredictor {
  double relative;
  Stop operator()(const NewtonProgress& at) const {
    return at.iteration == 1 && at.correction > relative * at.size ? Stop::far_from_predictor : Stop::no;
  }
};

void NewtonProgress::take(double largest_correction, double largest_value) {
  before = correction, correction = largest_correction, size = largest_value;
  travelled += correction;
  if (before < unknown && correction > rounding_of_corrections * size) steepest = std::max(steepest, ratio());
}

/// The first criterion that says stop.
template <class... Criteria>
Stop first_of(const NewtonProgress& at, const Criteria&... criteria) {
  Stop stop = Stop::no;
  static_cast<void>((((stop = criteria(at)) == Stop::no) && ...));
  return stop;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/solvers/newton.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "lattice/index.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// f(y) = 0, with f′(y) at each y, or with a constant in its place.
struct Scalar {
  std::function<double(double)> f, slope;
  double y;
  double matrix = 0;
  std::vector<double> corrections = {};

  bool linearise(const NewtonProgress&) { return (matrix = slope(y)) != 0; }
  double residual() const { return f(y); }
  double solve(double E) const { return E / matrix; }
  void apply(double change, NewtonProgress& at) {
    y -= change;
    corrections.push_back(std::abs(change));
    at.finite = std::isfinite(y);
    at.take(std::abs(change), std::abs(y));
  }
};
Scalar square_root(double of, double from) {
  return {[of](double y) { return y * y - of; }, [](double y) { return 2 * y; }, from};
}
/// y ← y − share · (y − 1): each correction is 1 − share of the one before.
Scalar shrinking_by(double ratio, double from = 2) {
  return {[](double y) { return y - 1; }, [ratio](double) { return 1 / (1 - ratio); }, from};
}

/// After an iteration whose last two corrections are these parts of |y| = 1.
NewtonProgress after(int iteration, double before, double correction) {
  NewtonProgress at;
  at.iteration = iteration;
  if (iteration > 1) at.take(before, 1);
  at.take(correction, 1);
  return at;
}

}  // namespace

TEST_CASE("Newton's method squares the error, and ends where the first criterion says so") {
  Scalar equation = square_root(2, 1);
  NewtonProgress at;
  CHECK(newton(equation, at, Overflows{}, Converged{}, Rounding{}, OutOfIterations{20}) == Stop::converged);
  CHECK(equation.y == Approx(std::sqrt(2)).epsilon(epsilon));
  CHECK(at.iteration <= 6);
  CHECK(equation.corrections.size() == delf::at(at.iteration));
  CHECK(at.correction == equation.corrections.back());
  CHECK(at.before == equation.corrections[equation.corrections.size() - 2]);
  CHECK(at.travelled >= std::sqrt(2) - 1);

  Scalar again = square_root(2, 1);
  NewtonProgress few;
  CHECK(newton(again, few, Converged{}, OutOfIterations{3}) == Stop::out_of_iterations);
  CHECK(few.iteration == 3);
}

TEST_CASE("a second iteration goes on from the progress of the first") {
  Scalar equation = square_root(2, 1);
  NewtonProgress at;
  CHECK(newton(equation, at, Converged{.relative = 1e-3}, OutOfIterations{20}) == Stop::converged);
  const double last = at.correction;
  const int iterations = at.iteration;
  CHECK(newton(equation, at, OutOfIterations{iterations + 1}) == Stop::out_of_iterations);
  CHECK(at.before == last);
}

TEST_CASE("a singular matrix ends the iteration before a correction") {
  Scalar equation = square_root(2, 0);
  NewtonProgress at;
  CHECK(newton(equation, at, Converged{}) == Stop::singular);
  CHECK(equation.corrections.empty());
  CHECK_FALSE(has_root(Stop::singular));
}

TEST_CASE("each criterion ends what it is for, and lets go on what it is not for") {
  CHECK(Converged{}(after(2, 1, 3 * epsilon)) == Stop::converged);
  CHECK(Converged{}(after(2, 1, 5 * epsilon)) == Stop::no);
  CHECK(Converged{.relative = 0, .absolute = 1e-9}(after(1, 0, 1e-9)) == Stop::converged);

  CHECK(Rounding{}(after(3, 1e-14, 5e-15)) == Stop::rounding);
  CHECK(Rounding{}(after(3, 1e-13, 1e-14)) == Stop::no);  // still shrinks
  CHECK(Rounding{}(after(3, 1e-10, 9e-11)) == Stop::no);  // does not, but is more than rounding
  CHECK(Rounding{}(after(1, 0, 1e-14)) == Stop::no);      // the first one is compared with nothing
  CHECK(Rounding{.most = 1e-10}(after(3, 1e-10, 9e-11)) == Stop::rounding);

  CHECK(Stalls{0.25}(after(3, 1e-3, 5e-4)) == Stop::stalls);
  CHECK(Stalls{0.25}(after(3, 1e-3, 2e-4)) == Stop::no);
  CHECK(Stalls{0.25}(after(3, 1e-14, 1e-14)) == Stop::no);  // is rounding
  CHECK(Stalls{0.25}(after(1, 0, 10)) == Stop::no);

  CHECK(Diverges{}(after(9, 1e-2, 2e-2)) == Stop::diverges);
  CHECK(Diverges{}(after(8, 1e-2, 2e-2)) == Stop::no);  // may still find its way
  CHECK(Diverges{}(after(9, 1e-2, 9e-3)) == Stop::no);

  CHECK(OutOfIterations{4}(after(4, 1, 0.1)) == Stop::out_of_iterations);
  CHECK(OutOfIterations{4}(after(3, 1, 0.1)) == Stop::no);

  CHECK(FarFromPredictor{1e-2}(after(1, 0, 0.1)) == Stop::far_from_predictor);
  CHECK(FarFromPredictor{1e-2}(after(2, 0.1, 0.1)) == Stop::no);
  CHECK(FarFromPredictor{1e-2}(after(1, 0, 1e-3)) == Stop::no);

  NewtonProgress at = after(2, 1, 0.1);
  CHECK(LittleLeft{1e-9}(at) == Stop::no);  // as long as nobody knows
  at.left = 1e-10;
  CHECK(LittleLeft{1e-9}(at) == Stop::converged);
  at.finite = false;
  CHECK(Overflows{}(at) == Stop::diverges);
  at.finite = true;
  CHECK(Overflows{}(at) == Stop::no);
  CHECK(first_of(at, Overflows{}, LittleLeft{1e-9}, OutOfIterations{1}) == Stop::converged);
  CHECK(first_of(at, Overflows{}, OutOfIterations{1}, LittleLeft{1e-9}) == Stop::out_of_iterations);
}

TEST_CASE("iterations end by the criterion that their course is for") {
  const auto ends = [](Scalar equation) {
    NewtonProgress at;
    return newton(equation, at, Overflows{}, Converged{}, Rounding{}, Stalls{0.5}, Diverges{}, OutOfIterations{200});
  };
  CHECK(ends(shrinking_by(0.1)) == Stop::converged);
  CHECK(ends(shrinking_by(0.6)) == Stop::stalls);
  CHECK(ends(shrinking_by(-1.5)) == Stop::stalls);  // grows
  // e^y/1e300 overflows at the first correction
  CHECK(ends({[](double y) { return std::exp(y); }, [](double) { return -1e-300; }, 300}) == Stop::diverges);
  // f is off by 4e-14, now above and now below: corrections no longer shrink
  const auto coarse = [n = 0](double y) mutable { return y * y - 2 + (n++ % 2 == 0 ? 4e-14 : -4e-14); };
  CHECK(ends({coarse, [](double y) { return 2 * y; }, 1.5}) == Stop::rounding);

  Scalar growing = shrinking_by(-1.5);
  NewtonProgress at;
  CHECK(newton(growing, at, Overflows{}, Converged{}, Rounding{}, Diverges{}, OutOfIterations{50}) == Stop::diverges);
  CHECK(at.iteration == 9);
}

TEST_CASE("progress holds the steepest ratio of corrections above rounding") {
  NewtonProgress at;
  at.take(1e-2, 1);
  CHECK(at.steepest == 0);
  at.take(2e-3, 1), at.take(1e-6, 1);
  CHECK(at.steepest == Approx(0.2));
  at.take(1e-14, 1), at.take(1e-14, 1);
  CHECK(at.steepest == Approx(0.2));
  CHECK(at.travelled == Approx(1.2001e-2).epsilon(1e-4));
}

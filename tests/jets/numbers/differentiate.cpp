// SPDX-License-Identifier: MIT
#include "jets/numbers/differentiate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/catch.hpp"
#include "tests/jets/random.hpp"

using namespace delf;
using delf::testing::Random;

namespace {

constexpr int sizes[] = {1, 7, 8, 9, 17};  // less than a chunk, one exactly, one and a little, two and a little
constexpr double never_written = std::numeric_limits<double>::quiet_NaN();

std::vector<double> random_point(Random& random, int n) {
  std::vector<double> y(n);
  for (double& v : y) v = random(0.3, 1.2);
  return y;
}
template <class F>
std::vector<double> gradient_of(const F& f, const std::vector<double>& y) {
  std::vector<double> g(y.size(), never_written);
  gradient(f, y, g);
  return g;
}
template <class F>
std::vector<double> hessian_of(const F& f, const std::vector<double>& y) {
  std::vector<double> H(y.size() * y.size(), never_written);
  hessian(f, y, H);
  return H;
}

/// The largest element of |a − b|; infinite where one is not a number.
double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double defect = std::abs(a[i] - b[i]);
    worst = std::isnan(defect) ? std::numeric_limits<double>::infinity() : std::max(worst, defect);
    if (std::isinf(worst)) break;
  }
  return worst;
}

/// The largest differences of gradient and Hessian to central differences of fourth order.
struct Defects {
  double gradient, hessian;
};
template <class F>
Defects against_differences(const F& f, const std::vector<double>& y) {
  constexpr double e = 3e-4;
  const auto slope = [&](std::size_t i, auto&& g) {
    const auto moved = [&](double s) {
      std::vector<double> to = y;
      to[i] += s;
      return g(to);
    };
    return (8 * (moved(e) - moved(-e)) - (moved(2 * e) - moved(-2 * e))) / (12 * e);
  };
  const std::size_t n = y.size();
  std::vector<double> g(n), H(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    g[i] = slope(i, [&](const std::vector<double>& at) { return f(std::span<const double>(at)); });
    for (std::size_t j = 0; j < n; ++j)
      H[i * n + j] = slope(j, [&](const std::vector<double>& at) { return gradient_of(f, at)[i]; });
  }
  return {distance(gradient_of(f, y), g), distance(hessian_of(f, y), H)};
}

/// exp(Σ w_i y_i) + Σ_{i≥1} (i + 1) y_i³ y_{i−1}: every second derivative is there and no two variables are alike.
struct Known {
  static double weight(std::size_t i) { return 0.1 / (1.0 + static_cast<double>(i)) - 0.03; }
  static double factor(std::size_t i) { return static_cast<double>(i) + 1; }

  template <class T>
  T operator()(std::span<const T> y) const {
    T sum(0.0), rest(0.0);
    for (std::size_t i = 0; i < y.size(); ++i) sum += weight(i) * y[i];
    for (std::size_t i = 1; i < y.size(); ++i) rest += factor(i) * (y[i] * y[i] * y[i] * y[i - 1]);
    using std::exp;
    return exp(sum) + rest;
  }
  std::vector<double> by_hand(const std::vector<double>& y) const {
    const double e = exponential(y);
    std::vector<double> g(y.size());
    for (std::size_t i = 0; i < y.size(); ++i) g[i] = weight(i) * e;
    for (std::size_t i = 1; i < y.size(); ++i) {
      g[i] += factor(i) * 3 * y[i] * y[i] * y[i - 1];
      g[i - 1] += factor(i) * y[i] * y[i] * y[i];
    }
    return g;
  }
  std::vector<double> twice_by_hand(const std::vector<double>& y) const {
    const double e = exponential(y);
    const std::size_t n = y.size();
    std::vector<double> H(n * n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) H[i * n + j] = weight(i) * weight(j) * e;
    for (std::size_t i = 1; i < n; ++i) {
      H[i * n + i] += factor(i) * 6 * y[i] * y[i - 1];
      H[i * n + i - 1] += factor(i) * 3 * y[i] * y[i];
      H[(i - 1) * n + i] += factor(i) * 3 * y[i] * y[i];
    }
    return H;
  }

 private:
  static double exponential(const std::vector<double>& y) {
    double sum = 0;
    for (std::size_t i = 0; i < y.size(); ++i) sum += weight(i) * y[i];
    return std::exp(sum);
  }
};

/// Quotients, roots and sines of neighbours and of the first and last variable.
constexpr auto mixed = []<class T>(std::span<const T> y) -> T {
  using std::sin, std::sqrt;
  T sum = sin(y.front() * y.back());
  for (std::size_t i = 0; i + 1 < y.size(); ++i) sum += sqrt(y[i] + 2.0 * y[i + 1]) / (1.0 + y[i] * y[i + 1]);
  return sum;
};

}  // namespace

TEST_CASE("gradient and Hessian of any number of variables are those by hand") {
  Random random(31);
  for (const int n : sizes) {
    CAPTURE(n);
    const std::vector<double> y = random_point(random, n);
    const Known f;
    CHECK(distance(gradient_of(f, y), f.by_hand(y)) < 1e-13 * (1 + 10 * n));
    CHECK(distance(hessian_of(f, y), f.twice_by_hand(y)) < 1e-13 * (1 + 10 * n));
  }
}

TEST_CASE("gradient and Hessian of any number of variables agree with finite differences") {
  Random random(32);
  for (const int n : sizes) {
    CAPTURE(n);
    const Defects known = against_differences(Known{}, random_point(random, n));
    CHECK(known.gradient < 1e-8);
    CHECK(known.hessian < 1e-8);
    const Defects others = against_differences(mixed, random_point(random, n));
    CHECK(others.gradient < 1e-9);
    CHECK(others.hessian < 1e-9);
  }
}

TEST_CASE("the comparison of run-time derivatives can fail: a square whose slope is missing is found") {
  const auto wrong = []<class T>(std::span<const T> y) -> T {
    const T& last = y.back();
    if constexpr (requires { last.d; }) return chain(last, last.value * last.value, last.value);
    else return last * last;
  };
  Random random(33);
  for (const int n : sizes) CHECK(against_differences(wrong, random_point(random, n)).gradient > 0.1);
}

TEST_CASE("the Hessian is symmetric to the last bit") {
  Random random(34);
  for (const int n : sizes) {
    const std::vector<double> H = hessian_of(mixed, random_point(random, n));
    bool symmetric = true;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) symmetric = symmetric && H[i * n + j] == H[j * n + i];
    CHECK(symmetric);
  }
}

TEST_CASE("differentiation leaves nothing behind: after more and fewer variables, and after an exception") {
  const Known f;
  Random random(35);
  const std::vector<double> many = random_point(random, 17), few = random_point(random, 3);
  const auto g = gradient_of(f, few), H = hessian_of(f, few);
  gradient_of(f, many), hessian_of(f, many);
  CHECK((gradient_of(f, few) == g && hessian_of(f, few) == H));

  bool fail = true;
  const auto moody = [&]<class T>(std::span<const T> y) -> T {
    if (fail) throw 1;
    return f(y);
  };
  CHECK_THROWS(gradient_of(moody, few));
  CHECK_THROWS(hessian_of(moody, few));
  fail = false;
  CHECK((gradient_of(moody, few) == g && hessian_of(moody, few) == H));
}

TEST_CASE("a constant has no derivatives, and no variables are none") {
  const auto constant = []<class T>(std::span<const T>) -> T { return 3.0; };
  CHECK(gradient_of(constant, {1, 2}) == std::vector<double>(2, 0.0));
  CHECK(hessian_of(constant, {1, 2}) == std::vector<double>(4, 0.0));
  CHECK(gradient_of(constant, {}).empty());
  CHECK(hessian_of(constant, {}).empty());
}

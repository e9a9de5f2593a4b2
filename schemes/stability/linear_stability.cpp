// SPDX-License-Identifier: MIT
#include "schemes/stability/linear_stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace delf {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

/// Separations nearer to zero than this are rounding.
constexpr double met = 1e-11;

/// The largest value of the parabola through three values at equal distances, of which the middle one is the largest.
double peak(double before, double here, double after) {
  const double slope = 0.5 * (after - before), bend = before - 2 * here + after;
  return bend < 0 ? here - 0.5 * slope * slope / bend : here;
}

/// (z₁ − z₂)²/z₁z₂: −4 sin²(α/2) for two roots on the circle with α between them, positive for a pair z, 1/z̄ off it,
/// smooth where one becomes the other. Of all pairs, the largest first.
std::vector<double> separations(const std::vector<Complex>& z) {
  std::vector<double> result;
  for (std::size_t i = 0; i < z.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (std::norm(z[i]) == 0) continue;
      const Complex difference = z[i] - z[j], product = z[i] * z[j];
      result.push_back(product == 0.0 ? -4.0 : std::real(difference * difference / product));
    }
  std::ranges::sort(result, std::greater{});
  return result;
}

bool solvable(const std::vector<Complex>& z) { return z.empty() || std::isfinite(z[0].real()); }

/// "pi", "2 pi/3", or a number of four digits; `cycle` is the q of 2πp/q.
std::string fraction_of_pi(double angle, int& cycle) {
  for (int q = 1; q <= 24; ++q) {
    const int p = static_cast<int>(std::lround(angle * q / (2 * pi)));
    if (std::abs(angle - 2 * pi * p / q) > 1e-6) continue;
    cycle = q;
    if (p == 0) return "0";
    const int g = q % 2 == 0 ? 2 : 1, above = 2 * p / g, below = q / g;
    const std::string top = above == 1 ? "pi" : fmt::format("{} pi", above);
    return below == 1 ? top : fmt::format("{}/{}", top, below);
  }
  cycle = 0;
  return fmt::format("{:.4g}", angle);
}

std::string in_words(const Ghost& ghost, bool point) {
  int cycle = 0, turn = 0;
  const std::string theta = fraction_of_pi(ghost.theta, cycle),
                    angle = fraction_of_pi(std::abs(std::arg(ghost.z)), turn);
  std::string where = "every theta";
  if (point) where = "the point";
  else if (!ghost.everywhere)
    where = fmt::format("theta = {} ({})", theta,
                        cycle == 1   ? "every N"
                        : cycle == 2 ? "even N only"
                        : cycle > 0  ? fmt::format("N a multiple of {} only", cycle)
                                     : "as N comes near it");
  const std::string z = ghost.everywhere ? "on the unit circle"
                        : turn == 1      ? "1"
                        : turn == 2      ? "-1"
                                         : fmt::format("exp({}i {})", std::arg(ghost.z) < 0 ? "-" : "", angle);
  const auto count = [](int n, const char* two) { return n == 2 ? std::string(two) : fmt::format("{}-fold", n); };
  std::string words = fmt::format("{}, z {}{}: {} root with {}", where, ghost.everywhere ? "" : "= ", z,
                                  count(ghost.multiplicity, "double"),
                                  ghost.modes == 1 ? "one mode" : fmt::format("{} modes", ghost.modes));
  if (!ghost.everywhere && (cycle == 1 || cycle == 2) && (turn == 1 || turn == 2)) {
    const std::string sign = cycle == 2 && !point ? turn == 2 ? "(-1)^(i+j) " : "(-1)^i " : turn == 2 ? "(-1)^j " : "";
    words += fmt::format(", {}(a + b j)", sign);
  }
  return words + (ghost.multiplicity == 2 * ghost.modes ? ", grows linearly" : ", grows like a power of time");
}

/// The scan of all wave numbers.
class Scan {
 public:
  Scan(const Symbol& symbol, int wave_numbers) : symbol_(symbol), drifts_(symbol.constant_solutions()) {
    const int points = symbol.zone() == 0 ? 1 : std::max(wave_numbers, 3) / (symbol.brick() ? 2 : 1) + 1;
    for (int i = 0; i < points; ++i) {
      const double theta = points == 1 ? 0 : symbol.zone() * i / (points - 1);
      grid_.push_back({theta, symbol.roots(theta), {}, 0});
      Point& point = grid_.back();
      point.separations = solvable(point.roots) ? separations(point.roots) : std::vector<double>{};
      point.growth = look_at(theta, point.roots);
    }
    on_grid_ = ghosts_.size();
    if (verdict_.amplification <= 1) look_between();
    if (verdict_.amplification > 1 && std::isfinite(verdict_.amplification)) find_largest();
  }

  StabilityVerdict verdict() && {
    verdict_.stable = verdict_.amplification <= 1;
    if (on_grid_ * 2 > grid_.size() && grid_.size() > 1) {
      ghosts_.resize(1);
      ghosts_[0].everywhere = true;
    }
    for (Ghost& ghost : ghosts_) ghost.words = in_words(ghost, symbol_.zone() == 0);
    verdict_.ghosts = std::move(ghosts_);
    return std::move(verdict_);
  }

 private:
  struct Point {
    double theta;
    std::vector<Complex> roots;
    std::vector<double> separations;
    double growth;
  };

  double look_at(double theta, const std::vector<Complex>& roots) {
    const double growth = symbol_.amplification(theta, roots);
    if (growth > verdict_.amplification) verdict_.amplification = growth, verdict_.worst_theta = theta;
    if (solvable(roots)) find_ghosts(theta, roots);
    return growth;
  }

  /// Every largest separation along θ, the largest of all pairs, the second, …, that may reach zero.
  void look_between() {
    const std::size_t n = grid_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Point &left = grid_[i > 0 ? i - 1 : 0], &point = grid_[i], &right = grid_[std::min(i + 1, n - 1)];
      for (std::size_t order = 0; order < point.separations.size(); ++order) {
        const double here = point.separations[order];
        if (order >= left.separations.size() || order >= right.separations.size()) break;
        // Wave numbers beyond both ends are mirror images of those within.
        const double left_value = left.separations[order], right_value = right.separations[order];
        const double before = i == 0 ? right_value : left_value, after = i + 1 == n ? left_value : right_value;
        if (here < before || here < after) continue;
        // Near a meeting the separation is a parabola: between points of the grid it rises to zero, or it does not.
        if (peak(before, here, after) < 0.25 * std::min(before, after)) continue;
        if (std::abs(here) < met && std::abs(before) < met && std::abs(after) < met) continue;  // at every θ
        refine(left.theta, right.theta, [&](double, const std::vector<Complex>& z) {
          const std::vector<double> all = separations(z);
          return order < all.size() ? -all[order] : 0.0;
        });
        if (verdict_.amplification > 1) return;
      }
    }
  }

  void find_largest() {
    const double theta = verdict_.worst_theta,
                 step = symbol_.zone() / std::max<double>(1, static_cast<double>(grid_.size()) - 1);
    if (step == 0) return;
    refine(std::max(0.0, theta - step), std::min(symbol_.zone(), theta + step),
           [&](double at, const std::vector<Complex>& z) { return -symbol_.amplification(at, z); });
  }

  template <class Function>
  void refine(double from, double to, Function least) {
    if (!(to > from)) return;
    std::uintmax_t evaluations = 40;
    boost::math::tools::brent_find_minima(
        [&](double theta) {
          const std::vector<Complex> z = symbol_.roots(theta);
          look_at(theta, z);
          return solvable(z) ? least(theta, z) : 0.0;
        },
        from, to, std::numeric_limits<double>::digits / 2, evaluations);
  }

  void find_ghosts(double theta, const std::vector<Complex>& z) {
    std::vector<Complex> seen;
    for (std::size_t i = 0; i < z.size(); ++i)
      for (std::size_t j = i + 1; j < z.size(); ++j) {
        const double apart = std::abs(z[i] - z[j]);
        if (apart > 1e-4 || std::abs(std::abs(z[i]) - 1) > 1e-4) continue;
        const Complex mean = (z[i] + z[j]) / std::abs(z[i] + z[j]);
        if (std::ranges::any_of(seen, [&](Complex x) { return std::abs(x - mean) < 1e-4; })) continue;
        if (!symbol_.is_root(mean, theta)) continue;  // two roots, however near
        seen.push_back(mean);
        const double cluster = 2 * apart + 1e-10;
        const int multiplicity =
            static_cast<int>(std::ranges::count_if(z, [&](Complex x) { return std::abs(x - mean) <= cluster; }));
        const int modes = static_cast<int>(
            std::ranges::count_if(symbol_.singular_values(mean, theta), [&](double x) { return x <= 1e-9 + apart; }));
        if (modes < multiplicity) add_ghost({theta, mean, multiplicity, modes, false, {}});
      }
  }

  void add_ghost(Ghost ghost) {
    if (symbol_.brick()) {
      // A mode has two names, (z, θ) and (−z, θ + π): the one taken gives even and odd sites the same values.
      const std::vector<Complex> v = symbol_.mode(ghost.z, ghost.theta);
      double like = 0;
      for (std::size_t c = 0; c < v.size() / 2; ++c) like += std::real(std::conj(v[c]) * v[c + v.size() / 2]);
      if (like < 0) ghost.theta = pi - ghost.theta, ghost.z = -std::conj(ghost.z);
    }
    // To rounding, very long waves of a massless field are a drift; those of a beam, whose frequency is θ², sooner.
    if (ghost.theta < 1e-2 && std::abs(ghost.z - 1.0) < 1e-4 && ghost.multiplicity <= 2 * drifts_) {
      verdict_.drift = true;
      return;
    }
    for (const Ghost& known : ghosts_)
      if (std::abs(known.theta - ghost.theta) < 1e-4 && std::abs(known.z - ghost.z) < 1e-3) return;
    ghosts_.push_back(ghost);
  }

  const Symbol& symbol_;
  int drifts_;
  std::vector<Point> grid_;
  std::vector<Ghost> ghosts_;
  std::size_t on_grid_ = 0;
  StabilityVerdict verdict_{true, 0, 0, {}, false};
};

}  // namespace

StabilityVerdict linear_stability(const Symbol& symbol, int wave_numbers) {
  return Scan(symbol, wave_numbers).verdict();
}

StabilityVerdict linear_stability(const LatticeSystem& system, double constant, int wave_numbers) {
  return linear_stability(Symbol(system, constant), wave_numbers);
}

}  // namespace delf

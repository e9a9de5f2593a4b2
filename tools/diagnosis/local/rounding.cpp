// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/diagnosis/findings.hpp"
#include "tools/diagnosis/own_equations.hpp"
#include "tools/diagnosis/rounded_values.hpp"

namespace delf {

namespace {

/// y as text with so many significant digits.
double with_digits(double y, int digits) { return std::stod(fmt::format("{:.{}e}", y, digits - 1)); }

}  // namespace

std::optional<RoundedValues> rounding_of(const std::vector<std::vector<double>>& rows) {
  constexpr int fewest = 16, most_decimals = 12, most_digits = 12;
  const double largest = largest_of(rows);
  std::int64_t values = 0;
  bool single = true;
  int decimals = 0, digits = 1;
  for (const auto& row : rows)
    for (const double y : row) {
      if (y == 0 || std::round(y) == y) continue;  // these are whole in any format
      ++values;
      single = single && static_cast<double>(static_cast<float>(y)) == y;
      // A decimal read from text is the double next to it.
      const auto is_decimal = [&](int d) {
        const double scaled = y * std::pow(10.0, d);
        return std::abs(scaled - std::round(scaled)) <= 4e-16 * std::abs(scaled);
      };
      while (decimals <= most_decimals && !is_decimal(decimals)) ++decimals;
      while (digits <= most_digits && with_digits(y, digits) != y) ++digits;
      if (!single && decimals > most_decimals && digits > most_digits) return std::nullopt;
    }
  if (values < fewest) return std::nullopt;
  // Numbers in single precision that were written with more digits than they have.
  if (!single && digits > 7 && digits <= most_digits)
    single = std::ranges::all_of(rows, [&](const auto& row) {
      return std::ranges::all_of(row, [&](double y) { return with_digits(static_cast<float>(y), digits) == y; });
    });
  const auto found = [&](std::string words, double unit, ValueError error) {
    return RoundedValues{std::move(words), unit, unit / largest, error};
  };
  if (single)
    return found("single precision (float32)", std::ldexp(1.0, -25) * largest, {.relative = std::ldexp(1.0, -24)});
  // The coarser one counts: decimals have more digits where values are large, digits more decimals at small ones.
  const double of_decimals = decimals > most_decimals ? 0 : 0.5 * std::pow(10.0, -decimals);
  const double of_digits =
      digits > most_digits ? 0 : 0.5 * std::pow(10.0, std::floor(std::log10(largest)) - digits + 1);
  if (of_digits > 1.5 * of_decimals)
    return found(fmt::format("{} significant digits", digits), of_digits, {.digits = digits});
  return found(fmt::format("{} decimals", decimals), of_decimals, {.absolute = of_decimals});
}

std::optional<RoundedValues> rounding_of(std::int64_t count,
                                         const std::function<std::vector<double>(std::int64_t)>& row) {
  std::vector<std::vector<double>> rows;
  const auto values = static_cast<std::int64_t>(row(0).size());
  const std::int64_t last = std::clamp<std::int64_t>(64 / values, 3, std::max<std::int64_t>(count - 1, 3));
  for (std::int64_t n = 0; n <= last; ++n) rows.push_back(row((count - 1) * n / last));
  return rounding_of(rows);
}

std::optional<Finding> find_rounding(const Evidence& e) {
  const auto& failing = e.failed.rows();
  constexpr std::size_t most_rows = 20;
  std::vector<std::int64_t> chosen{e.failed.worst_row()};
  for (std::size_t n = 0; n < std::min(most_rows, failing.size()); ++n)
    chosen.push_back(failing[failing.size() * n / std::min(most_rows, failing.size())]);
  std::vector<std::vector<double>> all;
  for (const std::int64_t row : chosen) all.push_back(e.row(row));
  const auto rounding = rounding_of(all);
  const double largest = largest_of(all);
  if (!rounding || largest == 0) return std::nullopt;

  // |ΔE| ≤ Σ|∂E/∂y| · unit, and the coefficients that vary add little
  constexpr double varying = 1.5;
  const std::int64_t reach = std::max(1, e.system.height());
  double worst = 0;  // |E|, in these bounds
  for (const std::int64_t row : chosen) {
    std::vector<std::vector<double>> rows;
    for (std::int64_t j = row - reach; j <= row + reach; ++j) rows.push_back(e.row(j));
    const double size = largest_of(rows);
    worst = std::max(worst,
                     worst_equation(e.system, rows, row - reach, row, e.monodromy) * size / (varying * rounding->unit));
  }
  if (worst > 1)
    return Finding{
        "rounding",
        fmt::format("The values have {}, and what fails is {:.2g} times what that explains: more than rounding is "
                    "wrong.",
                    rounding->words, worst),
        false};
  const double decade = std::pow(10.0, std::floor(std::log10(e.failed.worst())));
  const double tolerance = std::ceil(1.5 * e.failed.worst() / decade) * decade;
  const double hk = e.system.time_step() * e.system.lattice().space_step();
  return Finding{
      "rounding",
      fmt::format("The values have {}, and that explains the failure: use verify.tolerance = {:.2g}. It still "
                  "sees errors of {:.2g} in φ_tt.",
                  rounding->words, tolerance, tolerance * scale_of_terms(e.system, largest) / hk)};
}

}  // namespace delf

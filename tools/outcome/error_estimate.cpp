// SPDX-License-Identifier: MIT
#include "tools/outcome/error_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace delf {

Richardson richardson(double first, double second, double size) {
  constexpr double rounding = 1e-13;
  if (!std::isfinite(first) || !std::isfinite(second)) return {};
  if (std::max(first, second) <= rounding * size) return {std::max(first, second), Richardson{}.order, true};
  Richardson r;
  r.order = std::log2(first / second);
  // Differences that fall by less than √2 say nothing of the error.
  constexpr double least_order = 0.5;
  r.converging = r.order >= least_order;
  if (r.converging) r.error = std::isinf(r.order) ? first : first / (1 - std::exp2(-r.order));
  return r;
}

namespace {

std::string in_words(const std::string& what, const Richardson& r) {
  if (!r.converging)
    return std::isfinite(r.order) ? fmt::format("{}: not converging (order {:.2g} from three runs)", what, r.order)
                                  : fmt::format("{}: not known", what);
  return fmt::format("{}: error {:.3g}{}", what, r.error,
                     std::isfinite(r.order) ? fmt::format(", order {:.3g}", r.order) : "");
}

}  // namespace

std::vector<std::string> in_words(const ErrorEstimate& e) {
  if (!e.failure.empty()) return {"none: " + e.failure};
  std::vector<std::string> lines{in_words("last row", e.row)};
  for (const auto& [name, r] : e.measures) lines.push_back(in_words(name, r));
  return lines;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/nearest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace delf {

namespace {

std::string folded(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

// d(i, j) = min(d(i−1, j) + 1, d(i, j−1) + 1, d(i−1, j−1) + [a_i ≠ b_j], d(i−2, j−2) + 1 if the two are swapped)
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::string nearest(std::string_view unknown, const std::vector<std::string>& names) {
  const std::string wanted = folded(unknown.substr(0, 100));
  std::string best;
  std::size_t least = std::max<std::size_t>(2, wanted.size() / 3) + 1;
  for (const std::string& name : names) {
    const std::string candidate = folded(name);
    const bool begun = wanted.size() > 2 && candidate.starts_with(wanted);
    if (const std::size_t d = begun ? 0 : distance(wanted, candidate); d < least && d < candidate.size()) {
      least = d;
      best = name;
    }
  }
  return best;
}

std::string suggestion(std::string_view unknown, const std::vector<std::string>& names) {
  if (const std::string close = nearest(unknown, names); !close.empty())
    return fmt::format("; did you mean {}?", close);
  return fmt::format("; known: {}", fmt::join(names, ", "));
}

}  // namespace delf

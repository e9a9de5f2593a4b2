// SPDX-License-Identifier: MIT
#include "lattice/nearest_name.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace delf {
namespace {

std::string folded(std::string_view text) {
  std::string out(text.substr(0, 100));
  for (char& c : out) c = c == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

// d(i, j) = min(d(i−1, j) + 1, d(i, j−1) + 1, d(i−1, j−1) + [a_i ≠ b_j], d(i−2, j−2) + 1 if the two are swapped)
std::size_t edit_distance(const std::string& a, const std::string& b) {
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

std::optional<std::string> nearest(std::string_view name, const std::vector<std::string>& known) {
  const std::string wanted = folded(name);
  std::optional<std::string> best;
  std::size_t least = 2 + wanted.size() / 3;
  for (const std::string& candidate : known) {
    const std::string other = folded(candidate);
    const bool begun = wanted.size() > 2 && other.starts_with(wanted);
    if (const std::size_t d = begun ? 0 : edit_distance(wanted, other);
        d < least && d < std::max(wanted.size(), other.size())) {
      least = d;
      best = candidate;
    }
  }
  return best;
}

}  // namespace delf

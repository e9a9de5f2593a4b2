// SPDX-License-Identifier: MIT
#include "schemes/complex/refined_piece.hpp"

#include <map>

namespace delf {

StencilList refined_piece(double length, double duration, int cells, int steps) {
  // In halves of a cell and of a step; sites in the order of time.
  const int left = 2 * (cells / 3), right = 2 * (cells - cells / 3);
  const auto is_fine = [&](int i) { return left <= i && i <= right; };
  StencilList list;
  std::map<std::pair<int, int>, int> number;
  for (int j = 0; j <= 2 * steps; ++j)
    for (int i = 0; i <= 2 * cells; ++i) {
      const int step = is_fine(i) ? 1 : 2;
      if (i % step != 0 || j % step != 0) continue;
      number[{j, i}] = static_cast<int>(list.sites.size());
      const SiteRole role = i == 0 || i == 2 * cells || j == 0 ? SiteRole::given
                            : j == step                        ? SiteRole::initial
                            : j == 2 * steps                   ? SiteRole::final
                                                               : SiteRole::free;
      list.sites.push_back({{duration * j / (2 * steps), length * i / (2 * cells), 0, 0}, role});
    }
  const auto rectangle = [&](int j, int i, int step) {
    list.stencils.push_back(
        {"rectangle", {number[{j, i}], number[{j + step, i}], number[{j + step, i + step}], number[{j, i + step}]}});
  };
  const auto triangle = [&](std::pair<int, int> a, std::pair<int, int> b, std::pair<int, int> c) {
    list.stencils.push_back({"triangle", {number[a], number[b], number[c]}, 0.5});
  };
  for (int j = 0; j < 2 * steps; j += 2)
    for (int i = 0; i < 2 * cells; i += 2) {
      if (left <= i && i < right) {
        for (const int jj : {j, j + 1}) rectangle(jj, i, 1), rectangle(jj, i + 1, 1);
      } else if (i + 2 == left) {
        triangle({j, i}, {j + 2, i}, {j + 1, i + 2});
        triangle({j, i}, {j + 1, i + 2}, {j, i + 2});
        triangle({j + 2, i}, {j + 2, i + 2}, {j + 1, i + 2});
      } else if (i == right) {
        triangle({j, i}, {j + 1, i}, {j, i + 2});
        triangle({j + 1, i}, {j + 2, i}, {j + 2, i + 2});
        triangle({j + 1, i}, {j + 2, i + 2}, {j, i + 2});
      } else {
        rectangle(j, i, 2);
      }
    }
  return list;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/bench/textbook.hpp"

#include <stdexcept>

#include "tools/bench/textbook_explicit.hpp"
#include "tools/bench/textbook_guo.hpp"
#include "tools/bench/textbook_hexagon.hpp"
#include "tools/bench/textbook_rectangle.hpp"
#include "tools/bench/textbook_triangle.hpp"
#include "tools/bench/textbook_vu_quoc_li.hpp"

namespace delf::bench {

const std::vector<std::string>& textbook_schemes() {
  static const std::vector<std::string> names{
      "rectangle-symmetric", "rectangle", "triangle", "triangle-vertex", "hexagon", "vu-quoc-li", "guo"};
  return names;
}

std::unique_ptr<Textbook> make_textbook(const std::string& scheme, int N, double L, double h, double tolerance) {
  if (scheme == "rectangle-symmetric") return std::make_unique<TextbookSymmetricRectangle>(N, L, h, tolerance);
  if (scheme == "rectangle") return std::make_unique<TextbookPlainRectangle>(N, L, h, tolerance);
  if (scheme == "triangle") return std::make_unique<TextbookTriangle>(N, L, h, tolerance);
  if (scheme == "triangle-vertex") return std::make_unique<TextbookExplicit>(N, L, h, tolerance);
  if (scheme == "hexagon") return std::make_unique<TextbookHexagon>(N, L, h, tolerance);
  if (scheme == "vu-quoc-li") return std::make_unique<TextbookVuQuocLi>(N, L, h, tolerance);
  if (scheme == "guo") return std::make_unique<TextbookGuo>(N, L, h, tolerance);
  throw std::logic_error("no textbook implementation of " + scheme);
}

}  // namespace delf::bench

// SPDX-License-Identifier: MIT
#include "tools/bench/textbook/textbook.hpp"

#include <stdexcept>

#include "tools/bench/textbook/textbook_explicit.hpp"
#include "tools/bench/textbook/textbook_guo.hpp"
#include "tools/bench/textbook/textbook_hexagon.hpp"
#include "tools/bench/textbook/textbook_rectangle.hpp"
#include "tools/bench/textbook/textbook_triangle.hpp"
#include "tools/bench/textbook/textbook_vu_quoc_li.hpp"

namespace delf::bench {

namespace {

template <class T>
std::unique_ptr<Textbook> make(int N, double L, double h, double tolerance) {
  return std::make_unique<T>(N, L, h, tolerance);
}

struct Entry {
  const char* scheme;
  std::unique_ptr<Textbook> (*make)(int N, double L, double h, double tolerance);
};
constexpr Entry entries[] = {{"rectangle-symmetric", make<TextbookSymmetricRectangle>},
                             {"rectangle", make<TextbookPlainRectangle>},
                             {"triangle", make<TextbookTriangle>},
                             {"triangle-vertex", make<TextbookExplicit>},
                             {"hexagon", make<TextbookHexagon>},
                             {"vu-quoc-li", make<TextbookVuQuocLi>},
                             {"guo", make<TextbookGuo>}};

}  // namespace

const std::vector<std::string>& textbook_schemes() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Entry& entry : entries) all.emplace_back(entry.scheme);
    return all;
  }();
  return names;
}

std::unique_ptr<Textbook> make_textbook(const std::string& scheme, int N, double L, double h, double tolerance) {
  for (const Entry& entry : entries)
    if (scheme == entry.scheme) return entry.make(N, L, h, tolerance);
  throw std::logic_error("no textbook implementation of " + scheme);
}

}  // namespace delf::bench

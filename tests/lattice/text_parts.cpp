// SPDX-License-Identifier: MIT
#include "lattice/text_parts.hpp"

#include "tests/catch.hpp"

using namespace delf;

TEST_CASE("a list has one part more than separators, each without the white space around it") {
  using Parts = std::vector<std::string>;
  CHECK(parts_of(" 0.25,\t-1e-3 ") == Parts{"0.25", "-1e-3"});
  CHECK(parts_of("m = 1,, g = 2\r") == Parts{"m = 1", "", "g = 2"});
  CHECK(parts_of("") == Parts{""});
  CHECK(parts_of("a, b*c", '*') == Parts{"a, b", "c"});
  CHECK(trimmed(" \t\r\n").empty());
}

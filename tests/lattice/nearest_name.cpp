// SPDX-License-Identifier: MIT
#include "lattice/nearest_name.hpp"

#include "tests/catch.hpp"

using namespace delf;

TEST_CASE("the nearest stencil, theory, or method is the one a typing error away") {
  const std::vector<std::string> stencils{"triangle", "triangle-vertex", "rectangle", "rectangle-symmetric", "hexagon"};
  CHECK(nearest("rectange", stencils) == "rectangle");
  CHECK(nearest("rectangle-symetric", stencils) == "rectangle-symmetric");
  CHECK(nearest("hexagone", stencils) == "hexagon");
  CHECK(nearest("triangle", stencils) == "triangle");
}

TEST_CASE("of equally near names the first is taken") {
  CHECK(nearest("cat", {"bat", "hat"}) == "bat");
  CHECK(nearest("cat", {"hat", "bat"}) == "hat");
}

TEST_CASE("letters swapped count once, case and _ for - not at all, and a beginning is enough") {
  CHECK(nearest("kikn", {"kiwi", "kink"}) == "kink");
  CHECK(nearest("Sine_Gordon", {"sine-gordon-impurity", "sine-gordon"}) == "sine-gordon-impurity");  // begins it
  CHECK(nearest("KLEIN_GORDON", {"sine-gordon", "klein-gordon"}) == "klein-gordon");
  CHECK(nearest("breath", {"noise", "breather"}) == "breather");
}

TEST_CASE("a name that would need more than 1 + a third of its letters changed is not suggested") {
  // |name| = 6: three errors at most
  CHECK(nearest("abcdef", {"abcxyz"}) == "abcxyz");
  CHECK_FALSE(nearest("abcdef", {"abwxyz"}));
  CHECK_FALSE(nearest("", {"ab"}));
  CHECK_FALSE(nearest("abc", {}));
  // what is added and what is missing counts one each
  CHECK(nearest("aabbcc", {"abc"}) == "abc");
}

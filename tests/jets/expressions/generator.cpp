// SPDX-License-Identifier: MIT
#include "jets/expressions/generator.hpp"

#include <string>
#include <vector>

#include "lattice/error.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

const ExpressionNames uv{{"u", "v"}, {{"c", 0.5}}};

std::string refusal(const auto& what) {
  try {
    what();
  } catch (const BadInput& bad) {
    CHECK(bad.key() == "theory.symmetry");
    return bad.what();
  }
  return "accepted";
}
std::string read(const std::string& text, const ExpressionNames& names = uv) {
  return refusal([&] { generator_of(text, names, "symmetry", "theory.symmetry"); });
}
std::string tried(const std::string& generator, const std::string& density, const std::string& constraint = "",
                  const ExpressionNames& names = uv) {
  return refusal([&] {
    require_symmetry(generator_of(generator, names, "symmetry", "theory.symmetry"), density, constraint, names,
                     "theory.symmetry");
  });
}
void check_says(const std::string& message, const std::string& part) {
  INFO(message);
  CHECK(message.find(part) != std::string::npos);
}

}  // namespace

TEST_CASE("a generator is an affine change of each field") {
  const LinearSymmetry s = generator_of("-c*v + pow(2, 3), 2*(u + v)/4 - 1", uv, "turn", "theory.symmetry");
  CHECK(s.name == "turn");
  CHECK(s.matrix == std::vector<double>{0, -0.5, 0.5, 0.5});
  CHECK(s.shift == std::vector<double>{8, -1});
  check_says(read("u*v, 0"), "the change of u is not linear in u");
  check_says(read("0, sin(u)"), "the change of v is not linear in u");
  check_says(read("1"), "has 1 part; give one for each of u, v");
  check_says(read("1,"), "has an empty part");
  check_says(read("0, 0*u"), "changes no field");
  check_says(read("w, 0"), "theory.symmetry: character 1, at \"w\": unknown name w");
  check_says(read("1, x"), "unknown name x");
}

TEST_CASE("what is no symmetry of a density is refused, with what is in the way") {
  const std::string turns = "0.5*(u_t^2 - u_x^2 + v_t^2 - v_x^2) - (u^2 + v^2)^2";
  CHECK(tried("-v, u", turns) == "accepted");
  check_says(tried("v, u", turns), "is no symmetry: the density changes along it");
  check_says(tried("1, 0", turns), "not by a divergence");
  CHECK(tried("1, 1", "0.5*(u_t^2 + v_t^2) + cos(u - v)*u_x*v_x") == "accepted");
  // where a density has no value everywhere
  CHECK(tried("u, -v", "0.5*u_t*v_t + log(u*v)") == "accepted");
  // by a divergence: of t, of u v, and of u x
  CHECK(tried("1, 0", "0.5*(u_t^2 + v_t^2) - c*u") == "accepted");
  CHECK(tried("1, 0", "0.5*(u_t^2 + v_t^2) + u*v_t") == "accepted");
  CHECK(tried("1, 0", "0.5*(u_t^2 + v_t^2) + u*v*v_t + x*u_x*3") == "accepted");
  check_says(tried("1, 0", "0.5*(u_t^2 + v_t^2) + u*v"), "not by a divergence");
}

TEST_CASE("a symmetry keeps the constraint") {
  const std::string free = "0.5*(u_t^2 - u_x^2 + v_t^2 - v_x^2)";
  CHECK(tried("-v, u", free, "u^2 + v^2 - 1") == "accepted");
  check_says(tried("1, 0", free, "u^2 + v^2 - 1"), "it leads off the constraint");
  check_says(tried("-v, u", free, "u^2 + 2*v^2 - 1"), "it leads off the constraint");
}

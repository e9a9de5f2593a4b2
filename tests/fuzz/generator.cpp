// SPDX-License-Identifier: MIT
#include "jets/expressions/generator.hpp"

#include "tests/fuzz/target.hpp"

// The generator of a symmetry, theory.symmetry, and whether a density has it.
void delf::fuzz::read_bytes(std::string_view bytes) {
  const ExpressionNames names{{"u", "v"}, {{"c", 0.5}}};
  const LinearSymmetry symmetry = generator_of(bytes, names, "symmetry", "theory.symmetry");
  require_symmetry(symmetry, "0.5*(u_t^2 + v_t^2) - 0.5*(u_x^2 + v_x^2) - c*(u^2 + v^2)^2", "", names,
                   "theory.symmetry");
}

// SPDX-License-Identifier: MIT
#include "tests/catch.hpp"
#include "tools/report/field_symbol.hpp"

TEST_CASE("a field is φ in figures and pages, and keeps a name of its own") {
  CHECK(delf::field_symbol("phi") == "φ");
  CHECK(delf::field_symbol("phi1") == "φ₁");
  CHECK(delf::field_symbol("phi20") == "φ₂₀");
  for (const char* own : {"u", "psi", "phi_left", "phase", ""}) CHECK(delf::field_symbol(own) == own);
}

// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"

namespace delf::testing {

/// Exit code 2, nothing on stdout, and one line on stderr that holds all the parts.
inline void check_refused(const Ran& ran, const std::vector<std::string>& parts) {
  INFO(ran.err);
  CHECK(ran.code == 2);
  CHECK(ran.out.empty());
  CHECK(lines(ran.err).size() == 1);
  for (const std::string& part : parts) {
    INFO(part);
    CHECK(contains(ran.err, part));
  }
}

}  // namespace delf::testing

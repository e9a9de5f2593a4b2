// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"

namespace delf::testing {

/// A Python that has numpy and h5py. The one that comes first on the path need not be the one that Debian's packages
/// are for. The test fails if there is none.
inline std::string python(const Folder& folder) {
  for (const char* candidate : {"python3", "/usr/bin/python3"})
    if (shell(folder, std::string(candidate) + " -c 'import h5py, numpy'").code == 0) return candidate;
  FAIL("install python3-numpy and python3-h5py: tools/setup does");
  return {};
}

}  // namespace delf::testing

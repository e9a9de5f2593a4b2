// SPDX-License-Identifier: MIT
#pragma once
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "tools/scene/scene.hpp"

namespace delf {

/// The results of `delf verify` without its files, as texts: its report and verify.json.
struct VerifyInMemory {
  std::string status, report, json;
  bool passed = false;
  std::exception_ptr failure;  ///< of the numerics, after which the checks so far are there; null if there is none
};

/// Checks the rows of a scene on a lattice, or those of the file `fields`, without a word. Interrupt::asked() ends it
/// early. Throws BadScene.
VerifyInMemory verify_in_memory(const Scene&, const std::optional<std::string>& fields,
                                const std::vector<std::string>& nearby);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <string>
#include <vector>

namespace delf {

class FieldTheory;
struct Problem;

/// A theory that a scene can name: one constant of this type stands at the end of each file in schemes/theories/.
struct TheoryEntry {
  const char* name;
  const char* formula;
  std::vector<std::string> parameters;  ///< scene keys that it reads
  std::unique_ptr<FieldTheory> (*make)(const Problem&);
};

/// The list of all of them: a new theory adds one line there.
const std::vector<const TheoryEntry*>& theory_entries();

}  // namespace delf

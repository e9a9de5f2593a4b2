// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <vector>

#include "jets/symmetry.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

class FieldTheory;
struct NamedScheme;
struct Problem;

/// What a scheme is made of: stencil families over one lattice, and the components that they read.
struct SchemeParts {
  std::vector<std::shared_ptr<const StencilFamily>> families;
  std::vector<Component> components;
  std::vector<LinearSymmetry> symmetries =
      {};  ///< that the families have: the theory's, where it is its density that they carry
};

/// A scheme family that a scene can name by scheme.method: one constant of this type stands at the end of each file in
/// schemes/methods/.
struct MethodEntry {
  const char* name;
  const char* formula;
  /// Throws BadInput for what the method cannot be built for.
  SchemeParts (*build)(const FieldTheory&, const Problem&);
  /// The schemes that its keys tell apart; null where there is one, of the method's name. `base.method` is the
  /// method's.
  std::vector<NamedScheme> (*variants)(const Problem& base) = nullptr;
};

/// The list of all of them: a new method adds one line there.
const std::vector<const MethodEntry*>& method_entries();

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/methods/method_registry.hpp"

namespace delf {

/// True if a mesh takes the method by its name. The method that reads lattice.stencil is the usual one there, with stencils
/// and steps of a mesh's own.
inline bool is_named_on_meshes(const MethodEntry& method) { return method.on_meshes && !method.reads_stencil; }

/// True if lattice.time_steps = reversible is for the method on a lattice.
inline bool has_reversible_steps(const MethodEntry& method) { return method.row_density && !method.reads_stencil; }

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>

#include "schemes/complex/stencil_list.hpp"

namespace delf {

/// Whether a text begins with the line `complex`: a finite complex, and no mesh of space.
bool is_stencil_text(std::string_view text);

/// A finite complex from text:
///
///     complex
///     circle LENGTH                                           x is periodic; a line if this is left out
///     site T X [Y [Z]] [free | given | initial | final]       see SiteRole; free if none is named
///     stencil SHAPE I J … [share NUMBER]                      see StencilShapeKind; sites by number from 0
///
/// Throws MeshError for what cannot be read and for every fault of find_fault().
StencilList parse_stencils(std::string_view text);

/// As parse_stencils() reads it back, to the bit.
std::string stencil_text(const StencilList&);

}  // namespace delf

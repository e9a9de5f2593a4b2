// SPDX-License-Identifier: MIT
#pragma once

namespace delf {

/// The text of CITATION.cff.
extern const char* const citation;

}  // namespace delf

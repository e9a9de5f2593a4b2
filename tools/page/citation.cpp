// SPDX-License-Identifier: MIT
#include "tools/page/citation.hpp"

namespace delf {

const char* const citation =
#include "citation.inc"  // made of CITATION.cff
    ;

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/cite/citation.hpp"

namespace delf {

const char* const citation =
#include "citation.inc"  // made of CITATION.cff
    ;

}  // namespace delf

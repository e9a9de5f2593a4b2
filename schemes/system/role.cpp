// SPDX-License-Identifier: MIT
#include "schemes/system/lattice_system.hpp"

namespace delf {

const char* to_string(Role role) {
  switch (role) {
    case Role::field:
      return "field";
    case Role::inner:
      return "inner";
    case Role::multiplier:
      return "multiplier";
    case Role::trace:
      return "trace";
    case Role::slaved:
      return "slaved";
  }
  return "";
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/methods/method_registry.hpp"

namespace delf {

extern const MethodEntry multisymplectic_method, vu_quoc_li_method, guo_method, spacetime_method, r_adaptive_method,
    damped_method, composition_method;

const std::vector<const MethodEntry*>& method_entries() {
  static const std::vector<const MethodEntry*> entries{&multisymplectic_method, &composition_method, &spacetime_method,
                                                       &r_adaptive_method,      &vu_quoc_li_method,  &guo_method,
                                                       &damped_method};
  return entries;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/methods/method_registry.hpp"

#include "schemes/unknown_name.hpp"

namespace delf {

extern const MethodEntry multisymplectic_method, vu_quoc_li_method, guo_method, spacetime_method, r_adaptive_method,
    damped_method, composition_method, processed_method, cgvi_method, dgvi_method, radau_iia_method;

namespace {

std::vector<const MethodEntry*>& entries() {
  static std::vector<const MethodEntry*> all{&multisymplectic_method, &composition_method, &processed_method,
                                             &spacetime_method,       &cgvi_method,        &dgvi_method,
                                             &r_adaptive_method,      &vu_quoc_li_method,  &guo_method,
                                             &damped_method,          &radau_iia_method};
  return all;
}

}  // namespace

const std::vector<const MethodEntry*>& method_entries() { return entries(); }
void register_method(const MethodEntry& entry) { entries().push_back(&entry); }

const MethodEntry& find_method(const std::string& name) { return find_entry(method_entries(), "scheme.method", name); }

const char* to_string(StartRule rule) {
  switch (rule) {
    case StartRule::exact:
      return "exact";
    case StartRule::centred:
      return "centred";
    case StartRule::legendre:
      return "legendre";
    case StartRule::values:
      return "values";
  }
  return "";
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "lattice/error.hpp"

namespace delf {

/// A value that none of the known names is, with the nearest of them.
BadInput unknown_name(const std::string& key, const std::string& value, const std::vector<std::string>& names);

/// The entry of that name; throws unknown_name() if there is none.
template <class Entry>
const Entry& find_entry(const std::vector<const Entry*>& entries, const std::string& key, const std::string& name) {
  std::vector<std::string> names;
  for (const Entry* entry : entries) {
    if (entry->name == name) return *entry;
    names.push_back(entry->name);
  }
  throw unknown_name(key, name, names);
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/report/machine.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

// Common parts of the files in JSON: summary, verify, sweep, convergence, stability and workprecision.

/// JSON with keys in order. A number that is not finite is written as null.
using Json = nlohmann::ordered_json;

inline Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

/// The head: which version found it, on which machine, of which scene.
inline Json json_head(const std::string& scene) {
  return {
      {"version", DELF_VERSION}, {"scene", scene}, {"machine", machine_in_words()}, {"compiler", compiler_in_words()}};
}
inline Json json_head(const Scene& scene) { return json_head(scene.name); }

/// The array of what `json_of` makes of each element.
template <class Element, class JsonOf>
Json json_list(const std::vector<Element>& all, JsonOf json_of) {
  Json list = Json::array();
  for (const Element& one : all) list.push_back(json_of(one));
  return list;
}

/// The text of a file; bytes that are no UTF-8 are replaced.
inline std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace delf

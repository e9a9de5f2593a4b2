// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace delf {

/// The numbers that a key may take: low ≤ value ≤ high, or low < value where the lower end is open.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool open = false;
};

using ParameterValue = std::variant<double, int, std::string>;

/// Values of another key, in whose presence a key has no effect.
struct Without {
  std::string key;
  std::vector<std::string> values;
};

/// A key of a scene that a theory, a method or a state declares.
struct Parameter {
  std::string key;                        ///< "scheme.alpha"
  ParameterValue fallback;                ///< in force when the key is not given; its type is that of the key
  std::string help;                       ///< what it means
  std::string unit = {};                  ///< "1/length"
  Limits range = {};                      ///< of a number
  std::vector<std::string> choices = {};  ///< of a string; empty: any text
  std::string otherwise = {};             ///< if not empty, there is no fallback, and this says what holds: "L/2"
  std::vector<Without> without = {};      ///< who gives it all the same is warned
};

/// Values of parameters by their keys: values["scheme.alpha"] = 2.5; values.get<double>("scheme.alpha").
class ParameterValues {
 public:
  ParameterValue& operator[](std::string_view key) { return values_.try_emplace(std::string(key)).first->second; }
  bool has(std::string_view key) const { return values_.contains(key); }

  /// The value as double, int or std::string; an int is a double too. Empty if there is none of that key.
  template <class T>
  std::optional<T> maybe(std::string_view key) const {
    const auto at = values_.find(key);
    if (at == values_.end()) return std::nullopt;
    if (const T* value = std::get_if<T>(&at->second)) return *value;
    if constexpr (std::is_same_v<T, double>)
      if (const int* value = std::get_if<int>(&at->second)) return *value;
    throw std::logic_error(at->first + ": the value is of another type than the one asked for");
  }
  /// The value of a parameter that must be there; throws std::logic_error if there is none.
  template <class T>
  T get(std::string_view key) const {
    if (auto value = maybe<T>(key)) return *value;
    throw std::logic_error(std::string(key) + ": no value");
  }

  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }

 private:
  std::map<std::string, ParameterValue, std::less<>> values_;
};

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/scene/keys.hpp"
#include "tools/scene/settings.hpp"

namespace delf {

/// The values of settings, read as the table of keys says: the type, the range, the choices, and what is in force when
/// a key is not given. Whatever cannot be read is a BadScene that names its place.
class Values {
 public:
  explicit Values(const Settings& settings) : settings_(settings) {}

  bool given(std::string_view key) const { return settings_.find(key) != nullptr; }
  /// The text in force, if there is any.
  std::optional<std::string> text(std::string_view key) const;

  double real(std::string_view key) const;
  std::int64_t integer(std::string_view key) const;
  bool toggle(std::string_view key) const;
  std::string choice(std::string_view key) const;
  std::vector<double> times(std::string_view key) const;
  /// The value of a parameter, by the type of its fallback.
  ParameterValue parameter(const Parameter&) const;

  std::optional<double> maybe_real(std::string_view key) const;
  std::optional<std::int64_t> maybe_integer(std::string_view key) const;

  /// Reads a key for its errors only.
  void check(const Parameter&) const;

 private:
  /// The key as the scene's own theory or method declares it.
  Parameter known(std::string_view key) const;
  std::string required(std::string_view key) const;
  double number(const Parameter&, std::string_view text) const;
  /// The value of a formula of numbers, pi and the parameters that the scene's theory declares; nothing if it is none.
  std::optional<double> formula(std::string_view key, std::string_view text) const;
  const Settings& settings_;
};

}  // namespace delf

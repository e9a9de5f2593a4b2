// SPDX-License-Identifier: MIT
#pragma once
#include <stdexcept>
#include <string>
#include <utility>

namespace delf {

/// The base of everything delf throws on purpose. `what()` is one line: what, where, why, remedy.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The request itself cannot be met (exit code 2). `key()` names the scene key that asked for it, such as
/// "lattice.sites", or is empty; the program puts file and line in front.
class BadInput : public Error {
 public:
  BadInput(std::string key, const std::string& message) : Error(message), key_(std::move(key)) {}
  const std::string& key() const noexcept { return key_; }

 private:
  std::string key_;
};

/// The numerics failed (exit code 3); the stepper still holds the last good rows.
struct NumericalFailure : Error {
  using Error::Error;
};

/// An implicit step could not be solved.
struct NoConvergence : NumericalFailure {
  using NumericalFailure::NumericalFailure;
};

/// A value is not finite, or a wrapped difference left the range in which wrapping is unambiguous.
struct NotFinite : NumericalFailure {
  using NumericalFailure::NumericalFailure;
};

/// Sites of a moving mesh would cross.
struct MeshCrossing : NumericalFailure {
  using NumericalFailure::NumericalFailure;
};

}  // namespace delf

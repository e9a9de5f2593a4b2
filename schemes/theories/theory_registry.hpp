// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "schemes/parameter.hpp"

namespace delf {

class FieldTheory;
class StencilFamily;

/// A theory that a scene can name by theory.name: one constant of this type stands at the end of each file in
/// schemes/theories/.
struct TheoryEntry {
  std::string name;
  std::string formula;
  std::vector<Parameter> parameters;  ///< that it reads
  /// Makes the theory from the values of all its parameters.
  std::unique_ptr<FieldTheory> (*make)(const ParameterValues&);
  bool angle = false;  ///< the field is an angle: values 2π apart are the same state
  /// All components have this value in the state about which the linear limits of a run are found; none: they are not.
  std::optional<double> vacuum = {};

  /// Keys of its own that choose it where a scene does not give theory.name.
  std::vector<std::string> chosen_by = {};
  /// Parameters that the values of those above declare; null: none.
  std::vector<Parameter> (*further)(const ParameterValues&) = nullptr;
  /// Its action on cells whose sites move, in closed form, fields and then X piecewise linear in space: of a whole step by
  /// the trapezoidal rule, and of one point of an element, of (φ, X) at both ends, then of h (φ_t, X_t). Null: by quadrature.
  std::shared_ptr<const StencilFamily> (*moving_rectangle)(const ParameterValues&) = nullptr;
  std::shared_ptr<const StencilFamily> (*moving_stage)(const ParameterValues&, double weight) = nullptr;
  std::string words = {};                 ///< in a paper: "the sine-Gordon equation"
  std::vector<std::string> sources = {};  ///< its density, as keys of tools/cite/references.bib
};

/// m and λ, which several theories have.
Parameter mass_parameter();
Parameter lambda_parameter();

/// All theories, the built-in ones first: a new theory adds one line there.
const std::vector<const TheoryEntry*>& theory_entries();
/// Adds a theory of a program's own, before the first scene is read; the entry must outlive all use.
void register_theory(const TheoryEntry&);
/// Throws BadInput, with the nearest name, if there is none of that name.
const TheoryEntry& find_theory(const std::string& name);
/// All that it reads, with what these values declare. Throws BadInput for values that declare none.
std::vector<Parameter> parameters_of(const TheoryEntry&, const ParameterValues&);
/// Makes a theory, with the fallbacks of parameters that are not given. Throws BadInput for values out of range.
std::unique_ptr<FieldTheory> make_theory(const TheoryEntry&, ParameterValues given = {});

}  // namespace delf

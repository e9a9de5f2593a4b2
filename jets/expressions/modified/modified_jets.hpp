// SPDX-License-Identifier: MIT
#pragma once
#include <map>
#include <tuple>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "jets/expressions/print.hpp"
#include "lattice/index.hpp"

namespace delf::expressions {

/// The variables of a modified Lagrangian by number: h, k, x, t, the parameters, and the jets.
class ModifiedJets {
 public:
  enum : int { h, k, x, t, parameters };

  /// ∂ᵗ∂ⁿ of field a. Kind 0 is the field itself, with in_t = 0 or 1; kind c what node c of a cell differs from it by.
  struct Derivative {
    int kind, in_t, field, in_x;
    auto operator<=>(const Derivative&) const = default;
  };

  explicit ModifiedJets(const ExpressionNames& names) : names_(names) {}

  int number(const Derivative& jet) {
    const auto [place, made] = known_.try_emplace(jet, first() + static_cast<int>(jets_.size()));
    if (made) jets_.push_back(jet);
    return place->second;
  }
  bool is_jet(int variable) const { return variable >= first(); }
  const Derivative& jet(int variable) const { return jets_[at(variable - first())]; }
  bool is_difference(int variable) const { return is_jet(variable) && jet(variable).kind > 0; }
  int fields() const { return static_cast<int>(names_.fields.size()); }
  const ExpressionNames& names() const { return names_; }
  /// All that have been asked for, by number from first().
  const std::vector<Derivative>& jets() const { return jets_; }
  int first() const { return parameters + static_cast<int>(names_.parameters.size()); }

  std::string name(int variable, Notation) const;

 private:
  const ExpressionNames names_;
  std::map<Derivative, int> known_;
  std::vector<Derivative> jets_;
};

}  // namespace delf::expressions

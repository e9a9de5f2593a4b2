// SPDX-License-Identifier: MIT
#include "jets/expressions/modified/modified_jets.hpp"

#include "lattice/index.hpp"

namespace delf::expressions {

std::string ModifiedJets::name(int variable, Notation notation) const {
  const auto styled = [&](const std::string& name) {
    return notation == Notation::latex ? latex_name(name) : notation == Notation::mathml ? mathml_name(name) : name;
  };
  constexpr const char* letters[] = {"h", "k", "x", "t"};
  if (variable < parameters) return styled(letters[variable]);
  if (!is_jet(variable)) return styled(names_.parameters[at(variable - parameters)].first);
  const auto& [kind, in_t, field, in_x] = jet(variable);
  const std::string by = std::string(at(in_t), 't') + std::string(at(in_x), 'x');
  if (notation == Notation::mathml) {
    std::string below;
    for (const char letter : by) below.append("<mi>").append(1, letter).append("</mi>");
    return mathml_name(names_.fields[at(field)], below);
  }
  const std::string base = styled(names_.fields[at(field)]);
  if (by.empty()) return base;
  if (notation == Notation::plain) return base + "_" + by;
  if (base.back() == '}' && base.find("_{") != std::string::npos)  // one subscript: u_{1,tt}
    return base.substr(0, base.size() - 1) + "," + by + "}";
  return base + "_{" + by + "}";
}

}  // namespace delf::expressions

// SPDX-License-Identifier: MIT
#include "schemes/theories/theory_text.hpp"

#include <algorithm>

#include "lattice/text_parts.hpp"
#include "schemes/declared.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

const std::vector<TheoryText>& theory_texts() {
  static const std::vector<std::pair<std::string, std::string>> mass{{"m", "theory.mass"}}, lambda{{"lambda", "theory.lambda"}},
      both{{"m", "theory.mass"}, {"lambda", "theory.lambda"}};
  static const std::vector<TheoryText> all{
      {"wave", "0.5*phi_t^2 - 0.5*phi_x^2"},
      {"klein-gordon", "0.5*phi_t^2 - 0.5*phi_x^2 - 0.5*m^2*phi^2", "phi", mass},
      {"sine-gordon", "0.5*phi_t^2 - 0.5*phi_x^2 + m^2*cosm1(phi)", "phi", mass},
      {"phi4", "0.5*phi_t^2 - 0.5*phi_x^2 - 0.25*lambda*(phi^2 - 1)^2", "phi", lambda},
      {"double-sine-gordon", "0.5*phi_t^2 - 0.5*phi_x^2 + m^2*cosm1(phi) + 0.5*lambda*cosm1(2*phi)", "phi", both},
      {"sine-gordon-impurity",
       "0.5*phi_t^2 - 0.5*phi_x^2 + m^2*(1 + epsilon*exp(-((x - x0)/w)^2))*cosm1(phi)",
       "phi",
       {{"m", "theory.mass"}, {"epsilon", "theory.strength"}, {"w", "theory.width"}, {"x0", "theory.position"}}},
      {"coupled-sine-gordon",
       "0.5*(u_t^2 - u_x^2 + v_t^2 - v_x^2) + m^2*(cosm1(u) + cosm1(v)) + lambda*cosm1(u - v)", "u, v", both},
      {"complex-klein-gordon",
       "let s = u^2 + v^2; 0.5*(u_t^2 + v_t^2 - u_x^2 - v_x^2) - 0.5*m^2*s - 0.25*lambda*s^2", "u, v", both, "",
       "-v, u"},
      {"wave-map", "0.5*(u_t^2 + v_t^2 + w_t^2 - u_x^2 - v_x^2 - w_x^2)", "u, v, w", {}, "u^2 + v^2 + w^2 - 1",
       "0, -w, v; w, 0, -u; -v, u, 0"},
      {"pendulum",
       "0.5*phi_t^2 + m^2*(g/l)*cosm1(phi)",
       "phi",
       {{"m", "theory.mass"}, {"g", "theory.gravity"}, {"l", "theory.arm"}}},
      {"kepler", "0.5*(u_t^2 + v_t^2) + mu/sqrt(u^2 + v^2)", "u, v", {{"mu", "theory.gm"}}, "", "-v, u"},
      {"harmonic-oscillator", "0.5*phi_t^2 - 0.5*m^2*phi^2", "phi", mass},
      {"henon-heiles", "0.5*(u_t^2 + v_t^2) - 0.5*(u^2 + v^2) - u^2*v + v^3/3", "u, v"},
      {"double-pendulum", "u_t^2 + 0.5*v_t^2 + u_t*v_t*cos(u - v) + 2*cosm1(u) + cosm1(v)", "u, v"},
      {"spherical-pendulum", "0.5*(u_t^2 + v_t^2 + w_t^2) - w", "u, v, w", {}, "u^2 + v^2 + w^2 - 1", "-v, u, 0"},
      {"lotka-volterra", "(v + log(v)/u)*u_t + u*v_t - (u + v - log(u) - 2*log(v))", "u, v", {}, "", "",
       {"theory.gauge", "full"}},
      {"lotka-volterra", "log(v)/u*u_t - (u + v - log(u) - 2*log(v))", "u, v", {}, "", "", {"theory.gauge", "x"}},
      {"lotka-volterra", "0.5*(log(v)/u*u_t - log(u)/v*v_t) - (u + v - log(u) - 2*log(v))", "u, v", {}, "", "",
       {"theory.gauge", "symmetric"}},
      {"point-vortices",
       "0.5*(a1*b1_t - b1*a1_t) + 0.4*(a2*b2_t - b2*a2_t) - 0.25*(a3*b3_t - b3*a3_t)"
       " + (0.8*log((a1 - a2)^2 + (b1 - b2)^2) - 0.5*log((a1 - a3)^2 + (b1 - b3)^2)"
       " - 0.4*log((a2 - a3)^2 + (b2 - b3)^2))/(4*pi)",
       "a1, b1, a2, b2, a3, b3"},
      {"two-vortices",
       "let s1 = 1 + a1^2 + b1^2; let s2 = 1 + a2^2 + b2^2;"
       " 0.25*(s1*(a1*b1_t - b1*a1_t) + s2*(a2*b2_t - b2*a2_t)) - s1*s2*log((a1 - a2)^2 + (b1 - b2)^2)/(8*pi)",
       "a1, b1, a2, b2"},
      {"charged-particle", "0.5*(1 + u^2 + v^2)*(u*v_t - v*u_t) - cos(u) - sin(v)", "u, v"},
      {"guiding-centre",
       "let s = (R - 2)^2 + Z^2; let B = 5*sqrt(s/4 + 4)/R;"
       " (5*Z/R - 2.5*u*Z/(R*B))*R_t + (2.5*u*(R - 2)/(R*B) - 5*log(R/2))*Z_t - (1.25*s + 10*u/B)*phi_t"
       " - 0.5*u^2 - 0.01*B",
       "R, Z, phi, u"}};
  return all;
}

std::shared_ptr<const SymbolicDensity> text_of(const std::string& theory, ParameterValues given) {
  for (const char* unit : {"theory.speed", "theory.scale"})
    if (given.maybe<double>(unit).value_or(1) != 1) return nullptr;
  complete(given, find_theory(theory).parameters);
  const auto text = std::ranges::find_if(theory_texts(), [&](const TheoryText& one) {
    return one.theory == theory &&
           (one.choice.first.empty() || given.get<std::string>(one.choice.first) == one.choice.second);
  });
  if (text == theory_texts().end()) return nullptr;
  ExpressionNames names{parts_of(text->fields), {}};
  for (const auto& [name, key] : text->parameters) names.parameters.emplace_back(name, given.get<double>(key));
  return expression(text->density, names, "theory.name", {.symmetries = {}, .up_to_divergence = {}, .constraint = text->constraint});
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "jets/symmetry.hpp"
#include "schemes/verify/drawn_region.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The [verify] keys of a scene.
struct VerifyRequest {
  std::vector<RegionRequest> regions;
  std::vector<std::string> checks;  ///< names of verify_checks()
  bool chosen = false;              ///< the scene names its checks
  int variations = 2;
  int moments = 8;
  double tolerance = 1e-13;
  bool own_tolerance = false;  ///< the scene gives it
  std::string generator;       ///< empty: none
  bool force = false;
  bool identify = false;  ///< a diagnosis of rows that pass, too
  bool unwrap = false;    ///< rows of a file are reduced modulo 2π
  std::string fault;      ///< none, variation, sign, field

  bool wants(std::string_view check) const;
};

/// The names of checks: forms, equations, noether, balance, reversal, derivatives, newton.
const std::vector<std::string>& verify_checks();

/// Throws BadScene.
VerifyRequest read_verify_request(const Scene&);

/// Behind other symmetries that of verify.generator, as text for fields of these names; none if it is empty. Throws BadScene.
void add_generator(const Scene&, const std::string& text, const std::vector<std::string>& fields,
                   std::vector<LinearSymmetry>& all);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "schemes/complex/complex_noether.hpp"
#include "schemes/complex/complex_system.hpp"
#include "tools/complex/complex_scene.hpp"
#include "tools/scene/values.hpp"
#include "tools/verify/verdict.hpp"

namespace delf {

/// What is checked of any complex of a scene, and of the values on it: the equations, the form formula and Noether's theorem
/// on connected sets of sites drawn at random, the local identity of the forms, the constraint.
class MeshChecks {
 public:
  MeshChecks(const ComplexScene&, const Values&);

  void look_at(const ComplexSystem&, std::vector<double> y, const std::string& where);
  /// Of row after row of fields.
  void look_at_constraint(std::span<const double> fields, const std::string& where);
  /// Into a verdict, in the order of reports, and what was left out.
  void add_to(Verdict&) const;

  const std::string& fault() const { return fault_; }
  int variations() const { return variations_; }
  std::mt19937_64& random() { return random_; }

 private:
  static constexpr std::array<int, 5> sizes{1, 3, 9, 27, 60};  ///< sites of a set

  std::vector<LinearSymmetry> symmetries(const Values&);
  void look_at_equations(const ComplexSystem&, std::span<const double> y, const std::string& where);
  std::string name_of(const ComplexSystem&, int site) const;

  const ComplexScene& scene_;
  int variations_;
  std::string fault_, worst_site_;
  std::mt19937_64 random_;
  Check equations_, constraint_, local_;
  std::vector<Check> forms_;
  std::vector<std::string> left_out_;
  std::optional<ComplexNoether> noether_;
  std::vector<RegionPoint> points_;
  std::int64_t stencils_ = 0;
};

}  // namespace delf

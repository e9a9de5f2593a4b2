// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "jets/symmetry.hpp"
#include "schemes/verify/noether_check.hpp"
#include "tools/complex/complex_scene.hpp"
#include "tools/scene/values.hpp"
#include "tools/verify/checked_rows.hpp"
#include "tools/verify/verdict.hpp"

namespace delf {

/// The checks of any rows of a scene on a mesh, and of any complex: the equations, the form formula and Noether's theorem on
/// connected sets of sites drawn at random, the local identity of the forms, the constraint.
class MeshChecks {
 public:
  MeshChecks(const ComplexScene&, const Values&);

  void look_at(CheckedRows, const std::string& where);
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
  void break_a_value(const RegionSystem&, Window&);
  void look_at_equations(const CheckedRows&, const std::string& where);
  std::string name_of(const CheckedRows&, Site) const;

  const ComplexScene& scene_;
  int variations_;
  std::string fault_, worst_site_;
  std::mt19937_64 random_;
  Check equations_, constraint_, local_;
  std::vector<Check> forms_;
  std::vector<std::string> left_out_;
  std::vector<LinearSymmetry> symmetries_;
  bool forced_;
  std::optional<NoetherCheck> noether_;
  std::vector<RegionPoint> points_;
  std::int64_t stencils_ = 0;
};

}  // namespace delf

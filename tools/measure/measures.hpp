// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tools/measure/measurement.hpp"
#include "tools/outcome/named_number.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The keys measure.NAME of a scene, each an expression of measurements: `2*speed(1)`, `kinks - value(L/2)`. Their
/// arithmetic is that of densities as text, with the theory's parameters, L, and t, the time of the last row.
class Measures {
 public:
  /// Throws BadScene for what cannot be read, or measured in this scene.
  Measures(const Scene&, int winding, const Simulation&);
  ~Measures();
  Measures(const Measures&) = delete;
  Measures& operator=(const Measures&) = delete;

  bool empty() const { return all_.empty(); }
  /// A recorded row of the fields, and the row before it (row 1 for row 0) where it is held.
  void see(const MeasuredRow&);
  /// The row of any step, for measurements that see all of them.
  void see_step(const MeasuredRow&);
  bool sees_steps() const { return sees_steps_; }
  std::vector<NamedNumber> results() const;
  void visit(SavedState&);

 private:
  struct Expression;
  std::vector<Expression> all_;
  double time_ = 0;
  bool sees_steps_ = false;
};

}  // namespace delf

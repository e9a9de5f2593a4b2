// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lattice/space/joined_mesh.hpp"
#include "lattice/space/mesh_space.hpp"
#include "tools/complex/place_formula.hpp"
#include "tools/scene/settings.hpp"

namespace delf {

struct CellSpace;

/// The conditions that a scene puts on the boundary of its mesh by boundary.mesh and boundary.NAME, NAME being a part of it:
///
///     fixed, natural                     φ is kept, or free
///     a formula of t, x, y and z         φ follows it; without time it is the value there
///     periodic:OTHER                     space goes on from this part to another one
///     boundary.NAME.flux = a formula     ∂ℓ/∂(slope along the normal), of a natural part: what flows in
///
/// boundary.part.NAME is the same, for a part that has the name of some other key.
class MeshBoundary {
 public:
  /// Throws BadScene for what is none of these, for parts that are not there, and where conditions exclude each other. `numbers`
  /// may stand in formulas; `fields` are the theory's.
  MeshBoundary(const Settings&, const Mesh&, bool otherwise_fixed, const std::vector<std::string>& fields,
               const std::vector<std::pair<std::string, double>>& numbers);

  const std::vector<JoinedParts>& joined_parts() const { return joined_; }
  /// Puts the conditions on a mesh whose parts have been joined. A point between parts is driven if one is, or else held if
  /// one is.
  void put_on(MeshSpace&) const;
  /// Throws BadScene for formulas whose values at t = 0 break the constraint of a space that they have been put on.
  void require_constraint(const Settings&, const CellSpace&) const;
  /// The first key with a formula, of a value or a flux; empty: there is none.
  const std::string& key_of_formula() const { return key_of_formula_; }
  /// The first formula that reads t; empty: there is none.
  const std::string& key_that_reads_time() const { return key_that_reads_time_; }

 private:
  struct Data;
  class AtPlace;

  bool otherwise_fixed_;
  std::vector<PartCondition> conditions_;
  std::vector<std::shared_ptr<const Data>> motions_, fluxes_;
  std::vector<JoinedParts> joined_;
  std::string key_of_formula_, key_that_reads_time_;
};

/// True if G is rounding, by Σ |∂G/∂φ φ|.
bool keeps_constraint(double G, std::span<const double> slopes, std::span<const double> fields);

/// Throws BadScene where boundary.NAME is a key of other spaces, which a part of a mesh may have as its name.
void refuse_keys_of_lattices(const Settings&);

}  // namespace delf

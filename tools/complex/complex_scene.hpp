// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/complex/cell_space.hpp"
#include "schemes/complex/stencil_list.hpp"
#include "schemes/complex/tiling.hpp"
#include "schemes/theories/field_theory.hpp"
#include "tools/complex/place_formula.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// How time goes on over a mesh.
enum class MeshTime {
  rows,   ///< all sites at once
  none,   ///< there is none: data all round, an elliptic problem
  cells,  ///< each cell by its own step: asynchronous
  sites   ///< each site has its own: a finite complex of spacetime, given as such
};

/// A scene on a mesh, read and resolved.
struct ComplexScene {
  explicit ComplexScene(Scene given) : scene(std::move(given)) {}

  Scene scene;  ///< name, settings, problem, steps, records
  std::shared_ptr<const FieldTheory> theory;
  std::shared_ptr<const CellSpace> space;       ///< a mesh; none where the complex is one of spacetime:
  std::unique_ptr<const StencilList> stencils;  ///< then these
  std::filesystem::path mesh_file;              ///< empty: generated
  Tiling tiling;                                ///< of stencils of a file
  MeshTime time = MeshTime::rows;

  struct Field {
    std::string name;
    std::optional<PlaceFormula> value, rate, exact;
  };
  std::vector<Field> fields;

  /// A method that is not the usual one.
  bool has_method() const;
  /// The problem of rows of real numbers.
  Problem problem_on_mesh() const;
  /// Steps that the field chooses (schemes/methods/mesh_rows.hpp): of this strength, with time_step for ε.
  const std::optional<double>& step_control() const { return scene.problem.step_control; }
  /// Solved at once: there are no steps.
  bool is_one_problem() const { return time == MeshTime::none || time == MeshTime::sites; }
  int sites() const;
  int cells() const;
  /// The coordinates of a site, and all of them, site by site: t x y z in spacetime, x y z on a mesh.
  int coordinates() const;
  std::vector<double> places() const;
  /// Rows have a boundary that is driven, or that something flows in through: energies change by its work.
  bool boundary_works() const { return space && time == MeshTime::rows && space->boundary_works(); }
  bool has_solution() const { return fields.front().exact.has_value(); }
  /// φ and φ_t at t = 0, and the solution, if there is one, at any time; [i·d + a].
  std::vector<double> values() const;
  std::vector<double> rates() const;
  std::vector<double> solution(double t) const;
  /// "36.5 cells of ..." for reports
  std::string mesh_in_words() const;
  /// "Euler characteristic 1, 1 boundary curve"; nothing of stencils that are no cells.
  std::string topology_in_words() const;
  std::string state_in_words() const;

 private:
  /// [i·d + a]; a formula that is not there is 0. Sites of a finite complex have times of their own in place of t.
  std::vector<double> of_sites(double t, const std::vector<const PlaceFormula*>& formulas) const;
};

/// Whether a scene's space is a mesh. Throws BadScene for what is no scene.
bool is_on_mesh(const Settings&);
/// `halvings`: on the mesh whose sides are halved so often, with steps as much shorter, and as many more.
ComplexScene read_complex_scene(Settings, int halvings = 0);

/// A scene on a lattice, or on a mesh.
using AnyScene = std::variant<Scene, ComplexScene>;
AnyScene read_any_scene(Settings);
inline Scene& common_part(Scene& scene) { return scene; }
inline Scene& common_part(ComplexScene& c) { return c.scene; }

/// The scene with what is in force: it runs again to the same bits.
std::string resolved_text(const ComplexScene&);

}  // namespace delf

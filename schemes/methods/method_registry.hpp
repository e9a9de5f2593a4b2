// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "jets/symmetry.hpp"
#include "jets/tables/splitting.hpp"
#include "schemes/parameter.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

class FieldTheory;
struct EnergyEntry;
struct FieldPoint;
struct NamedScheme;
struct Problem;
struct RowDensity;
class StepMethod;

/// The parts of a scheme: stencil families over one lattice, and the components that they read.
struct SchemeParts {
  std::vector<std::shared_ptr<const StencilFamily>> families;
  std::vector<Component> components;
  std::vector<LinearSymmetry> symmetries =
      {};                    ///< that the families have: the theory's, where it is its density that they carry
  Processor processor = {};  ///< if rows are those of a kernel
  std::vector<std::string> remarks = {};  ///< lines for `delf plan`
  /// Makes a stepper of the scheme's own; none: one that follows the plan.
  std::function<std::unique_ptr<StepMethod>(const LatticeSystem&)> stepper = {};
};

/// The rule for row 1: the known solution; the field equation at row 0; the discrete Legendre transform there; a step
/// of a scheme of first order in time, which needs no more than the values of row 0.
enum class StartRule { exact, centred, legendre, values };
inline constexpr std::array all_start_rules{StartRule::exact, StartRule::centred, StartRule::legendre,
                                            StartRule::values};
const char* to_string(StartRule);

/// The last rows of a run, of all components.
struct RowsInTime {
  const FieldTheory& theory;
  const LatticeSystem& system;
  Window rows;          ///< the newest two; for a dataset of a row below, that row and all above it
  std::int64_t newest;  ///< index of the newest
  double time_step;     ///< of the step below it
};

/// A quantity that series.csv has a column for.
struct Monitor {
  std::string name;
  double (*value)(const RowsInTime&);
  /// A run warns by these words, what it means and a remedy, if the value grows far beyond what it is early; null: never.
  const char* when_it_grows = nullptr;
  /// The value of recorded rows that summary.json has: true for the least, false for the largest.
  bool least = false;
  const char* when_above_1 = nullptr;  ///< a run warns by these words if the value passes 1; null: never
};

/// A data set of fields.h5 beside the components, frames × sites × values for every recorded row, which a method
/// declares. It is found where a row is recorded, and costs nothing elsewhere.
struct Dataset {
  std::string name;     ///< of the dataset: "momentum" is /momentum; not the name of a role
  std::string meaning;  ///< its attribute `meaning`
  /// The names of the values at a site.
  std::vector<std::string> (*components)(const FieldTheory&);
  /// The values of one row, [i · components + a]: the newest, or at the start of a run one below it.
  std::vector<double> (*values)(const RowsInTime&, std::int64_t row);
};

/// The places at which the sites of a mesh that moves start, and their speeds.
struct MovingSites {
  std::vector<double> X, X_t;
};

/// A method that a scene can name by scheme.method: one constant of this type stands at the end of each file in
/// schemes/methods/.
struct MethodEntry {
  std::string name;
  std::string formula;
  /// The problem has the values of all parameters. Throws BadInput for what the method cannot be built for.
  SchemeParts (*build)(const FieldTheory&, const Problem&);

  std::vector<Parameter> parameters = {};  ///< that it reads
  bool reads_stencil = false;              ///< it reads lattice.stencil too
  bool on_meshes = false;  ///< built for a mesh too: a table of time on its sites and cells (take_to_mesh), from momenta
  /// The scheme in reports, from the values of all parameters; null: the name.
  std::string (*label)(const Problem&) = nullptr;

  std::vector<StartRule> starts = {StartRule::exact, StartRule::centred};  ///< that it knows
  /// When the scene gives none; empty: exact where the second row is known, or else centred.
  std::optional<StartRule> start = {};

  /// What a run records of the newest two rows; null: the theory's, on the jets of the symmetric rectangle.
  const EnergyEntry* energy = nullptr;
  const EnergyEntry* own_energy = nullptr;  ///< that its rows keep beside it
  std::vector<Monitor> monitors = {};
  /// The bound that the newest row puts on the step, in words; empty where nothing limits it.
  std::string (*limit)(const RowsInTime&) = nullptr;
  std::vector<Dataset> datasets = {};
  /// The density of steps, of a strength s, that lattice.time_steps = reversible follows, from the newest row and its
  /// momenta, [i·C + c]; null: its steps are all the same. For elements in time of one step, that start from momenta.
  /// A method that reads lattice.stencil has it on meshes alone.
  RowDensity (*row_density)(const RowsInTime&, std::span<const double> momenta, double strength) = nullptr;
  /// Places the sites that move for a field of row 0, (φ, φ_t, φ_x) at any x; null: they stay on the lattice.
  MovingSites (*place_sites)(const Problem&, int components,
                             const std::function<void(double x, std::span<FieldPoint>)>&) = nullptr;

  /// The schemes that its keys tell apart; null: one, of the method's name. `base.method` is the method's.
  std::vector<NamedScheme> (*variants)(const Problem& base) = nullptr;

  /// The order of the error at a fixed h/k, for smooth solutions, from the values of all parameters; null, or nothing: not
  /// known. `delf convergence` holds runs to it.
  std::optional<int> (*order)(const Problem&) = nullptr;

  /// The scheme as a clause of a paper, from the values of all parameters: "the Gauss method of two stages". Null: the label.
  std::string (*words)(const Problem&) = nullptr;
  std::vector<std::string> sources = {};  ///< the method, as keys of tools/cite/references.bib
  /// The sources of what its keys choose: a stencil, a splitting, a tableau. Null: nothing.
  std::vector<std::string> (*further_sources)(const Problem&) = nullptr;
};

/// All methods, the built-in ones first: a new method adds one line there.
const std::vector<const MethodEntry*>& method_entries();
/// Adds a method of a program's own, before the first scene is read; the entry must outlive all use.
void register_method(const MethodEntry&);
/// Throws BadInput, with the nearest name, if there is none of that name.
const MethodEntry& find_method(const std::string& name);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "lattice/lattice.hpp"
#include "schemes/parameter.hpp"

namespace delf {

/// The contents of a scene, in the engine's words.
struct Problem {
  std::string theory = "sine-gordon";
  bool circle_valued = false;  ///< theory.fibre = S1
  Lattice lattice = Lattice::circle(255, 40);
  int winding = 0;  ///< φ(x + L) = φ(x) + 2π·winding
  std::string stencil = "rectangle-symmetric";
  std::string method = "multisymplectic";
  ParameterValues parameters;  ///< of the theory and of the method; the others have their fallbacks
  double time_step = 0;
  double tolerance = 1e-14;                 ///< scheme.tolerance
  int predictor_order = 8;                  ///< scheme.seed_order
  int max_iterations = 50;                  ///< scheme.max_iterations
  int threads = 1;                          ///< run.threads: that explicit steps are shared by
  std::optional<double> step_control = {};  ///< s of steps that the rows choose; time_step is ε then
  std::vector<double> time_steps = {};      ///< lengths of the steps, over and over; empty: all are time_step
  /// Cells of a mesh with steps of their own: the step of each over its shortest edge. 0: all sites step together.
  double cell_courant = 0;
};

/// The problem with the fallbacks of all parameters that its theory and its method read. Throws BadInput for unknown
/// names and for values out of range.
Problem completed(Problem);
/// The scheme in reports, as its method declares it.
std::string scheme_label(const Problem&);

/// A scheme as a scene would name it: `problem` is what was asked for, with the keys that this scheme is made of.
struct NamedScheme {
  std::string name;
  Problem problem;
  int nodes = 1;       ///< in a cell of space
  int rank = 0;        ///< as a reference solution: the highest is taken; 0: never
  bool tuned = false;  ///< its keys tell it of the solution: comparisons have a column of its own for it
};
/// Every scheme of every method, for the lattice, the theory and the other keys of `base`; what cannot be built for them
/// says so when it is built.
std::vector<NamedScheme> named_schemes(const Problem& base);

// The lists of names, for `delf list`.

struct TheoryInfo {
  std::string name, formula;
  std::vector<std::string> parameters;  ///< keys that it reads, such as "theory.mass"
  int components = 1;                   ///< 0: its parameters say it
};
const std::vector<TheoryInfo>& theories();

struct NamedFormula {
  std::string name, formula;
};
/// Stencils with their jets, for `delf list stencils`; and methods, for `delf list schemes`.
const std::vector<NamedFormula>& stencils();
const std::vector<NamedFormula>& methods();

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "lattice/lattice.hpp"
#include "lattice/plan/incidence.hpp"
#include "lattice/site.hpp"

namespace delf {

/// The coupling of the unknowns of a slab.
enum class SolveKind {
  explicit_,    ///< each equation contains its own unknown of the slab and no other: all sites at once
  chain,        ///< one direction only, on an interval: a sweep (rightwards if lower > 0, leftwards if upper > 0)
  cyclic_band,  ///< a band matrix, with corners on a circle and without on an interval
  sparse        ///< no band: it wraps onto itself, or the slab has not one unknown for each site and component
};
const char* to_string(SolveKind);  ///< "explicit", "chain", "cyclic-band", "sparse"

/// A value of the field, or the equation of that name: `component` at `site`.
struct Node {
  Site site;
  int component = 0;

  friend auto operator<=>(const Node&, const Node&) = default;
};

/// The unknowns that are solved for together, in site-major order, and the equations that determine them.
struct Slab {
  std::vector<Node> unknowns, equations;
  bool matched = true;  ///< equations[n] is the one that is matched with unknowns[n]; if not, both are merely listed
};

/// The order of solving: which equation is solved when, and for what. In slab J the unknown (i, c) sits at row
/// J + offset(i, c), the equation (i, c) at row J − shift(i, c). The bulk unknowns of component 0 have offset 0.
struct SolvePlan {
  SolveKind kind = SolveKind::explicit_;
  /// Over all equations of a slab: the largest of ±(place of the matched unknown − place of another unknown of the
  /// slab that it contains), place = site·components + component. The matrix whose rows are in the order of the
  /// matched unknowns has `lower` diagonals below the main one and `upper` above it.
  int lower = 0, upper = 0;
  bool cyclic = false;             ///< space is a circle
  bool nonlinear_in_slab = false;  ///< some unknown enters an equation of its own slab nonlinearly
  bool linear = true;              ///< all couplings are linear
  int forward = 0;                 ///< q: rows from the bulk equation to the unknown that it is solved for
  int backward = 0;                ///< p: rows from the bulk equation back to the oldest that it contains
  int history = 0;                 ///< rows before row J that the equations of slab J contain: p + q for one field
  bool own = true;                 ///< every equation is solved for the unknown of its own site and component
  long long unknowns = 0;          ///< of a slab (the larger one, if even and odd slabs differ)
  long long blocks = 0;            ///< strongly connected components of a slab
  int components = 1;
  std::vector<std::string> names;  ///< of the components

  /// A site that is solved at other rows than the bulk is.
  struct Exception {
    int site = 0, component = 0;
    int parity = 0;  ///< of the row, on a brick wall
    int shift = 0, offset = 0;
  };
  std::vector<Exception> exceptional;

  /// One block is the whole slab.
  bool one_block() const { return blocks == 1; }
  /// There is an equation for `component` at `site`: the value there is not data.
  bool solved(int site, int component = 0) const;
  /// Rows from the equation up to its slab: in slab J it sits at row J − shift. `slab` matters at the natural walls of
  /// brick walls only.
  int shift(int site, int component = 0, int slab = 0) const;
  /// Rows from its slab up to the unknown: in slab J it sits at row J + offset.
  int offset(int site, int component = 0, int slab = 0) const;

  /// Slab J in full, whatever the kind: O(unknowns).
  Slab slab(int J) const;

  /// One line in words: "cyclic band, width 1+1, 255 unknowns a slab, one block".
  std::string describe() const;
  /// Says in a few lines which equation determines which unknown, where, and how.
  std::string report() const;

  /// The plan of one (site, component, parity of the row), as unknown and as equation.
  struct Entry {
    bool solved = false;
    int shift = 0, offset = 0;
    int equation_time = 0, equation_space = 0, equation_component = 0;  ///< from the unknown to its equation

    friend bool operator==(const Entry&, const Entry&) = default;
  };
  /// Entries of a cell (circle) or of a short interval, whose middle `period` sites stand for all between the walls.
  struct Table {
    int sites = 1, period = 1, parities = 1, lattice_sites = 1;
    bool circle = true;
    bool matched = true;  ///< the matching repeats between the walls
    bool regular = true;  ///< one unknown and one equation for each (site, component) in every slab
    std::vector<Entry> entries;
    /// [site·components + component]: values that are data whatever the entry says, on a mesh or as a gauge; else empty.
    std::vector<char> held = {};
    int position(int site) const;  ///< of a site of the lattice
  } table;

 private:
  const Entry& node(int site, int component, int parity) const;
  bool is_held(int site, int component) const {
    return !table.held.empty() && table.held[site * components + component] != 0;
  }
};

/// Throws BadInput: "lattice.sites" if the brick wall does not close on the circle or every value is data, "theory.name"
/// if no equation contains an unknown, "lattice.stencil" if some unknown is not determined, or by no fixed row.
SolvePlan make_plan(const Lattice&, const SystemPattern&);

}  // namespace delf

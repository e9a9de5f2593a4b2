// SPDX-License-Identifier: MIT
#pragma once
#include <compare>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "jets/simd/pack.hpp"
#include "lattice/index.hpp"
#include "lattice/plan/solve_plan.hpp"
#include "schemes/families/stencil_family.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// Rows of a section, row[i·C + c]: a ring of the newest `depth`. It may hold each value in two numbers, y + low.
class SectionView {
 public:
  SectionView(const double* values, int depth, std::size_t row_size, const double* low = nullptr)
      : values_(values), depth_(depth), row_size_(row_size), low_(low) {}

  const double* row(std::int64_t r) const { return at(index(r)); }
  /// The place of row r in the ring, and that of the row `by` rows after the one at an index: divisions are slow.
  int index(std::int64_t r) const {
    const auto i = static_cast<int>(r % depth_);
    return i < 0 ? i + depth_ : i;
  }
  const double* beside(int i, int by) const {
    for (i += by; i < 0;) i += depth_;
    while (i >= depth_) i -= depth_;
    return at(i);
  }
  std::size_t row_size() const { return row_size_; }
  bool has_low() const { return low_ != nullptr; }
  /// The low parts of a row that row() or beside() found.
  const double* low_of(const double* row) const { return low_ + (row - values_); }

 private:
  const double* at(int i) const { return values_ + delf::at(i) * row_size_; }

  const double* values_;
  int depth_;
  std::size_t row_size_;
  const double* low_;
};
class SectionRing {
 public:
  SectionRing(int depth, std::size_t row_size, bool has_low = false)
      : depth_(depth),
        row_size_(row_size),
        has_low_(has_low),
        values_(delf::at(depth) * row_size * (has_low ? 2 : 1), 0.0) {}
  /// Rows `first` to `last` of a window.
  SectionRing(const Window&, std::int64_t first, std::int64_t last);

  double* row(std::int64_t r) { return values_.data() + (view().row(r) - values_.data()); }
  const double* row(std::int64_t r) const { return view().row(r); }
  /// The low parts of a row, where there are any: a rounded value and what rounding took from it are one number.
  double* low(std::int64_t r) { return row(r) + delf::at(depth_) * row_size_; }
  const double* low(std::int64_t r) const { return row(r) + delf::at(depth_) * row_size_; }
  SectionView view() const {
    return {values_.data(), depth_, row_size_, has_low_ ? values_.data() + delf::at(depth_) * row_size_ : nullptr};
  }
  operator SectionView() const { return view(); }
  std::size_t bytes() const { return values_.size() * sizeof(double); }

 private:
  int depth_;
  std::size_t row_size_;
  bool has_low_ = false;
  std::vector<double> values_;  ///< of all rows, then their low parts
};

/// The assembler: equations of a system, the stencils that they are sums of, and some of their unknowns.
///
///     E(site) = Σ_families Σ_{l: Δˡ = site} rˡ(y_Δ)                        Marsden–Patrick–Shkoller (5.2)
///
/// Stencils of one family whose anchors lie in one row are a batch. What a batch reads, and where its residuals and
/// derivatives go, are lists of indices made at set-up: evaluation gathers values, calls the family for some packs of
/// stencils at once, and scatters. Rows count from a row J, which is given when the assembly is evaluated.
class Assembly {
 public:
  struct Anchor {
    int family;
    Site site;
    friend auto operator<=>(const Anchor&, const Anchor&) = default;
  };
  struct Parts {
    std::vector<Node> equations;
    /// Listed `copies` times one after another, where the same unknown moves values in several rows.
    std::vector<Node> unknowns = {};
    int copies = 1;
    bool matched = false;  ///< equation n determines unknown n
    int parity = 0;        ///< of row J: brick walls
    /// Rows J − past … J + future are there; stencils that reach further do not depend on what they read there.
    int past = 0, future = 0;
    double monodromy = 0;                              ///< φ(x + L) − φ(x)
    std::optional<std::vector<Anchor>> stencils = {};  ///< those that touch an equation, if not given
    std::function<int(Site)> place = {};               ///< in a row of the section; the number in space, if not given
  };
  Assembly(const LatticeSystem&, Parts);
  /// The equations and the unknowns of a plan's slabs of one parity.
  static Parts slab(const SolvePlan&, int parity, int past, int future, double monodromy);
  /// No equations: the stencils that reach across the cut below row J.
  static Parts across(const LatticeSystem&, int parity, double monodromy);

  int size() const { return static_cast<int>(parts_.equations.size()); }
  int unknowns() const { return static_cast<int>(parts_.unknowns.size()) / parts_.copies; }
  bool matched() const { return parts_.matched; }
  /// site.time counts from J.
  const Node& unknown(int n) const { return parts_.unknowns[n]; }
  const Node& equation(int n) const { return parts_.equations[n]; }
  /// The place of a node in its row.
  int place(const Node& node) const { return place(node.site) * components_ + node.component; }
  double& value(SectionRing& ring, std::int64_t J, int n) const {
    return ring.row(J + unknown(n).site.time)[place(unknown(n))];
  }

  /// An entry of the Jacobian, ∂(equation)/∂(unknown): those that may differ from zero, each once.
  struct Place {
    int equation, unknown;
  };
  const std::vector<Place>& places() const { return places_; }
  /// True for those that are not zero at three seeded random sections: others cancel between stencils.
  std::vector<char> present() const;

  /// h of all rows, if it is not what the system's rows have.
  void set_time_step(double h);

  /// E and Σ|terms| of every equation. With `momenta` (site·C + component), slab 1 from row 0 alone: the stencils below
  /// row 0 are replaced by their momenta ∂L/∂y₀, p₀ + Σ_above ∂L/∂y₀ = 0 (the discrete Legendre transform).
  void residual(SectionView, std::int64_t J, std::vector<double>& E, std::vector<double>* absolute = nullptr,
                const std::vector<double>* momenta = nullptr) const;
  /// The values of places().
  void jacobian(SectionView, std::int64_t J, std::vector<double>& values,
                const std::vector<double>* momenta = nullptr) const;

  /// The part of E that contains no unknown, and E from it.
  void known(SectionView, std::int64_t J, std::vector<double>& E, const std::vector<double>* momenta = nullptr) const;
  void residual_from(const std::vector<double>& known, SectionView, std::int64_t J, std::vector<double>& E) const;

  /// Gives sections low parts from here on. True if known() of the next slab follows from that of this one: an equation
  /// e of row −1 reads, of what is known, the stencils below it alone; in this slab these have unknowns. Where the
  /// slab's equations hold, and a column is all values of one field at one place,
  ///
  ///     known_e(J + 1) = known_e(J) + Σ_{l in its column} r^l,
  ///
  /// the momentum that a slab adds: as small as the step, and without the rounding of the momentum itself.
  bool keep_low(const LatticeSystem&);
  /// E from its known part, and what the slab adds to it.
  void residual_and_gain(const std::vector<double>& known, SectionView, std::int64_t J, std::vector<double>& E,
                         std::vector<double>& gain) const;
  /// The values of places() without the terms that depend on the field. False if some family cannot tell, or nothing is
  /// left of an equation.
  bool constant_jacobian(std::vector<double>& values) const;
  /// Every entry of the Jacobian is proved to be constant: the equations are linear in the unknowns.
  bool is_linear() const;

  /// Σ_a ∂E/∂y_a V_a and Σ|terms| for several V at once, every a that the stencils read, and the values of places().
  struct Variation {
    SectionView V;
    std::vector<double> E = {}, absolute = {};
  };
  void linearised(SectionView y, std::int64_t J, std::span<Variation> V, std::vector<double>& values) const;

  /// One stencil, its values y, and r or ∂r/∂y (row by row) there.
  struct Local {
    const StencilFamily& family;
    Anchor anchor;                      ///< its row counts from J
    std::span<const int> rows, places;  ///< of the values: where they are read
    std::span<const double> y, derivatives;
  };
  using Visit = std::function<void(const Local&)>;
  void each_residual(SectionView y, std::int64_t J, const Visit& visit) const { each(false, y, J, visit); }
  void each_jacobian(SectionView y, std::int64_t J, const Visit& visit) const { each(true, y, J, visit); }
  /// The values of a variation on that stencil.
  static void gather(const Local&, SectionView V, std::int64_t J, std::vector<double>& v);

  int stencils() const;
  std::size_t bytes() const;

 private:
  using Numbers = std::vector<double>;
  using Packs = std::vector<Pack>;
  static constexpr int most_together = 64;    ///< stencils of a strip
  static constexpr int largest_strip = 2048;  ///< doubles of its results: half of a cache of first level
  static double* numbers_of(Pack* packs) { return reinterpret_cast<double*>(packs); }
  static const double* numbers_of(const Pack* packs) { return reinterpret_cast<const double*>(packs); }
  /// An entry of a constant J that is not zero, in the row of equations[e].
  struct Term {
    int e, m;
    double value;
  };
  /// The stencils of a family in as many lanes as fill whole packs: the last one is repeated, and its copies add to an
  /// equation that nobody reads. Lists hold what belongs to value i of stencil s at i·padded + s.
  struct Batch {
    const StencilFamily* family;
    int number;           ///< of the family
    int size;             ///< values of a stencil
    int row, lowest_row;  ///< of the anchors and of the lowest value, from J
    int stencils, padded;
    std::vector<int> sites = {};  ///< of the anchors, or the numbers of listed stencils
    Packs x = {};                 ///< of the anchors; none of listed stencils, which have places of their own
    std::vector<int> rows = {};                      ///< of value i, from J
    std::vector<int> place = {};                     ///< of the site, in the row
    std::vector<char> side_by_side = {};             ///< [read/lanes]: a pack of stencils reads neighbouring places
    Numbers gained = {};                             ///< for having gone round the circle; empty if nothing
    std::vector<int> equation = {};                  ///< that the residual belongs to, or size()
    std::vector<int> equations = {}, unknowns = {};  ///< values that are one, of some stencil
    /// The numbers in places() of (equations[e], unknowns[u]) of stencil s, at (e·U + u)·padded + s, or one beyond.
    std::vector<int> entry = {};
    bool linear = false;          ///< r = r(0) + J y with the same J everywhere
    bool by_differences = false;  ///< J acts on differences within columns, and on the first value of each
    std::vector<Term> terms = {};
    Numbers at_zero = {};  ///< of evaluated[e]
    /// `equations`, then what else residual_and_gain() asks of the family: values, and sums of them.
    std::vector<int> evaluated = {};
    /// The equations to which a number of `evaluated` adds: [s] an equation, or size().
    struct Gain {
      int e;
      std::vector<int> equation;
    };
    std::vector<Gain> gains = {};

    int read(int i, int s) const { return i * padded + s; }
  };

  int place(Site site) const { return parts_.place ? parts_.place(site) : site.space; }
  bool list_gains(const LatticeSystem&);
  void list_stencils(const LatticeSystem&);
  void list_reads(const LatticeSystem&);
  void list_places(const std::vector<std::vector<int>>& unknown);
  void take_constant_parts();

  void begin(std::int64_t J, const std::vector<double>* momenta, std::vector<double>& E) const;
  bool below_start(const Batch& b, std::int64_t J, bool legendre) const { return legendre && J + b.lowest_row < 0; }
  Cell cell(const Batch& b, std::int64_t J, double x) const;
  /// All steps are as long as those that the constant parts were taken with.
  bool steady() const { return own_step_ || times_->uniform(); }
  class Columns;
  /// The stencils of a strip that has `numbers` results of each: they stay in the cache of first level.
  static int strip_length(const Batch&, std::size_t numbers);
  /// Calls use(stencils, number of the first, room for `numbers` of each, their values) for a batch, strip by strip.
  template <class Use>
  void strips(const Batch&, const Columns&, std::int64_t J, int numbers, bool low, const Use& use) const;
  bool take_matrix_of_differences(Batch&) const;
  static void take_differences(const Batch&, int packs, Pack* y);
  void add_residual(const Batch&, const Columns&, std::int64_t J, double* E, double* absolute,
                    double* gain = nullptr) const;
  void add_constant(const Batch&, const Numbers& J, Numbers& values) const;
  bool add_own_constants(const Batch&, Numbers& values) const;
  void each(bool jacobian, SectionView y, std::int64_t J, const Visit&) const;

  std::shared_ptr<const RowTimes> times_;
  std::optional<double> own_step_;
  double space_step_;
  int components_;
  Parts parts_;
  std::vector<Batch> batches_;
  std::vector<Place> places_;
  Numbers fixed_;            ///< the values of places() that linear batches give; none if there is no such batch
  bool keeps_low_ = false;   ///< sections have low parts
  mutable Numbers columns_;  ///< room for Columns
};

}  // namespace delf

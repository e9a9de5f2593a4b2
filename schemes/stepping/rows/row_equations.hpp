// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "schemes/stepping/rows/argument_rows.hpp"
#include "schemes/stepping/rows/candidate_rows.hpp"
#include "schemes/system/equation_terms.hpp"
#include "schemes/stepping/rows/largest_terms.hpp"
#include "schemes/solvers/linear_solver.hpp"
#include "schemes/stepping/rows/ring_slots.hpp"
#include "schemes/families/row_kernel.hpp"
#include "schemes/stepping/rows/row_sum.hpp"
#include "schemes/stepping/rows/section_rows.hpp"
#include "schemes/stepping/rows/time_tiles.hpp"

namespace delf {

/// The field equations of one slab, evaluated for whole rows: y_{n+1} = y_n + v_n + w is the unknown row. All of it is laid
/// out at set-up: which rows, at which shifts, with which coefficients; a step only looks up where rows lie.
class RowEquations {
 public:
  /// `history`: how many rows the equations of a slab read before the unknown one. Throws NoConvergence if the constant
  /// part of the equations is singular. With a mixture the nonlinear part is evaluated at rows of that argument, which
  /// steps extrapolate by polynomials up to `most_order`.
  RowEquations(const LatticeSystem&, const SolvePlan&, SectionRows&, int history,
               const std::optional<Mixture>& = std::nullopt, int most_order = 0);
  RowEquations(const RowEquations&) = delete;

  // What is inline without a body here has it in row_equations_step.hpp.

  /// Finds the rows for the step from row n. What follows is about this step.
  inline void begin(std::int64_t n);
  /// The same where what it makes is written over what it is made from, if can_go_in_place().
  void begin_in_place(std::int64_t n);

  /// A step is one loop: no outputs, no matrix.
  bool is_one_loop() const { return one_loop_ != nullptr; }
  /// Makes ready for the loop in so many parts of the row; `in_place`: the new row and its increment are written over the
  /// old ones. Σy² of the row that it goes from is no more than that given.
  void begin_loop(int parts, bool in_place, double sum_of_squares);
  /// Rows have been set anew.
  void forget_rows() { loop_row_ = residual_row_ = slopes_row_ = -1; }
  /// A part of the new row by that loop; returns its Σy².
  double loop(int part, int parts) const;
  void close_loop();
  /// Lets long rows be taken several steps on at once, in so many parts; and whether that is so.
  void tile(int parts);
  bool is_tiled() const { return tiles_.has_value(); }
  /// The steps from row n on in place, one for each of `squares`, which become Σy² of their rows. False where one of
  /// these is too large for the next step to be what it was taken for: the rows are then of no use.
  bool loop_levels(std::span<double> squares, double sum_of_squares, RowTeam*);

  ArgumentRows* arguments() { return arguments_ ? &*arguments_ : nullptr; }
  /// Those of the rows that are held: steps along straight lines make none.
  void find_arguments();
  CandidateRows& candidate() { return candidate_; }
  void make_row_the_candidate();
  /// Evaluates the nonlinear outputs that do not read row n+1, and finds the arguments of the rows that are held; those
  /// outputs that do, of the candidate or of the row.
  void evaluate_outputs();
  enum class At { candidate, row, straight_line };  ///< y_n + v_n in the place of y_{n+1}
  void evaluate_unknown_outputs(At);
  /// Evaluates the outputs that read rows up to n only and that no earlier step had to evaluate.
  void evaluate_known_outputs() {
    if (has_known_outputs_) evaluate_newest_known_outputs();
  }
  /// Whether there are outputs that read row n+1.
  bool reads_unknown_row() const;

  /// Solves for w with the outputs as they are, and makes v_{n+1} and y_{n+1} of it, halos too. `compared`: with the
  /// candidate, in what the nonlinear outputs look at; otherwise the change is zero.
  RowChange advance(bool compared);
  /// The same with the outputs that read row n+1, at arguments: extrapolated, or as the row makes them that was found.
  /// No |y| of all rows so far is above `largest`.
  inline RowChange advance_extrapolated(int order, double largest);
  /// Whether there are outputs enough, of steps since the start, to extrapolate from `order` + 1 rows of them; and a step
  /// with outputs so found: returns the largest |y|.
  bool can_extrapolate_outputs(int order) const {
    return order < static_cast<int>(here_->past_outputs.size()) && n_ + 1 - history_ > order;
  }
  double advance_from_outputs(int order);
  inline RowChange advance_again(double largest);
  /// Rows outgrow the cache, and all that a step does to them can go strip by strip.
  bool is_streamed() const { return is_streamed_; }
  /// From y_n + v_n, which need not be written down: strip by strip, or in one loop. The change is then a bound: the
  /// largest of w, times the weights of what is looked at.
  bool goes_straight() const {
    return divides_straight() || (is_streamed_ && outputs_[0].kernel->evaluates_straight());
  }
  /// No |y| of all rows so far is above `largest`.
  RowChange advance_straight(double largest);
  /// Steps of one of these kinds, of rows beyond the cache, read no rows before y_n, v_n and the newest outputs.
  bool can_go_in_place() const;
  /// Outputs of the unknown row are those of a row before y_n too, which straight lines know from v_n.
  bool looks_back() const;
  /// The same as finding the candidate by `find`, or taking the one there is, evaluating, and advance(true), in one
  /// stream through the rows. A candidate that is found on the way is not kept.
  RowChange advance_streamed(const std::function<void(PackRange)>& find) { return stream(At::candidate, find); }
  /// The largest difference between the candidate and y_{n+1}.
  double whole_change() const { return largest_change(whole_); }
  /// What outputs look at, at the unknown row: mixtures of values whose weights sum to at least this.
  double least_weight() const;
  double most_weight() const;  ///< and to no more than this
  const std::vector<Argument>& looks() const { return looks_; }
  /// The largest change of y_{n+1} for a change of 1 in what the outputs look at, if ∂E/∂(y_{n+1}) of the nonlinear part sums
  /// to 1: an exact ∞-norm, by the response to an impulse. 0 where it is not known: several components, walls.
  double gain();
  /// max |E| / max Σ |terms| over the sites for row n+1 as it is. Leaves nothing changed that a step reads.
  /// No |y| of the rows that it reads is above `largest`.
  double residual(std::int64_t n, double largest);
  /// Outputs are the whole residual: w must be corrected by −A₊⁻¹E instead of set to it.
  bool correction_form() const { return equations_.correction_form; }

  const LinearSolver& solver() const { return *solver_[0]; }
  bool matrix_free() const { return !solver_[1] && solver_[0]->bytes() == 0; }
  std::size_t output_bytes() const, matrix_bytes() const, work_bytes() const;
  /// What is not allocated yet, but will be: by loops in so many parts, by a stream's candidates, by residual().
  std::size_t bytes_to_come(int parts, bool residual) const;

 private:
  /// The rows out_c of one family: a ring over the anchors' rows.
  struct Outputs {
    const StencilFamily* family;
    const RowKernel* kernel;
    RowBuffer ring;
    RingSlots slots;
    int oldest = 0, newest = -1;        ///< anchors' rows that equations use, from n
    int first_time = 0, last_time = 0;  ///< of the pattern
    int lowest = 0, highest = 0;        ///< shifts at which equations read
    int base = 0, measured_base = 0;    ///< where its rows stand among the bases; and those that residual() finds
    int held = 0;                       ///< rows of the ring

    int rows() const { return newest - oldest + 1; }
    bool reads_unknown_row(int age) const { return age + kernel->outputs_read_until() >= 1; }
    /// The first age whose outputs do.
    int oldest_measured() const { return std::max(oldest, 1 - kernel->outputs_read_until()); }
    int measured_rows() const { return std::max(0, newest + 1 - oldest_measured()) * kernel->outputs(); }
    /// Where out_c of the stencils anchored `age` rows after row n stands among the bases; and that of residual().
    int index(int age, int c) const { return base + (age - oldest) * kernel->outputs() + c; }
    int measured_index(int age, int c) const {
      return measured_base + (age - oldest_measured()) * kernel->outputs() + c;
    }
  };

  /// Where all lies that a step from one place of the rings reads and makes.
  struct StepRows {
    std::vector<double*> bases;   ///< y_n, y_{n+1}; v_{n+1}, v_n, v_{n−1}, …; outputs; −E, d rows each
    std::vector<double*> values;  ///< …, y_{n−1}, y_n, y_{n+1}, d rows each; for rows that none reads the next of these
    std::vector<RowIncrement> increments;
    std::vector<const double*> past_outputs;  ///< before the newest ones, those first; none where none is extrapolated
    double *known_values = nullptr, *output = nullptr;  ///< of arguments: y of their known_row, and what they give
  };

  void build_outputs();
  void build_solvers();
  void build_marks();
  void build_sums();
  void build_loop();
  void find_loop_rows(bool in_place);
  void build_arguments(const Mixture&, int most_order);
  void build_looks();
  void make_room_in_place();
  static constexpr int longest_period = 32;  ///< of places_
  void build_places();
  inline void find_rows();
  inline void begin_arguments();
  // Out of line, what few steps come to: all others would save registers for it.
  [[gnu::noinline]] void find_rows_at(std::int64_t place);
  [[gnu::noinline]] StepRows& own_rows();
  [[gnu::noinline]] void go_in_place();
  std::size_t first_sum(int a) const { return static_cast<std::size_t>(bricks_ ? 2 * a : a); }
  inline void let_sums_read_here();
  void evaluate_newest_known_outputs();
  double largest_change(const std::vector<Argument>& looks) const { return largest_change(looks, layout_.all()); }
  double largest_change(const std::vector<Argument>& looks, PackRange) const;
  int residual_rows() const;
  void make_room_for_residual();
  void measure_sums(LargestTerms&, double largest);
  void measure_loop(LargestTerms*);  ///< one for each component, times right_side_scale()
  LargestTerms measure_loop(int a, const PackRange&, const double* slopes, LargestTerms) const;
  /// Of a stream, without the candidate's.
  std::size_t window_bytes() const;
  /// Packs of a strip: ten rows of it fit into the second level of the cache.
  static constexpr int strip_packs = 1024;
  /// That windows need room for where a stream goes by strips.
  int window_packs(PackRange last) const {
    return last.last - last.first + 2 * strip_packs + 8 * layout_.halo();
  }
  std::size_t edge_doubles(int parts) const {
    return parts == 1 ? 0 : static_cast<std::size_t>(2 * parts * d_ * loop_reach_ * lanes);
  }
  double*& base(int at) { return here_->bases[static_cast<std::size_t>(at)]; }
  const double* base(int at) const { return here_->bases[static_cast<std::size_t>(at)]; }
  RowIncrement& increment(int a) { return here_->increments[static_cast<std::size_t>(a)]; }
  const RowIncrement& increment(int a) const { return here_->increments[static_cast<std::size_t>(a)]; }
  /// Of a sum that is measured, with the outputs that residual() finds.
  int index_of(const Term&, bool measured) const;
  void add_term(RowSum&, const Term&, double coefficient, bool measured) const;
  bool brick_exists(const Term&, int equation_shift, int parity) const;
  /// Wherever the equations of a pack read outputs: beyond the ends of arcs too.
  PackRange where_read(const Outputs& o) const {
    if (turn_ != 0) return layout_.all();  // what is read across the seam is the site's own output, whatever the density
    return {o.lowest, layout_.packs() + o.highest};
  }
  /// Where the row so many after row n begins in StepRows::values.
  std::size_t value_index(int row) const { return static_cast<std::size_t>((row - oldest_value_) * d_); }
  /// Across the seam rows are more by turn_.
  double with_turn(double largest) const { return largest + std::abs(turn_); }
  using RowsAhead = decltype(SlabRows::ahead);
  static constexpr double unknown_largest = std::numeric_limits<double>::infinity();
  /// No |y| that is read is above `largest`.
  void evaluate(const Outputs&, int age, double* const* out, At, const PackRange&, double largest = unknown_largest,
                const RowsAhead& = {});
  void evaluate_in_ring(Outputs&, int age, At);
  /// Those at which stencils anchored `age` rows after row n exist.
  PackRange packs_of(const Outputs& o, int age, PackRange packs) const {
    if (o.family->pattern().placement != Placement::brick_wall) return packs;
    return {packs.first + static_cast<int>((packs.first + n_ + age) % 2 != 0), packs.last, 2};
  }
  void make_room_for_past_outputs(int count);
  void build_division(const Mixture&, bool in_steps);
  bool divides_straight() const { return divides_in_steps_ && on_the_way_; }
  void evaluate_arguments(At);
  inline const ArgumentRow& argument_row();
  double time_of_outputs() const { return static_cast<double>(n_ + outputs_[0].newest) * time_step_; }
  /// out_c of stencils anchored `age` rows after row n, where sums read it.
  double*& output(const Outputs& o, int age, int c = 0) { return base(o.index(age, c)); }
  /// Of the row before; null where equations read no such.
  double* old_output() { return outputs_[0].rows() > 1 ? output(outputs_[0], outputs_[0].newest - 1) : nullptr; }
  /// Where those of the unknown row go: in steps in place, over those of the row before.
  double* newest_output(int c = 0) {
    const Outputs& o = outputs_[0];
    return output(o, o.newest - (in_place_ && o.rows() > 1 ? 1 : 0), c);
  }
  const DivisionRows& division(const ArgumentRow&, double* output);
  RowChange divide(const ArgumentRow&, double* output);
  /// Where arguments have no rows of their own; none of what is looked at is above `largest`.
  ArgumentRow argument_on_the_way(double largest);
  RowChange stream(At, const std::function<void(PackRange)>& find, double largest = unknown_largest);
  inline void evaluate_at(const ArgumentRow&);
  inline RowChange advance_at(const ArgumentRow&);
  inline RowChange make_new_row();
  const double* edge(int part, int parts, int side, int a) const;
  /// Rows of stencils anchored at this row.
  SlabRows slab_of(const double* const* values, std::int64_t row) const;
  /// x of each slot's site; null where no family is placed.
  const double* positions() const { return positions_.rows() ? positions_.row(0) : nullptr; }
  const RowSum& right_side(int a) const { return *right_sides_[static_cast<std::size_t>(a)]; }
  /// −E stands where y_{n+1} will: solvers have read a right side before they write the row.
  double* stored_right_side(int a) { return base(E_base_ + a); }
  void store_right_sides();
  void set_exceptional_sites();
  double value_at(const SiteEquation&, bool unknown_too, double* absolute) const;

  const LatticeSystem& system_;
  SectionRows& rows_;
  const RowLayout& layout_;
  int d_, history_;
  double turn_, time_step_, space_step_;
  bool bricks_;
  AssembledEquations equations_;
  std::vector<Outputs> outputs_;
  std::unique_ptr<LinearSolver> solver_[2];  ///< of even and odd unknown rows; the second only if bricks differ

  std::int64_t n_ = -1;
  bool in_place_ = false;
  RingSlots y_slots_, v_slots_;
  int ages_ = 1;
  StepRows own_;                  ///< what may be written to
  std::vector<StepRows> places_;  ///< those of one step after the other, until they are the first again
  StepRows* here_ = &own_;        ///< one of these
  RingSlots period_;
  int y_base_ = 0, v_base_ = 0, E_base_ = 0, v_new_base_ = 0;
  int oldest_value_ = 0, newest_value_ = 1;  ///< of StepRows::values, from n

  /// −E times the solver's scale, for each component; of bricks two that take turns, the first for packs whose site and
  /// equation's row are both even or both odd.
  std::vector<RowSum> sums_, stored_, measured_;
  RowSum::Rows summed_;  ///< what all of them read
  std::vector<const RowSum*> right_sides_;
  bool has_known_outputs_ = false;  ///< that each step must evaluate
  bool is_stored_ = false;  ///< right sides are summed to a row first: walls, and solvers that alternate
  RowBuffer w_, scratch_, positions_;
  CandidateRows candidate_;
  std::vector<PackWindow> output_windows_;      ///< of a stream: out_c at the candidate
  std::vector<double*> output_places_;          ///< and where it stands afterwards
  PackWindow work_window_;                      ///< and its solver's work space
  std::optional<ArgumentRows> arguments_;
  std::optional<DivisionRows> division_;  ///< if a step at arguments can be one loop
  bool divides_in_steps_ = false;         ///< and is
  std::optional<Mixture> on_the_way_;     ///< what is looked at, if such a loop can find it
  std::vector<Argument> whole_{{{{Site{}, 1.0}}}},
      looks_;  ///< the row itself; what outputs look at, at the unknown row; one for those alike but for a shift
  std::vector<double*> w_rows_, slab_out_;
  std::vector<const double*> slab_rows_;
  int measured_reach_ = 0;             ///< so many sites to either side, residual() reads increments
  bool is_streamed_ = false;
  bool looks_on_the_way_ = false;  ///< advance() compares while it makes the row

  const RowKernel* one_loop_ = nullptr;
  std::optional<TimeTiles> tiles_;
  std::vector<double> loop_linear_, loop_nonlinear_;
  int loop_reach_ = 0;
  double loop_near_squares_ = -1;  ///< up to this Σy² slopes may be evaluated on NearPacks
  std::vector<const double*> loop_now_, loop_before_, loop_after_, loop_v_before_;
  std::vector<double*> loop_y_, loop_v_, loop_slopes_;
  ExplicitRows loop_rows_{};    ///< these, for a loop in one part
  std::int64_t loop_row_ = -1;  ///< the row that loop_y_ is
  bool loop_in_place_ = false;
  std::int64_t residual_row_ = -1;  ///< n when residual() was last asked for
  std::int64_t slopes_row_ = -1;    ///< the row whose slopes scratch_ holds, where that is at every step
  RowBuffer edges_;             ///< of the parts: what lies beside them, before it is written over
};

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "jets/simd/scratch_rows.hpp"
#include "schemes/stepping/rows/kept_rows.hpp"
#include "schemes/stepping/rows/row_equations.hpp"
#include "schemes/stepping/rows/row_operations.hpp"
#include "schemes/stepping/step_method.hpp"
#include "schemes/stepping/thread_team.hpp"

namespace delf {

/// The operations of a step on rows that lie by lanes, in strips that stay in the cache. Long rows are cut into arcs of
/// packs, whose number does not depend on how many threads share them. A pass first makes the joints of all arcs while rows
/// are as they were: right sides and the forward recurrence a little to either side of where arcs meet, and from these the
/// solution there. Then every arc goes on by itself, and no arc reads what another one writes.
class RowStrips final : public RowOperations {
 public:
  RowStrips(const LatticeSystem&, const RowEquations&, const RowLayout&, RowTable&, const KeptRows&, const StepOptions&,
            int history);

  double pass(Solving, std::vector<double>* corrections, const std::function<void(RowOperations&)>& along) override;
  void evaluate(Strip) override;
  void predict(int order, Strip) override;
  void right_side(Strip) override;
  Strip solve() override;
  void update(Strip) override;
  void compare(Strip) override;
  void evaluate_known() override;
  void evaluate_unknown() override;

  /// Source terms of whole rows, `back` rows before the newest anchors, with their halos: the group that begins at this one.
  void evaluate_rows(std::size_t first_of_group, int back = 0);
  /// Row n + 1 may take the place of row n.
  bool can_go_in_place() const { return can_go_in_place_; }
  /// The fewest packs that a thread is given of a row; 0: none.
  int packs_of_an_arc() const;
  std::size_t bytes() const;

 private:
  /// The solution of A₊ w = r.
  enum class Solver {
    number,     ///< r/A₊ is used as it is formed, or, where row n + 1 takes the place of row n, some packs later
    sweeps,     ///< by two recurrences; the second may follow the first at a distance
    whole_rows  ///< by a solver that takes whole rows
  };

  using Along = std::function<void(RowOperations&)>;

  /// An arc of the rows of `whole`.
  RowStrips(const RowStrips& whole, int from, int to);
  void choose_solver();
  void lay_out_strips(int from, int to);
  bool takes_whole_rows() const { return !sweeps_.empty() && sweeps_[0]->takes_whole_rows(); }
  bool updates_from_sums() const { return sums_are_updates_ && !kept_.in_place(); }
  void begin(Solving, std::vector<double>* corrections);
  void along_strips(const Along&);
  void make_joint(Solving, bool compares, const Along&);
  void right_side_at_joint(Strip);
  void go_on(const RowStrips& next, const Along&);
  void for_each_arc(const std::function<void(int)>&);
  void find_corrections();
  void move_window(int first);
  void compare_rest();
  RowUpdate updating(int a) const;
  void evaluate_group(std::size_t first, int from, int to, int back) const;
  int first_brick(const SourceRow&, int pack) const;
  void compare_packs(int from, int to);
  void compare_inside(int from, int to);
  void close() const;

  const RowEquations& equations_;
  const RowLayout& layout_;
  const KeptRows& kept_;
  const int d_;
  const double monodromy_;  ///< φ(x + L) − φ(x)
  RowTable* table_;
  RowTable own_;                        ///< an arc's: source terms that no row is kept of lie elsewhere
  const RowTable* of_whole_ = nullptr;  ///< that it is a copy of
  const int from_, to_;                 ///< packs of this arc
  Solver solver_ = Solver::whole_rows;
  std::vector<std::unique_ptr<Sweeps>> sweeps_;  ///< of each component
  bool sums_are_updates_ = false;  ///< a right side is a sum of rows that an update can take as it is formed
  bool has_local_ = false, can_go_in_place_ = false;
  int delay_ = 0;  ///< packs that the update stays behind right sides
  int longest_strip_ = 0;
  int reads_left_ = 0,
      reads_right_ = 0;          ///< shifts at which source terms of row n + 1 read it, or right sides read them
  int ahead_ = 0;                ///< shifts at which right sides read predictions
  int near_ = 0;                 ///< packs to either side of a joint that are swept forward with it
  RowBuffer memory_;             ///< right sides of whole rows; of an arc, those of its joint
  std::vector<Strip> at_joint_;  ///< before the arc, and its first packs
  std::optional<ThreadTeam> team_;
  std::vector<std::unique_ptr<RowStrips>> arcs_;

  // The state of the pass that is under way.
  Solving solving_ = Solving::step;
  std::vector<double>* corrections_ = nullptr;
  const ScratchRows* local_ = nullptr;  ///< source terms that no row is kept of
  bool is_at_joint_ = false;            ///< right sides are those of the joint
  const RowStrips* next_ = nullptr;     ///< the arc after this one
  std::vector<Pack> first_;             ///< the solution at the arc's first pack, as the arc before reads it
  std::vector<double> own_corrections_;
  int formed_ = 0, updated_ = 0;   ///< right sides are there before this pack, updates too
  int order_ = 0, predicted_ = 0;  ///< of predictions; they are there before this pack
  bool keeps_corrections_ = true;  ///< comparisons store δ
  PackRange made_{0, 0}, compared_{0, 0};
  Pack largest_ = 0.0;
  std::vector<double*> window_;  ///< right sides of the packs from some on, of each component
  std::vector<double*> w_;       ///< pack v of component a is at w_[a] + layout.at(v)
};

}  // namespace delf

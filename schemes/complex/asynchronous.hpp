// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "schemes/complex/cell_space.hpp"

namespace delf {

class SavedState;

/// An asynchronous variational integrator (Lew, Marsden, Ortiz, West, Arch. Rational Mech. Anal. 167, 2003): each cell K has
/// a step h_K of its own, in any ratio, and acts at the times n h_K; a site moves freely between the updates of its cells,
///
///     S = Σ_i Σ_m (t_i^{m+1} − t_i^m) A_i T((y_i^{m+1} − y_i^m)/(t_i^{m+1} − t_i^m)) − Σ_K Σ_n h_K V_K(y at n h_K),
///
/// where the updates at t = 0 have half a step. A priority queue generates the stencils as it goes; none is stored, unless a
/// window is asked for.
class AsynchronousEvolution {
 public:
  /// `steps` are the h_K. Throws BadInput "theory.name" if T is not quadratic, or if there is a constraint.
  AsynchronousEvolution(const CellSpace&, std::vector<double> steps);

  /// φ and φ_t at t = 0.
  void start(std::span<const double> values, std::span<const double> rates);
  /// All updates at times up to t.
  void advance(double t);
  /// So many updates.
  void update(std::int64_t count);

  /// Saves or restores what further updates depend on, without the window; what is restored needs no start.
  void visit(SavedState&);

  std::int64_t updates() const { return updates_; }
  /// Of the last update.
  double time() const { return time_; }
  double next_time() const { return queue_.top().first; }
  /// Every site at one time: moved freely since its last update.
  std::vector<double> values(double t) const;
  /// When each site was updated last.
  const std::vector<double>& node_times() const { return times_; }
  /// Σ_i A_i T + Σ_K V_K at a time; the impulses of cells are spread over their steps, so that it is of second order.
  double energy(double t) const;
  /// Σ_i p_i · ξ(φ_i), which free motion and every cell keep where ξ is a symmetry of the density.
  Balance momentum(const LinearSymmetry&) const;
  std::size_t bytes() const;

  /// From now on the sites and stencils are kept.
  void open_window();
  /// As a complex of its own, and the values there. Each site's first two times are data.
  struct Window {
    ComplexSystem system;
    std::vector<double> values;
  };
  Window window() const;

 private:
  struct Kept {
    int cell;
    double time;
  };
  struct SiteEvent {
    double time;
    std::vector<double> values;
  };

  void make_room();
  void fill_queue();
  void update_next();
  void drift(int site, double t);
  /// use(family, the cell as a batch, room for a number of each value)
  template <class Use>
  void at_cell(int cell, double t, std::span<const double> y, const Use& use) const;
  /// h_K ∂L/∂y at the corners of a cell at time t, added to the momenta, times a factor.
  void kick(int cell, double t, std::span<const double> y, double factor, std::vector<double>& momenta) const;

  const CellSpace& space_;
  int d_;
  std::vector<double> steps_;
  std::vector<std::int64_t> done_;    ///< of each cell: updates after t = 0
  ComplexSystem potentials_;          ///< V_K: stencil K is cell K, whose sites are the points of the mesh
  std::vector<double> inverse_mass_;  ///< of T, d × d
  using Next = std::pair<double, int>;
  std::priority_queue<Next, std::vector<Next>, std::greater<>> queue_;
  std::vector<double> y_, momenta_, times_;
  double time_ = 0;
  /// A cell that acts so shortly after a site's last update takes the site as it was then: another action, no less
  /// variational, without quotients of rounding errors.
  double simultaneous_ = 0;
  std::int64_t updates_ = 0;

  bool keeps_ = false;
  std::vector<Kept> cells_;
  std::vector<std::vector<SiteEvent>> events_;  ///< of each site
};

}  // namespace delf

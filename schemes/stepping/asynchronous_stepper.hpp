// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "jets/batch_density.hpp"
#include "lattice/space/mesh_space.hpp"
#include "schemes/stepping/step_method.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// An asynchronous variational integrator (Lew, Marsden, Ortiz, West, Arch. Rational Mech. Anal. 167, 2003): each cell K has
/// a step h_K of its own, in any ratio, and acts at the times n h_K; a site moves freely between the updates of its cells,
///
///     S = Σ_i Σ_m (t_i^{m+1} − t_i^m) A_i T((y_i^{m+1} − y_i^m)/(t_i^{m+1} − t_i^m)) − Σ_K Σ_n h_K V_K(y at n h_K),
///
///     drift    y_i ← y_i + (t − t_i) M⁻¹ p_i/A_i,  t_i ← t        each site of K
///     kick     p_i ← p_i − h_K ∂V_K/∂y_i
///
/// where the updates at t = 0 have half a step. A heap has the next update of every cell; no stencil is stored. A row is all
/// sites at one time, moved freely since their last updates.
class AsynchronousStepper final : public StepMethod {
 public:
  /// The system of the usual method on a mesh; `steps` are the h_K. Throws BadInput "theory.name" if T is not quadratic.
  AsynchronousStepper(const LatticeSystem&, std::vector<double> steps);

  void start(const std::vector<std::vector<double>>& rows) override;
  void start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) override;
  /// φ and φ_t at t = 0, [i·d + a].
  void start_rates(const std::vector<double>& values, std::span<const double> rates);
  void step(bool) override;
  /// All updates at times up to t.
  void advance(double t);
  /// So many updates.
  void update(std::int64_t count);

  StepState state() const override { return {.newest = newest_, .held = 1, .updates = updates_}; }
  std::vector<double> row(int back) const override;
  Window window(int rows) const override;
  double residual() const override;
  std::vector<double> own_momenta() const override;
  std::span<const double> site_times() const override { return times_; }
  StepReport report(bool residual) const override;
  void visit(SavedState&) override;

  /// Every site at a time, [i·d + a].
  std::vector<double> values(double t) const;
  /// The momenta there. The impulses of cells are spread over their steps, so that energies of them are of second order.
  std::vector<double> momenta(double t) const;

  /// h_K
  const std::vector<double>& steps() const { return steps_; }
  struct Update {
    int cell;
    double time;
  };
  struct SiteEvent {
    double time;
    std::vector<double> values;
  };
  /// Updates are kept from now on, and the values of each site at its own.
  void keep_updates();
  const std::vector<Update>& kept_updates() const { return kept_; }
  const std::vector<std::vector<SiteEvent>>& kept_events() const { return events_; }

 private:
  /// An entry of the jets of cells of so many corners: point by point, in a slot.
  struct Entry {
    int slot, corner, point;
  };
  struct Shape {
    std::vector<Entry> entries;
    int points = 0;  ///< filled up to whole packs
  };
  using Next = std::pair<double, int>;  ///< the time of an update, and its cell

  void read_cell(int cell, bool coupled);
  void make_room();
  void fill_queue();
  void update_next();
  void put_first_back(Next);
  void drift(int site, double t);
  /// −h_K ∂V_K/∂y at the corners of a cell at time t, added to the momenta, times a factor.
  void kick(int cell, double t, std::span<const double> y, double factor, std::vector<double>& momenta) const;

  const LatticeSystem& system_;
  const MeshSpace& space_;
  std::shared_ptr<const BatchDensity> density_;
  int d_;
  std::vector<double> steps_;
  std::vector<std::int64_t> done_;  ///< of each cell: updates after t = 0
  std::vector<Shape> shapes_;       ///< by number of corners
  std::vector<double> weights_;     ///< of a cell: of its entries in the jets, then h_K w_q times that in the kick
  std::vector<double> x_;           ///< of a cell: of its points; none if the density reads no x
  std::vector<std::size_t> first_weight_, first_x_;  ///< of each cell
  std::vector<double> inverse_mass_;                 ///< of T, d × d
  std::vector<double> per_area_;                     ///< 1/A_i
  std::vector<Next> queue_;                          ///< a heap, the first update in front
  std::vector<double> y_, momenta_, times_;
  double time_ = 0;  ///< of the last update
  /// A cell that acts so shortly after a site's last update takes the site as it was then: another action, no less
  /// variational, without quotients of rounding errors.
  double simultaneous_ = 0;
  std::int64_t updates_ = 0, newest_ = -1;

  bool keeps_ = false;
  std::vector<Update> kept_;
  std::vector<std::vector<SiteEvent>> events_;  ///< of each site
};

}  // namespace delf

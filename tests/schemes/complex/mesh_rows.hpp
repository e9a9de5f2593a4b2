// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "jets/symmetry.hpp"
#include "schemes/complex/cell_space.hpp"
#include "schemes/stepping/asynchronous_stepper.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/system/mesh_energy.hpp"

namespace delf::testing {

/// Rows of the usual method on a mesh, of any density: the engine's families and stepper, with steps of any lengths.
class MeshRows {
 public:
  MeshRows(const CellSpace&, double time_step, std::shared_ptr<const StencilFamily> constraint = nullptr);

  void start(std::span<const double> values, std::span<const double> rates, std::optional<double> time_step = {});
  void step(std::optional<double> time_step = {});

  std::int64_t newest() const { return evolution_.stepper().newest(); }
  double time() const { return times().time(newest()); }
  double last_step() const { return times().step(newest() - 1); }
  const std::vector<double>& row() const { return row_; }
  const std::vector<double>& before() const { return before_; }
  double energy() const { return energy_.between(before_, row_, last_step(), time()); }
  Balance momentum(const LinearSymmetry&) const;
  double residual() const { return evolution_.stepper().residual(); }
  const Evolution& evolution() const { return evolution_; }
  const MeshEnergy& energy_of() const { return energy_; }

 private:
  const RowTimes& times() const { return *evolution_.system().times(); }
  void read();

  const CellSpace& space_;
  double h_;
  Evolution evolution_;
  MeshEnergy energy_;
  std::vector<double> row_, before_;
};

/// Cells with these steps of their own on the same system.
struct MeshCells {
  MeshCells(const CellSpace& space, std::vector<double> steps)
      : rows(space, 0.01), stepper(rows.evolution().system(), std::move(steps)) {}

  double energy(double t) const {
    const std::vector<double> values = stepper.values(t);
    return rows.energy_of()(values, rows.energy_of().rates(values, stepper.momenta(t), t), t);
  }
  Balance momentum(const LinearSymmetry&, double t) const;

  MeshRows rows;
  AsynchronousStepper stepper;
};

}  // namespace delf::testing

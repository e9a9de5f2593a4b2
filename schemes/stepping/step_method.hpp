// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "jets/fibre.hpp"
#include "lattice/error.hpp"
#include "schemes/system/lattice_system.hpp"
#include "schemes/stepping/rows/row_layout.hpp"

namespace delf {

struct StepOptions {
  double tolerance = 1e-14;  ///< of the last change, relative to the largest |y| of the last three rows
  int seed_order = 8;        ///< rows that the seed of an implicit step is extrapolated from
  int max_iterations = 50;
  Fibre fibre = Fibre::real;
  double turn = 0;           ///< φ(x + L) − φ(x)
  int threads = 1;           ///< that explicit steps are shared by; the bits are the same for any number
};

/// Beyond this squares overflow, and with them every energy: nothing that could be reported is a number any more.
inline constexpr double largest_finite = 1e150;
inline bool overflowed(double largest_value) { return !(largest_value <= largest_finite); }
/// Of a whole row: whether √Σy² did.
inline bool squares_overflowed(double sum_of_squares) { return !(sum_of_squares <= largest_finite * largest_finite); }

/// How a system is stepped: by whole rows (RowStepper) or slab by slab (SlabStepper). What the functions do stands at
/// Stepper, which chooses one.
class StepMethod {
 public:
  virtual ~StepMethod() = default;

  virtual int starting_rows() const = 0;
  virtual void start(const std::vector<std::vector<double>>& rows) = 0;
  virtual void start_centred(const std::vector<double>&, const std::vector<double>&) {
    throw BadInput("initial.start",
                   "initial.start = centred: not for schemes with constraints or inner nodes; use exact");
  }
  virtual void start_legendre(const std::vector<double>&, const std::vector<double>&) {
    throw BadInput("initial.start", "initial.start = legendre: only for elements; use exact or centred");
  }
  virtual void step(bool looked_at) = 0;
  virtual void steps(int count) {
    for (; count > 0; --count) step(false);
  }
  virtual int steps_at_once() const { return 1; }

  virtual std::int64_t newest() const = 0;
  virtual std::vector<int> behind() const { return {}; }  ///< none: every component is known
  virtual std::vector<double> row(int back) const = 0;
  virtual Window window(int rows) const = 0;
  virtual double residual() const = 0;
  virtual int iterations() const = 0;

  virtual const RowLayout* layout() const { return nullptr; }
  virtual const double* row_data(int, int) const { return nullptr; }
  virtual double newest_pair(const double** /*rows*/) const { return std::numeric_limits<double>::infinity(); }

  virtual bool iterates() const = 0;
  virtual std::string solver_name() const = 0;
  virtual bool matrix_free() const = 0;
  virtual std::size_t bytes() const = 0;
  virtual std::size_t bytes_to_come(bool residual) const = 0;
  virtual std::string memory_report(bool residual) const = 0;
};

}  // namespace delf

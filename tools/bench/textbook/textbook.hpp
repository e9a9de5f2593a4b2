// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace delf::bench {

/// The programs that the engine is compared with: φ_tt − φ_xx + sin φ = 0 on a circle, the equations of one scheme
/// written out by hand as scalar loops over plain arrays with the library's sine. tools/bench/README.md says what was
/// done in them and what was not.
class Textbook {
 public:
  virtual ~Textbook() = default;
  virtual void start(std::span<const double> row0, std::span<const double> row1) = 0;
  virtual void step() = 0;
  virtual std::span<const double> row() const = 0;  ///< the newest
  virtual long iterations() const { return 0; }     ///< since the start; none of explicit schemes
};

/// The schemes with a textbook program, named as in scenes: stencils, then methods.
const std::vector<std::string>& textbook_schemes();

/// N sites on a circle of length L. The tolerance is of the last change, relative to the largest |y| of three rows.
std::unique_ptr<Textbook> make_textbook(const std::string& scheme, int sites, double length, double time_step,
                                        double tolerance);

}  // namespace delf::bench

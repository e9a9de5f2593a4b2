// SPDX-License-Identifier: MIT
#pragma once
#include <exception>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "schemes/methods/energies.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/verify/equation_check.hpp"
#include "schemes/verify/force_share.hpp"
#include "schemes/verify/form_check.hpp"
#include "schemes/verify/nearby_check.hpp"
#include "schemes/verify/noether_check.hpp"
#include "schemes/verify/stress_balance.hpp"
#include "tools/diagnosis/evidence.hpp"
#include "tools/diagnosis/rounded_values.hpp"
#include "tools/rows/initial_rows.hpp"
#include "tools/rows/nearby_rows.hpp"
#include "tools/rows/recorded_section.hpp"
#include "tools/rows/section_source.hpp"
#include "tools/verify/energy_history.hpp"
#include "tools/verify/residual_bins.hpp"
#include "tools/verify/verdict.hpp"
#include "tools/verify/verify_request.hpp"

namespace delf {

/// The symmetries that the theory declares, and verify.generator. Throws BadScene.
std::vector<LinearSymmetry> requested_symmetries(const Scene&, const VerifyRequest&, const FieldTheory&,
                                                 const LatticeSystem&);

/// The checks of `delf verify`: the rows of a scene are made, or read from a file, one after the other, and checked as
/// they come; a few of them are held for the regions.
class Verification {
 public:
  /// Throws BadScene. `fields` and `nearby` are files of rows that another program made.
  Verification(const Scene&, const VerifyRequest&, const std::optional<std::string>& fields,
               const std::vector<std::string>& nearby);

  /// The results; also when the numerics failed on the way, or it was interrupted.
  Verdict run();
  /// Why it ended early, if it failed.
  std::exception_ptr failure() const { return failure_; }

 private:
  void open_files(const std::string& fields, const std::vector<std::string>& nearby);
  void require_every_row(const std::string& fields) const;
  void open_nearby(const std::string& fields, const std::vector<std::string>& nearby);
  void require_interiors() const;
  void choose_moments();
  std::int64_t steps_of_run() const;
  void pass_over_rows();
  void take(std::vector<double> row);
  void look_at_moment();
  void look_at_nearby(const Window&);
  void look_at_energy(std::int64_t row);
  void measure_energy(std::int64_t row);
  void look_at_walls(std::int64_t row, const std::vector<double>& values);
  void diagnose_rows();
  std::vector<LinearSymmetry> symmetries();
  bool scheme_has(const LinearSymmetry&) const;
  Window window(std::int64_t first, std::int64_t last) const;
  void collect();
  void collect_severity();
  void leave_out(const std::string& what) { verdict_.left_out.push_back(what); }
  std::uint64_t seed() { return random_(); }

  const Scene& scene_;
  const VerifyRequest& request_;
  const std::optional<InitialRows> initial_;  ///< none where the rows of --fields are all there is
  int winding_;
  double monodromy_;
  Simulation simulation_;
  std::unique_ptr<LatticeSystem> faulty_;  ///< if a sign is to be wrong
  const LatticeSystem& system_;
  const SolvePlan& plan_;
  std::unique_ptr<RecordedSection> fields_;
  std::vector<std::unique_ptr<NearbyRows>> nearby_;
  std::mt19937_64 random_;

  std::optional<EquationCheck> equations_;
  std::optional<FormCheck> forms_;
  std::optional<RegionDrawer> drawer_;  ///< in the rows of a moment
  std::optional<NoetherCheck> noether_;
  std::optional<NearbyCheck> near_;
  std::optional<StressBalance> balance_;
  std::optional<ResidualBins> bins_, severity_;
  std::optional<OwnEnergy> energy_;
  std::optional<EnergyChange> energy_change_;  ///< where rows choose the steps
  FailedEquations failed_, hidden_;            ///< of `equations_`; and beyond the errors of the values
  std::optional<RoundedValues> rounded_;       ///< of rows of a file
  std::optional<ForceShare> share_;            ///< of rows of a file
  std::optional<Check> walls_;                 ///< of rows of a file: fixed walls keep their values

  std::int64_t rows_ = 0;  ///< of the section
  std::int64_t balance_rows_ = 0;
  int held_rows_ = 3;                  ///< how many are held at once
  int moment_rows_ = 0;                ///< rows of a moment
  std::vector<std::int64_t> moments_;  ///< first rows
  std::size_t next_moment_ = 0;
  Window held_;
  std::vector<std::vector<double>> first_rows_;
  std::vector<double> unwrapped_;     ///< the newest row of a file, if they are unwrapped
  std::vector<double> first_values_;  ///< of every row, at the first site, then
  std::exception_ptr failure_;
  Verdict verdict_;
};

}  // namespace delf

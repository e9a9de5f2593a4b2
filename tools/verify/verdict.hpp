// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "schemes/verify/check.hpp"
#include "schemes/verify/force_share.hpp"
#include "tools/diagnosis/finding.hpp"
#include "tools/outcome/outcome.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The form formula on one region.
struct RegionPoint {
  std::string kind;  ///< rectangle, staircase, hole, wall, slab, random or given
  std::int64_t stencils = 0;
  double value = 0;   ///< the relative form formula residual
  bool local = true;  ///< V, W from the null space of the linearised equations there; else evolved
};

/// A site of a region as it is drawn.
struct DrawnSite {
  int time = 0, space = 0, node = 0;
  bool interior = false, boundary = false;
  double weight = 0;  ///< |contribution| / normaliser at that site, 0 if none
};

/// The region where the form formula holds worst.
struct WorstRegion {
  std::string title;
  std::vector<DrawnSite> sites;
  double value = 0;
};

/// The residual of the equations over space and time, in bins.
struct ResidualMap {
  std::vector<double> time, space;  ///< centres of the bins, evenly spaced
  std::vector<double> log10;        ///< rows × columns: of the largest |E| / normaliser; NaN if no equation is there
};

/// The energy that the rows have for themselves (schemes/methods/energies.hpp), row by row.
struct EnergyHistory {
  std::string name, meaning;
  std::vector<double> time, value;
};

/// The distance of a run forth and back, of so many steps, from where it began.
struct ReversalCurve {
  std::vector<std::int64_t> steps;
  std::vector<double> distance;
};

/// A statement of which the values can tell nothing: it has neither passed nor failed.
struct Unmeasured {
  Check check;
  std::string reason;
};

/// The results of `delf verify`: everything in verify.json, in the report on stdout and in the figures.
struct Verdict {
  std::vector<Check> checks;
  std::vector<Unmeasured> unmeasured;
  std::vector<Measured> measured;
  std::vector<Finding> diagnosis;     ///< what rows of a file are
  std::vector<std::string> left_out;  ///< "noether: no symmetry is declared"
  std::vector<RegionPoint> points;
  WorstRegion worst;
  ResidualMap map;
  ResidualMap severity;                ///< of rows of a file: |E| of a site beside the largest force there
  std::vector<SiteSeverity> severest;  ///< the same of each site, over all rows
  EnergyHistory energy;
  ReversalCurve reversal;
  std::uint64_t seed = 0;
  double seconds = 0;
  std::int64_t stencils = 0;    ///< verified
  std::string subject;          ///< "rows computed here" or "rows of FILE"
  std::string status = "done";  ///< as in Outcome

  std::int64_t failed() const {
    return std::ranges::count_if(checks, [](const Check& check) { return !check.passed(); });
  }
  /// Every check was made and passed; without checks, or where one can tell nothing, nothing has passed.
  bool passed() const {
    return status == "done" && !(checks.empty() && measured.empty()) && failed() == 0 && unmeasured.empty();
  }
};

/// verify.json; what is not a finite number is null.
std::string verdict_json(const Subject&, const Scene&, const Verdict&);
/// The verdict for people: a table within 120 columns, and what each failure means.
std::string verdict_report(const Subject&, const Scene&, const Verdict&);

}  // namespace delf

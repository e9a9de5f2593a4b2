// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tools/scene/scene.hpp"
#include "tools/stability/observed_limit.hpp"
#include "tools/stability/stress_case.hpp"

namespace delf {

/// The growth of noise over Courant number and mh: rows of mh, from the least.
struct StabilityMap {
  std::string scheme;
  int sites;  ///< of the circle: odd, so that ghosts of even N stay away, wherever the scheme closes on it
  std::vector<double> courants, mass_steps;
  std::vector<Growth> grows;               ///< mass_steps × courants
  std::vector<double> edge_masses;         ///< finer than the rows
  std::vector<std::vector<double>> edges;  ///< theory: the Courant numbers where stability begins or ends
};

/// ω against the wave number, of one scheme.
struct DispersionCurve {
  std::string scheme;
  std::vector<FrequencyPoint> points;
};

struct StressFinding {
  StressCase stress_case;
  StressResult result;
};

/// A scheme whose rounding errors grow off the surface that the scene's theory is kept on.
struct ConstraintFinding {
  std::string scheme, words;
};

/// The results of `delf stability`.
struct StabilityFindings {
  bool own_waves = false;    ///< of the scene's theory, about φ = 0
  std::string own_left_out;  ///< the scene's own scheme, and why it has no limits here, or empty
  std::vector<Limit> limits;
  std::vector<ConstraintFinding> constraints;
  std::vector<StressFinding> stress_cases;
  std::vector<StabilityMap> maps;
  std::vector<DispersionCurve> dispersion;
  double dispersion_courant = 0, dispersion_mass = 0;  ///< of the dispersion curves: h/k and mk
  double most_courant = 0, agreement = 0;
  double least_growth = 0;  ///< LimitRequest::least_growth(), on a circle of
  int limit_sites = 0;
  std::uint64_t seed = 0;
  double seconds = 0;
  std::string status = "done";  ///< or interrupted

  std::int64_t disagreements() const;
  std::int64_t unresolved() const;   ///< Courant numbers of limits
  std::int64_t must_not_be() const;  ///< stress cases with a forbidden verdict
  bool nothing_compared() const;
  bool not_applicable() const;       ///< nothing compared, and nothing else found
  std::string why_left_out() const;  ///< every scheme without a limit, with the reason, in one line
  bool passed() const { return !nothing_compared() && status == "done" && disagreements() == 0 && must_not_be() == 0; }
};

/// stability.json; what is not a finite number is null.
std::string stability_json(const Scene&, const StabilityFindings&);
/// The findings for people: tables within 120 columns.
std::string stability_report(const Scene&, const StabilityFindings&);

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/diagnosis/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/diagnosis/findings.hpp"
#include "tools/diagnosis/from_values.hpp"
#include "tools/diagnosis/rounded_values.hpp"

namespace delf {

namespace {

// Few equations, or none of the sample.
std::optional<Finding> find_elsewhere(const Evidence& e, const Sample& sample) {
  const FailedEquations& f = e.failed;
  const auto own = sample.equations(e.problem, {});
  const bool few = static_cast<double>(f.failed()) < 0.05 * static_cast<double>(f.tried());
  if (f.failed() == 0 || !(few || (own && own->hold(e.tolerance)))) return std::nullopt;
  const auto sites = f.sites();
  return Finding{
      "elsewhere",
      fmt::format("The equations hold but for {} of {}, in {} of {} rows (the first is row {}, the last row {}) and at "
                  "sites {} to {}: the theory, the steps and the scheme are right. What happened there is none of the "
                  "mishaps that were tried: several values were changed, or steps not solved to this tolerance.",
                  f.failed(), f.tried(), f.rows().size(), f.rows_tried(), f.rows().front(), f.rows().back(),
                  sites.front(), sites.back())};
}

}  // namespace

Diagnosis diagnose(Evidence evidence) {
  Diagnosis diagnosis;
  const Sample sample(evidence);

  // The common first. What settles the case ends it: a seam is no wrong coefficient.
  using Local = std::optional<Finding> (*)(const Evidence&);
  for (const Local find : {find_rounding, find_wrapped, find_doubled_frame, find_exchanged_frames, find_dropped_frame,
                           find_edited_value, find_first_rows, find_seam, find_fixed_sites, find_sponge}) {
    if (evidence.failed.failed() == 0) break;
    if (auto finding = find(evidence)) {
      diagnosis.findings.push_back(std::move(*finding));
      if (diagnosis.findings.back().settles) return diagnosis;
    }
  }
  if (sample.rests()) {
    diagnosis.findings.push_back({"rest", "The fields rest: no equation can be distinguished from another by them."});
    return diagnosis;
  }
  if (const auto rounded = rounding_of(evidence.rows, evidence.row); rounded && evidence.failed.failed() > 0)
    evidence.tolerance = std::max(evidence.tolerance, 3 * rounded->relative);
  // Momenta tell maps apart whose rows are the same.
  if (evidence.momenta)
    if (auto finding = find_one_step(evidence, sample)) {
      diagnosis.findings.push_back(std::move(*finding));
      if (auto scheme = find_scheme(evidence, sample)) diagnosis.findings.push_back(std::move(*scheme));
      if (diagnosis.findings.back().settles) return diagnosis;
    }
  using Everywhere = std::optional<Finding> (*)(const Evidence&, const Sample&);
  for (const Everywhere find : {find_elsewhere, find_scheme, find_time_weights})
    if (auto finding = find(evidence, sample)) {
      diagnosis.findings.push_back(std::move(*finding));
      if (diagnosis.findings.back().settles) return diagnosis;
    }
  if (auto finding = find_from_values(evidence)) {
    diagnosis.findings.push_back(std::move(*finding));
    return diagnosis;
  }
  // A map that is exact goes before coefficients that are not.
  auto coefficients = find_coefficients(evidence, sample);
  if (!evidence.momenta && !(coefficients && coefficients->exact))
    if (auto map = find_one_step(evidence, sample)) coefficients = std::move(map);
  if (coefficients) diagnosis.findings.push_back(std::move(*coefficients));
  return diagnosis;
}

}  // namespace delf

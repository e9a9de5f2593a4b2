// SPDX-License-Identifier: MIT
#include "tools/verify/verify.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <utility>

#include "tools/figures/drawing.hpp"
#include "tools/files/plain_rows.hpp"
#include "tools/files/text_file.hpp"
#include "tools/outcome/outcome.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/rows/engine.hpp"
#include "tools/scene/brick_rows.hpp"
#include "tools/verify/momenta_verification.hpp"
#include "tools/verify/verdict_figures.hpp"
#include "tools/verify/verification.hpp"
#include "tools/verify/verify_in_memory.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

// Writes the tables of rows and sites that there are; those of an earlier time go.
void write_tables(const fs::path& folder, const Verdict& verdict) {
  const auto write = [&](const char* name, const char* head, const std::string& lines) {
    std::error_code none;
    if (lines.empty()) fs::remove(folder / name, none);
    else write_text_file(folder / name, head + lines);
  };
  std::string sites, energies;
  for (const SiteSeverity& s : verdict.severest)
    sites += fmt::format("{},{},{},{},{},{}\n", s.site, s.field, s.row, s.error, s.force, s.share());
  for (std::size_t n = 0; n < verdict.energy.value.size(); ++n)
    energies += fmt::format("{},{}\n", verdict.energy.time[n], verdict.energy.value[n]);
  write("severity.csv", "site,field,row,error,force,share\n", sites);
  write("energy_own.csv", "time,energy_own\n", energies);
}

/// The checks, and what ended them early, if anything did.
struct Verified {
  Verdict verdict;
  std::exception_ptr failure;
};

/// `begin` is called before the first row, once all files of rows are open.
template <class Begin>
Verified verified(const Scene& scene, const std::optional<std::string>& fields, const std::vector<std::string>& nearby,
                  const Begin& begin) {
  VerifyRequest request = read_verify_request(scene);
  // on the fibre S1 values modulo 2π are those of the field
  if (scene.problem.circle_valued && fields && nearby.empty()) request.unwrap = true;
  std::optional<Verification> verification;
  const bool momenta_alone = fields && has_momenta_alone(scene, *fields);
  if (!momenta_alone) verification.emplace(scene, request, fields, nearby);
  begin();
  Verdict verdict = verification ? verification->run() : Verdict{};
  if (fields && verdict.status == "done") verify_momenta(scene, request, *fields, nearby, momenta_alone, verdict);
  return {std::move(verdict), verification ? verification->failure() : nullptr};
}

ExitCode verify_in(const fs::path& folder, const Scene& scene, const std::optional<std::string>& fields,
                   const std::vector<std::string>& nearby) {
  const Interrupt interrupt;
  // earlier results stay until there are new ones
  const auto [verdict, failure] = verified(scene, fields, nearby, [&] { make_results_folder(folder); });
  const ExitCode code =
      write_verdict(verdict, subject_of(scene.problem), scene, folder, scheme_in_words(scene.problem));
  if (failure) std::rethrow_exception(failure);
  return code;
}

Scene with_first_row_of(Scene scene, const std::optional<std::string>& fields) {
  if (fields) take_first_row(scene, *fields, 0);
  return scene;
}

}  // namespace

ExitCode write_verdict(const Verdict& verdict, const Subject& subject, const Scene& scene, const fs::path& folder,
                       const std::string& title) {
  make_results_folder(folder);
  write_text_file(folder / "verify.json", verdict_json(subject, scene, verdict));
  write_tables(folder, verdict);
  remove_figures(verdict_figure_names(), folder);
  const bool draws = scene.figures && !title.empty();
  const std::string missing =
      draws ? draw_verdict(verdict, scene.name, title, scene.figure_form, folder) : std::string();
  fmt::print("{}", verdict_report(subject, scene, verdict));
  fmt::print("{}: verify.json{}\n", folder.string(), draws && missing.empty() ? " figures" : "");
  if (!missing.empty()) fmt::print(stderr, "delf: no figures: {}\n", missing);
  if (verdict.status == "interrupted") return ExitCode::interrupted;
  return verdict.passed() ? ExitCode::done : ExitCode::check_failed;
}

void imply_rows(Settings& settings, const std::string& fields) {
  if (!settings.find("initial.state")) {
    settings.imply("initial.state", "file", "theory.name");
    settings.imply("initial.file", fs::absolute(file_of_rows(fields)).string(), "theory.name");
  }
  if (!settings.find("run.until")) settings.imply("run.steps", "0", "theory.name");
}

ExitCode verify(const Scene& given, const fs::path& folder, const std::optional<std::string>& fields,
                const std::vector<std::string>& nearby) {
  const Scene scene = with_first_row_of(given, fields);
  return with_memory_for(scene, [&] { return verify_in(folder, scene, fields, nearby); });
}

VerifyInMemory verify_in_memory(const Scene& given, const std::optional<std::string>& fields,
                                const std::vector<std::string>& nearby) {
  const Scene scene = with_first_row_of(given, fields);
  VerifyInMemory result;
  with_memory_for(scene, [&] {
    const auto [verdict, failure] = verified(scene, fields, nearby, [] {});
    const Subject subject = subject_of(scene.problem);
    result = {verdict.status, verdict_report(subject, scene, verdict), verdict_json(subject, scene, verdict),
              verdict.passed(), failure};
    return ExitCode::done;
  });
  return result;
}

}  // namespace delf

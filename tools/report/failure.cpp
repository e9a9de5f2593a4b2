// SPDX-License-Identifier: MIT
#include "tools/report/failure.hpp"

#include <new>

namespace delf {

ExitCode exit_code(const std::exception& error) {
  if (dynamic_cast<const BadInput*>(&error)) return ExitCode::bad_input;
  if (dynamic_cast<const NumericalFailure*>(&error)) return ExitCode::numerics_failed;
  return ExitCode::system_failed;  // SystemFailure, std::bad_alloc, std::filesystem::filesystem_error, …
}

const char* status_of(const NumericalFailure& error) {
  if (dynamic_cast<const NotFinite*>(&error)) return "not-finite";
  return dynamic_cast<const MeshCrossing*>(&error) ? "mesh-crossing" : "no-convergence";
}

std::string error_line(const std::exception& error) {
  std::string line = error.what();
  if (dynamic_cast<const std::bad_alloc*>(&error)) line = "out of memory; ask for fewer sites or records";
  for (char& c : line)  // one line, and nothing that a terminal obeys
    if (c == '\r' || c == '\n' || c == '\t') c = ' ';
    else if ((c >= 0 && c < ' ') || c == 127) c = '?';
  return dynamic_cast<const BadScene*>(&error) ? line : "delf: " + line;
}

}  // namespace delf

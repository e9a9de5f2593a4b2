// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

#include "tools/report/failure.hpp"

namespace delf {

/// Writes what ParaView opens the rows of a folder by, as output.xdmf does at the end of a run: of a run that was killed, too,
/// whose fields.h5 is marked closed first, after its last whole rows. Throws BadScene for what has none to show, and
/// SystemFailure while the run goes on.
ExitCode write_xdmf(const std::filesystem::path& folder);

}  // namespace delf

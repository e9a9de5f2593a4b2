// SPDX-License-Identifier: MIT
#pragma once
#include "tools/bench/request.hpp"

namespace delf::bench {

// One file each, named as the command.
void time_schemes(const Request&);
void time_limit(const Request&);
void time_sizes(const Request&);
void time_density(const Request&);
void time_monitors(const Request&);
void time_threads(const Request&);
void time_slabs(const Request&);
void time_verify(const Request&);

}  // namespace delf::bench

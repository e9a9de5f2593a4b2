// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/problem.hpp"

namespace delf {

/// The problem seen backwards: T − t in place of t, which densities that are given as text alone read.
Problem mirrored_in_time(Problem, double T);

}  // namespace delf

// SPDX-License-Identifier: MIT
#include <cstdio>

#include "lattice/lattice.hpp"

int main() { std::printf("%.17g\n", delf::Lattice::circle(255, 40).space_step()); }

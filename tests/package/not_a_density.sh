#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# not_a_density.sh COMPILER ROOT: a functor that is no density is refused in one readable error, and a density is not.
set -euo pipefail

compiler=$1 root=$2
program() {
  cat <<CPP
#include "jets/tables/hexagon_jet.hpp"
#include "schemes/scheme.hpp"
struct Given { auto operator()(const auto& j) const { return $1; } };
int main() {
  const auto scheme = delf::Scheme{delf::hexagon, Given{}};
  auto evolution = scheme.on(delf::Lattice::circle(10, 1), 0.1);
}
CPP
}
compiled() { program "$1" | "$compiler" -std=c++20 -fsyntax-only -I "$root" -x c++ - 2>&1; }

if said=$(compiled "(void)j, 1.0"); then
  echo "a functor that returns 1.0 is taken for a density" >&2
  exit 1
fi
if ! grep -q "delf: this is no Lagrangian density" <<<"$said" || [ "$(grep -c 'error:' <<<"$said")" != 1 ]; then
  echo "the refusal of a functor that returns 1.0 is not one readable error: $said" >&2
  exit 1
fi
# The check can fail: a density is none to be refused.
if ! said=$(compiled "0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x)"); then
  echo "a density is refused: $said" >&2
  exit 1
fi

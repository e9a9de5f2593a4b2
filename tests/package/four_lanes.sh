#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds for any processor have the same bits, whatever instructions they use: four_lanes.sh COMPILER SOURCE. With products
# that are fused with sums the check fails.
set -euo pipefail
compiler=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

bits_of() {
  "$compiler" -std=c++20 -O3 -I"$source" -DDELF_FOUR_LANES -fno-math-errno -fno-trapping-math -Wno-psabi "$@" \
    "$source/tests/package/four_lanes.cpp" -o "$work/bits"
  "$work/bits"
}

any=$(bits_of -march=x86-64 -ffp-contract=off)
grep -qw avx2 /proc/cpuinfo && grep -qw fma /proc/cpuinfo || { echo "skipped: this processor has no AVX2"; exit 0; }
higher=$(bits_of -march=x86-64-v3 -mno-fma -ffp-contract=off)
[ "$any" = "$higher" ] || { echo "x86-64-v3 has $higher, and x86-64 $any"; exit 1; }
fused=$(bits_of -march=x86-64-v3 -ffp-contract=fast)
[ "$any" != "$fused" ] || { echo "fused products were not found"; exit 1; }

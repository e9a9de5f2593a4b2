#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# one_way_includes.sh ROOT: each folder includes itself and the folders that this table gives it, and nothing else.
set -euo pipefail

rooms=(lattice jets schemes tools tests)
lattice='lattice lattice/shapes lattice/space lattice/plan lattice/complex'
jets='jets jets/numbers jets/simd jets/tables'
families="$lattice $jets jets/expressions schemes/families"
system="$families schemes/system"
stepping="$system schemes/solvers schemes/stepping"
schemes="$stepping jets/expressions schemes schemes/theories schemes/methods schemes/states schemes/verify
  schemes/stability schemes/complex"
results="$schemes tools/report tools/files tools/figures tools/scene tools/outcome"
runs="$results tools/rows tools/measure tools/compare tools/warnings"
commands="$runs tools/run tools/diagnosis tools/verify tools/complex tools/convergence tools/sweep tools/stability
  tools/workprecision tools/results tools/cite tools/page tools/film tools/reproduce"

declare -A may_include=(
  [lattice]='lattice/space'  # a mesh is the space of a lattice
  [lattice/shapes]='lattice'
  [lattice/space]='lattice'
  [lattice/plan]='lattice'
  [lattice/complex]='lattice lattice/space lattice/plan'
  [jets]="lattice $jets"  # a density is defined by the numbers that it works for
  [jets/numbers]='lattice jets jets/simd'
  [jets/simd]='lattice jets'
  [jets/tables]="lattice lattice/shapes lattice/space jets jets/numbers jets/simd"
  [jets/expressions]="lattice $jets"
  [schemes/families]="$lattice $jets jets/expressions"  # monitors are text too
  [schemes/system]="$families schemes/solvers"
  [schemes/solvers]="$lattice jets/simd"
  [schemes/stepping]="$system schemes/solvers schemes/stepping/rows schemes/stability"  # failures name ghosts
  [schemes/stepping/rows]="$stepping"
  [schemes/theories]="$system jets/expressions schemes"
  [schemes/states]="$families jets/expressions schemes"
  [schemes/methods]="$stepping jets/expressions schemes schemes/theories schemes/states schemes/stability"  # plans name limits
  [schemes/stability]="$system"
  [schemes/complex]="$system schemes/solvers schemes/stepping schemes/verify schemes/methods"  # the state of a run, balances
  [schemes/verify]="$stepping schemes schemes/theories"  # time reversal steps a simulation, balances ask a theory
  [schemes]="$schemes"
  [tools/report]="$schemes"
  [tools/files]="$schemes tools/report"
  [tools/figures]="$schemes tools/report tools/files"
  [tools/scene]="$schemes tools/report tools/files tools/figures"
  [tools/outcome]="$schemes tools/report tools/scene"
  [tools/diagnosis]="$schemes"
  [tools/rows]="$results tools/diagnosis"  # rows of a file may be reduced modulo 2π
  [tools/measure]="$results"
  [tools/compare]="$results tools/rows tools/measure"
  [tools/warnings]="$results tools/rows tools/measure tools/compare"
  [tools/run]="$runs"
  [tools/complex]="$runs tools/run"
  [tools/verify]="$runs tools/diagnosis tools/complex"
  [tools/convergence]="$runs tools/complex"
  [tools/sweep]="$runs tools/run tools/complex"
  [tools/stability]="$runs tools/complex"
  [tools/workprecision]="$runs tools/peers"
  [tools/results]="$results"
  [tools/cite]="$runs tools/run tools/complex tools/results tools/peers"  # what a comparison cites
  [tools/page]="$runs tools/complex tools/results tools/cite"
  [tools/reproduce]="$runs tools/page"
  [tools/film]="$runs tools/complex"
  [tools/peers]="$schemes"
  [tools/bench]="$schemes"
  [tools/python]="$commands tools"
  [tools/examples]="$schemes"
  [tools]="$commands"
  [tests]="$commands schemes/stepping/rows tools tools/bench tools/peers"
)

# Sets `folder` to the entry of the table that a path is in, or to nothing.
find_folder() {
  folder=${1%/*}
  while [ -n "$folder" ] && [ -z "${may_include[$folder]+x}" ]; do
    case $folder in */*) folder=${folder%/*} ;; *) folder='' ;; esac
  done
}

# Prints INCLUDER:INCLUDED FILE:LINE PATH of every include under ROOT that the table does not allow.
against_the_arrows() {
  local include='^[[:space:]]*#[[:space:]]*include[[:space:]]*[<"]' file line text path from
  cd "$1"
  grep -rnE --include='*.hpp' --include='*.cpp' "$include[^<>\"]*/" "${rooms[@]}" |
    while IFS=: read -r file line text; do
      path=${text#*[<\"]}
      path=${path%%[>\"]*}
      path=${path#delf/}
      find_folder "$file"
      from=$folder
      find_folder "$path"
      case $path in
        ../* | */../*) echo "$from:.. $file:$line $path" ;;  # headers are included by their path from the root
        *) [[ -z $folder || " ${may_include[$from]//$'\n'/ } " == *" $folder "* || $folder == "$from" ]] ||
          echo "$from:$folder $file:$line $path" ;;
      esac
    done
}

fail() {
  echo "$*" >&2
  exit 1
}

# A folder that the table does not know would pass as part of its room.
for room in lattice jets schemes tools; do
  for path in "$1/$room"/*/; do
    compgen -G "$path*.[hc]pp" >/dev/null || continue  # such as the shipped scenes
    path=${path#"$1/"}
    [ -n "${may_include[${path%/}]+x}" ] || fail "$path has no entry in tests/package/one_way_includes.sh"
  done
done

# Prints both folders of each pair in tools that the table lets include each other.
pairs_both_ways() {
  local one other
  for one in "${!may_include[@]}"; do
    for other in ${may_include[$one]}; do
      [[ $one != tools* || $other != tools* || " ${may_include[$other]//$'\n'/ } " != *" $one "* ]] || echo "$one $other"
    done
  done
}
[ -z "$(pairs_both_ways)" ] || fail "$(pairs_both_ways)"$'\n'"these folders may include each other"

wrong=$(against_the_arrows "$1")
[ -z "$wrong" ] || fail "$wrong"$'\n'"these includes go against the arrows between folders"

# The check can fail: every folder includes every other in each way of writing it, and just those that the table does not
# give are reported.
planted=$(mktemp -d)
trap 'rm -rf "$planted"' EXIT
expected=''
for from in "${!may_include[@]}"; do
  mkdir -p "$planted/$from/inner"
  for to in "${!may_include[@]}"; do
    printf '#include "%s/a.hpp"\n#  include <delf/%s/a.hpp>\n' "$to" "$to" >>"$planted/$from/inner/b.hpp"
    if [ "$to" != "$from" ] && [[ " ${may_include[$from]//$'\n'/ } " != *" $to "* ]]; then
      expected+="$from:$to"$'\n'"$from:$to"$'\n'
    fi
  done
  echo '#include "../a.hpp"' >>"$planted/$from/inner/b.hpp"
  expected+="$from:.."$'\n'
done
reported=$(against_the_arrows "$planted" | sed 's/ .*//' | sort)
[ "$reported" = "$(sort <<<"${expected%$'\n'}")" ] || fail "planted includes were not reported as the table has them"
for against in lattice:jets jets:schemes schemes:tools schemes/verify:schemes/stepping/rows \
    schemes/solvers:schemes/system schemes/families:schemes/system tools/run:tools/complex tools/scene:tools/verify \
    tools/files:tools/run tools/figures:tools/scene tools/run:tools; do
  grep -qx "$against" <<<"$reported" || fail "$against should go against the arrows"
done

may_include[tools/files]+=' tools/run'
[ -n "$(pairs_both_ways)" ] || fail "tools/files and tools/run include each other, and are not found"

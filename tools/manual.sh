#!/bin/sh
# SPDX-License-Identifier: MIT
# The manual page, made from what the program says of itself: manual.sh DELF > delf.1
set -eu
delf=$1
# A line of text for roff: backslashes, hyphens, and dots and quotes at its beginning.
plain() { sed -e 's/\\/\\e/g' -e 's/-/\\-/g' -e "s/^\([.']\)/\\\\\&\1/"; }
version=$("$delf" --version | cut -d ' ' -f 2)
cat <<END
.TH DELF 1 "" "delf $version" "User Commands"
.SH NAME
delf \- a discrete multisymplectic lattice engine
.SH SYNOPSIS
.nf
END
"$delf" help | sed -n '/^  delf /,/^$/s/^  //p' | plain
printf '.fi\n'
for command in $("$delf" help | sed -n 's/^  delf \([a-z]*\) .*/\1/p' | awk '!seen[$0]++') ; do
  [ "$command" = help ] && continue
  printf '.SH DELF %s\n.nf\n' "$(echo "$command" | tr a-z A-Z)"
  "$delf" help "$command" | plain
  printf '.fi\n'
done
for topic in lagrangians measures; do
  printf '.SH %s\n.nf\n' "$(echo "$topic" | tr a-z A-Z)"
  "$delf" help "$topic" | plain
  printf '.fi\n'
done
cat <<'END'
.SH EXIT STATUS
0 done; 130 interrupted; 1 a check failed; 2 bad input; 3 the numerics failed; 4 the system failed.
END

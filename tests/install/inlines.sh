#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# inlines.sh HEADERS SHARED WORD LEAST: every function that a header defines, marked by WORD, is a symbol of the shared library as well; there
# are at least LEAST of them, and none without the mark.
set -euo pipefail
shown=$(nm --extern-only --defined-only --dynamic --format=posix "$2" | awk '{ print $1 }')
bad=0
count=0
while read -r name; do
    count=$((count + 1))
    grep -qx "$name" <<<"$shown" || { echo "$name is inline only"; bad=1; }
done <<<"$(sed -n 's/^'"$3"' [a-z0-9_ ]*[ *]\([a-z0-9_]*\)(.*/\1/p' "$1"/*.h)"
! grep -nE '^(static )?inline ' "$1"/*.h || bad=1
echo "$count inline functions"
[ "$count" -ge "$4" ] && [ "$bad" = 0 ]

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# inlines.sh HEADERS SHARED: every function that a header defines is a symbol of the shared library as well.
set -euo pipefail
shown=$(nm --extern-only --defined-only --dynamic --format=posix "$2" | awk '{ print $1 }')
bad=0
count=0
while read -r name; do
    count=$((count + 1))
    grep -qx "$name" <<<"$shown" || { echo "$name is inline only"; bad=1; }
done <<<"$(sed -n 's/^QUAT_INLINE [a-z0-9_ ]*[ *]\([a-z0-9_]*\)(.*/\1/p' "$1"/*.h)"
echo "$count inline functions"
[ "$count" -gt 50 ] && [ "$bad" = 0 ]

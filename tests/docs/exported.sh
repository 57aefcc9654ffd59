#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# exported.sh SOURCE WORK LUA LIBRARY...: every function that the shared libraries show is named on a page of docs/, and the reference that
# is made of the headers has these functions and no others.
set -euo pipefail
source=$1 work=$2 lua=$3
shift 3
rm -rf "$work"
mkdir -p "$work"
"$lua" "$source/docs/reference.lua" "$source" "$work"
bad=0
nm --extern-only --defined-only --dynamic --format=posix "$@" | awk 'NF > 1 && $1 !~ /[.:]/ { print $1 }' | LC_ALL=C sort -u >"$work/shown"
# shellcheck disable=SC2016
sed -n 's/^- \[`\([a-z0-9_]*\)()`\](\(quat\|impact\)_[a-z_]*_h\.md.*/\1/p' "$work/index.md" | LC_ALL=C sort -u >"$work/told"
while read -r name; do
    grep -qw -- "$name" "$source"/docs/*.md "$source/README.md" || { echo "$name is on no page of docs/"; bad=1; }
done <"$work/shown"
for name in $(LC_ALL=C comm -23 "$work/shown" "$work/told"); do echo "$name is not in the reference"; bad=1; done
for name in $(LC_ALL=C comm -13 "$work/shown" "$work/told"); do echo "$name of the reference is in no library"; bad=1; done
count=$(wc -l <"$work/shown")
echo "$count functions"
[ "$count" -gt 100 ] && [ "$bad" = 0 ]

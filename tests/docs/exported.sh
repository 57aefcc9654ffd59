#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# exported.sh SOURCE WORK LUA LIBRARY...: every function that the shared libraries show is named on a page of docs/, and has its place
# in the reference that is made of the headers.
set -euo pipefail
source=$1 work=$2 lua=$3
shift 3
rm -rf "$work"
mkdir -p "$work"
"$lua" "$source/docs/reference.lua" "$source" "$work"
bad=0
count=0
while read -r name; do
    count=$((count + 1))
    grep -qw -- "$name" "$source"/docs/*.md "$source/README.md" || { echo "$name is on no page of docs/"; bad=1; }
    grep -q -- "^### .$name. " "$work"/*.md || { echo "$name is not in the reference"; bad=1; }
done <<<"$(nm --extern-only --defined-only --dynamic --format=posix "$@" | awk 'NF > 1 && $1 !~ /[.:]/ { print $1 }' | sort -u)"
echo "$count functions"
[ "$count" -gt 100 ] && [ "$bad" = 0 ]

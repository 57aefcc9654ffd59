#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# symbols.sh NAME SHARED STATIC: the shared library shows, and the archive defines, our prefixes only.
set -euo pipefail
prefix="^${1%%_*}_"
bad=0
check() { # check FILE NM-FLAG...
    local file=$1 names strangers
    shift
    names=$(nm --extern-only --defined-only --format=posix "$@" "$file" | awk 'NF >= 2 && !/:$/ { print $1 }' | sort -u)
    strangers=$(grep -vE "$prefix" <<<"$names" || true)
    echo "$file: $(wc -l <<<"$names") names"
    [ -n "$names" ] || { echo "  none at all"; bad=1; }
    [ -z "$strangers" ] || { echo "  not ours: ${strangers//$'\n'/ }"; bad=1; }
}
check "$2" --dynamic
check "$3"
exit "$bad"

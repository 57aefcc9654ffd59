#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# headers.sh CC CXX DIRECTORY...: every public header compiles alone, and twice over, as C11 and as C++17.
set -euo pipefail
cc=$1
cxx=$2
shift 2
includes=("${@/#/-I}")
warnings=(-Wall -Wextra -Wpedantic -Wshadow -Werror -fsyntax-only)
bad=0
count=0
while read -r header; do
    text="#include <$header>"$'\n'"#include <$header>"$'\n'"extern int not_empty;"
    "$cc" -std=c11 "${warnings[@]}" "${includes[@]}" -x c - <<<"$text" || { echo "$header: not clean C11"; bad=1; }
    [ -z "${cxx%%*NOTFOUND}" ] ||
        "$cxx" -std=c++17 "${warnings[@]}" "${includes[@]}" -x c++ - <<<"$text" || { echo "$header: not clean C++17"; bad=1; }
    count=$((count + 1))
done <<<"$(for directory; do (cd "$directory" && find . -name '*.h' | sed 's|^\./||'); done | sort)"
[ -n "${cxx%%*NOTFOUND}" ] || echo "no C++ compiler: C only"
echo "$count headers"
[ "$count" -gt 0 ] && [ "$bad" = 0 ]

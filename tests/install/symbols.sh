#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# symbols.sh NAME SHARED STATIC: the shared library shows our public prefix only; the archive defines names of that and of
# the internal prefix (impact_: imp_). Vectors are quat's: qvec3_. A library is a guest: it neither speaks on its host's
# streams, nor asks its environment, nor ends it.
set -euo pipefail
prefix=${1%%_*}
[ "$prefix" = impact ] || prefix='quat|qvec[23]|qmat3'
bad=0
check() { # check FILE PREFIXES NM-FLAG...
    local file=$1 prefixes=$2 names strangers
    shift 2
    names=$(nm --extern-only --defined-only --format=posix "$@" "$file" | awk 'NF >= 2 && !/:$/ { print $1 }' | sort -u)
    # gcc's own of 32-bit code that knows no place are hidden, once for all that link them
    strangers=$(grep -vE "^($prefixes)_|^__x86\.get_pc_thunk\." <<<"$names" || true)
    echo "$file: $(wc -l <<<"$names") names"
    [ -n "$names" ] || { echo "  none at all"; bad=1; }
    [ -z "$strangers" ] || { echo "  not ours: ${strangers//$'\n'/ }"; bad=1; }
}
rude=$(nm --dynamic --undefined-only --format=posix "$2" | sed 's/[ @].*//' |
    grep -xE 'std(in|out|err)|v?printf|puts|putchar|perror|(secure_)?getenv|setenv|setlocale|signal|exit|_exit|abort|__assert_fail' || true)
[ -z "$rude" ] || { echo "$2 calls ${rude//$'\n'/ }"; bad=1; }
check "$2" "$prefix" --dynamic
check "$3" "$prefix|imp"
exit "$bad"

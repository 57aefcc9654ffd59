#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# floors.sh SOURCES: a folder of libimpact/src includes from its own and from lower floors only; folders of one floor do not
# include each other; only base/ode_cvode.c with its pool names SUNDIALS, and only one file libccd.
set -euo pipefail
cd "$1"
floor() {
    case $1 in
    base) echo 1 ;;
    shape | flight | collide) echo 2 ;;
    gap) echo 3 ;;
    world) echo 4 ;;
    contact) echo 5 ;;
    motion) echo 6 ;;
    scene) echo 7 ;;
    report | run) echo 8 ;; # what a scene wrote down: asks the scene, and is asked by none below
    *) echo "floors.sh: folder $1 has no floor" >&2; exit 1 ;;
    esac
}
bad=0
count=0
while IFS=: read -r file include; do
    from=${file%%/*}
    to=${include#*\"}
    to=${to%%/*}
    count=$((count + 1))
    [ "$from" = "$to" ] && continue
    [ "$(floor "$to")" -lt "$(floor "$from")" ] || { echo "$file ($(floor "$from")) includes up or sideways: $include"; bad=1; }
done <<<"$(grep -o '#include "[^"]*"' -- */*.[ch])"
only() { # only PATTERN FILES: none but those whose name matches all of it includes it
    local others
    others=$(grep -lE "#include <$1" -- */*.[ch] | grep -vxE "$2" || true)
    [ -z "$others" ] || { echo "$1 is included by ${others//$'\n'/ }"; bad=1; }
}
only '(cvode|nvector|sundials|sunmatrix|sunlinsol|sunnonlinsol|arkode)/' 'base/ode_(cvode|pool)\.[ch]'
only ccd/ 'gap/gjk\.c'
echo "$count includes between files"
[ "$count" -gt 50 ] && [ "$bad" = 0 ]

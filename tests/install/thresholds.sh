#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# thresholds.sh SOURCES FOLDER...: numbers with an exponent, which is how thresholds are written, stand in
# base/tolerances.h alone, with their reasons; and each name there is used. collide/collide_real.h is a number type: its
# literals are powers of two of its own arithmetic.
set -euo pipefail
cd "$1"
shift
bad=0
count=0
plain() { # plain FILE: as it stands, line by line, without comments and strings
    sed -e 's/"\(\\.\|[^"\\]\)*"/""/g' -e 's#/\*.*\*/##g' -e '/\/\*/,/\*\//s/.*//' "$1"
}
for folder; do
    for file in "$folder"/*.[ch]; do
        count=$((count + 1))
        case $file in base/tolerances.h | collide/collide_real.h) continue ;; esac
        found=$(plain "$file" | grep -nE '(^|[^[:alnum:]_.])([0-9]+\.?[0-9]*[eE][-+]?[0-9]+|0x1p[-+]?[0-9]+)' || true)
        [ -z "$found" ] || { echo "$file:${found//$'\n'/$'\n'$file:}"; bad=1; }
    done
done
while read -r name; do
    grep -rqw --include='*.[ch]' --exclude=tolerances.h "$name" . || [ "$(grep -cw "$name" base/tolerances.h)" -gt 1 ] ||
        { echo "tolerances.h: nothing asks for $name"; bad=1; }
done <<<"$(sed -n 's/^#define \(IMP_[A-Z0-9_]*\) .*/\1/p' base/tolerances.h)"
echo "$count files"
[ "$count" -gt 50 ] && [ "$bad" = 0 ]

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# parts.sh CC SOURCE QUAT.a IMPACT.a LIBRARIES WORK HAS_CVODE [RUNNER]: a program holds and loads what its scene needs.
#   static       one of quaternions is at most 30 KB (1 KB = 1024 bytes, stripped) over an empty one
#   archives     one impact, and a ball on a floor, link without SUNDIALS and libccd; a wind says what is absent
#   shared       they load neither; the wind loads CVODE; all answers are those of the archives' programs, to the bit
#   runner       the same of the runner and its scripts
# LIBRARIES: the flags that link SUNDIALS and libccd, in one word.
set -euo pipefail
cc=$1 source=$2 quat=$3 impact=$4 libraries=$5 work=$6 cvode=$7 runner=${8:-}
here=$source/tests/install/parts
flags=(-std=c11 -O2 "-I$source/libquat/include" "-I$source/libimpact/include")
shared=(-L"${impact%/*}" -L"${quat%/*}" -limpact -lquat -lm "-Wl,-rpath,${impact%/*}:${quat%/*}")
read -ra outside <<<"$libraries"
rm -rf "$work"
mkdir -p "$work"
cd "$work"
bad=0
fail() { echo "parts: $*"; bad=1; }
third='lib(sundials|ccd)'
# What the loader mapped while the program ran.
loads() { LD_DEBUG=files LD_DEBUG_OUTPUT="$work/loader" "$@" >said 2>&1 || true; cat "$work"/loader.* >files 2>/dev/null; rm -f "$work"/loader.*; grep -qE "calling init:.*/$third" files; }

size() { "$cc" "${flags[@]}" -static "$@" -Wl,--gc-sections -s -lm -o program && ./program >/dev/null && stat -c %s program; }
over() { # over WHAT FLAG...: what the program of quaternions is over the empty one, both with FLAG
    local what=$1 empty full
    shift
    empty=$(size "$@" "$here/empty.c") full=$(size "$@" "$here/quaternions.c" "$quat")
    echo "a static program of quaternions: $((full - empty)) bytes over $what ($empty)"
    [ $((full - empty)) -le $((30 * 1024)) ] || fail "that is over 30 KB"
}
if size "$here/empty.c" >/dev/null 2>&1; then
    over "an empty one"
    over "one that calls sin, cos and atan2" -DANGLES
else
    echo "no static C library here: sizes are not measured"
fi

awk '$0 == "```c" { on = 1; next } /^```/ { on = 0 } on' "$source/README.md" >impact.c
cp "$source/examples/embed/hello.c" ball.c
cp "$here/wind.c" wind.c
draw=()
[ "$cvode" = 0 ] || draw=("-Wl,-u,imp_part_cvode")
for name in impact ball wind; do
    "$cc" "${flags[@]}" $name.c "$impact" "$quat" -Wl,--gc-sections -lm -o lean_$name # undefined names would stop the linker
    "$cc" "${flags[@]}" $name.c "${draw[@]}" "$impact" "$quat" "${outside[@]}" -lm -o whole_$name
    "$cc" "${flags[@]}" $name.c "${shared[@]}" -o shared_$name
    for kind in lean whole shared; do ./${kind}_$name >$kind.$name || fail "${kind}_$name: $(cat $kind.$name)"; done
    cmp -s whole.$name shared.$name || fail "$name: the shared library answers otherwise than the archive"
done
for name in impact ball; do
    cmp -s whole.$name lean.$name || fail "$name: without the parts it answers otherwise"
    loads ./shared_$name && fail "shared_$name loads $(grep -oE "${third}[a-z_]*" files | sort -u | tr '\n' ' ')"
done
grep -q 'absent: .*CVODE\|absent: .*integrator' lean.wind || fail "the lean program with a wind says: $(cat lean.wind)"
if [ "$cvode" = 1 ]; then
    grep -q flew whole.wind || fail "the whole program with a wind says: $(cat whole.wind)"
    loads ./shared_wind || fail "shared_wind flew without CVODE"
fi

if [ -n "$runner" ]; then
    cat >ball.lua <<'LUA'
local impact = require "impact"
return impact.scene {
  name = "ball", duration = 1,
  bodies = {
    impact.body { name = "floor", shape = impact.plane(), restitution = 1 },
    impact.body { name = "ball", shape = impact.sphere(0.1), mass = 1, position = { 0, 0, 1 }, restitution = 0.8 },
  },
}
LUA
    sed 's/duration = 1,/duration = 1, methods = { motion = "cvode" },/' ball.lua >integrated.lua
    sed 's/duration = 1,/duration = 1, methods = { gaps = "ccd" },/' ball.lua >gaps.lua
    loads "$runner" ball.lua --out out --quiet && fail "the runner's ball loads SUNDIALS or libccd"
    [ -s out/ball.csv ] || fail "the runner's ball: $(cat said)"
    if [ "$cvode" = 1 ]; then
        loads "$runner" integrated.lua --out out --quiet || fail "the runner integrates without CVODE: $(cat said)"
    fi
    "$runner" --version
fi
exit "$bad"

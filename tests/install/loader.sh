#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# loader.sh CC QUAT IMPACT WORK: a program that was linked to 0.1, whose soname was libNAME.so.0, does not start with these libraries; one that
# is linked to them does, and asks for them by their minor version.
set -euo pipefail
cc=$1 quat=$2 impact=$3 work=$4
rm -rf "$work"
mkdir -p "$work/old"
cd "$work"
printf 'double quat_length(void); double quat_length(void) { return 1; }\n' >quat.c
printf 'const char *impact_version(void); const char *impact_version(void) { return "0.1.0"; }\n' >impact.c
printf 'const char *impact_version(void); int main(void) { return impact_version()[0] != 48; }\n' >program.c
for name in quat impact; do "$cc" -shared -fPIC -Wl,-soname,lib$name.so.0 -o old/lib$name.so $name.c; done
"$cc" program.c -o program_old -Wl,--no-as-needed -Lold -limpact -lquat
"$cc" program.c -o program_new "$impact" "$quat"
libraries=$(dirname "$quat"):$(dirname "$impact")
if LD_LIBRARY_PATH=$libraries ./program_old 2>said; then
    echo "a program of 0.1 was loaded"
    exit 1
fi
cat said
grep -qE 'lib(quat|impact)\.so\.0: cannot open shared object file' said
LD_LIBRARY_PATH=$libraries ./program_new
readelf --dynamic --wide program_new | grep -q 'libimpact\.so\.0\.2'

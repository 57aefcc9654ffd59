#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# needed.sh NAME SHARED: the library asks the loader for what its table row says, and nothing drags in a Fortran runtime.
set -euo pipefail
system='libm|libc|ld-linux[^ ]*|libgcc_s'
case $1 in
quat) allowed="$system" ;;
quat_gsl) allowed="$system|libquat|libgsl|libgslcblas" ;;
# libmpi: a SUNDIALS 7 that was built with MPI asks for it
impact) allowed="$system|libpthread|libquat|libsundials_[a-z]*|libccd|libmpi" ;;
esac
needed=$(readelf --dynamic --wide "$2" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
echo "$2 needs: ${needed//$'\n'/ }"
strangers=$(grep -vE "^($allowed)\.so" <<<"$needed" || true)
[ -z "$strangers" ] || { echo "not in its row: $strangers"; exit 1; }
if ldd "$2" | grep -E '^\s*lib(gfortran|flang|quadmath)'; then
    echo "a Fortran runtime is loaded"
    exit 1
fi

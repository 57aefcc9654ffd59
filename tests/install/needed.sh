#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# needed.sh NAME SHARED: the library asks the loader for what its table row says, and nothing drags in a Fortran runtime.
set -euo pipefail
system='libm|libc|ld-linux[^ ]*|libgcc_s'
case $1 in
quat) allowed="$system" ;;
quat_gsl) allowed="$system|libquat|libgsl|libgslcblas" ;;
# its parts, libimpact_cvode and libimpact_ccd, are loaded when a scene needs them
impact) allowed="$system|libpthread|libdl|libquat" ;;
# libmpi: a SUNDIALS 7 that was built with MPI asks for it
impact_cvode) allowed="$system|libsundials_[a-z]*|libmpi" ;;
impact_ccd) allowed="$system|libccd" ;;
esac
needed=$(readelf --dynamic --wide "$2" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
echo "$2 needs: ${needed//$'\n'/ }"
strangers=$(grep -vE "^($allowed)\.so" <<<"$needed" || true)
[ -z "$strangers" ] || { echo "not in its row: $strangers"; exit 1; }
if ldd "$2" | grep -E '^\s*lib(gfortran|flang|quadmath)'; then
    echo "a Fortran runtime is loaded"
    exit 1
fi

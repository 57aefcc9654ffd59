-- SPDX-License-Identifier: MIT
-- From the clone: luarocks --lua-version 5.4 make packaging/quat-impact-0.2.0-1.rockspec
rockspec_format = "3.0"
package = "quat-impact"
version = "0.2.0-1"
source = { url = "." }
description = {
  summary = "Quaternion geometry and exact rigid-body impact",
  detailed = "The Lua modules quat and impact, over libquat and libimpact. SUNDIALS and libccd are taken from the system.",
  license = "MIT",
}
dependencies = { "lua >= 5.4, < 5.5" }
build = {
  type = "command",
  build_command = 'cmake -S . -B build/rock -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTS=OFF -DIMPACT_WITH_MPI=OFF -DIMPACT_WITH_HDF5=OFF ' ..
    '-DLUA_MODULE_DIR="$(LIBDIR)" -DLUA_LAYER_DIR="$(LUADIR)" && cmake --build build/rock',
  install_command = 'cmake --install build/rock --prefix "$(PREFIX)" --component lua',
}

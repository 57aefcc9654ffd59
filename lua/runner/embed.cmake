# SPDX-License-Identifier: MIT
# cmake -DOUTPUT=FILE.c -DLAYERS=module=path,module=path... -P embed.cmake: Lua sources as C arrays (runner_layers.h).
string(REPLACE "," ";" LAYERS "${LAYERS}")
set(arrays "")
set(rows "")
set(number 0)
foreach(layer ${LAYERS})
  string(REGEX MATCH "^([^=]+)=(.+)$" matched "${layer}")
  set(module ${CMAKE_MATCH_1})
  file(READ ${CMAKE_MATCH_2} bytes HEX)
  string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(APPEND arrays "static const unsigned char layer_${number}[] = {\n${bytes}\n};\n")
  string(APPEND rows "    {\"${module}\", layer_${number}, sizeof layer_${number}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT} "/* Made by embed.cmake. */\n#include \"runner_layers.h\"\n\n${arrays}
const impact_runner_layer impact_runner_layers[] = {\n${rows}    {NULL, NULL, 0},\n};\n")

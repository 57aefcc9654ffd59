# SPDX-License-Identifier: MIT
# cmake -DPROGRAM=... -DEXPECTED=... -P same_output.cmake: the program succeeds and prints the file, byte for byte.
execute_process(COMMAND ${PROGRAM} OUTPUT_VARIABLE got RESULT_VARIABLE result)
file(READ ${EXPECTED} wanted)
if(NOT result EQUAL 0 OR NOT got STREQUAL wanted)
  message(FATAL_ERROR "${PROGRAM} ended with ${result}\nwanted: ${wanted}\ngot:    ${got}")
endif()

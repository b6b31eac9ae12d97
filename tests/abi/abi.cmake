# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
#
# Holds the shared library and its header against what was promised: whatever differs here breaks
# programs that were compiled before, and asks for another SOVERSION and another list. Given: LIBRARY,
# LAYOUT (the program), PROMISED (the list), NM, FOUND (where to write what is).
execute_process(COMMAND ${LAYOUT} OUTPUT_VARIABLE found COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${NM} --dynamic --defined-only --format=posix ${LIBRARY}
                OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n ]+ [A-Z] [^\n]*" symbols "${symbols}")
list(TRANSFORM symbols REPLACE " .*" "")
list(SORT symbols)
foreach(symbol ${symbols})
  string(APPEND found "exports ${symbol}\n")
endforeach()
file(WRITE ${FOUND} "${found}")
file(READ ${PROMISED} promised)
if(NOT found STREQUAL promised)
  execute_process(COMMAND diff -u ${PROMISED} ${FOUND} OUTPUT_VARIABLE difference)
  message(FATAL_ERROR "the C interface is not the one that was promised:\n${difference}")
endif()

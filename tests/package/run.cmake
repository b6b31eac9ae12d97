# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
#
# Programs that must succeed, and what they must say.

# run(PROGRAM ARGUMENT...): what it says is in ${text} then.
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE code OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT code EQUAL 0)
    list(JOIN ARGV " " line)
    message(FATAL_ERROR "${line}\n${text}")
  endif()
  set(text "${text}" PARENT_SCOPE)
endfunction()

function(expect_text PATTERN)
  if(NOT text MATCHES "${PATTERN}")
    message(FATAL_ERROR "expected ${PATTERN} in\n${text}")
  endif()
endfunction()

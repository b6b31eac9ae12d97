# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0

# Runs the viewer page's own tests, KIND `unit` or `browser`, with the program VICINITY, in the folder
# PAGE that the page was built in; SOURCE is the page's. Where that cannot be, it says "skipped" and why.

if(NOT NPM)
  message(STATUS "skipped: npm was not found, so that the page was not built")
  return()
endif()
if(NOT EXISTS ${PAGE}/node_modules/.bin/vitest)
  message(STATUS "skipped: npm could not install what the page's tests need")
  return()
endif()
set(script test)
if(KIND STREQUAL browser)
  set(script test:browser)
  find_program(CHROMIUM chromium)
  if(NOT CHROMIUM)
    message(STATUS "skipped: no chromium on PATH (scripts/install_packages.sh --viewer-tests)")
    return()
  endif()
  set(ENV{CHROMIUM} ${CHROMIUM})
  set(ENV{VICINITY} ${VICINITY})
  set(ENV{VICINITY_SCENES} ${SCENES})
endif()
# The page is built from a copy; the two kinds may run at once, and copy the same.
file(COPY ${SOURCE}/tests DESTINATION ${PAGE})
execute_process(COMMAND ${NPM} run --silent ${script} WORKING_DIRECTORY ${PAGE} RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "the page's ${KIND} tests failed")
endif()

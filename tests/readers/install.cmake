# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0

# Puts the public reader that SOURCE is about beside its read.mjs in READER, as the lock file has it.
# Where that cannot be done (no network?) READER holds no read.mjs, and the test that needs it says so.
file(REMOVE_RECURSE ${READER})
file(MAKE_DIRECTORY ${READER})
file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json ${SOURCE}/.npmrc DESTINATION ${READER})
execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
                WORKING_DIRECTORY ${READER} RESULT_VARIABLE failed)
if(failed)
  get_filename_component(name ${SOURCE} NAME)
  message(WARNING "npm could not install the public reader of .${name}: no test opens such files with it")
else()
  file(COPY ${SOURCE}/read.mjs DESTINATION ${READER})
endif()
file(TOUCH ${STAMP})

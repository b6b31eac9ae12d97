# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0

# Builds the page of the viewer in PAGE from SOURCE with NPM, and writes OUTPUT: C++ that holds the
# files it came to.

set(entries)
file(MAKE_DIRECTORY ${PAGE})
set(built FALSE)
if(NPM AND EXISTS ${SOURCE}/package-lock.json)
  file(GLOB inputs LIST_DIRECTORIES true RELATIVE ${SOURCE} ${SOURCE}/* ${SOURCE}/.npmrc)
  list(REMOVE_ITEM inputs node_modules dist tests)
  file(REMOVE_RECURSE ${PAGE}/src ${PAGE}/public ${PAGE}/dist)
  foreach(input IN LISTS inputs)
    file(COPY ${SOURCE}/${input} DESTINATION ${PAGE})
  endforeach()
  set(built TRUE)

  # What was installed for the same lock file is still right.
  file(SHA256 ${PAGE}/package-lock.json lock)
  set(stamp ${PAGE}/node_modules/installed_for_${lock})
  if(NOT EXISTS ${stamp})
    execute_process(COMMAND ${NPM} ci --no-audit --no-fund --loglevel=error
                    WORKING_DIRECTORY ${PAGE} RESULT_VARIABLE failed)
    if(failed)
      set(built FALSE)
      message(WARNING "npm could not install what the viewer's page is made from (no network?): "
                      "vicinity serve is built without its page")
    else()
      file(TOUCH ${stamp})
    endif()
  endif()
  if(built)
    execute_process(COMMAND ${NPM} run --silent build WORKING_DIRECTORY ${PAGE}
                    RESULT_VARIABLE failed)
    if(failed)
      message(FATAL_ERROR "the viewer's page could not be built")
    endif()
  endif()
endif()

set(blobs)
set(table)
if(built)
  file(GLOB_RECURSE files RELATIVE ${PAGE}/dist ${PAGE}/dist/*)
  set(n 0)
  foreach(file IN LISTS files)
    file(SIZE ${PAGE}/dist/${file} size)
    # The assembler takes the bytes as they are.
    string(APPEND blobs "__asm__(\".pushsection .rodata\\n.balign 16\\npage_file_${n}:\\n\"\n"
                        "        \".incbin \\\"${PAGE}/dist/${file}\\\"\\n.popsection\\n\");\n"
                        "extern \"C\" const char page_file_${n}[];\n")
    string(APPEND table "    {\"/${file}\", {page_file_${n}, ${size}}},\n")
    math(EXPR n "${n} + 1")
  endforeach()
endif()
file(WRITE ${OUTPUT}
"// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Made by build_page.cmake from what the page's build left.
#include \"page_files.h\"

#include <vector>

${blobs}
namespace vicinity::viewer {

std::span<const PageFile> page_files() {
  static const std::vector<PageFile> files = {
${table}  };
  return files;
}

}  // namespace vicinity::viewer
")

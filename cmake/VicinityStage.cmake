# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0

# vicinity_stage(NAME [SEES stage...] [PUBLIC library...] [PRIVATE library...])
#
# One stage is one library: include/vicinity/NAME and src/NAME. SEES names the stages above it.
function(vicinity_stage NAME)
  cmake_parse_arguments(STAGE "" "" "SEES;PUBLIC;PRIVATE" ${ARGN})
  list(TRANSFORM STAGE_SEES PREPEND vicinity_)
  set(target vicinity_${NAME})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${NAME}/*.cpp)
  add_library(${target} STATIC ${sources})
  add_library(vicinity::${NAME} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${NAME} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src)  # "STAGE/own_header.h"
  target_link_libraries(${target} PUBLIC ${STAGE_SEES} ${STAGE_PUBLIC} PRIVATE ${STAGE_PRIVATE})
  vicinity_compile_rules(${target})
endfunction()

# The rules every target of ours is compiled by.
function(vicinity_compile_rules TARGET)
  target_compile_features(${TARGET} PUBLIC cxx_std_20)
  # A unity build joins files, where a local may bear the name of another file's constant.
  set(shadow $<IF:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>,-Wshadow=local,-Wshadow>)
  # No fused multiply-add: the same scene gives the same bytes on every machine.
  target_compile_options(${TARGET} PRIVATE -Wall -Wextra ${shadow} -Wconversion -Wno-sign-conversion
                                           -ffp-contract=off)
  if(VICINITY_WERROR)
    target_compile_options(${TARGET} PRIVATE -Werror)
  endif()
  if(VICINITY_SANITIZE)
    # Without the checks of every pointer for null, which stops a program anyhow, and for alignment:
    # they are more than half of what a sanitized build takes. And without that of sums of pointers
    # past the end of memory, a fifth of the code that is left: whoever follows one is caught.
    target_compile_options(${TARGET} PUBLIC $<BUILD_INTERFACE:-fsanitize=${VICINITY_SANITIZE}>
                                            $<BUILD_INTERFACE:-fno-sanitize=null,alignment,pointer-overflow>
                                            $<BUILD_INTERFACE:-fno-omit-frame-pointer>)
    target_link_options(${TARGET} PUBLIC $<BUILD_INTERFACE:-fsanitize=${VICINITY_SANITIZE}>)
  endif()
endfunction()

# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0

# What `cmake --install` lays down, so that find_package(vicinity) and pkg-config work from another
# folder. The components are Debian's packages: VicinityPackages.cmake.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(stages c teleop drag robot viscosity layers voxel mesh geometry)  # as a linker wants them
list(TRANSFORM stages PREPEND vicinity_ OUTPUT_VARIABLE stage_targets)
install(TARGETS vicinity ${stage_targets} EXPORT vicinityTargets COMPONENT development)
install(TARGETS vicinity_shared EXPORT vicinityTargets
        LIBRARY COMPONENT library NAMELINK_COMPONENT development)
install(DIRECTORY include/vicinity DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(EXPORT vicinityTargets NAMESPACE vicinity:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vicinity
        COMPONENT development)
configure_package_config_file(cmake/vicinityConfig.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/vicinityConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vicinity)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/vicinityConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/vicinityConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/vicinityConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vicinity COMPONENT development)

file(RELATIVE_PATH VICINITY_PREFIX_FROM_PC /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" VICINITY_PREFIX_FROM_PC ${VICINITY_PREFIX_FROM_PC})
list(TRANSFORM stage_targets PREPEND -l OUTPUT_VARIABLE VICINITY_PC_LIBS)
list(JOIN VICINITY_PC_LIBS " " VICINITY_PC_LIBS)
foreach(name vicinity vicinity-c)
  configure_file(cmake/${name}.pc.in ${name}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
          COMPONENT development)
endforeach()

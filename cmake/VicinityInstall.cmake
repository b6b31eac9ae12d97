# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0

# What `cmake --install` lays down, so that find_package(vicinity) works from another folder.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS vicinity vicinity_geometry vicinity_mesh vicinity_voxel vicinity_layers
                vicinity_viscosity vicinity_robot vicinity_drag vicinity_teleop vicinity_c
        EXPORT vicinityTargets)
install(DIRECTORY include/vicinity DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT vicinityTargets NAMESPACE vicinity:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vicinity)
configure_package_config_file(cmake/vicinityConfig.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/vicinityConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vicinity)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/vicinityConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/vicinityConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/vicinityConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vicinity)

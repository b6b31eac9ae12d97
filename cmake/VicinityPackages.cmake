# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0

# Debian packages of what was built: cpack -G DEB --config build/release/CPackConfig.cmake. Each states
# the packages that its libraries come from, as dpkg-shlibdeps finds them.
set(CPACK_PACKAGE_NAME vicinity)
set(CPACK_PACKAGE_CONTACT "The Vicinity authors")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)
set(CPACK_STRIP_FILES ON)

set(CPACK_COMPONENTS_ALL library development)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libvicinity0)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "Vicinity: the tick for C, as a shared library")

# Debian's libassimp-dev names zlib to CMake, and not to apt.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libvicinity-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libvicinity0 (= ${PROJECT_VERSION}), libeigen3-dev, libfmt-dev, libtbb-dev, libassimp-dev, zlib1g-dev, libyaml-cpp-dev, nlohmann-json3-dev, libpugixml-dev")
if(VICINITY_MUJOCO)  # for vicinity::mujoco alone
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "libmujoco-dev, libqhull-dev, libgl-dev, libopengl-dev")
endif()
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Vicinity: headers and libraries for C++ and C")

if(VICINITY_CLI)
  list(APPEND CPACK_COMPONENTS_ALL tools)
  set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME vicinity)
  set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS fonts-dejavu-core)
  set(CPACK_COMPONENT_TOOLS_DESCRIPTION "${PROJECT_DESCRIPTION}: the vicinity command")
  if(VICINITY_BRIDGE)
    list(APPEND CPACK_COMPONENTS_ALL bridge)
    set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS vicinity-bridge)
    set(CPACK_DEBIAN_BRIDGE_PACKAGE_NAME vicinity-bridge)
    set(CPACK_DEBIAN_BRIDGE_PACKAGE_SECTION science)
    set(CPACK_DEBIAN_BRIDGE_PACKAGE_DEPENDS "vicinity (= ${PROJECT_VERSION})")  # vicinity bridge
    set(CPACK_COMPONENT_BRIDGE_DESCRIPTION "Vicinity: the bridge to ROS 2 over DDS, vicinity bridge")
  endif()
endif()
if(VICINITY_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-vicinity)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS ${VICINITY_PYTHON_NEEDS})
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Vicinity: import vicinity")
endif()
include(CPack)

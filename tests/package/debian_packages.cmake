# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
#
# Makes the Debian packages of this build, installs them into a root of their own, uses each there and
# removes them again: nothing is left. Given: BUILD, SOURCE, SCRATCH (an own folder), PYTHON, and TOOLS,
# whether the command line is among them.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

file(REMOVE_RECURSE ${SCRATCH})
set(root ${SCRATCH}/root)
file(MAKE_DIRECTORY ${root}/var/lib/dpkg/info ${root}/var/lib/dpkg/updates)
file(TOUCH ${root}/var/lib/dpkg/status)
# Not compressed: that takes longer than all else here, and says nothing of what is in them.
run(${CMAKE_CPACK_COMMAND} -G DEB -D CPACK_DEBIAN_COMPRESSION_TYPE=none --config ${BUILD}/CPackConfig.cmake -B ${SCRATCH}/made)
set(names libvicinity0 libvicinity-dev python3-vicinity)
if(TOOLS)
  list(APPEND names vicinity)
endif()
foreach(name ${names})
  file(GLOB package ${SCRATCH}/made/${name}_*.deb)
  if(NOT package)
    message(FATAL_ERROR "no package ${name} was made")
  endif()
  list(APPEND packages ${package})
endforeach()
foreach(package ${packages})
  run(dpkg-deb --field ${package} Package Version Depends)
  expect_text("Depends: .*(libc6|libvicinity0|libstdc)")
endforeach()

# What they depend on is not in this root, nor a shell: the machine's own libraries and ldconfig serve.
execute_process(COMMAND id -u OUTPUT_VARIABLE user OUTPUT_STRIP_TRAILING_WHITESPACE)
if(user EQUAL 0)
  set(dpkg dpkg --root=${root} --force-depends --force-script-chrootless)
  run(${dpkg} --install ${packages})
else()  # only root may install
  foreach(package ${packages})
    run(dpkg-deb --extract ${package} ${root})
  endforeach()
endif()

set(arm ${SOURCE}/examples/02_arm_tick)
set(field ${SCRATCH}/cell.vicinity)
set(ENV{PYTHONPATH} ${root}/usr/lib/python3/dist-packages)
run(${PYTHON} -B -c "import vicinity
vicinity.save_field(vicinity.build_field(vicinity.read_scene('${arm}/cell.yaml')).field, '${field}')
print(vicinity.__file__)")
expect_text(${root})
if(TOOLS)
  run(${root}/usr/bin/vicinity info ${field})
  expect_text("post")
endif()

set(ENV{PKG_CONFIG_PATH} ${root}/usr/lib/pkgconfig)
run(pkg-config --cflags --libs vicinity-c)
separate_arguments(flags UNIX_COMMAND "${text}")
run(cc ${SOURCE}/tests/package/c_example.c -o ${SCRATCH}/c_example ${flags} -Wl,-rpath,${root}/usr/lib)
run(${SCRATCH}/c_example ${field} ${arm}/arm.urdf)
expect_text("2 joints, started")

run(pkg-config --cflags --libs vicinity)
separate_arguments(flags UNIX_COMMAND "${text}")
run(c++ -std=c++20 ${SOURCE}/examples/01_first_touch/main.cpp -o ${SCRATCH}/first_touch ${flags})
run(${SCRATCH}/first_touch)
expect_text("100 mm away: rank 5")

if(user EQUAL 0)
  run(${dpkg} --purge ${names})
  file(GLOB_RECURSE left ${root}/usr/*)
  if(left)
    message(FATAL_ERROR "left behind: ${left}")
  endif()
endif()

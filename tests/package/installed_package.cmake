# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs this build into a folder of its own, builds the examples against it from another folder,
# and runs them. Given: BUILD (this build), EXAMPLES (their source), SCRATCH (an own folder).
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

function(build_example NAME)
  run(${CMAKE_COMMAND} -S ${EXAMPLES}/${NAME} -B ${SCRATCH}/${NAME} -G Ninja
      -DCMAKE_PREFIX_PATH=${SCRATCH}/installed)
  run(${CMAKE_COMMAND} --build ${SCRATCH}/${NAME})
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/installed)

build_example(01_first_touch)
run(${SCRATCH}/01_first_touch/first_touch)
expect_text("100 mm away: rank 5, drag 0.00060 N")

build_example(02_arm_tick)
set(arm ${EXAMPLES}/02_arm_tick)
if(EXISTS ${SCRATCH}/installed/bin/vicinity)  # what the example ticks in comes from the program
  run(${SCRATCH}/installed/bin/vicinity build ${arm}/cell.yaml -o ${SCRATCH}/cell.vicinity)
  run(${SCRATCH}/02_arm_tick/arm_tick ${SCRATCH}/cell.vicinity ${arm}/arm.urdf ${arm}/device.yaml)
  expect_text("most felt: [a-z_]+ near (post|bench)")
endif()

if(EXISTS ${SCRATCH}/installed/include/vicinity/mujoco)
  build_example(03_mujoco)
  run(${SCRATCH}/03_mujoco/swing ${EXAMPLES}/03_mujoco/arm.xml)
  expect_text("freely: over the table after 0.37 s, at 3.84 m/s\nwith drag: .* 0.29 m/s\n.*near table")
endif()

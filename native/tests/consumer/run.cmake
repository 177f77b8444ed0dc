# SPDX-License-Identifier: Apache-2.0
#
# Installs the library from BUILD below WORK, then configures, builds and runs SOURCE against it.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --config ${CONFIG} --prefix ${WORK}/prefix
  --component development)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G ${GENERATOR}
  -D CMAKE_MAKE_PROGRAM=${MAKE_PROGRAM} -D CMAKE_CXX_COMPILER=${COMPILER}
  -D CMAKE_CXX_FLAGS=${FLAGS}
  -D CMAKE_BUILD_TYPE=${CONFIG} -D CMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/build --config ${CONFIG})
execute_process(COMMAND ${WORK}/build/consumer OUTPUT_VARIABLE printed
  COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
message(STATUS "${printed}")

# The corner of a closed B-spline curve is (1, 4, 1) / 6 of its three control points.
if(NOT printed MATCHES "\\(0, 0\\): position 0.166667 0.166667 0.000000"
    OR NOT printed MATCHES "\\(0.5, 0.5\\): position 0.500000 0.500000 0.000000"
    OR NOT printed MATCHES "closest: 0.500000 0.250000 -?0.000000, distance 2\n")
  message(FATAL_ERROR "This is not the limit surface of a square.")
endif()

execute_process(COMMAND ${WORK}/build/readme OUTPUT_VARIABLE printed
  COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
if(NOT printed STREQUAL "0.166667 0.166667\n")
  message(FATAL_ERROR "The README's program prints ${printed}")
endif()

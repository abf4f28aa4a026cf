# SPDX-FileCopyrightText: 2026 the flocklift authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs BUILD_DIR into a prefix below SCRATCH_DIR, then configures, builds and runs the project
# beside this file against it. Needs BUILD_DIR, SCRATCH_DIR, CONFIG, CXX_COMPILER, GENERATOR; takes
# CXX_FLAGS.

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output
                  ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}: status ${status}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

set(prefix ${SCRATCH_DIR}/prefix)
file(REMOVE_RECURSE ${SCRATCH_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --config ${CONFIG} --prefix ${prefix})
run(${prefix}/bin/flocklift --version)
message("${output}")
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${SCRATCH_DIR}/build -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${CXX_COMPILER}
    -DCMAKE_CXX_FLAGS=${CXX_FLAGS} -DCMAKE_BUILD_TYPE=${CONFIG})
run(${CMAKE_COMMAND} --build ${SCRATCH_DIR}/build --config ${CONFIG})
run(${SCRATCH_DIR}/build/consumer)
message("${output}")
file(REMOVE_RECURSE ${SCRATCH_DIR})

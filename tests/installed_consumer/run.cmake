# SPDX-License-Identifier: MIT
# Installs the package into an empty folder, then configures, builds and runs the project beside this file against it.

function(run_step title)
    message("== ${title}")
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
    if(NOT status EQUAL 0)
        message(FATAL_ERROR "${title} failed")
    endif()
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")
run_step("install" "${CMAKE_COMMAND}" --install "${MYRIAD_BINARY_DIR}" --prefix "${WORK_DIR}/prefix")

# Nothing that is installed may know where it was built.
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH source_dir)
cmake_path(GET source_dir PARENT_PATH source_dir)
file(GLOB_RECURSE installed "${WORK_DIR}/prefix/*")
foreach(file IN LISTS installed)
    file(READ "${file}" text)
    string(FIND "${text}" "${source_dir}/" position)
    if(NOT position EQUAL -1)
        message(FATAL_ERROR "${file} holds a path of the source tree")
    endif()
endforeach()

run_step("configure" "${CMAKE_COMMAND}" -S "${CONSUMER_SOURCE_DIR}" -B "${WORK_DIR}/build" -G "${GENERATOR}"
         "-DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix" "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}" -DCMAKE_BUILD_TYPE=Release
         "-DMYRIAD_ARCH=${ARCH}" "-DMYRIAD_XSIMD_INCLUDE_DIR=${XSIMD_INCLUDE_DIR}"
         "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wconversion -Werror")
run_step("build" "${CMAKE_COMMAND}" --build "${WORK_DIR}/build")
run_step("run" "${WORK_DIR}/build/decay")
run_step("run with a shared library" "${WORK_DIR}/build/decay_shared")

# SPDX-License-Identifier: MIT
# Configures, builds and runs the project beside this file with Myriad from one of: find_package (installed into an
# empty folder, with a model in a shared library too), no_xsimd (the same without SIMD lanes), no_study (Myriad built
# where nlohmann_json is missing), Debian (the package, unpacked), add_subdirectory, FetchContent, CUDA
# (add_subdirectory with MYRIAD_ENABLE_CUDA in a project that has not that language).

function(run_step title)
    message("== ${title}")
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
    if(NOT status EQUAL 0)
        message(FATAL_ERROR "${title} failed")
    endif()
endfunction()

# Expects one sentence from a configuration that fails.
function(run_refused title sentence)
    message("== ${title}")
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE said)
    string(REGEX REPLACE "[ \n]+" " " said "${said}")
    if(status EQUAL 0 OR NOT said MATCHES "${sentence}")
        message(FATAL_ERROR "${title}: expected \"${sentence}\" and not: ${said}")
    endif()
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH source_dir)
cmake_path(GET source_dir PARENT_PATH source_dir)
set(prefix "${WORK_DIR}/prefix")
set(by ${KIND})
set(further)
set(programs decay)
if(KIND STREQUAL "find_package")
    run_step("install" "${CMAKE_COMMAND}" --install "${MYRIAD_BINARY_DIR}" --prefix "${prefix}")
    list(APPEND further -DWITH_SHARED_LIBRARY=ON)
    list(APPEND programs decay_shared)
    if(STUDY) # with which openmp comes
        list(APPEND further -DWITH_STUDY=study)
        list(APPEND programs stored)
    else()
        list(APPEND further "-DMYRIAD_COMPONENTS=openmp")
    endif()
    if(MPI)
        list(APPEND further -DWITH_MPI=mpi)
        list(APPEND programs ranks)
    endif()
elseif(KIND STREQUAL "no_xsimd")
    set(by find_package)
    run_step("install" "${CMAKE_COMMAND}" --install "${MYRIAD_BINARY_DIR}" --prefix "${prefix}")
    list(APPEND further -DMYRIAD_SIMD=OFF)
elseif(KIND STREQUAL "no_study")
    set(by find_package)
    run_step("configure Myriad" "${CMAKE_COMMAND}" -S "${source_dir}" -B "${WORK_DIR}/myriad" -G "${GENERATOR}"
             "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}" "-DMYRIAD_XSIMD_INCLUDE_DIR=${XSIMD_INCLUDE_DIR}"
             -DCMAKE_DISABLE_FIND_PACKAGE_nlohmann_json=ON -DMYRIAD_BUILD_TESTS=OFF -DMYRIAD_BUILD_EXAMPLES=OFF
             -DMYRIAD_BUILD_BENCHMARKS=OFF -DMYRIAD_BUILD_VALIDATION=OFF)
    run_step("build Myriad" "${CMAKE_COMMAND}" --build "${WORK_DIR}/myriad")
    run_step("install" "${CMAKE_COMMAND}" --install "${WORK_DIR}/myriad" --prefix "${prefix}")
elseif(KIND STREQUAL "Debian")
    set(by find_package)
    run_step("package" "${CMAKE_COMMAND}" -E chdir "${MYRIAD_BINARY_DIR}" cpack -G DEB -B "${WORK_DIR}/package")
    file(GLOB package "${WORK_DIR}/package/libmyriad-dev_*.deb")
    run_step("contents" dpkg-deb --info "${package}")
    run_step("unpack" dpkg-deb --extract "${package}" "${WORK_DIR}/unpacked")
    set(prefix "${WORK_DIR}/unpacked/usr")
elseif(KIND STREQUAL "CUDA")
    set(by add_subdirectory)
    list(APPEND further -DMYRIAD_ENABLE_CUDA=ON -DMYRIAD_CUDA_ARCHITECTURES=90 "-DCMAKE_CUDA_COMPILER=${NVCC}")
endif()

if(by STREQUAL "find_package")
    # Nothing that is installed may know where it was built.
    file(GLOB_RECURSE installed "${prefix}/*")
    if(NOT installed)
        message(FATAL_ERROR "nothing was installed")
    endif()
    if(BUILD_TYPE MATCHES "Deb") # the library's debug information does
        list(FILTER installed EXCLUDE REGEX "\\.a$")
    endif()
    foreach(file IN LISTS installed)
        file(STRINGS "${file}" lines REGEX "${source_dir}/")
        if(lines)
            message(FATAL_ERROR "${file} holds a path of the source tree: ${lines}")
        endif()
    endforeach()
endif()

set(configure "${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}" -G "${GENERATOR}" "-DMYRIAD_BY=${by}"
    "-DMYRIAD_SOURCE_DIR=${source_dir}" "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}"
    -DCMAKE_BUILD_TYPE=Release "-DMYRIAD_ARCH=${ARCH}" "-DMYRIAD_XSIMD_INCLUDE_DIR=${XSIMD_INCLUDE_DIR}"
    "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wconversion -Werror")
if(KIND STREQUAL "find_package")
    run_step("install the core alone" "${CMAKE_COMMAND}" --install "${MYRIAD_BINARY_DIR}" --prefix "${WORK_DIR}/core"
             --component core)
    run_refused("a component that is not installed"
                "component openmp of myriad is not installed, only core: install Myriad" ${configure}
                -B "${WORK_DIR}/refused" "-DCMAKE_PREFIX_PATH=${WORK_DIR}/core" -DMYRIAD_COMPONENTS=openmp)
    run_refused("a component that there is not" "component opencl of myriad is not installed" ${configure}
                -B "${WORK_DIR}/unknown" -DMYRIAD_COMPONENTS=opencl)
endif()
if(KIND STREQUAL "no_study")
    run_refused("studies that are not installed"
                "component study of myriad is not installed, only core, openmp: install" ${configure}
                -B "${WORK_DIR}/refused" -DWITH_STUDY=study)
endif()
run_step("configure" ${configure} -B "${WORK_DIR}/build" ${further})
run_step("build" "${CMAKE_COMMAND}" --build "${WORK_DIR}/build")
foreach(program IN LISTS programs)
    run_step("run ${program}" "${CMAKE_COMMAND}" -E chdir "${WORK_DIR}/build" ./${program})
endforeach()

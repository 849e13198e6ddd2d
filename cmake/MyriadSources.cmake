# SPDX-License-Identifier: MIT
# The compiled parts of the host side, which are in the libraries and in the Python package's module. The files of
# a part are compiled together, since a file alone takes most of its time for headers.

# myriad_add_host_sources(<target>): what depends on no model.
function(myriad_add_host_sources target)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../src/host/*.cpp")
    target_sources(${target} PRIVATE ${sources})
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
    # Fast where a project has no build type, too.
    target_compile_options(${target} PRIVATE $<$<NOT:$<CONFIG:Debug>>:-O2>)
endfunction()

# myriad_add_compile_sources(<target>): models compiled at run time, by the program and the Python package.
function(myriad_add_compile_sources target)
    cmake_path(SET folder NORMALIZE "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../src")
    file(GLOB sources CONFIGURE_DEPENDS "${folder}/compile/*.cpp")
    target_sources(${target} PRIVATE ${sources})
    target_include_directories(${target} PRIVATE "${folder}")
    include("${CMAKE_CURRENT_FUNCTION_LIST_DIR}/MyriadKernelFlags.cmake")
    foreach(compiler IN ITEMS "" _GNU _Clang)
        string(TOUPPER "MYRIAD_KERNEL_FLAGS${compiler}" name)
        list(JOIN myriad_kernel_flags${compiler} " " flags)
        target_compile_definitions(${target} PRIVATE "${name}=\"${flags}\"")
    endforeach()
    foreach(set IN ITEMS AVX512 AVX2 SSE2)
        target_compile_definitions(${target} PRIVATE "MYRIAD_ARCHITECTURE_${set}=\"${myriad_architecture_${set}}\"")
    endforeach()
    target_compile_definitions(${target} PRIVATE MYRIAD_OLDEST_GNU=${myriad_oldest_GNU}
                                                 MYRIAD_OLDEST_CLANG=${myriad_oldest_Clang})
endfunction()

# myriad_add_study_sources(<target>): studies and their results on disk. What works on every value is fully optimised,
# in an object library of its own, <target>_values.
function(myriad_add_study_sources target)
    cmake_path(SET folder NORMALIZE "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../src/study")
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${folder}/*.cpp")
    set(fast plan/axes plan/exact_sum plan/histogram plan/reduced_sets plan/reduction run/chunk_solver run/device_solver
             store/crc32c)
    list(TRANSFORM fast REPLACE "(.+)" "${folder}/\\1.cpp")
    list(REMOVE_ITEM sources ${fast})
    add_library(${target}_values OBJECT ${fast})
    target_compile_options(${target}_values PRIVATE $<$<NOT:$<CONFIG:Debug>>:-O3>)
    target_sources(${target} PRIVATE ${sources})
    target_compile_options(${target} PRIVATE $<$<NOT:$<CONFIG:Debug>>:-Og>)
    set_target_properties(${target} ${target}_values PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
endfunction()

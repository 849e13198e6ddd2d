# SPDX-License-Identifier: MIT
# The compiled parts of the host side, which the libraries and the Python package's module consist of. Their files are
# compiled together, several at a time, as most of the time of each is that of the headers.

# myriad_add_host_sources(<target>): what depends on no model.
function(myriad_add_host_sources target)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../src/host/*.cpp")
    target_sources(${target} PRIVATE ${sources})
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 9)
    # Fast where a project has no build type, too.
    target_compile_options(${target} PRIVATE $<$<NOT:$<CONFIG:Debug>>:-O3>)
endfunction()

# myriad_add_study_sources(<target>): studies and their results on disk. Only what works on every value is fully
# optimised.
function(myriad_add_study_sources target)
    set(folder "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../src/study")
    file(GLOB sources CONFIGURE_DEPENDS "${folder}/*.cpp")
    target_sources(${target} PRIVATE ${sources})
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 7)
    target_compile_options(${target} PRIVATE $<$<NOT:$<CONFIG:Debug>>:-O1>)
    set(fast axes chunk_solver crc32c device_solver exact_sum reduction)
    list(TRANSFORM fast REPLACE "(.+)" "${folder}/\\1.cpp")
    set_source_files_properties(${fast} PROPERTIES COMPILE_OPTIONS "$<$<NOT:$<CONFIG:Debug>>:-O3>")
endfunction()

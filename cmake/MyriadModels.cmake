# SPDX-License-Identifier: MIT
# myriad_add_models(): compiles model source files with the flags that SIMD lanes need. Per file and not per target,
# because the alignment of Eigen's objects depends on them, and main and its libraries must agree on that.
include_guard(GLOBAL)
include(CheckCXXCompilerFlag)

set(MYRIAD_ARCH "" CACHE STRING
    "Instruction set of model files, as in -march=, or a list of which a program takes what the CPU has; \
empty: the compiler's own")
set(MYRIAD_FP_CONTRACT off CACHE STRING
    "Contraction of a * b + c in model files: off, or fast, which gives up bit-identical results")
set(MYRIAD_MODEL_FLAGS "" CACHE STRING
    "Further flags of model files, after the library's own, which they override: -O0 for a debugger")
set_property(CACHE MYRIAD_ARCH PROPERTY STRINGS native x86-64-v4 x86-64-v3 x86-64-v2)
set_property(CACHE MYRIAD_FP_CONTRACT PROPERTY STRINGS fast off)

# myriad_model_flags(<result> [<arch>]) sets the variable to the flags of model files for one instruction set, by
# default the last of MYRIAD_ARCH.
function(myriad_model_flags result)
    set(arch ${ARGN})
    if(NOT arch AND MYRIAD_ARCH)
        list(GET MYRIAD_ARCH -1 arch)
    endif()
    if(NOT MYRIAD_FP_CONTRACT MATCHES "^(fast|off)$")
        message(FATAL_ERROR "MYRIAD_FP_CONTRACT is ${MYRIAD_FP_CONTRACT} (must be fast or off)")
    endif()
    set(flags)
    if(arch)
        string(MAKE_C_IDENTIFIER "MYRIAD_HAS_ARCH_${arch}" check)
        set(CMAKE_REQUIRED_QUIET ON)
        check_cxx_compiler_flag("-march=${arch}" ${check})
        if(NOT ${check})
            message(FATAL_ERROR "MYRIAD_ARCH is ${MYRIAD_ARCH}, and ${CMAKE_CXX_COMPILER} does not know "
                                "-march=${arch}: give native, x86-64-v3, or nothing for the compiler's own "
                                "instruction set")
        endif()
        list(APPEND flags "-march=${arch}")
    else()
        get_property(told GLOBAL PROPERTY MYRIAD_ARCH_TOLD)
        if(NOT told)
            set_property(GLOBAL PROPERTY MYRIAD_ARCH_TOLD TRUE)
            message(STATUS "Myriad: models use the compiler's own instruction set; "
                           "-DMYRIAD_ARCH=native is several times as fast")
        endif()
    endif()
    include("${CMAKE_CURRENT_FUNCTION_LIST_DIR}/MyriadKernelFlags.cmake")
    list(APPEND flags ${myriad_kernel_flags})
    if(CMAKE_CXX_COMPILER_ID MATCHES "(GNU|Clang)")
        list(APPEND flags ${myriad_kernel_flags_${CMAKE_MATCH_1}})
    endif()
    list(TRANSFORM flags REPLACE "^-ffp-contract=.*" "-ffp-contract=${MYRIAD_FP_CONTRACT}")
    # In every configuration, including none and custom ones: without optimisation kernels take 50 to 250 times as long.
    # Debug needs it too: the AVX-512 part of xsimd 8.1 compiles only with optimisation, and without inlining packs are
    # useless.
    list(TRANSFORM flags REPLACE "^-O3$" "$<IF:$<CONFIG:Debug>,-O1,-O3>")
    separate_arguments(further UNIX_COMMAND "${MYRIAD_MODEL_FLAGS}")
    list(APPEND flags ${further})
    set(${result} "${flags}" PARENT_SCOPE)
endfunction()

# Adds one file with the flags for one instruction set.
function(myriad_add_model_source target file arch)
    target_sources(${target} PRIVATE "${file}")
    get_property(known SOURCE "${file}" TARGET_DIRECTORY ${target} PROPERTY MYRIAD_MODEL)
    if(known)
        return()
    endif()
    myriad_model_flags(flags ${arch})
    set_property(SOURCE "${file}" TARGET_DIRECTORY ${target} PROPERTY MYRIAD_MODEL TRUE)
    set_property(SOURCE "${file}" TARGET_DIRECTORY ${target} APPEND PROPERTY COMPILE_OPTIONS ${flags})
    set_property(SOURCE "${file}" TARGET_DIRECTORY ${target} APPEND PROPERTY COMPILE_DEFINITIONS MYRIAD_MODEL_FILE)
    # A unity file or a precompiled header would mix these flags with those of other files.
    set_property(SOURCE "${file}" TARGET_DIRECTORY ${target} PROPERTY SKIP_UNITY_BUILD_INCLUSION ON)
    set_property(SOURCE "${file}" TARGET_DIRECTORY ${target} PROPERTY SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# Refuses a file that is not a model: its flags would be incompatible with the other files of the program.
function(myriad_require_model target file)
    if(NOT EXISTS "${file}") # made by the build
        return()
    endif()
    file(READ "${file}" text)
    if(text MATCHES "(^|\n)[ \t]*(auto|int)[ \t\n]+main[ \t\n]*\\(" AND NOT text MATCHES "MYRIAD_INSTANTIATE")
        message(FATAL_ERROR
                "myriad_add_models(${target} ...): ${file} has the function main and no MYRIAD_INSTANTIATE. "
                "Model files "
                            "get other flags than the rest of a program, on which the memory layout of Eigen's "
                            "objects depends: "
                            "name ${file} in add_executable, and here the files with MYRIAD_INSTANTIATE alone")
    endif()
endfunction()

# Refuses an option that nvcc's preprocessor, and so kernel/core/ieee.hpp, cannot detect.
function(myriad_require_exact_cuda target)
    set(flags "${CMAKE_CUDA_FLAGS}")
    foreach(config IN ITEMS ${CMAKE_BUILD_TYPE} ${CMAKE_CONFIGURATION_TYPES})
        string(TOUPPER "${config}" config)
        string(APPEND flags " ${CMAKE_CUDA_FLAGS_${config}}")
    endforeach()
    get_target_property(options ${target} COMPILE_OPTIONS)
    if("${flags} ${options}" MATCHES "(^|[ ;:-])(-?use_fast_math|-?ftz=true|-?prec-sqrt=false)")
        message(FATAL_ERROR
                "myriad_add_models(${target} ...): nvcc is given ${CMAKE_MATCH_2}, with which single precision loses "
                            "the accuracy that step-size control and the mathematical functions rely on: remove "
                            "the option")
    endif()
endfunction()

# The name, without extension, of files generated from a model file.
function(myriad_twin_name result file)
    cmake_path(ABSOLUTE_PATH file NORMALIZE)
    string(SHA256 unique "${file}")
    string(SUBSTRING "${unique}" 0 8 unique)
    cmake_path(GET file STEM stem)
    set(${result} "${stem}_${unique}" PARENT_SCOPE)
endfunction()

# myriad_add_models(<target> [CPU_ONLY] [EXACT_FLOAT] <file>...) adds model files, those with MYRIAD_INSTANTIATE, to a
# target of the same directory: a program, an OBJECT library or a SHARED one. Such a file includes no Eigen. With a list
# of instruction sets in MYRIAD_ARCH it is compiled once for each, and may then define nothing but the kernels; of
# x86-64-v2, -v3 and -v4 each at most once, since kernels are distinguished only by SSE2, AVX2 and AVX-512, and two of
# the same would clash. Optimisation is required to inline the standard library's inline functions, of which the linker
# would otherwise keep one copy for all instruction sets. Links myriad::openmp and, if the CUDA backend is on, compiles
# each file for GPUs too, unless CPU_ONLY is given, and links myriad::cuda; there, functions and quotients in single
# precision are the fast ones of docs/numerics.md, or with EXACT_FLOAT CUDA's own.
function(myriad_add_models target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "CPU_ONLY;EXACT_FLOAT" "" "")
    include("${CMAKE_CURRENT_FUNCTION_LIST_DIR}/MyriadKernelFlags.cmake")
    if(NOT TARGET ${target})
        message(FATAL_ERROR "myriad_add_models(${target} ...): there is no target ${target}; "
                            "call add_executable or add_library first")
    endif()
    get_target_property(type ${target} TYPE)
    if(type STREQUAL "STATIC_LIBRARY")
        message(FATAL_ERROR
                "myriad_add_models(${target} ...): a linker takes no models out of a static library, as nothing "
                            "refers to them by name; make ${target} an OBJECT library, or add the models to the "
                            "program")
    endif()
    if(type STREQUAL "INTERFACE_LIBRARY")
        message(FATAL_ERROR
                "myriad_add_models(${target} ...): an INTERFACE library compiles no files; make ${target} an "
                            "OBJECT library, or add the models to the program")
    endif()
    if(type STREQUAL "SHARED_LIBRARY")
        get_target_property(visibility ${target} CXX_VISIBILITY_PRESET)
        if(visibility STREQUAL "hidden")
            message(FATAL_ERROR
                    "myriad_add_models(${target} ...): with CXX_VISIBILITY_PRESET hidden no program sees the "
                                "kernels of a SHARED library; set it to default for ${target} and the programs "
                                "that link it, "
                                "or make ${target} an OBJECT library")
        endif()
        # Programs refer to kernels only weakly, so a linker might drop the library.
        target_link_options(${target} INTERFACE "LINKER:--no-as-needed")
    endif()
    list(LENGTH MYRIAD_ARCH sets)
    foreach(file IN LISTS arg_UNPARSED_ARGUMENTS)
        cmake_path(ABSOLUTE_PATH file NORMALIZE)
        myriad_require_model(${target} "${file}")
        myriad_twin_name(name "${file}")
        if(sets LESS_EQUAL 1)
            myriad_add_model_source(${target} "${file}" "${MYRIAD_ARCH}")
        else()
            foreach(arch IN LISTS MYRIAD_ARCH)
                set(twin "${CMAKE_CURRENT_BINARY_DIR}/${arch}/${name}.cpp")
                file(CONFIGURE OUTPUT "${twin}" CONTENT "#include \"${file}\"\n")
                myriad_add_model_source(${target} "${twin}" "${arch}")
            endforeach()
        endif()
        if(TARGET myriad::cuda AND NOT arg_CPU_ONLY)
            if(NOT CMAKE_CUDA_COMPILE_OBJECT) # CMake would say "_CMAKE_CUDA_WHOLE_FLAG not set", and not where
                message(FATAL_ERROR
                        "myriad_add_models(${target} ...): MYRIAD_ENABLE_CUDA is ON, and this directory has not the "
                        "language CUDA, which Myriad turned on for another: write project(${CMAKE_PROJECT_NAME} "
                        "LANGUAGES CXX CUDA)")
            endif()
            # The same file again, under a name that nvcc recognises as CUDA.
            set(twin "${CMAKE_CURRENT_BINARY_DIR}/cuda/${name}.cu")
            file(CONFIGURE OUTPUT "${twin}" CONTENT "#include \"${file}\"\n")
            target_sources(${target} PRIVATE "${twin}")
            # The host part of it, unless the configuration's own flags have an optimisation level, which nvcc puts
            # last.
            set_property(SOURCE "${twin}" TARGET_DIRECTORY ${target} PROPERTY COMPILE_OPTIONS
                         "$<$<NOT:$<CONFIG:Debug>>:-Xcompiler=-O3>")
            if(arg_EXACT_FLOAT)
                set_property(SOURCE "${twin}" TARGET_DIRECTORY ${target} APPEND PROPERTY COMPILE_DEFINITIONS
                             MYRIAD_EXACT_FLOAT)
            else()
                set_property(SOURCE "${twin}" TARGET_DIRECTORY ${target} APPEND PROPERTY COMPILE_OPTIONS
                             ${myriad_kernel_flags_NVIDIA})
            endif()
            set_property(SOURCE "${twin}" TARGET_DIRECTORY ${target} PROPERTY OBJECT_DEPENDS "${file}")
        endif()
    endforeach()
    target_link_libraries(${target} PRIVATE myriad::openmp)
    if(TARGET myriad::cuda AND NOT arg_CPU_ONLY)
        myriad_require_exact_cuda(${target})
        target_link_libraries(${target} PRIVATE myriad::cuda)
    endif()
endfunction()

# SPDX-License-Identifier: MIT
# Enables the CUDA language, with nvcc and the architectures of MYRIAD_CUDA_ARCHITECTURES. Included at file scope, as
# CMake requires, by the project itself and by the installed package.

set(MYRIAD_CUDA_ARCHITECTURES "" CACHE STRING "GPUs to compile for, as CMAKE_CUDA_ARCHITECTURES; empty: this machine's")
get_property(languages GLOBAL PROPERTY ENABLED_LANGUAGES)
if(NOT CUDA IN_LIST languages)
    if(MYRIAD_CUDA_ARCHITECTURES)
        set(CMAKE_CUDA_ARCHITECTURES "${MYRIAD_CUDA_ARCHITECTURES}")
    elseif(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
        find_program(MYRIAD_NVIDIA_SMI nvidia-smi)
        mark_as_advanced(MYRIAD_NVIDIA_SMI)
        set(gpus "")
        if(MYRIAD_NVIDIA_SMI)
            execute_process(COMMAND "${MYRIAD_NVIDIA_SMI}" -L OUTPUT_VARIABLE gpus ERROR_QUIET)
        endif()
        if(gpus MATCHES "^GPU ")
            set(CMAKE_CUDA_ARCHITECTURES native)
        else()
            # Machine code for Turing, Ampere and Hopper, and PTX for newer GPUs.
            set(CMAKE_CUDA_ARCHITECTURES 75-real 80-real 90)
        endif()
    endif()
    include(CheckLanguage)
    check_language(CUDA)
    if(NOT CMAKE_CUDA_COMPILER)
        message(FATAL_ERROR
                "MYRIAD_ENABLE_CUDA is ON, and nvcc was not found: put nvcc (from the CUDA Toolkit, 12 or newer) on "
                            "the PATH, or set the option to OFF")
    endif()
    enable_language(CUDA)
    # CMake turns a language on for the directory that asks for it and those below. As a part of a project that has not
    # CUDA, Myriad hands what it found out to the directory that added it, whose targets are compiled with it.
    if(PROJECT_NAME STREQUAL "myriad" AND NOT PROJECT_IS_TOP_LEVEL)
        get_cmake_property(variables VARIABLES)
        list(FILTER variables INCLUDE REGEX "CUDA")
        list(FILTER variables EXCLUDE REGEX "^MYRIAD_")
        foreach(variable IN LISTS variables)
            set(${variable} "${${variable}}" PARENT_SCOPE)
        endforeach()
    endif()
endif()
find_package(CUDAToolkit REQUIRED)

# SPDX-License-Identifier: MIT
# Defines myriad::xsimd, the include directory of xsimd 8.1 or newer, or nothing where models do without SIMD lanes.
# Not xsimd's own target, since the one of Debian 12 links xtl, which is neither a library nor needed. Sets
# myriad_xsimd_FOUND, and a message if it is not found.

set(MYRIAD_SIMD ON CACHE STRING
    "SIMD lanes, by xsimd: ON, OFF (one instance at a time, several times slower), AUTO (as xsimd is there or not)")
set_property(CACHE MYRIAD_SIMD PROPERTY STRINGS ON OFF AUTO)

find_path(MYRIAD_XSIMD_INCLUDE_DIR NAMES xsimd/xsimd.hpp DOC "Directory that holds xsimd/xsimd.hpp")
mark_as_advanced(MYRIAD_XSIMD_INCLUDE_DIR)

set(myriad_xsimd_FOUND FALSE)
if(NOT MYRIAD_SIMD AND NOT MYRIAD_SIMD STREQUAL "AUTO")
    set(myriad_xsimd_NOT_FOUND_MESSAGE "MYRIAD_SIMD is OFF")
elseif(NOT MYRIAD_XSIMD_INCLUDE_DIR)
    set(myriad_xsimd_NOT_FOUND_MESSAGE "xsimd/xsimd.hpp was not found")
else()
    set(myriad_xsimd_VERSION)
    file(STRINGS "${MYRIAD_XSIMD_INCLUDE_DIR}/xsimd/config/xsimd_config.hpp" myriad_xsimd_lines
         REGEX "define XSIMD_VERSION_(MAJOR|MINOR|PATCH) ")
    foreach(line IN LISTS myriad_xsimd_lines)
        if(line MATCHES " ([0-9]+)")
            list(APPEND myriad_xsimd_VERSION ${CMAKE_MATCH_1})
        endif()
    endforeach()
    unset(myriad_xsimd_lines)
    list(JOIN myriad_xsimd_VERSION "." myriad_xsimd_VERSION)
    if(myriad_xsimd_VERSION VERSION_LESS 8.1)
        set(myriad_xsimd_NOT_FOUND_MESSAGE
            "${MYRIAD_XSIMD_INCLUDE_DIR} holds xsimd ${myriad_xsimd_VERSION}, and 8.1 is the oldest that works")
    else()
        set(myriad_xsimd_FOUND TRUE)
        if(NOT TARGET myriad::xsimd)
            message(STATUS "xsimd ${myriad_xsimd_VERSION}: found")
            add_library(myriad::xsimd INTERFACE IMPORTED GLOBAL)
            target_include_directories(myriad::xsimd INTERFACE "${MYRIAD_XSIMD_INCLUDE_DIR}")
        endif()
    endif()
endif()
if(NOT myriad_xsimd_FOUND AND NOT TARGET myriad::xsimd AND (NOT MYRIAD_SIMD OR MYRIAD_SIMD STREQUAL "AUTO"))
    message(NOTICE "Myriad: models are compiled without SIMD lanes and take several times as long, as "
                   "${myriad_xsimd_NOT_FOUND_MESSAGE}: install Debian package libxsimd-dev, and configure anew")
    set(myriad_xsimd_FOUND TRUE)
    add_library(myriad::xsimd INTERFACE IMPORTED GLOBAL)
    target_compile_definitions(myriad::xsimd INTERFACE MYRIAD_WITHOUT_XSIMD)
endif()

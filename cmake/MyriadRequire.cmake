# SPDX-License-Identifier: MIT
# Looks up packages and collects what is missing, so that one message lists all Debian packages to install.

# myriad_require(<package> <debian package> TARGET <target> FOR <purpose> [UNLESS <option>] [COMPONENTS <component>...])
# looks for a CMake package. If it does not define the target, myriad_require_report() will say so; UNLESS names the
# option that switches off the part which needs the package.
function(myriad_require package debian_package)
    cmake_parse_arguments(PARSE_ARGV 2 arg "" "TARGET;FOR;UNLESS;SKIPPED" "COMPONENTS")
    if(arg_SKIPPED)
        set(${arg_SKIPPED} FALSE PARENT_SCOPE)
    endif()
    set(components)
    if(arg_COMPONENTS)
        set(components COMPONENTS ${arg_COMPONENTS})
    endif()
    if(TARGET ${arg_TARGET})
        return() # given in another way
    elseif(package STREQUAL "OpenMP")
        find_package(OpenMP QUIET ${components}) # CMake's own module, not a package that OpenMP installs
    else()
        find_package(${package} CONFIG QUIET ${components})
    endif()
    if(TARGET ${arg_TARGET})
        message(STATUS "${package} ${${package}_VERSION}: found")
    elseif(arg_SKIPPED AND MYRIAD_SKIP_MISSING)
        message(NOTICE "Left out: ${arg_FOR}, as ${package} is missing (Debian package ${debian_package})")
        set(${arg_SKIPPED} TRUE PARENT_SCOPE)
    else()
        myriad_missing(${package} ${debian_package} FOR "${arg_FOR}" UNLESS "${arg_UNLESS}")
    endif()
endfunction()

# With MYRIAD_SKIP_MISSING such a part is left out instead, with a message. That is a macro's work, as it sets the
# option.
macro(myriad_require_for_part option package debian_package)
    myriad_require(${package} ${debian_package} ${ARGN} UNLESS ${option} SKIPPED myriad_skipped)
    if(myriad_skipped)
        set(${option} OFF)
    endif()
endmacro()

# myriad_missing(<package> <debian package> FOR <purpose> [UNLESS <option>] [BECAUSE <reason>]) notes a missing package.
function(myriad_missing package debian_package)
    cmake_parse_arguments(PARSE_ARGV 2 arg "" "FOR;UNLESS;BECAUSE" "")
    set(line "${package}, for ${arg_FOR}: Debian package ${debian_package}")
    if(arg_UNLESS)
        string(APPEND line ", or configure with -D${arg_UNLESS}=OFF")
    endif()
    if(arg_BECAUSE)
        string(APPEND line " (${arg_BECAUSE})")
    endif()
    set_property(GLOBAL APPEND_STRING PROPERTY MYRIAD_MISSING_TEXT "  * ${line}\n")
    set_property(GLOBAL APPEND PROPERTY MYRIAD_MISSING_PACKAGES ${debian_package})
endfunction()

# myriad_require_report() stops the configuration if anything was missing.
function(myriad_require_report)
    get_property(text GLOBAL PROPERTY MYRIAD_MISSING_TEXT)
    get_property(packages GLOBAL PROPERTY MYRIAD_MISSING_PACKAGES)
    if(text)
        list(JOIN packages " " packages)
        message(FATAL_ERROR "Myriad needs what was not found:\n${text}"
                            "On Debian and Ubuntu:\n  apt-get install ${packages}\n")
    endif()
endfunction()

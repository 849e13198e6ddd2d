# SPDX-License-Identifier: MIT
# myriad_single_lanes(): which of the project's own model files test just as much without packs.
include_guard(GLOBAL)

# Files that scripts/test.sh compiles for GPUs only with --all.
file(WRITE "${PROJECT_BINARY_DIR}/single_lanes.txt" "")

# myriad_single_lanes(<file>...): without MYRIAD_THOROUGH the kernels of these files, of the same directory, integrate
# one instance at a time on the CPU. A program must not contain a kernel in both variants. For files that test numbers
# (orders, references, closed forms), not interactions between lanes, and whose features other files test in packs.
function(myriad_single_lanes)
    if(NOT MYRIAD_THOROUGH)
        set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_DEFINITIONS MYRIAD_SCALAR_LANES)
    endif()
    foreach(file IN LISTS ARGN)
        myriad_twin_name(name "${file}")
        file(APPEND "${PROJECT_BINARY_DIR}/single_lanes.txt" "/cuda/${name}.cu.o\n")
    endforeach()
endfunction()

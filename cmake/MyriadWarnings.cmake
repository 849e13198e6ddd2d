# SPDX-License-Identifier: MIT
# The target myriad_warnings: what the project's own programs are warned of. Never a dependency of a user's target.

add_library(myriad_warnings INTERFACE)
# A double constant in a float model costs a GPU dearly, so narrowing is an error in every preset.
target_compile_options(myriad_warnings INTERFACE -Wall -Wextra -Wconversion -Werror=float-conversion)
if(MYRIAD_WERROR)
    target_compile_options(myriad_warnings INTERFACE -Werror)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # "note: the ABI for passing parameters with 64-byte alignment has changed in GCC 4.6" concerns no one today.
    target_compile_options(myriad_warnings INTERFACE -Wno-psabi)
endif()

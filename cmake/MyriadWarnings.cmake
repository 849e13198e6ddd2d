# SPDX-License-Identifier: MIT
# The target myriad_warnings: the warning flags of the project's own programs. Never a dependency of a user's target.

add_library(myriad_warnings INTERFACE)
# A double constant in a float model is expensive on a GPU, so narrowing is an error in every preset.
set(cxx_warnings -Wall -Wextra -Wconversion -Werror=float-conversion)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # "note: the ABI for passing parameters with 64-byte alignment has changed in GCC 4.6" is irrelevant today.
    list(APPEND cxx_warnings -Wno-psabi)
endif()
set(cuda_warnings -Xcompiler=-Wall,-Wextra,-Wconversion)
if(MYRIAD_WERROR)
    list(APPEND cxx_warnings -Werror)
    list(APPEND cuda_warnings --Werror=all-warnings)
endif()
target_compile_options(myriad_warnings INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:${cxx_warnings}>"
                                                 "$<$<COMPILE_LANGUAGE:CUDA>:${cuda_warnings}>")

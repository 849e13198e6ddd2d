# SPDX-License-Identifier: MIT
# CLI11 from a folder with its headers, -DMYRIAD_CLI11_INCLUDE_DIR=, where it is not installed as a package.
set(MYRIAD_CLI11_INCLUDE_DIR "" CACHE PATH "Directory that holds CLI/CLI.hpp; empty: the installed package")
mark_as_advanced(MYRIAD_CLI11_INCLUDE_DIR)
if(MYRIAD_CLI11_INCLUDE_DIR AND NOT TARGET CLI11::CLI11)
    add_library(CLI11::CLI11 INTERFACE IMPORTED GLOBAL)
    target_include_directories(CLI11::CLI11 INTERFACE "${MYRIAD_CLI11_INCLUDE_DIR}")
endif()

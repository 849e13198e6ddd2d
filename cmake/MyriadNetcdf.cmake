# SPDX-License-Identifier: MIT
# Finds netCDF's C library, 4.7 or newer, as the target myriad::netcdf: installed, or in a folder with include/ and lib/
# that netCDF_ROOT or CMAKE_PREFIX_PATH names. Not by netCDF's own package, whose target names the development files of
# libraries that programs do not need. Sets myriad_netcdf_FOUND.

find_path(MYRIAD_NETCDF_INCLUDE_DIR NAMES netcdf.h HINTS "${netCDF_ROOT}" PATH_SUFFIXES include
          DOC "Directory that holds netcdf.h")
find_library(MYRIAD_NETCDF_LIBRARY NAMES netcdf HINTS "${netCDF_ROOT}" PATH_SUFFIXES lib DOC "netCDF's C library")
mark_as_advanced(MYRIAD_NETCDF_INCLUDE_DIR MYRIAD_NETCDF_LIBRARY)
set(myriad_netcdf_FOUND FALSE)
if(MYRIAD_NETCDF_INCLUDE_DIR AND MYRIAD_NETCDF_LIBRARY)
    file(STRINGS "${MYRIAD_NETCDF_INCLUDE_DIR}/netcdf_meta.h" line REGEX "define NC_VERSION ")
    string(REGEX REPLACE ".*\"(.*)\".*" "\\1" myriad_netcdf_VERSION "${line}")
    if(myriad_netcdf_VERSION VERSION_GREATER_EQUAL 4.7)
        set(myriad_netcdf_FOUND TRUE)
        if(NOT TARGET myriad::netcdf)
            message(STATUS "netCDF ${myriad_netcdf_VERSION}: found")
            add_library(myriad::netcdf INTERFACE IMPORTED GLOBAL)
            target_include_directories(myriad::netcdf INTERFACE "${MYRIAD_NETCDF_INCLUDE_DIR}")
            target_link_libraries(myriad::netcdf INTERFACE "${MYRIAD_NETCDF_LIBRARY}")
        endif()
    endif()
endif()

// SPDX-License-Identifier: MIT
// Results as one file that other programs open. Written under a temporary name and renamed when whole, so that there is
// never half a file; read chunk by chunk, so that memory is bounded by the size of a chunk.
#pragma once

#include <string>
#include <string_view>

#include "myriad/study/plan/layout.hpp"

namespace myriad {

/// How `export_netcdf` compresses.
struct netcdf_options {
    int deflate = 1;  ///< zlib's level, 0 (none) to 9
};

/// Writes netCDF-4, which is HDF5: for xarray, netCDF4, h5py, MATLAB and Julia. Variables have the dimensions of the
/// grid, one for each axis, and then their own; the axes are coordinate variables. What is not done yet has the value
/// of the attribute `_FillValue`, and the global attribute `incomplete` says how much that is. Replaces a file of that
/// name, or that a symbolic link of that name points to, and refuses to replace anything else, as a device; so do the
/// others.
///
/// Global attributes are the entries of the study's description ("options_relative_tolerance"), the description as a
/// whole as JSON, the devices, and CF's `history`: when it was exported. Throws `error` if data is
/// damaged or the file cannot be written.
void export_netcdf(const studies::results& from, const std::string& path, const netcdf_options& options = {});

/// Writes text with commas: a line with names, then a line for each instance: its place in the grid (the axes'
/// coordinates, or the index where there is none), then the values of all variables along instances, each with as many
/// digits as it takes to read the same number again. A variable with dimensions of its own has a column for each of its
/// values, named as "x[0][3]". What is not done, or is NaN, is "nan".
void export_csv(const studies::results& from, const std::string& path);

/// Writes one variable or coordinate as an array of NumPy (numpy.load), with the same shape as `export_netcdf`.
void export_npy(const studies::results& from, std::string_view variable, const std::string& path);

}  // namespace myriad

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints what xarray finds in the netCDF file that the program studies writes. Usage: read.py [FILE]"""
import sys

import xarray

FILE = sys.argv[1] if len(sys.argv) > 1 else "duffing_study.nc"
# snippet: read
data = xarray.open_dataset(FILE)
print(data)
print(data.x.sel(k=0.25, method="nearest").isel(phase=-1).values)
flag = dict(zip(data.status.flag_meanings.split(), data.status.flag_values))
print((data.status == flag["success"]).all().item(), data.attrs["options_relative_tolerance"])
# end of snippet

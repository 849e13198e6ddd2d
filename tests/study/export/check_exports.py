#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Reads what a test program has stored and exported, by the programs of others: xarray, netCDF4, h5py and NumPy, Zarr's
own library if it is of version 3, and a reader of Zarr's format that is written here, from its specification.

Usage: check_exports.py PROGRAM, the test program study_store_test. Exit status 77, "skipped" for ctest, if there is no
xarray with netCDF4. Says on its last line which libraries it had.
"""

import json
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile

try:
    import netCDF4
    import numpy
    import xarray
except ImportError as missing:
    # Debian's packages are for Debian's Python, which may not be the first on the PATH.
    if sys.executable != "/usr/bin/python3" and os.path.exists("/usr/bin/python3"):
        os.execv("/usr/bin/python3", ["/usr/bin/python3"] + sys.argv)
    print(f"skipped: {missing}")
    sys.exit(77)


def crc32c(data):
    """CRC-32C, bit by bit."""
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc >> 1) ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


def read_zarr(folder):
    """An array of Zarr, version 3, with the codecs bytes and crc32c, as the specification says."""
    about = json.loads((folder / "zarr.json").read_text(encoding="utf-8"))
    assert about["zarr_format"] == 3 and about["node_type"] == "array"
    assert [codec["name"] for codec in about["codecs"]] == ["bytes", "crc32c"]
    assert about["codecs"][0]["configuration"]["endian"] == "little"
    encoding = about["chunk_key_encoding"]
    assert encoding["name"] == "default"
    kind = numpy.dtype(about["data_type"]).newbyteorder("<")
    shape, part = about["shape"], about["chunk_grid"]["configuration"]["chunk_shape"]
    assert len(shape) == len(part) == len(about["dimension_names"])
    fill = float("nan") if about["fill_value"] == "NaN" else about["fill_value"]
    values = numpy.full(shape, fill, dtype=kind)
    for place in numpy.ndindex(*[-(-whole // piece) for whole, piece in zip(shape, part)]):
        path = folder / encoding["configuration"]["separator"].join(["c"] + [str(i) for i in place])
        if not path.exists():
            continue
        data = path.read_bytes()
        assert struct.unpack("<I", data[-4:])[0] == crc32c(data[:-4]), path
        piece = numpy.frombuffer(data[:-4], dtype=kind).reshape(part)
        there = tuple(slice(i * n, min((i + 1) * n, whole)) for i, n, whole in zip(place, part, shape))
        values[there] = piece[tuple(slice(0, s.stop - s.start) for s in there)]
    return values


def check_netcdf(folder):
    """The grid, the coordinates, the values and what describes them, by xarray and netCDF4."""
    with xarray.open_dataset(folder / "run.nc") as data:
        assert dict(data.sizes) == {"a": 7, "b": 5, "bin": 4, "phase": 3, "side": 2}, data.sizes
        assert set(data.coords) == {"a", "b", "bin", "noise", "t_end"}, data.coords
        assert data.x.dims == ("a", "b") and data.x.attrs["units"] == "m"
        assert data["count"].dtype == "int64" and data.status.dtype == "uint8" and data.y.dtype == "float32"
        assert data["count"].sel(a=0.3, b=8.0, method="nearest") == 18 * 18
        assert (data.step.values.reshape(35, 6)[:, 5] == 10 * numpy.arange(35) + 5).all()
        assert list(data.status.attrs["flag_values"]) == [0, 1]
        assert data.status.attrs["flag_values"].dtype == "uint8"
        assert data.attrs["options_relative_tolerance"] == 1e-9 and data.attrs["seed"] == 7
        assert json.loads(data.attrs["description"])["model"] == "synthetic"
        assert not [name for name in data.attrs if not name.replace("_", "").isalnum()], data.attrs
        assert data.attrs["history"].endswith("exported by Myriad " + data.attrs["source"].removeprefix("Myriad "))
        assert float(data.total.sum()) == 35 and float(data.t_end) == 12.5
        x = data.x.values.reshape(35)
    with xarray.open_dataset(folder / "part.nc") as data:
        assert data.attrs["incomplete"].startswith("31 of 35 instances are not computed yet")
        there = numpy.arange(8, 12)
        assert (numpy.flatnonzero(data.x.notnull().values) == there).all()
        assert (numpy.flatnonzero(data.status.notnull().values) == there).all()
        assert (data.x.values.reshape(35)[there] == x[there]).all()
    with netCDF4.Dataset(folder / "run.nc") as data:
        assert data.data_model == "NETCDF4" and data["x"].filters()["shuffle"]
        assert (data["x"][:].reshape(35) == x).all()
    return x


def check_h5py(folder, x):
    """Dimension scales, as programs for HDF5 see them."""
    import h5py  # pylint: disable=import-outside-toplevel
    with h5py.File(folder / "run.nc", "r") as data:
        assert [list(dimension.keys()) for dimension in data["x"].dims] == [["a"], ["b"]]
        assert (data["x"][:].reshape(35) == x).all()


def check_zarr_library(folder, x):
    """The store as a whole, by Zarr's own library; version 2 knows nothing of version 3 of the format."""
    import zarr  # pylint: disable=import-outside-toplevel
    if int(zarr.__version__.split(".")[0]) < 3:
        raise ImportError("zarr 3")
    import warnings  # pylint: disable=import-outside-toplevel
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        group = zarr.open_group(folder / "run", mode="r")
        assert sorted(group.array_keys()) == ["a", "b", "bin", "count", "noise", "partial", "status", "step", "t_end",
                                              "total", "x", "y"]
        assert (group["x"][:] == x).all() and (group["step"][:, 2, 1] == 10 * numpy.arange(35) + 5).all()
        assert group["x"].attrs["units"] == "m" and float(group["t_end"][()]) == 12.5
        part = zarr.open_group(folder / "part", mode="r")
        assert (numpy.flatnonzero(part["status"][:] != 255) == numpy.arange(8, 12)).all()
        # Each array by itself too, without what the group says of it.
        assert zarr.open_array(folder / "run" / "y", mode="r").shape == (35, 3)


def main(program):
    """Lets the program write its files, and reads them."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([program, "[files]"], check=True, stdout=subprocess.DEVNULL,
                       env={**os.environ, "MYRIAD_TEST_FILES": name})
        x = check_netcdf(folder)
        used = [f"xarray {xarray.__version__}", f"netCDF4 {netCDF4.__version__}"]
        arrays = {path.parent.name: read_zarr(path.parent) for path in folder.glob("run/*/zarr.json")
                  if path.parent.name != "myriad"}
        assert set(arrays) >= {"x", "y", "count", "step", "status", "a", "t_end", "total"}, arrays
        assert (arrays["x"] == x).all() and (arrays["b"] == [1, 2, 4, 8, 16]).all() and arrays["t_end"] == 12.5
        assert math.isnan(read_zarr(folder / "part/x")[0])
        assert (arrays["y"].reshape(7, 5, 3) == numpy.load(folder / "run.npy")).all()
        table = numpy.genfromtxt(folder / "run.csv", delimiter=",", names=True)
        assert (table["x"] == x).all() and (table["noise"] == arrays["noise"]).all()
        for check in (check_h5py, check_zarr_library):
            try:
                check(folder, x)
                used.append(check.__name__.removeprefix("check_"))
            except ImportError as missing:
                used.append(f"not {missing.name or missing}")
    print(", ".join(used))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    main(sys.argv[1])

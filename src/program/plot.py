#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws diagrams of a study over one or two of its parameters.

RESULTS is the folder of a study, or a netCDF file. Over one axis, every value is a dot: all phases, and all places of
axes that --at does not fix. Over two, colours show one value for each place, of several the one that --value says.
"""

import argparse
import json
import os
import site
import subprocess
import sys
import tempfile
from typing import Callable, NamedTuple

# Run in isolation (python -I), without the modules of the current folder and of PYTHONPATH: those beside this file, and
# what the user has installed.
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
if sys.flags.no_user_site:
    site.addsitedir(site.getusersitepackages())

import figure as figures  # noqa: E402  pylint: disable=wrong-import-position

VALUES = ("last", "minimum", "maximum", "mean", "distinct")


class Results(NamedTuple):
    """What can be drawn: arrays by name, with the names of their dimensions and their attributes."""

    grid: list      # the names of the axes
    aside: set      # the names of arrays that are no results
    dims: dict
    attributes: dict
    read: Callable  # returns the values of an array


def results_of_folder(numpy, path, program):
    """Results in a folder. The program reads it, and compares the values with their checksums."""
    def ask(*words):
        done = subprocess.run([program, *words], check=False, capture_output=True, text=True)
        if done.returncode != 0:
            raise figures.PlotError(done.stderr.strip())
        return done.stdout

    def read(name):
        with tempfile.TemporaryDirectory() as folder:
            values = os.path.join(folder, "values.npy")
            ask("export", path, values, "--variable", name)
            return numpy.load(values)

    content = json.loads(ask("info", path, "--json"))
    arrays = content["arrays"]
    return Results(content["axes"], {name for name, array in arrays.items() if array["role"] != "data"},
                   {name: array["dimensions"] for name, array in arrays.items()},
                   {name: array["attributes"] for name, array in arrays.items()}, read)


def results_of_file(path):
    """Results in a netCDF file."""
    data = figures.open_netcdf(path, "myriad export", [])
    arrays = data.variables
    return Results([dimension["name"] for dimension in json.loads(getattr(data, "axes_dimensions", "[]"))],
                   {place for array in arrays.values() for place in getattr(array, "coordinates", "").split()},
                   {name: list(array.dimensions) for name, array in arrays.items()},
                   {name: {key: array.getncattr(key) for key in array.ncattrs()} for name, array in arrays.items()},
                   lambda name: arrays[name][...])


def choose_variable(data, wanted):
    """The variable to draw: the first result that has an axis of the grid, or the one that is named."""
    coordinates = {name for name in data.dims if data.dims[name] == [name]}
    usable = [name for name in data.dims
              if name not in coordinates and any(axis in data.dims for axis in data.dims[name])]
    if wanted is not None:
        if wanted not in data.dims:
            raise figures.PlotError(f"there is no variable {wanted}: there are {', '.join(usable)}")
        return wanted
    results = [name for name in usable if name not in data.aside]
    of_grid = [name for name in results if len(data.dims[name]) > 1 or data.dims[name][0] in data.grid]
    results.sort(key=lambda name: (name == "status", name not in of_grid))
    if not results:
        raise figures.PlotError("the results have no variable over an axis")
    return results[0]


def label_of(data, name):
    unit = data.attributes[name].get("units") if name in data.dims else None
    return f"{name} ({unit})" if unit else name


def fix_axes(numpy, data, values, dims, places):
    """Takes the place nearest to a value along some axes."""
    for place in places:
        axis, _, text = place.partition("=")
        if axis not in dims:
            raise figures.PlotError(f"--at {place}: there is no axis {axis}: there are {', '.join(dims)}")
        try:
            value = float(text)
        except ValueError:
            raise figures.PlotError(f"--at {place}: write a number, as {axis}=0.5") from None
        along = axis_values(numpy, data, axis, values.shape[dims.index(axis)])
        values = values.take(int(numpy.abs(along - value).argmin()), axis=dims.index(axis))
        dims = [name for name in dims if name != axis]
    return values, dims


def axis_values(numpy, data, axis, length):
    return data.read(axis) if axis in data.dims else numpy.arange(length, dtype=float)


def choose_axes(data, values, dims, wanted):
    """The axes to draw over: the named ones, or the longest ones that have coordinates, two if there are."""
    if wanted is None:
        axes = [name for name in dims if name in data.dims and name not in ("phase", "sample")]
        axes.sort(key=lambda name: -values.shape[dims.index(name)])
        axes = [name for name in axes[:2] if values.shape[dims.index(name)] > 1] or axes[:1]
        return sorted(axes, key=dims.index)
    axes = wanted.split(",")
    for axis in axes:
        if axis not in dims:
            raise figures.PlotError(f"--over {wanted}: there is no axis {axis}: there are {', '.join(dims)}")
    if len(axes) not in (1, 2) or len(set(axes)) != len(axes):
        raise figures.PlotError(f"--over {wanted}: give one axis or two")
    return axes


def distinct(numpy, row):
    """How many values differ by more than a thousandth of their range over all, or of their size."""
    row = numpy.sort(row[numpy.isfinite(row)])
    if not row.size:
        return numpy.nan
    return 1 + int(numpy.count_nonzero(numpy.diff(row) > 1e-3 * max(1e-300, float(numpy.abs(row).max()))))


def value_of_rows(numpy, rows, which):
    """One number for each row; phases that an instance did not reach are NaN."""
    if rows.shape[-1] == 1:
        return rows[..., 0]
    if which == "distinct":
        return numpy.apply_along_axis(lambda row: distinct(numpy, row), -1, rows)
    if which == "last":
        return rows[..., -1]
    masked = numpy.ma.masked_invalid(rows)
    take = {"minimum": masked.min, "maximum": masked.max, "mean": masked.mean}[which]
    return numpy.ma.filled(take(axis=-1), numpy.nan)


def names_of(numpy, attributes, values):
    """The names of whole numbers that stand for something, or None."""
    if "flag_meanings" not in attributes:
        return None
    flags = (int(flag) for flag in numpy.atleast_1d(attributes["flag_values"]))
    return {**{int(value): str(value) for value in numpy.unique(values)},
            **dict(zip(flags, attributes["flag_meanings"].split()))}


def draw(plots, numpy, data, asked):
    """The figure."""
    variable = choose_variable(data, asked.variable)
    values, dims = fix_axes(numpy, data, numpy.asarray(data.read(variable)), data.dims[variable], asked.at)
    if not dims:
        raise figures.PlotError(f"{variable} is one number: name a variable with an axis")
    over = choose_axes(data, values, dims, asked.over) or dims[:1]
    attributes = data.attributes[variable]
    names = names_of(numpy, attributes, values)
    if names is None and values.dtype.kind in "iu":
        fill = attributes.get("_FillValue")
        values = numpy.where(values == fill, numpy.nan, values) if fill is not None else values.astype(float)
    if not numpy.isfinite(values).any():
        raise figures.PlotError("there is no finite value to draw")
    order = [dims.index(axis) for axis in over]
    values = values.transpose(order + [i for i in range(len(dims)) if i not in order])
    sides = [axis_values(numpy, data, axis, values.shape[i]) for i, axis in enumerate(over)]
    rows = values.reshape(values.shape[:len(over)] + (-1,))
    labels, label = [label_of(data, axis) for axis in over], label_of(data, variable)
    if len(over) == 1:
        return plots.bifurcation(sides[0], rows.astype(float), xlabel=labels[0], ylabel=label).figure
    if rows.shape[-1] > 1 and names is None:
        label = f"{asked.value} of {label}"
    reduced = value_of_rows(numpy, rows, asked.value if names is None else "last")
    return plots.parameter_map(*sides, reduced, names=names, xlabel=labels[0], ylabel=labels[1], zlabel=label).figure


def libraries():
    """The modules that draw, and numpy. They are the Python package's, and lie beside this file."""
    _, numpy = figures.import_libraries()
    from pictures import errors, plots  # pylint: disable=import-outside-toplevel
    return plots, numpy, errors.Error


def import_elsewhere():
    """The libraries, imported in a folder without the settings of anybody (matplotlibrc), which can name modules."""
    try:
        here = os.open(".", os.O_RDONLY)
    except OSError:
        return libraries()
    try:
        os.chdir(os.path.dirname(os.path.abspath(__file__)))
        return libraries()
    finally:
        os.fchdir(here)
        os.close(here)


def main():
    """Reads the arguments of `myriad plot`; exit status 2 if something is missing or wrong."""
    parser = argparse.ArgumentParser("myriad plot", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", help="folders of results, or netCDF files", metavar="RESULTS")
    parser.add_argument("--output", help="the picture (default: RESULTS.png)", metavar="PNG")
    parser.add_argument("--variable", help="what to show (default: the first one)", metavar="NAME")
    parser.add_argument("--over", help="one axis, or two with a comma (default: the longest ones)", metavar="AXES")
    parser.add_argument("--at", action="append", default=[], metavar="AXIS=VALUE",
                        help="for another axis the value nearest to this; may be repeated")
    parser.add_argument("--value", choices=VALUES, default="last",
                        help="over two axes, of several phases or starts: one of them, or how many values there are")
    parser.add_argument("--reader", default="myriad", help=argparse.SUPPRESS)  # the program that reads folders
    asked = parser.parse_args()
    refused = ()
    try:
        if asked.output and len(asked.results) > 1:
            raise figures.PlotError("--output names one picture, and several results are given")
        plots, numpy, refused = import_elsewhere()
        for path in asked.results:
            path = path.rstrip("/") or "/"
            is_folder = os.path.isdir(path)  # whose name may have dots
            picture = asked.output or (path if is_folder else os.path.splitext(path)[0]) + ".png"
            data = results_of_folder(numpy, path, asked.reader) if is_folder else results_of_file(path)
            figures.save(draw(plots, numpy, data, asked), picture, dpi=200)
            print(f"picture: {picture}")
    except (figures.PlotError, refused) as error:
        print(error, file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()

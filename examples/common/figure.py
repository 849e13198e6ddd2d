# SPDX-License-Identifier: MIT
"""Common parts of the drawing scripts: reading the table, the style, writing the picture, and messages.

An example's plot.py defines `draw(pyplot, numpy, table, comments)`, which returns the figure, and ends with

    figure.main(__doc__, "program", COLUMNS, draw)

COLUMNS is the header of the table that the program writes; `table` maps the names of its columns, except `status`, to
arrays; `comments` is the text of its first lines. Exit status 2, and no picture, if something is missing or wrong.
Scripts whose tables also contain text use read_rows, import_libraries, save and exit_with.
"""

import csv
import os
import sys

# For all pictures, and for those with ticks on all sides.
PLAIN = {"font.family": "serif", "font.serif": ["STIXGeneral", "DejaVu Serif"], "mathtext.fontset": "stix",
         "axes.linewidth": 0.6, "xtick.direction": "in", "ytick.direction": "in"}
FRAMED = {**PLAIN, "font.size": 9, "axes.titlesize": 11, "xtick.top": True, "ytick.right": True,
          "xtick.minor.visible": True, "ytick.minor.visible": True}
# Okabe and Ito's colours, which the colour-blind can tell apart.
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#F0E442")
BLUE, ORANGE, GREEN, PINK, RED, SKY, YELLOW = COLOURS


class PlotError(Exception):
    """An error message: why there is no picture."""


def import_libraries(style=None):
    """Returns the modules matplotlib.pyplot, with a style (default: FRAMED), and numpy."""
    try:
        import matplotlib
        import numpy
    except ImportError as error:
        raise PlotError(f"{error.name} is missing for {sys.executable}: install it (Debian, Ubuntu: apt-get install "
                        "python3-matplotlib), or run this with a Python that has it, as /usr/bin/python3") from error
    matplotlib.use("Agg")  # no display needed
    from matplotlib import pyplot
    pyplot.rcParams.update(FRAMED if style is None else style)
    return pyplot, numpy


def label_ticks(pyplot, axis):
    """Labels the ticks of a logarithmic axis at 1, 2 and 5 of each decade, if it has less than two decades and so
    perhaps a single label, from which a scale cannot be read."""
    least, most = axis.get_view_interval()
    if most / least < 100:
        axis.set_major_locator(pyplot.matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(pyplot.matplotlib.ticker.StrMethodFormatter("{x:.10g}"))
        axis.set_minor_formatter(pyplot.matplotlib.ticker.NullFormatter())


def read_rows(path, program, columns):
    """Returns the rows of a table as dictionaries of text, and the comments at the top of the file.

    Other columns are allowed.
    """
    try:
        with open(path, encoding="utf-8") as file:
            lines = file.readlines()
    except OSError as error:
        raise PlotError(f"{path} cannot be read: {error.strerror or error}; run `{program}` first") from error
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    if not rows or not set(columns) <= set(rows[0]):
        raise PlotError(f"{path} is no table of `{program}`, which has the columns {', '.join(sorted(columns))}")
    return rows, [line[1:].strip() for line in lines if line.startswith("#")]


def read_table(numpy, path, program, columns):
    """Returns all columns except `status` as a dictionary of arrays, and the comments at the top as text."""
    wanted = [name for name in columns if name != "status"]
    comments = []
    again = f"run the program `{program}` again"
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            line = file.readline()
            while line.startswith("#"):
                comments.append(line[1:].strip())
                line = file.readline()
            names = tuple(line.strip().split(",")) if line.strip() else ()
            if not names:
                raise PlotError(f"{path} is empty: {again}")
            if names != tuple(columns):
                raise PlotError(f"{path} has the columns {ascii(line.strip()[:200])}, not those of the program "
                                f"`{program}`, {','.join(columns)}")
            start = file.tell()
            if not file.readline().strip():
                raise PlotError(f"{path} has no rows: {again}")
            file.seek(start)
            table = numpy.loadtxt(file, comments="#", delimiter=",", usecols=[columns.index(name) for name in wanted],
                                  ndmin=2)
    except OSError as error:
        raise PlotError(f"{path} cannot be read: {error.strerror or error}; "
                        f"run the program `{program}` first") from error
    except (ValueError, IndexError) as error:
        raise PlotError(f"{path} cannot be read as a table: {error}") from error
    check_finite(numpy, table.T)
    return {name: table[:, column] for column, name in enumerate(wanted)}, "\n".join(comments)


def check_finite(numpy, columns):
    """Says how many rows have values that are not finite; an error if all have."""
    rows = len(columns[0])
    missing = rows - int(numpy.logical_and.reduce([numpy.isfinite(column) for column in columns]).sum())
    if missing == rows:
        raise PlotError("The file has no finite rows to draw: every instance failed")
    if missing:
        print(f"{missing} of {rows} rows have values that are not finite, which are not drawn", file=sys.stderr)


def open_netcdf(path, program, variables):
    """The netCDF file that a program has written, an object of netCDF4, after a look for these variables in it."""
    try:
        import netCDF4  # pylint: disable=import-outside-toplevel
    except ImportError as error:
        raise PlotError(f"{error.name} is missing for {sys.executable}: install it (Debian, Ubuntu: apt-get install "
                        "python3-netcdf4), or let the program write a table: --output FILE.csv") from error
    try:
        data = netCDF4.Dataset(path)
    except OSError as error:
        raise PlotError(f"{path} cannot be read: {error.strerror or error}; "
                        f"run the program `{program}` first") from error
    data.set_auto_mask(False)
    missing = [name for name in variables if name not in data.variables]
    if missing:
        raise PlotError(f"{path} has no variable {missing[0]}: it is not from the program `{program}`")
    return data


def limits(numpy, values):
    """Limits of an axis that contain all finite values with a small margin."""
    finite = values[numpy.isfinite(values)]
    if finite.size == 0:
        raise PlotError("The file has no finite values to draw: every instance failed")
    low, high = float(finite.min()), float(finite.max())
    margin = 0.03 * (high - low) or 0.5
    return low - margin, high + margin


def square_grid(table, across, up, program):
    """Cells along each side of a square grid stored row by row in the table, and its limits (left, right, bottom, top).

    across, up: the columns with the midpoints of the cells, equidistant.
    """
    side = round(len(table[across]) ** 0.5)
    if side * side != len(table[across]) or side < 2:
        raise PlotError(f"The file holds no square grid: run the program `{program}` again")
    ends = []
    for axis in (table[across], table[up]):
        half = (axis[-1] - axis[0]) / (side - 1) / 2
        ends += [axis[0] - half, axis[-1] + half]
    return side, ends


def edges(numpy, middles):
    """Borders of the cells with these midpoints, halfway between neighbours."""
    if middles.size == 1:
        return middles + numpy.array([-0.1, 0.1])
    inner = (middles[1:] + middles[:-1]) / 2
    return numpy.concatenate(([2 * middles[0] - inner[0]], inner, [2 * middles[-1] - inner[-1]]))


def edges_of_ratios(numpy, middles):
    """The same on a logarithmic axis."""
    return numpy.exp(edges(numpy, numpy.log(middles)))


def save(figure, path, dpi, colours=None):
    """Writes the picture under another name and renames it, so that it is complete or absent.

    colours: for a PNG, the number of colours to reduce it to, at most 256. A noisy map then takes a third of the space.
    """
    kind = os.path.splitext(path)[1].lstrip(".").lower() or "png"
    temporary = f"{path}.{os.getpid()}.part"
    try:
        if os.path.exists(path) and not os.path.isfile(path):
            raise PlotError(f"{path} is not a regular file: name another one")
        folder = os.path.dirname(path)
        if folder and not os.path.isdir(folder):
            os.mkdir(folder)
        figure.savefig(temporary, format=kind, dpi=dpi)
        if colours and kind == "png":
            from PIL import Image  # with which matplotlib writes  # pylint: disable=import-outside-toplevel
            with Image.open(temporary) as picture:
                fewer = picture.convert("RGB").quantize(colours, Image.Quantize.MAXCOVERAGE, kmeans=4,
                                                        dither=Image.Dither.NONE)
            fewer.save(temporary, format="png", optimize=True)
        os.replace(temporary, os.path.realpath(path))
    except (OSError, ValueError) as error:
        raise PlotError(f"{path} cannot be written: {getattr(error, 'strerror', None) or error}") from error
    finally:
        if os.path.exists(temporary):
            os.remove(temporary)


def exit_with(documentation, run, takes=("CSV", "PNG")):
    """Runs a script with its arguments; ends it with status 2 and a message if something is missing or wrong."""
    arguments = sys.argv[1:]
    if arguments in (["-h"], ["--help"]):
        print(documentation.strip())
        return
    try:
        if len(arguments) != len(takes):
            raise PlotError(f"Usage: plot.py {' '.join(takes)}")
        run(*arguments)
    except PlotError as error:
        print(error, file=sys.stderr)
        sys.exit(2)


def main(documentation, program, columns, draw, dpi=200, colours=None, read=read_table):
    """Runs an example's plot.py with the arguments CSV and PNG; `read` reads the file in place of read_table."""
    def run(source, target):
        pyplot, numpy = import_libraries()
        table, comments = read(numpy, source, program, columns)
        save(draw(pyplot, numpy, table, comments), target, dpi, colours)
    exit_with(documentation, run)

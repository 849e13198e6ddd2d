# SPDX-License-Identifier: MIT
"""A run in the formats of other packages, each made of its quantities."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from ..base import component_kinds as kinds
from ..base.errors import Error
from ..base.packages import package
from ..base.statuses import in_words, status_names
from ..base.whole_files import replacing

if TYPE_CHECKING:
    import pandas
    import xarray

    from ..symbolic.types import Array
    from .protocol import Results


def _axis(run: Results, name: str) -> str:
    """The name of an axis of the sweep in a dataset."""
    kind, _ = run._components.place.get(run._components.aliases.get(name, name), ("", 0))
    called = run._called.get(run._components.aliases.get(name, name), name)
    return f"{called}_start" if kind in kinds.recorded else called


def _axes(run: Results) -> tuple[list[str], tuple[int, ...]]:
    """The dimensions of the instances and their lengths."""
    if run.sweep is None or not run.sweep.axes:
        return ["instance"], (run.size,)
    return [_axis(run, name) for name, _ in run.sweep.axes], tuple(run.sweep.shape)


def to_xarray(run: Results) -> xarray.Dataset:
    xarray = package("xarray", "to_xarray")
    dims, lengths = _axes(run)
    along = {} if run.sweep is None else {_axis(run, name): (_axis(run, axis), np.asarray(values))
                                          for name, (axis, values) in run.sweep.coordinates.items()}
    variables: dict[str, Any] = {}
    coordinates: dict[str, Any] = {}
    for name, quantity in run._quantities.items():
        if not quantity.listed:
            continue
        about = {"units": quantity.unit, "long_name": quantity.long_name}
        attributes = {key: text for key, text in about.items() if text}
        more = [quantity.along] if quantity.along else []
        made: tuple[Any, Any]
        if name in along:
            made = along[name]
        elif quantity.of_instances:
            array = quantity.read()
            made = (*dims, *more), array.reshape(*lengths, *array.shape[1:])
        else:
            made = tuple(more), quantity.read()
        (coordinates if quantity.is_input else variables)[name] = (*made, attributes)
    return xarray.Dataset(variables, coordinates, {"myriad_version": _core.version})


def write_netcdf(run: Results, path: str) -> None:
    data = to_xarray(run)
    status = data["status"]
    # words as numbers, with the flags of the CF conventions, as in the files of studies
    flags = {"flag_values": np.arange(len(status_names), dtype=np.uint8), "flag_meanings": " ".join(status_names)}
    data["status"] = (status.dims, run.status_codes.reshape(status.shape), {**status.attrs, **flags})
    with replacing(path) as temporary:
        data.to_netcdf(temporary, engine=_netcdf_engine())


def _netcdf_engine() -> Any:
    for engine, packages in (("netcdf4", ["netCDF4"]), ("h5netcdf", ["h5netcdf", "h5py"])):
        if all(map(_is_there, packages)):
            return engine
    raise Error("to_netcdf needs the package netCDF4, or h5netcdf and h5py: `pip install netCDF4`")


def _is_there(package: str) -> bool:
    try:
        __import__(package)
    except ImportError:
        return False
    return True


def _table(run: Results, instead: str) -> dict[str, Array]:
    """The columns of a table: one row for each instance and recorded phase, or instance and sample, or instance. The
    statuses are codes. `instead`: what takes more than a table does."""
    recorded = bool(run._recorded or run._records_time)
    if recorded and run._sampled:
        raise Error(f"records by phase and samples do not fit into one table: use {instead}")
    along = "phase" if recorded else "sample" if run._sampled else None
    chosen = {name: quantity.read() for name, quantity in run._quantities.items()
              if quantity.listed and quantity.along == along and not quantity.is_input and name != "status"}
    if run._sampled:
        chosen = {"t_sample": run._quantities["t_sample"].read(), **chosen}
    columns = next(iter(chosen.values())).shape[1] if along and chosen else 1
    table = {"instance": np.repeat(np.arange(run.size), columns)}
    if recorded:
        table["phase"] = np.tile(run["phase"], run.size)
    for name in map(run._called.__getitem__, run._components.names["parameter"]):
        if name in run._quantities:  # but what a GPU was given and hooks have changed
            table[name] = np.repeat(np.broadcast_to(run[name], run.size), columns)
    table.update((name, array.ravel()) for name, array in chosen.items())
    table["status"] = np.repeat(run.status_codes, columns)
    if run._sampled:
        there = ~np.isnan(table["t_sample"])
        table = {name: column[there] for name, column in table.items()}
    return table


def to_pandas(run: Results, instead: str = "to_xarray()") -> pandas.DataFrame:
    pandas = package("pandas", "to_pandas")
    table: dict[str, Any] = dict(_table(run, instead))
    table["status"] = pandas.Categorical.from_codes(table["status"], status_names)
    return pandas.DataFrame(table)


def _to_polars(run: Results, instead: str) -> Any:
    import polars

    table: dict[str, Any] = dict(_table(run, instead))
    table["status"] = polars.Series(in_words(table["status"]), dtype=polars.Enum(status_names))
    return polars.DataFrame(table)


def write_csv(run: Results, path: str) -> None:
    _write_table(run, path, "csv", "the package pandas or polars: `pip install pandas`")


def write_parquet(run: Results, path: str) -> None:
    _write_table(run, path, "parquet", "the packages pandas and pyarrow, or polars: `pip install pandas pyarrow`")


def _write_table(run: Results, path: str, form: str, needed: str) -> None:
    """Writes the table of `to_pandas` in a form that both pandas and polars have."""
    if _is_there("pandas") and (form == "csv" or _is_there("pyarrow") or _is_there("fastparquet")):
        write = functools.partial(getattr(to_pandas(run, "to_netcdf(path)"), f"to_{form}"), index=False)
    elif _is_there("polars"):
        write = getattr(_to_polars(run, "to_netcdf(path)"), f"write_{form}")
    else:
        raise Error(f"to_{form} needs {needed}")
    with replacing(path) as temporary:
        write(temporary)


_longest_in_matlab = 63


def write_mat(run: Results, path: str) -> None:
    try:
        from scipy.io import savemat
    except ImportError:
        raise Error("to_mat needs the package SciPy: `pip install scipy`") from None
    read = {name: quantity.read() for name, quantity in run._quantities.items()
            if quantity.listed and name != "status"}
    _refuse_long(list(read))
    words = np.array(status_names, dtype=object)
    with replacing(path) as temporary:
        savemat(temporary, {**read, "status_codes": run.status_codes, "status_names": words}, appendmat=False,
                do_compression=True, oned_as="column")


def _refuse_long(names: Sequence[str]) -> None:
    long = next((name for name in names if len(name) > _longest_in_matlab), None)
    if long is not None:
        raise Error(f"'{long}' has {len(long)} letters, and MATLAB takes names of at most {_longest_in_matlab}: rename "
                    "the component, or use to_netcdf(path), which MATLAB reads too")

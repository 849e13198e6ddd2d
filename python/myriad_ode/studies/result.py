# SPDX-License-Identifier: MIT
"""The results of a study, in memory or in its store: arrays by name, xarray, netCDF."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .. import _core
from ..base import html
from ..base.errors import Error
from ..base.packages import package
from ..base.statuses import first_failure, in_words, status_names
from ..base.whole_files import replacing
from ..models.components import name_of
from ..results.quantities import names_of_symbol, of_component, times, unknown_quantity
from ..sweeps.inputs import path_text
from ..symbolic.node import Node
from ..symbolic.symbols import time
from .store_slices import blocks, read_part

if TYPE_CHECKING:
    import xarray

    from ..symbolic.types import Array, Component, Path


class Damage(NamedTuple):
    """Something wrong with stored data; chunk is -1 for what belongs to none."""

    chunk: int
    variable: str
    reason: str


class StudyResult(Mapping):
    """Results by name, a mapping whose length is the number of names: `result["x_end"]` is an array with the axes of
    the study, and then the phases or samples. Names are those of a run. Of an axis, and of other coordinates, it is the
    values. `result[x]` of a component is what was recorded of it, else its samples, else its last values."""

    def __init__(self, results: _core.Results, folder: str | None = None,
                 facts: Mapping[str, Any] | None = None) -> None:
        self._results, self.folder = results, folder
        facts = facts or {}
        #: whether all instances are done
        self.complete = facts.get("complete", results.instances_done == results.instances)
        self.instances = facts.get("instances", 0)  #: that this run has finished
        self.seconds = facts.get("seconds", 0.0)  #: that this run took
        self.by_status = facts.get("by_status", {})  #: instances of this run by the name of their status
        self.notes = facts.get("notes", [])  #: of the reports of the integration
        self.warnings = facts.get("warnings", [])  #: devices that failed, memory that was short
        self.kernel = facts.get("kernel", "")  #: where the model's kernel came from
        self._variables = {name: rest for name, *rest in results.variables}
        self._coordinates = {name: rest for name, *rest in results.coordinates}
        self._axes = dict(results.axes)
        self._inner = {d: n for rest in self._variables.values() for d, n in rest[1]}

    @property
    def size(self) -> int:
        """The number of instances of the study."""
        return self._results.instances

    @property
    def done(self) -> int:
        """The number of instances whose results are there, from this run or another."""
        return self._results.instances_done

    @property
    def shape(self) -> tuple[int, ...]:
        """The lengths of the axes."""
        return tuple(self._axes.values())

    @property
    def axes(self) -> dict[str, int]:
        """The names of the axes and their lengths."""
        return dict(self._axes)

    @property
    def names(self) -> list[str]:
        """The names of all variables and coordinates."""
        return [*self._variables, *self._coordinates]

    @property
    def description(self) -> dict[str, Any]:
        """All that determines the results, as a dict: model, axes, options, what is kept, version."""
        return json.loads(self._results.description)

    @property
    def status(self) -> Array:
        """How each instance ended, in words: "success", "max_steps" and others; "not_started" if it is not done."""
        return self["status"]

    @property
    def status_codes(self) -> Array:
        """The same as numbers into `my.status_names`, in a byte of memory each; 255 of those that are not done."""
        return self._read(self._find("status"))

    @property
    def failed(self) -> Array:
        """True for each instance that ended with a failure."""
        codes = self.status_codes
        return (codes >= first_failure) & (codes < len(status_names))

    @property
    def devices(self) -> list[str]:
        """The devices that computed what is in the store."""
        return self._results.devices

    def _find(self, key: Component) -> str:
        """The name of the variable or coordinate that a name, a symbol or `my.time` stands for."""
        there = self.names
        if isinstance(key, str) and key in there:
            return key
        if key is time or isinstance(key, str) and key == "t":
            found = next((name for name in times if name in there), None)
        else:
            found = of_component(names_of_symbol(key) if isinstance(key, Node) else [name_of(key)], there)
        if found is None:
            raise unknown_quantity("t" if key is time else name_of(key), there)
        return found

    def __getitem__(self, key: Component) -> Array:
        name = self._find(key)
        if name in self._coordinates:
            return self._coordinate(name)
        values = self._read(name)
        return in_words(values) if name == "status" else values

    def _read(self, name: str) -> Array:
        _, inner, _, of_instances, _ = self._variables[name]
        if not of_instances:
            return self._results.read(name, 0, 1)[0]
        values = self._results.read(name, 0, self.size)
        return values.reshape((*self.shape, *(n for _, n in inner)))

    def _coordinate(self, name: str) -> Array:
        along = self._coordinates[name][0]
        if not along:
            return self._results.coordinate(name, 1)[0]
        return self._results.coordinate(name, {**self._axes, **self._inner}[along])

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def __contains__(self, key: object) -> bool:
        try:
            return self._find(key) in self.names
        except Error:
            return False

    def _ipython_key_completions_(self) -> list[str]:
        return self.names

    __eq__, __hash__ = object.__eq__, object.__hash__

    def __repr__(self) -> str:
        state = "" if self.complete else f", {self.done} of them done"
        where = f" in {self.folder}" if self.folder else ""
        return f"<myriad study of {self.size} instances{state}{where}: {', '.join(self._variables)}>"

    def __str__(self) -> str:
        if not self.by_status:
            return f"{self.done} of {self.size} instances are done"
        counts = ", ".join(f"{count} {name}" for name, count in self.by_status.items())
        lines = [f"{self.instances} of {self.size} instances: {counts}; {self.seconds:.3g} s"
                 f"{'' if self.complete else '; stopped before all were done'}"]
        lines += [f"note: {note}" for note in self.notes] + [f"warning: {warning}" for warning in self.warnings]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        axes = " x ".join(f"{name} ({length})" for name, length in self._axes.items())
        rows = [("study of", f"{self.size} instances" + (f": {axes}" if axes else "")), ("store", self.folder or ""),
                ("variables", ", ".join(self._variables)), ("coordinates", ", ".join(self._coordinates))]
        return html.table(row for row in rows if row[1]) + html.paragraphs(str(self).splitlines())

    def __reduce__(self) -> tuple[Any, ...]:
        if self.folder is None:
            raise Error("results in memory cannot be pickled: pickle result.to_xarray(), or give the study a store")
        return open_study, (self.folder,)

    def verify(self) -> list[Damage]:
        """Reads all that is stored, and returns what is damaged as a list of `Damage`. `study.run(store=...,
        check="checksums")` computes it again."""
        return verify(self.folder) if self.folder is not None else []

    def _written(self) -> dict[str, Any]:
        """Variables with a value per instance, and then reductions, which are not there before all is done."""
        there = [name for name, rest in self._variables.items() if rest[3] or self._results.written(name)]
        return {name: self._variables[name] for name in sorted(there, key=lambda name: not self._variables[name][3])}

    def _fill(self, type_name: str) -> np.generic | None:
        """What stands for a value that was not computed, if there may be one."""
        return _fill_values[type_name] if type_name.startswith("float") or not self.complete else None

    def to_xarray(self) -> xarray.Dataset:
        """The results as an `xarray.Dataset` along the axes of the study. A store is read when its values are used,
        chunk by chunk. What is not done is NaN, the attribute `_FillValue` of integers, and "not_started" of statuses,
        which are words; files have them as numbers, with the flags of the CF conventions."""
        xarray = package("xarray", "to_xarray")
        variables: dict[str, Any] = {}
        coordinates: dict[str, Any] = {}
        for name, (type_name, inner, attributes, of_instances, is_coordinate) in self._written().items():
            dims, lengths = tuple(d for d, _ in inner), tuple(n for _, n in inner)
            if name == "status":  # which is words here
                attributes = {key: text for key, text in attributes.items() if not key.startswith("flag_")}
            if not of_instances:
                made = xarray.Variable(dims, self[name], attributes)
            elif self.folder is None:
                made = xarray.Variable((*self._axes, *dims), self[name], attributes)
            else:
                from .xarray_backend import lazy
                made = xarray.Variable((*self._axes, *dims),
                                       lazy(self.folder, self._results, name, type_name, self.shape, lengths),
                                       attributes)
            if name != "status":
                made.encoding["_FillValue"] = self._fill(type_name) if of_instances else None
            (coordinates if is_coordinate else variables)[name] = made
        for name, (along, attributes) in self._coordinates.items():
            if not along or along in self._axes or any(along in v.dims for v in variables.values()):
                coordinates[name] = xarray.Variable((along,) if along else (), self._coordinate(name), attributes)
        return xarray.Dataset(variables, coordinates, {"myriad_study": self._results.description})

    def to_netcdf(self, path: Path, complevel: int = 1) -> None:
        """Writes netCDF-4 by the package netCDF4 or h5netcdf, whichever is there, part by part, so that memory is
        bounded. The file replaces one of that name when it is whole."""
        dataset_of = _netcdf_package()
        path = os.path.realpath(path_text(path))
        if "\\" in path:
            raise Error(f"the path {path!r} has a backslash, which netCDF takes for a slash: give another path")
        with replacing(path) as temporary, dataset_of(temporary, "w") as file:
            self._write(file, complevel)

    def _write(self, file: Any, complevel: int) -> None:
        written = self._written()
        used = {d: n for rest in written.values() for d, n in rest[1]}
        for name, length in {**self._axes, **used}.items():
            file.createDimension(name, length)
        compression = {"zlib": True, "complevel": complevel} if complevel else {}
        for name, (along, attributes) in self._coordinates.items():
            if along and along not in self._axes and along not in used:
                continue
            made = file.createVariable(name, "f8", (along,) if along else ())
            made[...] = self._coordinate(name)
            _set_attributes(made, attributes, np.float64)
        for name, (type_name, inner, attributes, of_instances, _) in written.items():
            dims = tuple(d for d, _ in inner)
            lengths = tuple(n for _, n in inner)
            if not of_instances:
                made = file.createVariable(name, type_name, dims)
                made[...] = self[name]
            else:
                made = file.createVariable(name, type_name, (*self._axes, *dims), fill_value=self._fill(type_name),
                                           **(compression if self._axes or dims else {}))
                for key in blocks(self.shape, max(1, 4_000_000 // max(1, int(np.prod(lengths))))):
                    whole = (*key, *(slice(None) for _ in lengths))
                    made[whole if whole else ...] = read_part(self._results, name, self.shape, whole)
            _set_attributes(made, attributes, np.dtype(type_name).type)
        file.setncattr("myriad_study", self._results.description)
        file.setncattr("coordinates", " ".join([*(name for name, (along, _) in self._coordinates.items() if not along),
                                                *(name for name, rest in written.items() if rest[4])]))
        if not self.complete:
            file.setncattr("incomplete", f"{self.done} of {self.size} instances are done")

    def to_csv(self, path: Path) -> None:
        """Writes text with commas, a line for each instance, as the C++ library does; for small results."""
        self._results.write_csv(path_text(path))


_fill_values = {"float64": np.float64(np.nan), "float32": np.float32(np.nan), "int64": np.int64(-(1 << 63) + 2),
                "int32": np.int32(-(1 << 31) + 1), "uint8": np.uint8(255)}


def _set_attributes(variable: Any, attributes: Mapping[str, Any], type_of_values: type[np.generic]) -> None:
    for name, value in attributes.items():
        if name.startswith("flag_") and isinstance(value, list):
            value = np.array(value, type_of_values)
        variable.setncattr(name, value)


def _netcdf_package() -> Any:
    try:
        import netCDF4
        return netCDF4.Dataset
    except ImportError:
        pass
    try:
        import h5py  # noqa: F401, without which h5netcdf does not write
        from h5netcdf import legacyapi
        return legacyapi.Dataset
    except ImportError:
        raise Error("to_netcdf needs the package netCDF4, or h5netcdf and h5py: `pip install netCDF4`; the "
                    "wheel is built without the library for netCDF itself") from None


def open_study(folder: Path) -> StudyResult:
    """The results of a study in its store, also while it runs. Raises `Error` if there is none."""
    folder = os.path.abspath(path_text(folder))
    return StudyResult(_core.open_store(folder), folder)


def verify(folder: Path) -> list[Damage]:
    """Reads all that is stored in a folder and compares checksums; returns what is damaged as a list of `Damage`."""
    return [Damage(*d) for d in _core.verify_store(os.path.abspath(path_text(folder)))]

# SPDX-License-Identifier: MIT
"""Tables of data that users give: data frames, dicts of columns, and CSV files."""

from __future__ import annotations

import csv
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import Error, at, users_line

if TYPE_CHECKING:
    import numpy.typing as npt


class DataTable:
    """The columns of a data frame of pandas or polars, of a dict with a list for each, or of the CSV file of a path.
    `what` it is in messages; in small letters are the names of columns with `any_case`. A cell that is empty, None,
    NaN, "." or "NA" is missing. Raises `my.Error` where it is no table, or its columns are not equally long."""

    def __init__(self, data: Any, what: str, any_case: bool = False) -> None:
        self.called = f"{what}{at(users_line())}"
        if isinstance(data, (str, os.PathLike)):
            data = self._of_file(data)
        if hasattr(data, "notna"):  # pandas, which has several kinds of missing values
            data = data.astype(object).where(data.notna(), None)
        try:
            columns = [(str(name).strip(), list(data[name])) for name in getattr(data, "columns", data)]
        except TypeError:
            raise Error(f"{self.called} is no table: give a data frame, a dict with a list for each column, or the "
                        "path of a CSV file") from None
        if any_case:
            columns = [(name.lower(), cells) for name, cells in columns]
        self._columns, lengths = dict(columns), {len(cells) for _, cells in columns}
        self.names = [name for name, _ in columns]  #: of all columns, in their order
        if len(self._columns) < len(columns):
            raise Error(f"{self.called} has two columns of one name, {', '.join(self.names)}"
                        f"{', where case does not count' if any_case else ''}: rename one of them")
        if len(lengths) > 1 or lengths == {0}:
            raise Error(f"the columns of {self.called} have {' or '.join(map(str, sorted(lengths)))} rows: give as "
                        "many for each, and one or more")
        self.length = max(lengths, default=0)  #: the number of rows

    def _of_file(self, path: Any) -> dict[str, list[Any]]:
        try:
            with open(path, encoding="utf-8-sig", newline="") as file:
                read = csv.DictReader(file, skipinitialspace=True)
                rows = list(read)
        except OSError as why:
            raise Error(f"{os.fspath(path)!r}, the file of {self.called}, cannot be read: {why.strerror or why}"
                        ) from None
        return {name: [row[name] for row in rows] for name in read.fieldnames or ()}

    def __contains__(self, name: str) -> bool:
        return name in self._columns

    def row(self, number: int) -> str:
        """A row, counted from 0, as messages call it."""
        return f"row {number + 1} of {self.called}"

    def cells(self, name: str, use: str = "", otherwise: str = "") -> list[Any]:
        """The cells of a column. In messages `use` says what for, and `otherwise` what the user may do instead."""
        if name not in self._columns:
            raise Error(f"{self.called} has no column '{name}'{use and f' for {use}'}, but "
                        f"{', '.join(self.names) or 'none'}: name the right one{otherwise}")
        return self._columns[name]

    def numbers(self, name: str, use: str = "", cure: str = "give a number, or nothing") -> npt.NDArray[np.float64]:
        """The numbers of a column, NaN where a cell is missing."""
        cells = self.cells(name, use)
        made = np.empty(len(cells))
        for row, cell in enumerate(cells):
            try:
                made[row] = np.nan if is_missing(cell) else float(cell)
            except (TypeError, ValueError):
                raise Error(f"{self.row(row)} has {cell!r} in the column '{name}': {cure}") from None
        return made


def is_missing(cell: Any) -> bool:
    """Whether a cell has no value."""
    if isinstance(cell, str):
        return cell.strip().lower() in ("", ".", "na", "nan")
    return cell is None or isinstance(cell, (float, np.floating)) and bool(np.isnan(cell))


def name_in(cell: Any) -> str:
    """A cell as a name: that of 3.0, which columns with gaps have in the place of 3, is "3"."""
    return str(int(cell)) if isinstance(cell, (float, np.floating)) and float(cell).is_integer() else str(cell)

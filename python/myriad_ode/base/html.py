# SPDX-License-Identifier: MIT
"""What notebooks show: tables whose texts are escaped."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape


def row(name: str, content: str) -> str:
    """A row of a table: a name, and what is HTML already."""
    left = ' style="text-align:left"'
    return f"<tr><th{left}>{escape(name)}</th><td{left}>{content}</td></tr>"


def table(rows: Iterable[tuple[str, str]]) -> str:
    """Rows of a name and a text."""
    return f"<table>{''.join(row(name, escape(text)) for name, text in rows)}</table>"


def columns(names: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of several columns with their names."""
    head = "".join(f"<th>{escape(name)}</th>" for name in names)
    body = "".join(f"<tr>{''.join(f'<td>{escape(text)}</td>' for text in row)}</tr>" for row in rows)
    return f"<table><tr>{head}</tr>{body}</table>"


def paragraphs(lines: Iterable[str]) -> str:
    """A paragraph for each line."""
    return "".join(f"<p>{escape(line)}</p>" for line in lines)

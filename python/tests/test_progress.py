# SPDX-License-Identifier: MIT
"""The bar of `progress=True`, by what it writes."""

import io
import sys
import time
import types

import pytest

pytest.importorskip("tqdm")

from myriad_ode.solving.progress import ProgressDisplay  # noqa: E402


class Terminal(io.StringIO):
    def isatty(self):
        return True


def frames(stream, monkeypatch):
    """What is drawn of 200 calls, and the seconds that they took."""
    monkeypatch.setattr("sys.stderr", stream)
    begin = time.perf_counter()
    display = ProgressDisplay(True)
    for done in range(1, 201):
        display(done, 200, by_status={"success": done, "max_steps": 3})
        time.sleep(0.002)
    display.close()
    return [frame for frame in stream.getvalue().split("\r") if frame.strip()], time.perf_counter() - begin


def test_a_terminal_gets_at_most_ten_frames_a_second_and_the_last(monkeypatch):
    drawn, seconds = frames(Terminal(), monkeypatch)
    assert 3 < len(drawn) <= 10 * seconds + 2
    assert "200/200" in drawn[-1] and "max_steps=3" in drawn[-1]


def test_a_notebook_gets_as_many_as_a_terminal(monkeypatch):
    ipython = types.SimpleNamespace(get_ipython=lambda: "the shell")
    monkeypatch.setitem(sys.modules, "IPython", ipython)
    drawn, _ = frames(io.StringIO(), monkeypatch)
    assert len(drawn) > 3


@pytest.mark.parametrize("imported", [None, "ipykernel"])
def test_a_file_gets_a_frame_every_few_seconds_and_the_last(imported, monkeypatch):
    if imported is not None:  # by another test, or by a program that makes notebooks
        pytest.importorskip(imported)
    drawn, seconds = frames(io.StringIO(), monkeypatch)
    assert len(drawn) <= seconds / 5 + 2
    assert "200/200" in drawn[-1] and "max_steps=3" in drawn[-1]

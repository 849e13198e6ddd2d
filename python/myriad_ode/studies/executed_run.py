# SPDX-License-Identifier: MIT
"""A study whose chunks the workers of an executor compute."""

from __future__ import annotations

import concurrent.futures
import pickle
import queue
import threading
import time as clock
from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from ..base.errors import Error
from ..results.report import Interrupted
from ..solving.progress import ProgressDisplay
from .result import StudyResult


class ChunkedStudy(Protocol):
    """What a run by an executor needs of a study."""

    _core: Any

    @property
    def size(self) -> int: ...
    def payload(self) -> bytes: ...
    def _use(self, devices: Sequence[str], chunk: int | None) -> None: ...
    def _result(self, results: Any, facts: Mapping[str, Any], folder: str | None) -> StudyResult: ...


_received = threading.local()  # the last study of each thread of a worker, and its devices and chunks


def _compute(payload: bytes, chunk: int, chunk_size: int, devices: Sequence[str]) -> Any:
    """A chunk of a study, in a worker."""
    if getattr(_received, "payload", None) != payload:
        make, given = pickle.loads(payload)
        _received.study, _received.payload, _received.use = make(*given), payload, None
    if _received.use != (devices, chunk_size):
        _received.study._use(devices, chunk_size)
        _received.use = devices, chunk_size
    return _received.study._core.compute(chunk, chunk_size)


_lost = (concurrent.futures.BrokenExecutor, concurrent.futures.CancelledError, OSError)
_lost_by_name = ("KilledWorker", "WorkerLost", "ManagerLost")  # of Dask and Parsl


class ExecutedRun:
    """A run whose chunks the workers of an executor compute."""

    _patience = 10.0  # seconds, with chunks under way when the run ends early

    def __init__(self, study: ChunkedStudy, executor: Any, devices: Sequence[str], chunk: int | None,
                 folder: str | None, show: ProgressDisplay) -> None:
        self._study, self._executor, self._devices, self._folder, self._show = study, executor, devices, folder, show
        workers = getattr(executor, "_max_workers", None)
        workers = workers if isinstance(workers, int) and workers > 0 else 16
        self._most = 2 * workers + 2  # chunks under way
        if not chunk:  # several for each worker, and not too large to send
            chunk = min(max(1, -(-study.size // (8 * workers))), 1 << 16)
        study._use(devices, chunk)
        self._payload = study.payload()
        self._handed = study._core.hand_out()
        self._earlier, self._begin = self._handed.instances_done(), clock.perf_counter()
        self._under_way: dict[concurrent.futures.Future[Any], int] = {}
        self._ended: queue.SimpleQueue[concurrent.futures.Future[Any]] = queue.SimpleQueue()

    def run(self) -> StudyResult:
        try:
            self._work()
        except KeyboardInterrupt:
            self._end()
            raise Interrupted(self._result()) from None
        except BaseException as error:
            self._end()
            error.result = self._result()  # type: ignore[attr-defined]
            raise
        return self._result()

    def _work(self) -> None:
        handed = self._handed
        while True:
            while len(self._under_way) < self._most and (chunk := handed.claim_next()) is not None:
                self._submit(chunk)
            if not self._under_way:
                if handed.complete():
                    break
                threading.Event().wait(0.5)  # other processes are at work on the rest, and may die
                continue
            try:
                future = self._ended.get(timeout=0.2)
            except queue.Empty:
                continue
            self._take(future)
            self._show(self._earlier + handed.committed, handed.instances)

    def _submit(self, chunk: int) -> None:
        try:
            future = self._executor.submit(_compute, self._payload, chunk, self._handed.chunk, self._devices)
        except BaseException as error:
            self._handed.release(chunk)
            if isinstance(error, concurrent.futures.BrokenExecutor):
                raise self._died(error) from error
            raise
        self._under_way[future] = chunk
        future.add_done_callback(self._ended.put)

    def _take(self, future: concurrent.futures.Future[Any]) -> None:
        chunk = self._under_way.pop(future)
        try:
            values = future.result()
        except BaseException as error:
            self._handed.release(chunk)
            if isinstance(error, _lost) or type(error).__name__ in _lost_by_name:
                raise self._died(error) from error
            raise
        self._handed.commit(chunk, values)

    def _died(self, error: BaseException) -> Error:
        kept = "what was done is kept: run the study again with the same store" if self._folder else \
            "give the study a store, in which it goes on when it is run again"
        return Error(f"a chunk was lost with its worker ({type(error).__name__}: {error}); {kept}")

    def _end(self) -> None:
        """Takes what is done, and gives the rest back."""
        for future in list(self._under_way):
            try:
                future.cancel()
            except NotImplementedError:  # Parsl's
                pass
        concurrent.futures.wait([f for f in self._under_way if not f.cancelled()], timeout=self._patience)
        for future, chunk in list(self._under_way.items()):
            try:
                self._handed.commit(chunk, future.result(timeout=0))
            except BaseException:  # the reason why the run ends is what matters
                self._handed.release(chunk)
        self._under_way.clear()

    def _result(self) -> StudyResult:
        results, facts = self._study._core.finish(self._handed)
        return self._study._result(results, {**facts, "seconds": clock.perf_counter() - self._begin}, self._folder)

# SPDX-License-Identifier: MIT
"""Chunks of studies handed to executors: the same bits, and nothing done is lost with a worker."""

import concurrent.futures
import multiprocessing
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.studies import executed_run

x, v = my.states("x v")
k = my.parameter("k")
deaths = pathlib.Path(os.environ.get("MYRIAD_CACHE_DIR", "."))


def oscillator(**more):
    return my.study(my.model({x: v, v: -k * x}), my.grid({k: my.linspace(1, 2, 60), x: [1.0, 2.0]}), start={v: 0},
                    time=(0, 20), keep=[x], **more)


def energy(chunk):
    """A function that pickles."""
    return [(chunk["x_end"]**2).sum()]


def spawned(workers=2):
    return concurrent.futures.ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn"))


def loky():
    return pytest.importorskip("loky").ProcessPoolExecutor(2)


def dask():
    distributed = pytest.importorskip("distributed")
    client = distributed.Client(n_workers=2, threads_per_worker=1, dashboard_address=None, processes=True)
    executor = client.get_executor()
    executor.client_of_test = client
    return executor


def parsl():
    concurrent_of_parsl = pytest.importorskip("parsl.concurrent")
    import parsl
    from parsl.executors import HighThroughputExecutor
    from parsl.providers import LocalProvider
    programs, here = pathlib.Path(sys.executable).parent, pathlib.Path(__file__).parent
    environment = f"export PATH={programs}:$PATH PYTHONPATH={here}:$PYTHONPATH"
    workers = HighThroughputExecutor(label="local", address="127.0.0.1", max_workers_per_node=2, encrypted=False,
                                     interchange_launch_cmd=[str(programs / "interchange.py")],
                                     provider=LocalProvider(worker_init=environment, init_blocks=1, max_blocks=1))
    folder = tempfile.mkdtemp(prefix="myriad-parsl-")
    return concurrent_of_parsl.ParslPoolExecutor(parsl.Config(executors=[workers], strategy="none", run_dir=folder))


@pytest.mark.parametrize("make", [lambda: concurrent.futures.ThreadPoolExecutor(3), spawned, loky, dask, parsl],
                         ids=["threads", "processes", "loky", "dask", "parsl"])
@pytest.mark.parametrize("interpreted", [False, True])
def test_executors_give_the_bits_of_a_run(tmp_path, make, interpreted):
    if interpreted and make is not spawned:
        return  # once is enough
    study = oscillator(interpreted=interpreted,
                       reduce=[my.reduce.mean("x_end"), my.reduce.total("energy", "x_end", 1, energy)])
    expected = study.run()
    executor, told = make(), []
    try:
        for store in (None, tmp_path / "store"):
            result = study.run(store, executor=executor, chunk=9, progress=lambda *now: told.append(now))
            assert result.complete and result.by_status == {"success": 120} and result.instances == 120
            np.testing.assert_array_equal(result["x_end"], expected["x_end"])
            assert result["x_end_mean"] == expected["x_end_mean"]
            np.testing.assert_allclose(result["energy"], expected["energy"], rtol=1e-14)
        assert told[-1] == (120, 120)
    finally:
        executor.shutdown()
        if hasattr(executor, "client_of_test"):
            executor.client_of_test.close()


def test_mpi4py_gives_the_bits_of_a_run(tmp_path):
    pytest.importorskip("mpi4py")
    if subprocess.run([sys.executable, "-c", "import mpi4py.MPI"], capture_output=True).returncode != 0:
        pytest.skip("mpi4py finds no MPI library")
    launcher = shutil.which("mpiexec") or pytest.skip("there is no mpiexec")
    script = tmp_path / "study_by_mpi.py"
    script.write_text(f'''
import sys
sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})
from test_executors import energy, my, np, oscillator
from mpi4py.futures import MPIPoolExecutor

if __name__ == "__main__":
    study = oscillator(reduce=my.reduce.total("energy", "x_end", 1, energy))
    expected = study.run()
    with MPIPoolExecutor() as executor:
        result = study.run(executor=executor, chunk=9)
    assert result.complete and np.array_equal(result["x_end"], expected["x_end"])
    assert np.allclose(result["energy"], expected["energy"], rtol=1e-14)
    print("well")
''')
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                   "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_btl_vader_single_copy_mechanism": "none"}
    done = subprocess.run([launcher, "-n", "3", sys.executable, "-m", "mpi4py.futures", str(script)], text=True,
                          capture_output=True, env=environment, timeout=120)
    assert done.returncode == 0 and done.stdout == "well\n", done.stdout + done.stderr


def test_a_worker_takes_the_devices_of_each_run(monkeypatch):
    class_of_studies, used = my.Study, []
    use = class_of_studies._use
    monkeypatch.setattr(class_of_studies, "_use", lambda study, devices, chunk: (
        used.append((threading.current_thread() is threading.main_thread(), devices)), use(study, devices, chunk)))
    study = oscillator()
    with concurrent.futures.ThreadPoolExecutor(1) as executor:
        for threads in (1, 2, 2):
            study.run(executor=executor, device=f"cpu:{threads}", chunk=60)
    assert [devices for here, devices in used if not here] == [["cpu:1"], ["cpu:2"]]


class LossyExecutor(concurrent.futures.Executor):
    """Its second task is lost, as Parsl says it, and it cannot cancel the others, which never end."""

    def __init__(self):
        self._tasks = 0

    def submit(self, function, *arguments):
        class WorkerLost(Exception):
            pass

        class Future(concurrent.futures.Future):
            def cancel(self):
                raise NotImplementedError("Cancel not implemented")

        future = Future()
        self._tasks += 1
        if self._tasks == 1:
            future.set_result(function(*arguments))
        elif self._tasks == 2:
            future.set_exception(WorkerLost("worker 0"))
        return future


def test_an_executor_that_cannot_cancel_still_tells_of_a_lost_worker(tmp_path, monkeypatch):
    monkeypatch.setattr(executed_run.ExecutedRun, "_patience", 0.1)
    with pytest.raises(my.Error, match="lost with its worker .WorkerLost: worker 0.; what was done is kept") as raised:
        oscillator().run(tmp_path / "store", executor=LossyExecutor(), chunk=10)
    assert raised.value.result.done == 10


def die_once(chunk):
    """Kills the worker at the third chunk, the first time."""
    done = deaths / "chunks"
    with open(done, "a", encoding="ascii") as file:
        file.write("+")
    if done.stat().st_size == 5 and not (deaths / "died").exists():
        (deaths / "died").touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return [len(chunk["status"])]


def test_a_worker_that_dies_loses_no_chunk_that_is_done(tmp_path):
    for name in ("chunks", "died"):
        (deaths / name).unlink(missing_ok=True)
    study = oscillator(reduce=my.reduce.total("count", [], 1, die_once))
    with spawned(1) as executor, pytest.raises(my.Error, match="lost with its worker.*run the study again") as raised:
        study.run(tmp_path / "store", executor=executor, chunk=10)
    kept = raised.value.result
    assert kept.done == my.open_study(tmp_path / "store").done == 40 and not kept.complete
    with spawned(1) as executor:
        result = study.run(tmp_path / "store", executor=executor)
    assert result.complete and result.instances == 80 and result["count"] == 120
    np.testing.assert_array_equal(result["x_end"], oscillator().run()["x_end"])


def test_what_a_worker_raises_arrives():
    for inputs, expected, message in ((["x_end"], my.Error, "gives 1 numbers, and 3 are"), ([], KeyError, "x_end")):
        study = oscillator(reduce=my.reduce.total("wrong", inputs, 3, energy))
        with concurrent.futures.ThreadPoolExecutor(2) as executor, pytest.raises(expected, match=message) as raised:
            study.run(executor=executor)
        assert raised.value.result.done == 0


def test_a_study_that_does_not_pickle_is_refused():
    study = oscillator(reduce=my.reduce.total("wrong", [], 1, lambda chunk, lock=threading.Lock(): [1]))  # noqa: B008
    with spawned(1) as executor, pytest.raises(my.Error, match="does not pickle"):
        study.run(executor=executor)

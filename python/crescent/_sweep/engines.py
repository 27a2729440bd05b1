"""Where tasks run: a Dask cluster on this machine, one that is running, or one of a queueing system.

Dask assigns tasks to workers and repeats those of a worker that was lost. Each thread of a worker has one child process
(runner.py). The client holds a bounded window of tasks, so its memory does not grow with their number.
"""

from __future__ import annotations

import contextlib
import importlib
import itertools
import logging
import os
import signal
import queue
import sys
import threading
import time
import tomllib
import urllib.request
import uuid
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from .. import _crescent
from .grid import UsageError, hint
from .runner import Runner, TaskStopped
from .tasks import Job, Result, Task, host

#: Set by Ctrl-C: a KeyboardInterrupt that is raised while Python finalizes an object is lost.
interrupted = threading.Event()
_threads = threading.local()
_LOST_TRIES = 3  # submissions of a task whose reference was lost with its worker
_BATCH = 64  # results in one request
_RESPONSE_S = 6.0  # longest wait for the scheduler to respond; with it the exit takes at most 10 s
_NO_WORKER_S = 60.0


def _module(name: str) -> Any:
    """A module of Dask, imported on first use."""
    return importlib.import_module(name)


class EngineError(RuntimeError):
    """The engine cannot run or was lost: exit code 3."""


def on_worker(task: Task, reference: Any = None) -> Result:
    """Computes a task on a Dask worker: in the child process of this thread."""
    worker = _module("distributed").get_worker()
    key = _module("distributed.worker").thread_state.key

    def cancelled() -> bool:
        state = worker.state.tasks.get(key)
        return state is None or state.state in ("cancelled", "released", "forgotten") or worker.status.name != "running"

    if reference is not None and "error" in reference:
        return {"error": f"its reference: {reference['error']}"}
    if task.get("reference") and reference is None:
        return {"error": "its reference was not computed"}
    if reference is not None and reference["id"] != task["reference"]:
        return {"error": f"another scene's reference arrived: {reference['id']}, expected {task['reference']}"}
    runner = getattr(_threads, "runner", None)
    if runner is None:
        runner = _threads.runner = Runner()
    try:
        result: Result = runner.compute(task, reference and reference["reference"], cancelled)
    except TaskStopped:
        result = {"error": "stopped"}
    return {**result, "worker": str(worker.address), "host": host(), "name": str(worker.name)}


def usable_cores() -> int:
    """The cores of this job: affinity and control groups (Dask), and Slurm's own count."""
    from dask.system import CPU_COUNT  # type: ignore[import-untyped,unused-ignore]

    count = int(CPU_COUNT)
    with contextlib.suppress(ValueError):
        count = min(count, int(os.environ.get("SLURM_CPUS_PER_TASK", "")))
    return max(count, 1)


_SCHEDULERS = {
    "slurm": "SLURMCluster",
    "pbs": "PBSCluster",
    "sge": "SGECluster",
    "lsf": "LSFCluster",
    "local": "LocalCluster",
}
_PROFILE_KEYS = (
    "scheduler",
    "jobs",
    "cores",
    "processes",
    "memory",
    "queue",
    "walltime",
    "account",
    "extra",
    "prologue",
)


def profile_of(name: str) -> dict[str, Any]:
    """The keys of a profile: a TOML file, or the name of one in ~/.config/crescent."""
    path = Path(name)
    if not path.suffix:
        path = Path.home() / ".config" / "crescent" / f"{name}.toml"
    try:
        profile = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise UsageError(f"--engine slurm:{name}: cannot read the profile {path}: {error.strerror}") from None
    except tomllib.TOMLDecodeError as error:
        raise UsageError(f"--engine slurm:{name}: {path}: {error}") from None
    for key in profile:
        if key not in _PROFILE_KEYS:
            near = _crescent.nearest(key, list(_PROFILE_KEYS))
            raise UsageError(f"{path}: no key '{key}': expected {', '.join(_PROFILE_KEYS)}" + hint(near))
    kind = profile.setdefault("scheduler", "slurm")
    if kind not in _SCHEDULERS:
        near = _crescent.nearest(str(kind), list(_SCHEDULERS))
        raise UsageError(f"{path}: no scheduler '{kind}': expected {', '.join(_SCHEDULERS)}" + hint(near))
    return profile


def _queue_cluster(name: str) -> tuple[Any, int]:
    """A cluster whose workers are jobs of a queueing system, and the number of jobs."""
    profile = profile_of(name)
    handler = signal.getsignal(signal.SIGINT)
    try:
        import dask_jobqueue  # type: ignore[import-untyped,import-not-found,unused-ignore]
        from dask_jobqueue.local import LocalCluster as LocalJobs  # type: ignore[import-untyped,import-not-found,unused-ignore]
    except ImportError:
        raise EngineError("crescent sweep: needs dask-jobqueue: pip install 'crescent-bench[sweep]'") from None
    finally:
        signal.signal(signal.SIGINT, handler)  # importing dask-jobqueue replaces it
    kind = _SCHEDULERS[profile.pop("scheduler")]
    jobs = int(profile.pop("jobs", 1))
    options: dict[str, Any] = {"cores": 1, "memory": "4GB", **profile}
    for ours, theirs in (("extra", "job_extra_directives"), ("prologue", "job_script_prologue")):
        if ours in options:
            options[theirs] = options.pop(ours)
    options.setdefault("processes", options["cores"])  # one thread per process
    cluster = (LocalJobs if kind == "LocalCluster" else getattr(dask_jobqueue, kind))(**options)
    cluster.scale(jobs=jobs)
    return cluster, jobs


@contextlib.contextmanager
def _without_script() -> Iterator[None]:
    """Keeps new processes from running the user's script once more, whose call of a sweep would start others: tasks
    bring along all that they need."""
    main = vars(sys.modules["__main__"])
    known: dict[str, Any] = {name: main[name] for name in ("__file__", "__spec__") if name in main}
    main.pop("__file__", None)
    main["__spec__"] = None
    try:
        yield
    finally:
        main.update(known)


class DaskEngine:
    """A Dask client with a bounded window of tasks. Use as a context."""

    def __init__(self, engine: str, workers: int | None = None) -> None:
        self._engine, self._workers = engine, workers
        self._cluster: Any = None
        self.client: Any = None
        self._lost = threading.Event()
        self._closing = False
        self.slots = 1
        self._open = contextlib.ExitStack()
        self._call, self._numbers = uuid.uuid4().hex[:8], itertools.count()
        self.later: list[Job] = []  #: jobs that the caller adds while it reads results

    def __enter__(self) -> DaskEngine:
        try:
            self._start()
        except BaseException:
            self._open.close()
            raise
        return self

    def _start(self) -> None:
        import dask

        distributed = _module("distributed")

        for name in ("distributed", "distributed.client", "distributed.scheduler", "tornado", "asyncio"):
            logging.getLogger(name).setLevel(logging.CRITICAL)
        dask.config.set({
            "distributed.comm.timeouts.connect": "5s",
            "distributed.admin.tick.limit": "60s",
            # Logs for debugging and for the dashboard; at their defaults they hold about 1 kB of each task.
            "distributed.admin.low-level-log-length": 20,
            "distributed.admin.log-length": 200,
            "distributed.scheduler.dashboard.tasks.task-stream-length": 1000,
        })  # fmt: skip
        if self._engine == "local":
            self._open.enter_context(_without_script())
            count = self._workers or usable_cores()
            self._cluster = distributed.LocalCluster(
                n_workers=count, threads_per_worker=1, processes=True, dashboard_address="127.0.0.1:0",
                memory_limit=0, silence_logs=logging.CRITICAL,
            )  # fmt: skip
        elif self._engine.startswith("slurm:"):
            self._cluster, _ = _queue_cluster(self._engine.partition(":")[2])
        at = self._cluster or "tcp://" + self._engine.removeprefix("dask://")
        try:
            self.client = distributed.Client(at, timeout=5, set_as_default=False)
        except (OSError, TimeoutError, ValueError) as error:
            raise EngineError(f"no Dask scheduler at {self._engine}: {error}") from None
        threading.Thread(target=self._watch, daemon=True).start()

    def __exit__(self, kind: type[BaseException] | None, *rest: Any) -> None:
        with self._open:
            self.close(quick=kind is not None)

    def close(self, quick: bool = False) -> None:
        """Ends the client, and the cluster if it is this engine's own; `quick`: its workers are ended at once."""
        self._closing = True
        if quick and self._engine == "local" and self._cluster is not None:
            self._kill_workers()
        for part in (self.client, self._cluster):
            if part is not None and not self._lost.is_set():
                with contextlib.suppress(Exception):
                    part.close(timeout=1 if quick else 10)

    def _kill_workers(self) -> None:
        for nanny in getattr(self._cluster, "workers", {}).values():
            with contextlib.suppress(Exception):
                os.kill(nanny.process.process.pid, 9)

    def _watch(self) -> None:
        """Sets `lost` as soon as the scheduler does not respond."""
        since = time.monotonic()
        while not self._closing and not self._lost.is_set():
            try:
                comm = self.client.scheduler_comm
                if comm is not None and not comm.comm.closed():
                    self.client.sync(self.client.scheduler.versions, callback_timeout=_RESPONSE_S / 2)
                    since = time.monotonic()
            except Exception:  # noqa: BLE001: any failure counts as no response
                pass
            if time.monotonic() - since > _RESPONSE_S:
                self._lost.set()
            time.sleep(1)

    @property
    def dashboard(self) -> str:
        """The address of Dask's dashboard; "" if this scheduler has none, or bokeh is missing there."""
        address = str(self.client.dashboard_link)
        try:
            with urllib.request.urlopen(address, timeout=2):
                return address
        except (OSError, ValueError):
            return ""

    def workers(self) -> dict[str, Any]:
        """The scheduler's information about its workers, by address."""
        return dict(self.client.scheduler_info(n_workers=-1)["workers"])

    def wait_for_workers(self) -> None:
        """Waits for the first worker; EngineError if there is none in a minute, except for workers of a queue."""
        start = time.monotonic()
        while True:
            found = self.workers()
            self.slots = sum(w["nthreads"] for w in found.values())
            if self.slots:
                return
            self._check()
            if time.monotonic() - start > _NO_WORKER_S and not self._engine.startswith("slurm:"):
                raise EngineError(f"{self._engine}: no worker for {_NO_WORKER_S:.0f} s")
            time.sleep(0.1)

    def _disconnected(self) -> bool:
        """Whether the connection to the scheduler is closed."""
        comm = self.client.scheduler_comm
        return self._lost.is_set() or self.client.status != "running" or comm is None or bool(comm.comm.closed())

    def _check(self) -> None:
        if interrupted.is_set():
            raise KeyboardInterrupt
        if self._lost.is_set():
            raise EngineError(f"the Dask scheduler of {self._engine} does not answer")

    def run(self, jobs: Iterator[Job], references: Callable[[str], bytes | None]) -> Iterator[tuple[Job, Result]]:
        """Runs jobs and yields them with their results as they end. A job that needs references comes after the job
        that computes them, whose id is their identity; else `references` returns them."""
        done: queue.SimpleQueue[Any] = queue.SimpleQueue()
        running: dict[Any, tuple[Any, Job]] = {}
        length = 1.0  # of a task in s, a running mean: long ones are submitted late, so that workers end together
        shared: dict[str, Any] = {}  # references of the current points, as futures
        waiting = self.later
        deferred: list[Job] = []  # a job whose references must wait
        exhausted = False
        last_worker = time.monotonic()

        def submit(job: Job) -> None:
            job.tries += 1
            reference = None
            if job.needs:
                if job.needs not in shared:
                    data = references(job.needs)
                    if data is not None:
                        kept = {"reference": data, "id": job.needs}
                        shared[job.needs] = self.client.scatter([kept], hash=False)[0]
                reference = shared.get(job.needs)
            where = None
            if job.avoid:
                others = [address for address in self.workers() if address != job.avoid]
                where = others or None
            # A new key for each task. Tasks of one group stay in the scheduler's queue until a worker is free.
            key = (f"{job.needs or job.task['kind']}-{self._call}", next(self._numbers))
            future = self.client.submit(on_worker, job.task, reference, key=key, pure=False, workers=where, retries=0)
            if job.task["kind"] == "reference":
                shared[job.id] = future
            running[key] = (future, job)
            future.add_done_callback(done.put)

        def release() -> None:
            needed = {job.needs for _, job in running.values()} | {job.needs for job in waiting + deferred}
            needed |= {job.id for _, job in running.values() if job.task["kind"] == "reference"}
            for name in [name for name in list(shared)[:-2] if name not in needed]:
                del shared[name]

        try:
            while True:
                self._check()
                most = max(2 * _BATCH, 4 * self.slots) if length < 0.5 else 3 * self.slots + 1
                while len(running) < most and not (exhausted and not waiting and not deferred):
                    job = waiting.pop() if waiting else deferred.pop() if deferred else next(jobs, None)
                    if job is None:
                        exhausted = True
                        break
                    new = job.task["kind"] == "reference" or bool(job.needs) and job.needs not in shared
                    if new and running and len(shared) > self.slots + 2:  # references fill the memory of workers
                        deferred.append(job)
                        break
                    submit(job)
                if exhausted and not running and not waiting and not deferred:
                    return
                try:
                    future = done.get(timeout=0.5)
                except queue.Empty:
                    self._check()
                    found = self.workers()
                    if found:
                        last_worker = time.monotonic()
                        self.slots = sum(w["nthreads"] for w in found.values())
                    elif time.monotonic() - last_worker > _NO_WORKER_S and not self._engine.startswith("slurm:"):
                        raise EngineError(f"{self._engine}: no worker for {_NO_WORKER_S:.0f} s") from None
                    continue
                futures = [future]
                while len(futures) < _BATCH:
                    try:
                        futures.append(done.get_nowait())
                    except queue.Empty:
                        break
                futures = [future for future in futures if future.key in running]
                together = self._together([f for f in futures if running[f.key][1].task["kind"] != "reference"])
                for future in futures:
                    _, job = running.pop(future.key)
                    if future.key in together:
                        result, again = together[future.key], False
                    else:
                        result, again = self._result(future, job)
                    length += (result.get("seconds", length) - length) / 8
                    if again:
                        shared.pop(job.needs, None)
                        waiting.append(job)
                        continue
                    yield job, result
                release()
        except BaseException as error:
            if isinstance(error, Exception) and not isinstance(error, EngineError) and self._disconnected():
                self._lost.set()
                raise EngineError(f"the Dask scheduler of {self._engine} does not answer") from None
            ends = self._engine == "local" and isinstance(error, KeyboardInterrupt)  # the workers, with the cluster
            with contextlib.suppress(Exception):
                if not self._lost.is_set() and not ends:
                    self.client.cancel([future for future, _ in running.values()], force=True)
            raise

    def _together(self, futures: list[Any]) -> dict[Any, Result]:
        """The results of finished futures in one request; empty if one of them has none."""
        if any(future.status != "finished" for future in futures):
            return {}
        try:
            results = self.client.sync(self.client._gather, futures, callback_timeout=60)
            return {future.key: result for future, result in zip(futures, results, strict=True)}
        except Exception:  # noqa: BLE001: each is then requested alone, for its own error
            return {}

    def _result(self, future: Any, job: Job) -> tuple[Result, bool]:
        """The result of a finished future, and whether the job must be submitted again."""
        if future.status == "finished":
            try:
                return dict(future.result(timeout=30)), False
            except Exception as error:  # noqa: BLE001: its worker was lost before the result arrived
                problem: BaseException = error
        else:
            try:
                problem = future.exception(timeout=5) or EngineError("lost")
            except KeyboardInterrupt:
                raise
            except BaseException as error:  # noqa: BLE001: a cancelled future raises a CancelledError
                problem = error
        self._check()
        if type(problem).__name__ == "KilledWorker":
            return {
                "error": f"{getattr(problem, 'allowed_failures', 3) + 1} workers were lost while they computed it"
            }, False
        if job.tries < _LOST_TRIES:
            return {}, True
        return {"error": f"{type(problem).__name__}: {problem}"}, False


class InProcess:
    """One child process without Dask, for tasks of `commands`."""

    def __enter__(self) -> InProcess:
        self._runner = Runner()
        return self

    def __exit__(self, *rest: Any) -> None:
        self._runner.stop()

    def compute(self, task: Task, reference: bytes | None = None) -> Result:
        """The result of one task."""
        result = self._runner.compute(task, reference, lambda: False)
        return {**result, "worker": f"{host()}:{os.getpid()}", "host": host(), "name": ""}


def engine_of(text: str) -> str:
    """Validates the text of ``--engine``; UsageError with the nearest word if it is wrong."""
    kind, colon, rest = text.partition(":")
    if text in ("local", "commands"):
        return text
    if (
        kind == "dask"
        and rest.startswith("//")
        and rest[2:].rpartition(":")[2].isdecimal()
        and rest[2:].rpartition(":")[0]
    ):
        return text
    if kind == "slurm" and rest:
        return text
    near = _crescent.nearest(kind, ["local", "commands", "dask", "slurm"])
    raise UsageError(
        f"--engine {text}: expected local, dask://HOST:PORT, slurm:PROFILE or commands"
        + (f"; did you mean '{near}'?" if near and near != kind else "")
    )

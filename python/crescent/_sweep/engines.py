"""Where tasks run: a Dask cluster on this machine, one that is running, or one of a queueing system.

Dask assigns tasks to workers and repeats those of a worker that was lost. Each thread of a worker has one child process
(runner.py). A bounded number of tasks is in flight, so the client's memory does not grow with their number.
"""

from __future__ import annotations

import contextlib
import importlib
import itertools
import logging
import os
import signal
import sys
import threading
import time
import tomllib
import urllib.request
import uuid
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from .. import _crescent
from .grid import UsageError, hint
from .progress import Progress
from .runner import Runner, TaskStopped
from .tasks import Job, Result, Task, host

#: Set by Ctrl-C: a KeyboardInterrupt that is raised while Python finalizes an object is lost.
interrupted = threading.Event()
_threads = threading.local()
_IN_FLIGHT = 16  # tasks for each thread of the workers; with 4 a task costs 1 ms more, in smaller batches of results
_POLL_S = 0.005
_TRANSFER_S = 60.0  # of the results of one request
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
    return {**result, "worker": str(worker.address), "host": host()}


def usable_cores() -> int:
    """The cores of this job: affinity and control groups (Dask), and Slurm's own count."""
    from dask.system import CPU_COUNT  # type: ignore[import-untyped,unused-ignore]

    count = int(CPU_COUNT)
    with contextlib.suppress(ValueError):
        count = min(count, int(os.environ.get("SLURM_CPUS_PER_TASK", "")))
    return max(count, 1)


_SCHEDULERS = {
    "slurm": "SLURMCluster", "pbs": "PBSCluster", "sge": "SGECluster", "lsf": "LSFCluster", "local": "LocalCluster",
}  # fmt: skip
_PROFILE_KEYS = (
    "scheduler", "jobs", "cores", "processes", "memory", "queue", "walltime", "account", "extra", "prologue",
)  # fmt: skip


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


def _queue_cluster(name: str) -> Any:
    """A cluster whose workers are jobs of a queueing system."""
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
    return cluster


@contextlib.contextmanager
def _without_script() -> Iterator[None]:
    """Keeps new processes from running the user's script once more, whose call of a sweep would start others: tasks
    bring along all that they need."""
    main = vars(sys.modules["__main__"])
    before: dict[str, Any] = {name: main[name] for name in ("__file__", "__spec__") if name in main}
    main.pop("__file__", None)
    main["__spec__"] = None
    try:
        yield
    finally:
        main.update(before)


def _given(value: Any) -> Any:
    """What Dask repeats if the worker that holds the value is lost."""
    return value


class DaskEngine:
    """A Dask client with a bounded number of tasks in flight. Use as a context, which has a worker."""

    def __init__(self, engine: str, workers: int | None = None, say: Callable[[str], None] | None = None) -> None:
        self._engine, self._count, self._say = engine, workers, say
        self._cluster: Any = None
        self.client: Any = None
        self.workers: dict[str, int] = {}  #: threads by address
        self._lost = False
        self._problem = ""  # why the engine cannot go on
        self._closing = False
        self._contexts = contextlib.ExitStack()
        self._call = uuid.uuid4().hex[:8]
        self._numbers = itertools.count()

    def __enter__(self) -> DaskEngine:
        try:
            self._start()
            while not self.workers:
                self._check()
                time.sleep(0.05)
            if self._say and (address := self._dashboard()):
                self._say(f"dashboard: {address}")
        except BaseException:
            self.close(quick=True)
            self._contexts.close()
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
            "distributed.admin.large-graph-warning-threshold": "1TB",  # references are large
            # Logs for debugging and for the dashboard; at their defaults they hold about 1 kB of each task.
            "distributed.admin.low-level-log-length": 20,
            "distributed.admin.log-length": 200,
            "distributed.scheduler.dashboard.tasks.task-stream-length": 1000,
        })  # fmt: skip
        if self._engine == "local":
            self._contexts.enter_context(_without_script())
            self._cluster = distributed.LocalCluster(
                n_workers=self._count or usable_cores(), threads_per_worker=1, processes=True,
                dashboard_address="127.0.0.1:0", memory_limit=0, silence_logs=logging.CRITICAL,
            )  # fmt: skip
        elif self._engine.startswith("slurm:"):
            self._cluster = _queue_cluster(self._engine.partition(":")[2])
        address = self._cluster or "tcp://" + self._engine.removeprefix("dask://")
        try:
            self.client = distributed.Client(address, timeout=5, set_as_default=False)
        except (OSError, TimeoutError, ValueError) as error:
            raise EngineError(f"no Dask scheduler at {self._engine}: {error}") from None
        threading.Thread(target=self._watch, daemon=True).start()

    def __exit__(self, kind: type[BaseException] | None, *rest: Any) -> None:
        with self._contexts:
            self.close(quick=kind is not None)

    def close(self, quick: bool = False) -> None:
        """Ends the client, and the cluster if this engine started it; `quick`: its workers are ended at once."""
        self._closing = True
        if quick and self._engine == "local" and self._cluster is not None:
            for nanny in self._cluster.workers.values():
                with contextlib.suppress(Exception):
                    os.kill(nanny.process.process.pid, 9)
        for part in (self.client, self._cluster):
            if part is not None and not self._lost:
                with contextlib.suppress(Exception):
                    part.close(timeout=1 if quick else 10)

    def _watch(self) -> None:
        """Keeps the list of workers, and notices that the scheduler does not respond or that there are no workers."""
        responded = seen = time.monotonic()
        while not self._closing and not self._problem:
            try:
                self.workers = self.client.sync(self.client.scheduler.ncores, callback_timeout=_RESPONSE_S / 2)
                responded = time.monotonic()
            except Exception:  # noqa: BLE001: any failure counts as no response
                pass
            seen = responded if self.workers else seen
            if time.monotonic() - responded > _RESPONSE_S:
                self._set_lost()
            elif responded - seen > _NO_WORKER_S and not self._engine.startswith("slurm:"):
                self._problem = f"{self._engine}: no worker for {_NO_WORKER_S:.0f} s"
            time.sleep(1 if self.workers else 0.1)

    def _set_lost(self) -> None:
        self._lost = True
        self._problem = f"the Dask scheduler of {self._engine} does not answer"

    def _check(self) -> None:
        if interrupted.is_set():
            raise KeyboardInterrupt
        if self._problem:
            raise EngineError(self._problem)

    def _dashboard(self) -> str:
        """The address of Dask's dashboard; "" if this scheduler has none, or bokeh is missing there."""
        address = str(self.client.dashboard_link)
        try:
            with urllib.request.urlopen(address, timeout=2):
                return address
        except (OSError, ValueError):
            return ""

    @property
    def threads(self) -> int:
        """The threads of all workers."""
        return sum(self.workers.values())

    def run(
        self, next_job: Callable[[], Job | None], stored_reference: Callable[[str], bytes | None] = lambda name: None
    ) -> Iterator[tuple[Job, Result]]:
        """Runs jobs and yields them with their results as they end. `next_job` returns None if there is no job now; the
        end is when there is none, and none runs. A job that needs references comes after the job that computes them,
        whose id is their identity; else `stored_reference` returns them."""
        finished = _module("distributed").as_completed(loop=self.client.loop)
        running: dict[Any, tuple[Any, Job]] = {}
        references: dict[str, Any] = {}  # of running jobs, and the last two, as futures
        try:
            while True:
                threads = max(self.threads, 1)
                while len(running) < _IN_FLIGHT * threads and len(references) <= threads + 2:
                    if (job := next_job()) is None:
                        break
                    future = self._submit(job, references, stored_reference)
                    running[future.key] = future, job
                    finished.add(future)
                if not running:
                    return
                self._check()
                if not (batch := finished.next_batch(block=False)):
                    time.sleep(_POLL_S)
                for future, result in zip(batch, self._results(batch), strict=True):
                    if result is None:
                        finished.add(future)
                    else:
                        yield running.pop(future.key)[1], result
                in_use = {name for _, job in running.values() for name in (job.id, job.reference)}
                for name in [name for name in list(references)[:-2] if name not in in_use]:
                    del references[name]
        except BaseException as error:
            if isinstance(error, Exception) and not isinstance(error, EngineError) and self.client.status != "running":
                self._set_lost()
                raise EngineError(self._problem) from None
            workers_end = self._engine == "local" and isinstance(error, KeyboardInterrupt)
            if not self._lost and not workers_end:
                with contextlib.suppress(Exception):
                    self.client.cancel([future for future, _ in running.values()], force=True)
            raise

    def _submit(
        self, job: Job, references: dict[str, Any], stored_reference: Callable[[str], bytes | None]
    ) -> Any:
        """The future of a job. Jobs of one reference are a group of Dask, which waits in the scheduler's queue until a
        worker is free; a worker that is lost is repeated with its tasks and the references that it held."""
        name = job.reference
        if name and name not in references and (data := stored_reference(name)) is not None:
            key = (f"reference-{name}-{self._call}", next(self._numbers))
            references[name] = self.client.submit(_given, {"reference": data, "id": name}, key=key, pure=False)
        others = [address for address in self.workers if address != job.avoid] if job.avoid else None
        kind = job.task["kind"]
        key = (f"{kind}-{job.id if kind == 'reference' else name}-{self._call}", next(self._numbers))
        future = self.client.submit(on_worker, job.task, references.get(name), key=key, pure=False, workers=others or None)
        if kind == "reference":
            references[job.id] = future
        return future

    def _results(self, futures: Sequence[Any]) -> list[Result | None]:
        """The results of futures that have ended, in one request; None of one that was lost with its worker since: Dask
        computes it again."""
        done = {k: future for k, future in enumerate(futures) if future.status == "finished"}
        values: dict[int, Any] = {}
        is_late = False
        try:
            if done:
                values = self.client.sync(self.client._gather, done, errors="skip", callback_timeout=_TRANSFER_S)
        except TimeoutError:
            is_late = True
        return [values.get(k) or self._failure(future, is_late) for k, future in enumerate(futures)]

    def _failure(self, future: Any, is_late: bool) -> Result | None:
        """Why a future has no result. Only the loss of the scheduler cancels one."""
        if future.cancelled():
            self._set_lost()
            raise EngineError(self._problem)
        if future.status == "finished" and is_late:
            return {"error": f"its result did not arrive in {_TRANSFER_S:.0f} s"}
        if future.status != "error":
            return None
        problem = future.exception(timeout=5)
        if type(problem).__name__ == "KilledWorker":
            return {"error": f"{problem.allowed_failures + 1} workers were lost while they computed it"}
        return {"error": f"{type(problem).__name__}: {problem}"}


def execute(
    engine: DaskEngine, next_job: Callable[[], Job | None], take: Callable[[Job, Result], None], failed: dict[str, str],
    bar: Progress, stored_reference: Callable[[str], bytes | None] = lambda name: None,
) -> None:  # fmt: skip
    """Computes jobs; `take` stores a result, `failed` gets the errors by the labels of the jobs."""
    for job, result in engine.run(next_job, stored_reference):
        error = result.get("error")
        if error is None:
            try:
                take(job, result)
            except OSError as problem:
                error = f"cannot write the result: {problem.strerror or problem}"
        if error is not None:
            failed[job.label] = error
        bar.add(job.samples, error is not None)
    bar.show(last=True)


def engine_of(text: str) -> str:
    """Validates the text of ``--engine``; UsageError with the nearest word if it is wrong."""
    kind, _, rest = text.partition(":")
    address, _, port = rest.removeprefix("//").rpartition(":")
    if text in ("local", "commands") or (kind == "slurm" and rest):
        return text
    if kind == "dask" and rest.startswith("//") and address and port.isdecimal():
        return text
    near = _crescent.nearest(kind, ["local", "commands", "dask", "slurm"])
    raise UsageError(
        f"--engine {text}: expected local, dask://HOST:PORT, slurm:PROFILE or commands"
        + (f"; did you mean '{near}'?" if near and near != kind else "")
    )

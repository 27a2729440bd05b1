"""What the engine of `crescent sweep` costs: overhead of a task, use of the cores, memory of the client, scaling.

    PYTHONPATH=build/python python bench/sweep.py [--tasks 100000] [--write docs/clusters.md]

All tasks are stubs that sleep, sent the way of real ones: client, scheduler, worker, child process of the worker, and
back. Sleeping tasks need no core, so that eight workers can be timed on two cores: a model of many hosts, in which the
client and the scheduler are real and the computing is not.
"""

import argparse
import datetime
import os
import platform
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from measured_part import write_between

from crescent._sweep.engines import DaskEngine
from crescent._sweep.identity import NUMERICS
from crescent._sweep.tasks import Job


def stubs(count, seconds):
    """A function that returns the next of these jobs that sleep."""
    task = {"kind": "sleep", "numerics": NUMERICS, "seconds": seconds}
    jobs = (Job(f"stub-{k}", task) for k in range(count))
    return lambda: next(jobs, None)


def resident():
    """The memory of this process in MB."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            return int(line.split()[1]) / 1024
    return float("nan")


def timed(engine, count, seconds):
    """Wall-clock seconds of `count` tasks, and processor seconds of this process, which has the client and the
    scheduler of a local cluster; after each worker has had some."""
    for _, result in engine.run(stubs(8 * engine.threads, 0)):
        assert "error" not in result, result
    start, spent = time.perf_counter(), time.process_time()
    for _, result in engine.run(stubs(count, seconds)):
        assert "error" not in result, result
    return time.perf_counter() - start, time.process_time() - spent


def with_workers(workers, work):
    with DaskEngine("local", workers) as engine:
        while engine.threads < workers:
            time.sleep(0.1)
        return work(engine)


def memory(engine, count):
    """The client's memory after a tenth of the tasks and at the end, and the seconds."""
    start, done, early = time.perf_counter(), 0, 0.0
    for _ in engine.run(stubs(count, 0)):
        done += 1
        if done == count // 10:
            early = resident()
    return early, resident(), time.perf_counter() - start


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tasks", type=int, default=100_000)
    parser.add_argument("--write")
    parser.add_argument("--only-memory", action="store_true")
    given = parser.parse_args()
    load = os.getloadavg()[0]
    lines = ["| measured | result |", "|---|---|"]

    def line(what, text):
        lines.append(f"| {what} | {text} |")
        print(f"{what}: {text}", flush=True)

    if given.only_memory:
        print(*with_workers(2, lambda e: memory(e, given.tasks)))
        return
    wall, spent = with_workers(2, lambda e: timed(e, 2000, 0))
    line(
        "overhead of a task, 2,000 empty tasks on 2 workers",
        f"{wall / 2000 * 1e3:.1f} ms; {spent / 2000 * 1e3:.1f} ms of processor time of client and scheduler",
    )
    wall, _ = with_workers(2, lambda e: timed(e, 2000, 0.1))
    line("use of 2 workers, 2,000 tasks of 0.1 s", f"{2000 * 0.1 / 2 / wall:.1%}")
    one = None
    for workers in (1, 2, 4, 8):
        wall, _ = with_workers(workers, lambda e, w=workers: timed(e, 60 * w, 0.5))
        rate = 60 * workers / wall
        one = one or rate
        line(
            f"{workers} workers, {60 * workers} tasks of 0.5 s that sleep",
            f"{rate:.2f} tasks/s, {rate / one / workers:.0%} of linear",
        )
    early, late, wall = with_workers(2, lambda e: memory(e, given.tasks))
    line(
        f"memory of the client, {given.tasks:,} empty tasks",
        f"{early:.0f} MB after a tenth of them, {late:.0f} MB at the end; {wall / given.tasks * 1e3:.1f} ms a task",
    )
    day = datetime.date.today().isoformat()
    note = (
        f"Measured on {day} on {os.cpu_count()} cores ({platform.machine()}), load average {load:.1f} to "
        f"{os.getloadavg()[0]:.1f} from other work on the machine, by `bench/sweep.py`."
    )
    if given.write:
        write_between(given.write, "sweep.py", "\n".join(lines) + f"\n\n{note}")
    print(note)


if __name__ == "__main__":
    main()

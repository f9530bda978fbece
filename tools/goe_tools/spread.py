"""Work spread over processes of this machine, or over a Dask cluster.

The results do not depend on where a task runs: they come in the order of the tasks, each task contains the seed of its
random numbers, and sums are formed only when all results are there.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, TypeVar

from joblib import Parallel, delayed, parallel_config
from joblib.externals.loky.process_executor import TerminatedWorkerError
from tqdm import tqdm

Job = TypeVar("Job")
Result = TypeVar("Result")
CONNECT_S = 10


@dataclass(frozen=True)
class Workers:
    jobs: int = 1  # processes of this machine
    scheduler: str = ""  # address of a Dask scheduler; uses all its workers


ALONE = Workers()


def add_arguments(parser: argparse.ArgumentParser) -> None:
    own = os.cpu_count() or 1
    parser.add_argument("--jobs", type=int, default=own, metavar="N", help=f"processes (default: processors, {own})")
    parser.add_argument(
        "--scheduler",
        default="",
        metavar="ADDRESS",
        help="spread over the workers of this Dask scheduler, each with this project built in the same place",
    )


def workers_of(arguments: argparse.Namespace) -> Workers:
    if arguments.jobs < 1:
        raise ValueError(f"--jobs {arguments.jobs}: must be at least 1")
    if arguments.scheduler and importlib.util.find_spec("distributed") is None:
        raise ValueError("--scheduler: the Python packages dask and distributed are not installed")
    return Workers(arguments.jobs, arguments.scheduler)


@lru_cache(maxsize=1)
def _client(address: str) -> Any:
    """Stays connected until the process ends."""
    from distributed import Client

    try:
        return Client(address, timeout=CONNECT_S)
    except (OSError, ValueError) as error:
        raise ValueError(f"--scheduler {address}: {error}") from None


def connect(workers: Workers) -> None:
    """Raises ValueError if the scheduler does not answer. Without one there is nothing to do."""
    if workers.scheduler:
        _client(workers.scheduler)


@contextmanager
def _cluster(address: str) -> Iterator[None]:
    with parallel_config("dask", client=_client(address)):
        yield


@contextmanager
def deaf() -> Iterator[None]:
    """Ignores Ctrl-C meanwhile. A process that starts meanwhile ignores it until it ends."""
    if threading.current_thread() is not threading.main_thread():  # only the main thread may set signal handlers
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _begun(work: Callable[[Job], Result], tasks: Sequence[Job], workers: Workers) -> Iterator[Result]:
    """The back end applies to the tasks started here, not to the caller's work between the results."""
    backend = _cluster(workers.scheduler) if workers.scheduler else parallel_config("loky", n_jobs=workers.jobs)
    with backend, deaf():  # this process handles Ctrl-C and then ends those that it started
        return Parallel(return_as="generator")(delayed(work)(task) for task in tasks)


def spread(work: Callable[[Job], Result], tasks: Sequence[Job], workers: Workers) -> Iterator[Result]:
    """Results in the order of the tasks, as they arrive. ``work`` and tasks are pickled."""
    if workers.jobs == 1 and not workers.scheduler:
        yield from map(work, tasks)
        return
    try:
        yield from _begun(work, tasks, workers)
    except TerminatedWorkerError:
        raise ValueError("a process of --jobs was killed (out of memory?); its flights are lost") from None
    except (ConnectionError, OSError, TimeoutError) as error:
        if not workers.scheduler:
            raise
        raise ValueError(f"--scheduler {workers.scheduler}: {error or 'no workers'}") from None


def each(work: Callable[[Job], Result], tasks: Sequence[Job], workers: Workers, title: str) -> list[Result]:
    """All results, with a progress bar."""
    return list(tqdm(spread(work, tasks, workers), total=len(tasks), desc=title, disable=None, leave=False))

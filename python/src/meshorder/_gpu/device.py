# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""A graphics processor, through CuPy."""

from __future__ import annotations

import contextlib
import functools
import importlib
import pathlib
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._errors import Unavailable

#: threads of a block
BLOCK = 256

_ROUNDS = 15
_BATCH_MILLISECONDS = 2.0
_MOST_LAUNCHES = 400  # launches of a batch; all of them wait in the device's queue
_CYCLES_TO_LAUNCH = 20_000  # cycles of the device's clock while this process makes a launch


class Launch(NamedTuple):
    """A launch of a kernel.

    Attributes:
        kernel: name of the function in kernels.cu.
        threads: number of threads, which is rounded up to whole blocks.
        arguments: integers, of 32 bits in the kernel, and arrays on the device.
        shared: bytes of shared memory of a block.
    """

    kernel: str
    threads: int
    arguments: tuple[Any, ...]
    shared: int = 0


def _first_line(error: BaseException) -> str:
    return next((line.strip() for line in str(error).splitlines() if line.strip()), type(error).__name__)


class Device:
    """The current device of CuPy, which is imported and checked here.

    Attributes:
        name: of the device.

    Raises:
        Unavailable: CuPy is not installed or cannot be imported, there is no device, or no driver for it.
    """

    def __init__(self) -> None:
        try:
            self._cupy: Any = importlib.import_module("cupy")
        except ModuleNotFoundError:
            raise Unavailable(
                "compare on a GPU: CuPy is not installed; pip install 'cupy-cuda12x[ctk]', or cupy-cuda13x where "
                "nvidia-smi reports CUDA 13"
            ) from None
        except ImportError as error:
            raise Unavailable(f"compare on a GPU: CuPy cannot be imported: {_first_line(error)}") from None
        runtime = self._cupy.cuda.runtime
        try:
            self.name: str = runtime.getDeviceProperties(runtime.getDevice())["name"].decode()
        except runtime.CUDARuntimeError as error:
            raise Unavailable(
                f"compare on a GPU: CuPy finds no GPU: {_first_line(error)}; see what nvidia-smi reports"
            ) from None
        self._module: Any = self._cupy.RawModule(
            code=pathlib.Path(__file__).with_name("kernels.cu").read_text(encoding="utf-8"), options=("-std=c++17",)
        )

    def upload(self, values: NDArray[Any]) -> Any:
        """Returns a copy of an array on the device.

        Raises:
            Unavailable: the memory of the device is too small.
        """
        with self._enough_memory():
            return self._cupy.asarray(np.ascontiguousarray(values))

    def download(self, values: Any) -> NDArray[Any]:
        """Returns a copy of an array on the device, once all launches have ended."""
        found: NDArray[Any] = self._cupy.asnumpy(values)
        return found

    def launch(self, launches: Sequence[Launch]) -> None:
        """Starts kernels, one after another.

        Raises:
            Unavailable: NVRTC cannot compile them.
        """
        for start in self._ready(launches):
            start()

    def milliseconds(self, runs: Sequence[Sequence[Launch]]) -> NDArray[np.float64]:
        """Times runs alternately: each round repeats each run several times.

        Returns:
            Milliseconds of one run, for each of 15 rounds and each run.
        """
        ready = [self._ready(run) for run in runs]
        once = [self._batch(run, 1) for run in ready for _ in range(2)][1::2]  # the first batch of each run warms up
        most = max(1, _MOST_LAUNCHES // max(map(len, runs)))
        repeats = int(np.clip(_BATCH_MILLISECONDS / max(float(np.median(once)), 1e-4), 1, most))
        times = np.empty((_ROUNDS, len(runs)))
        for row in range(_ROUNDS):
            for column in np.roll(np.arange(len(runs)), row).tolist():
                times[row, column] = self._batch(ready[column], repeats) / repeats
        return times

    def free(self) -> None:
        """Returns memory that arrays no longer use to the device."""
        self._cupy.get_default_memory_pool().free_all_blocks()

    def _ready(self, launches: Sequence[Launch]) -> list[Callable[[], None]]:
        """Returns functions that start the kernels in as little time as possible."""
        ready: list[Callable[[], None]] = []
        for launch in launches:
            blocks = -(-launch.threads // BLOCK)
            given = tuple(np.int32(value) if isinstance(value, int) else value for value in launch.arguments)
            function = self._function(launch.kernel)
            ready.append(functools.partial(function, (blocks,), (BLOCK,), given, shared_mem=launch.shared))
        return ready

    def _batch(self, run: Sequence[Callable[[], None]], repeats: int) -> float:
        """Returns the milliseconds of ``repeats`` runs. The device is kept busy until all of them wait in its queue."""
        begin, end = self._cupy.cuda.Event(), self._cupy.cuda.Event()
        self._function("hold")((1,), (1,), (np.int64(_CYCLES_TO_LAUNCH * (10 + len(run) * repeats)),), shared_mem=0)
        begin.record()
        for _ in range(repeats):
            for start in run:
                start()
        end.record()
        end.synchronize()
        return float(self._cupy.cuda.get_elapsed_time(begin, end))

    def _function(self, name: str) -> Any:
        try:
            return self._module.get_function(name)
        except self._cupy.cuda.compiler.CompileException as error:
            raise Unavailable(f"compare on a GPU: NVRTC cannot compile the kernels: {_first_line(error)}") from None

    @contextlib.contextmanager
    def _enough_memory(self) -> Iterator[None]:
        try:
            yield
        except self._cupy.cuda.memory.OutOfMemoryError:
            raise Unavailable(
                f"compare on a GPU: the memory of {self.name} is too small for this mesh in so many orders; name fewer"
            ) from None

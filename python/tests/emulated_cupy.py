# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""A stand-in for the part of CuPy that `meshorder.compare_on_gpu` uses. It runs kernels on the CPU with emulator.hpp."""

import ctypes
import hashlib
import pathlib
import re
import subprocess
import time
import types

import numpy as np

EMULATOR = pathlib.Path(__file__).with_name("emulator.hpp")
LAUNCH = """
extern "C" const char* launch_{0}(int blocks, int threads, void** arguments) {{
  return emulator::launch({0}, blocks, threads, arguments);
}}
"""
OF_NUMPY = {np.int32: ctypes.c_int, np.int64: ctypes.c_longlong}


class CompileException(Exception):
    pass


class OutOfMemoryError(MemoryError):
    pass


class CUDARuntimeError(RuntimeError):
    pass


class Fault(Exception):
    """Not all threads of a block reach the same barriers."""


class Array:
    """An array on the device; NumPy does not take it."""

    def __init__(self, values):
        memory = np.empty(values.nbytes + 256, np.uint8)
        begin = -memory.ctypes.data % 256  # as the allocator of CuPy aligns arrays
        self.values = memory[begin : begin + values.nbytes].view(values.dtype).reshape(values.shape)
        self.values[...] = values

    def __array__(self, *given, **named):
        raise TypeError("Implicit conversion to a NumPy array is not allowed")


class Cupy(types.ModuleType):
    """The stand-in for the module.

    Attributes:
        folder: for compiled kernels.
        counts: requests and sectors of the atomic additions in the last launch of each kernel, as `gpu_cost` counts them.
        patches: pairs (old, new) of texts to replace in the source of the kernels.
        vector_additions: whether the device can add four numbers at once.
        memory: bytes of the device.
        devices: number of devices.
    """

    def __init__(self, folder):
        super().__init__("cupy")
        self.folder = folder
        self.counts = {}
        self.patches = []
        self.vector_additions = True
        self.memory = 1 << 40
        self.devices = 1
        self.taken = 0
        self.cuda = types.SimpleNamespace(
            runtime=types.SimpleNamespace(
                CUDARuntimeError=CUDARuntimeError, getDevice=self._device,
                getDeviceProperties=lambda device: {"name": b"emulator"}),
            compiler=types.SimpleNamespace(CompileException=CompileException),
            memory=types.SimpleNamespace(OutOfMemoryError=OutOfMemoryError),
            Event=Event,
            get_elapsed_time=lambda begin, end: 1e3 * (end.at - begin.at),
        )  # fmt: skip

    def _device(self):
        if self.devices == 0:
            raise CUDARuntimeError("cudaErrorNoDevice: no CUDA-capable device is detected")
        return 0

    def asarray(self, values):
        self.taken += values.nbytes
        if self.taken > self.memory:
            raise OutOfMemoryError(f"Out of memory allocating {values.nbytes} bytes")
        return Array(values)

    def asnumpy(self, array):
        return array.values.copy()

    def get_default_memory_pool(self):
        return types.SimpleNamespace(free_all_blocks=lambda: setattr(self, "taken", 0))

    def RawModule(self, *, code, options):  # noqa: N802 - CuPy's name
        for old, new in self.patches:
            assert code.count(old) == 1, f"{old}: is {code.count(old)} times in the source"
            code = code.replace(old, new)
        return types.SimpleNamespace(get_function=lambda name: Kernel(self, compiled(code, options, self), name))


class Event:
    def record(self):
        self.at = time.perf_counter()

    def synchronize(self):
        pass


class Kernel:
    def __init__(self, cupy, library, name):
        self.cupy, self.library, self.name = cupy, library, name

    def __call__(self, grid, block, arguments, *, shared_mem):
        assert shared_mem <= 48 * 1024
        given = [
            ctypes.c_void_p(value.values.ctypes.data) if isinstance(value, Array) else OF_NUMPY[type(value)](value)
            for value in arguments
        ]
        pointers = (ctypes.c_void_p * len(given))(*map(ctypes.addressof, given))
        launch = getattr(self.library, f"launch_{self.name}")
        launch.restype = ctypes.c_char_p
        fault = launch(*grid, *block, pointers)
        counts = (ctypes.c_longlong * 2)()
        self.library.take_counts(counts)
        self.cupy.counts[self.name] = tuple(counts)
        if fault:
            raise Fault(f"{self.name}: {fault.decode()}")


def compiled(code, options, cupy):
    """Returns the library of kernels; compiles it unless an earlier call has done so."""
    names = re.findall(r'extern "C" __global__ void (\w+)\(', code)
    code += "".join(map(LAUNCH.format, names))
    options = [*options, f"-DVECTOR_ADDITIONS={int(cupy.vector_additions)}"]
    name = hashlib.sha256(repr((code, options)).encode()).hexdigest()[:16]
    source, library = (pathlib.Path(cupy.folder) / f"{name}{suffix}" for suffix in (".cpp", ".so"))
    if not library.exists():
        source.write_text(code)
        command = ["c++", *options, "-O2", "-w", "-shared", "-fPIC", "-include", EMULATOR, source, "-o", library]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise CompileException(done.stderr)
    return ctypes.CDLL(str(library))

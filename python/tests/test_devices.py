# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Arrays of other libraries are moved and renumbered as NumPy's are, by functions of those libraries."""

import sys
import types

import meshorder
import numpy as np
import pytest
from meshorder import InvalidArgument, Permutation

N = 50


class OfStrict:
    """array_api_strict, which has only what the array API standard requires."""

    def __init__(self):
        self.library = pytest.importorskip("array_api_strict")

    def made(self, values):
        return self.library.asarray(values)

    def read(self, array):
        return np.asarray(array._array)


class OfJax(OfStrict):
    def __init__(self):
        self.library = pytest.importorskip("jax.numpy")

    def read(self, array):
        return np.asarray(array)


class OfWarp(OfStrict):
    def __init__(self):
        self.library = pytest.importorskip("warp")
        self.library.config.quiet = True

    def made(self, values):
        return self.library.array(values, device="cpu")

    def read(self, array):
        return array.numpy()


class OfCupy(OfStrict):
    """A stand-in for CuPy, which needs a GPU: it has functions of the module and a device that is a context manager."""

    def __init__(self, monkeypatch):
        class Device:
            entered = 0

            def __enter__(self):
                Device.entered += 1

            def __exit__(self, *error):
                Device.entered -= 1

        class ndarray:  # noqa: N801 - CuPy's name
            device = Device()

            def __init__(self, values):
                self.values = np.array(values)
                self.dtype, self.shape, self.ndim = self.values.dtype, self.values.shape, self.values.ndim

            def __array__(self, *given, **named):
                raise TypeError("Implicit conversion to a NumPy array is not allowed")

        def asarray(values):
            assert Device.entered == 1, "made on the current device, not on that of the array"
            return ndarray(values)

        ndarray.__module__ = "cupy"
        self.ndarray = ndarray
        cupy = types.ModuleType("cupy")
        vars(cupy).update(
            asarray=asarray,
            iinfo=np.iinfo,
            int32=np.int32,
            take=lambda a, indices, axis: ndarray(np.take(a.values, indices.values, axis=axis)),
            reshape=lambda a, shape: ndarray(a.values.reshape(shape)),
            astype=lambda a, dtype: ndarray(a.values.astype(dtype)),
            min=lambda a: a.values.min(),
            max=lambda a: a.values.max(),
        )
        monkeypatch.setitem(sys.modules, "cupy", cupy)

    def made(self, values):
        return self.ndarray(values)

    def read(self, array):
        return array.values


@pytest.fixture(params=["strict", "jax", "warp", "cupy"])
def library(request, monkeypatch):
    kinds = {"strict": OfStrict, "jax": OfJax, "warp": OfWarp}
    return kinds[request.param]() if request.param in kinds else OfCupy(monkeypatch)


@pytest.fixture
def permutation():
    return Permutation(new_to_old=np.random.default_rng(1).permutation(N))


@pytest.mark.parametrize("shape, axis", [((N,), 0), ((N, 3), 0), ((4, N), 1), ((4, N), -1), ((2, N, 3), 1)])
def test_arrays_move_as_numpys_do(library, permutation, shape, axis):
    values = np.random.default_rng(2).random(shape).astype(np.float32)
    given = library.made(values)
    moved = permutation.move(given, axis=axis)
    assert type(moved) is type(given) and moved.dtype == given.dtype
    assert (library.read(moved) == permutation.move(values, axis=axis)).all()
    assert (library.read(given) == values).all()


@pytest.mark.parametrize("shape", [(7,), (9, 4), (2, 3, 5), (0,)])
def test_numbers_are_renumbered_as_numpys_are(library, permutation, shape):
    numbers = np.random.default_rng(3).integers(N, size=shape).astype(np.int32)
    given = library.made(numbers)
    renumbered = permutation.renumber(given)
    assert type(renumbered) is type(given) and renumbered.dtype == given.dtype and tuple(renumbered.shape) == shape
    assert (library.read(renumbered) == permutation.renumber(numbers)).all()
    assert (library.read(given) == numbers).all()


def test_faulty_arrays_are_refused(library, permutation):
    for wrong in ([0, N], [-1, 0]):
        outside = rf"number {[w for w in wrong if not 0 <= w < N][0]} is outside 0 … {N - 1}"
        with pytest.raises(InvalidArgument, match=outside):
            permutation.renumber(library.made(np.array(wrong, np.int32)))
    with pytest.raises(InvalidArgument, match="expected integers"):
        permutation.renumber(library.made(np.zeros(3, np.float32)))
    with pytest.raises(InvalidArgument, match="along axis 0, not the shape"):
        permutation.move(library.made(np.zeros(N + 1, np.float32)))
    with pytest.raises(InvalidArgument, match="out; it is for arrays of NumPy"):
        permutation.move(library.made(np.zeros(N, np.float32)), out=np.zeros(N, np.float32))
    with pytest.raises(InvalidArgument, match="out; it is for arrays of NumPy"):
        permutation.renumber(library.made(np.zeros(3, np.int32)), out=np.zeros(3, np.int32))


def test_small_integers_become_int32(permutation):
    for library in (OfStrict(), OfJax()):
        renumbered = permutation.renumber(library.made(np.array([3, 4], np.uint8)))
        assert renumbered.dtype == library.library.int32
        assert library.read(renumbered).tolist() == permutation.renumber([3, 4]).tolist()


def test_gradients_of_jax_flow_through_moves(permutation):
    jax = pytest.importorskip("jax")
    weights = np.random.default_rng(4).random(N).astype(np.float32)
    gradient = jax.grad(lambda x: (permutation.move(x) * weights).sum())(jax.numpy.zeros(N))
    assert np.asarray(gradient) == pytest.approx(permutation.inverse().move(weights))


def test_warps_vectors_move(permutation):
    warp = pytest.importorskip("warp")
    points = np.random.default_rng(5).random((N, 3)).astype(np.float32)
    moved = permutation.move(warp.array(points, dtype=warp.vec3, device="cpu"))
    assert moved.dtype is warp.vec3 and (moved.numpy() == points[permutation.new_to_old]).all()


def test_no_library_is_imported_before_it_is_asked_for():
    import subprocess

    done = subprocess.run(
        [sys.executable, "-c", "import sys, meshorder; print({'jax', 'warp', 'cupy', 'torch', 'taichi', 'meshorder._gpu'} "
         "& set(sys.modules))"],
        capture_output=True, text=True, check=True)  # fmt: skip
    assert done.stdout == "set()\n"


def test_meshes_of_jax_are_ordered():
    jnp = pytest.importorskip("jax.numpy")
    points = np.random.default_rng(6).random((N, 3))
    cells = np.random.default_rng(7).permuted(np.tile(np.arange(N), (30, 1)), axis=1)[:, :4].astype(np.int32)
    expected = meshorder.order_mesh(points.astype(np.float32), cells)
    found = meshorder.order_mesh(jnp.asarray(points, jnp.float32), jnp.asarray(cells))
    assert found.vertices.permutation == expected.vertices.permutation
    assert (meshorder.patches(jnp.asarray(cells)).local == meshorder.patches(cells).local).all()

# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Permutations against NumPy's and SciPy's own indexing."""

import pickle
from typing import Any

import meshorder
import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given
from hypothesis import strategies as st
from meshorder import InvalidArgument, Permutation

permutations = st.integers(0, 40).flatmap(lambda n: st.permutations(range(n)))


@given(permutations)
def test_directions_are_inverse(new_to_old):
    p = Permutation(new_to_old=new_to_old)
    assert list(p.new_to_old) == list(new_to_old)
    assert list(p.old_to_new[p.new_to_old]) == list(range(len(new_to_old)))
    assert p == Permutation(old_to_new=p.old_to_new) and hash(p) == hash(Permutation(old_to_new=p.old_to_new))
    assert p.then(p.inverse()) == Permutation.identity(len(p))
    assert pickle.loads(pickle.dumps(p)) == p


@given(permutations, st.sampled_from(["f8", "f4", "i2", "c16", "S5", "?", ">i4", "M8[s]"]), st.integers(0, 3))
def test_moves_rows_as_indexing_does(new_to_old, dtype, width):
    p = Permutation(new_to_old=new_to_old)
    a = np.random.default_rng(0).integers(0, 2, (len(p), width)).astype(dtype)
    np.testing.assert_array_equal(p.move(a), a[p.new_to_old])
    np.testing.assert_array_equal(p.move(a.T, axis=1), a.T[:, p.new_to_old])
    np.testing.assert_array_equal(p.move(np.repeat(a, 2, axis=0)[::2]), a[p.new_to_old])
    assert p.move(list(range(len(p)))) == list(p.new_to_old)
    out = np.empty_like(a)
    assert p.move(a, out=out) is out and (out == a[p.new_to_old]).all()


def test_moves_masks():
    p = Permutation(new_to_old=[2, 0, 1])
    moved = p.move(np.ma.masked_array([1.0, 2.0, 3.0], [True, False, False]))
    np.testing.assert_array_equal(moved.mask, [False, True, False])


@pytest.mark.parametrize("form", ["csr", "csc", "coo", "lil", "dok", "dia"])
@pytest.mark.parametrize("kind", [sp.coo_array, sp.coo_matrix])
def test_moves_matrices_of_every_kind(form, kind):
    random = np.random.default_rng(3)
    a = kind(np.where(random.random((50, 50)) < 0.1, random.random((50, 50)), 0)).asformat(form)
    p = Permutation(new_to_old=np.random.default_rng(4).permutation(50))
    moved = p.move(a)
    assert type(moved) is type(a)
    np.testing.assert_array_equal(moved.toarray(), a.toarray()[p.new_to_old][:, p.new_to_old])


def test_matrix_of_the_permutation():
    p = Permutation(new_to_old=[2, 0, 1])
    x = np.array([1.0, 2.0, 3.0])
    np.testing.assert_array_equal(p.as_matrix() @ x, p.move(x))
    np.testing.assert_array_equal(p.as_matrix().T @ p.move(x), x)


def test_renumbers_connectivity():
    p = Permutation(new_to_old=[2, 0, 1])
    cells = np.array([[0, 1], [1, 2]], dtype=np.uint64)
    expected = p.old_to_new[cells.astype(int)]
    np.testing.assert_array_equal(p.renumber(cells), expected)
    assert cells[0, 0] == 0
    assert p.renumber(cells, out=cells) is cells
    np.testing.assert_array_equal(cells, expected)
    with pytest.raises(InvalidArgument):
        p.renumber([3])


def test_renumbers_into_another_array():
    p = Permutation(new_to_old=[2, 0, 1])
    for dtype in ("i4", "u4", "i8", "u8"):
        out = np.empty(3, dtype)
        assert p.renumber(np.array([0, 1, 2]), out=out) is out and out.tolist() == [1, 2, 0]
    wrong: list[Any] = [np.zeros((2, 3), "i4"), np.zeros(3, "i2"), np.zeros(3), [0, 0, 0]]
    for other in wrong:
        with pytest.raises(InvalidArgument):
            p.renumber(np.arange(3), out=other)
    with pytest.raises(InvalidArgument, match="4294967297"):  # which is 1 in 32 bits
        p.renumber(np.array([0, 1, 2**32 + 1]), out=np.zeros(3, "i4"))


def test_moves_all_of_a_pandas_object():
    pandas = pytest.importorskip("pandas")
    p = Permutation(new_to_old=[2, 0, 1])
    frame = pandas.DataFrame(np.arange(6).reshape(3, 2))
    assert p.move(frame).index.tolist() == p.move(frame, axis=-2).index.tolist() == [2, 0, 1]
    assert p.move(frame.T, axis=1).columns.tolist() == p.move(frame.T, axis=-1).columns.tolist() == [2, 0, 1]
    square = pandas.DataFrame(np.eye(3))
    wrong: list[tuple[Any, Any]] = [(pandas.Series(range(4)), 0), (pandas.Series(range(2)), 0), (frame, 1),
                                    (square, "index"), (square, 2)]  # fmt: skip
    for other, axis in wrong:
        with pytest.raises(InvalidArgument):
            p.move(other, axis=axis)


@pytest.mark.parametrize("a", [[1, 2, 3], (1, 2, 3), sp.csr_array(np.eye(3))])
def test_axis_and_out_are_for_arrays(a):
    p = Permutation(new_to_old=[2, 0, 1])
    for axis, out in ((1, None), (0, np.zeros(3))):
        with pytest.raises(InvalidArgument, match="for arrays"):
            p.move(a, axis=axis, out=out)


def test_out_must_take_what_is_moved():
    p = Permutation(new_to_old=[2, 0, 1])
    frozen = np.zeros(3)
    frozen.flags.writeable = False
    wrong: list[Any] = [frozen, [0, 0, 0], np.zeros(4), np.zeros(3, "i8"), np.zeros(6)[::2]]
    for array in (np.zeros(3), np.zeros(6)[::2]):
        for out in wrong:
            with pytest.raises(InvalidArgument, match="out must be"):
                p.move(array, out=out)


def test_degrees_of_freedom():
    p = Permutation(new_to_old=[2, 0, 1])
    u = np.arange(9.0).reshape(3, 3)
    np.testing.assert_array_equal(p.repeated(3).move(u.ravel()), u[p.new_to_old].ravel())
    np.testing.assert_array_equal(p.repeated(3, node_major=False).move(u.T.ravel()), u.T[:, p.new_to_old].ravel())


def test_maps_are_views_that_outlive_the_permutation():
    p = Permutation(new_to_old=np.random.default_rng(5).permutation(1000))
    view, copy = p.old_to_new, p.old_to_new.copy()
    assert np.shares_memory(view, p.old_to_new) and not view.flags.writeable
    del p
    np.testing.assert_array_equal(view, copy)


@pytest.mark.parametrize(
    "wrong",
    [{}, {"old_to_new": [0], "new_to_old": [0]}, {"old_to_new": [0, 0]}, {"new_to_old": [1, 2]}, {"new_to_old": [-1, 0]},
     {"old_to_new": [0.0, 1.0]}, {"old_to_new": [[0, 1]]}, {"old_to_new": np.ma.masked_array([0, 1], [True, False])},
     {"old_to_new": [None, 0]}, {"old_to_new": [[0], [0, 1]]}],
)  # fmt: skip
def test_refuses_what_is_no_permutation(wrong):
    with pytest.raises(ValueError) as caught:
        Permutation(**wrong)
    assert type(caught.value) is InvalidArgument


def test_asks_for_the_direction():
    p = Permutation.identity(3)
    for use in (np.asarray, iter):
        with pytest.raises(TypeError, match="which direction"):
            use(p)
    with pytest.raises(AttributeError):
        p.x = 1
    with pytest.raises(InvalidArgument):
        p.move(np.zeros(4))
    with pytest.raises(InvalidArgument):
        p.move(np.zeros(3), out=np.zeros(3, dtype=int))
    assert meshorder.Permutation is Permutation


def test_no_permutation_has_fewer_than_no_items():
    assert len(Permutation.identity(0)) == 0
    with pytest.raises(InvalidArgument, match="0 or more items, not -1"):
        Permutation.identity(-1)

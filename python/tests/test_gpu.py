# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Comparisons on a GPU. A stand-in for CuPy runs the kernels on the CPU with emulator.hpp."""

import json
import shutil
import sys

import meshorder
import numpy as np
import pytest
from meshorder import GpuComparison, GpuOrder, GpuTime, InternalError, Unavailable, _command
from meshorder._gpu import kernels as gpu_kernels
from meshorder._gpu.comparison import Speedup
from meshorder._gpu.comparison import _best_of as best_of

import emulated_cupy
from conftest import tetrahedra

pytestmark = pytest.mark.skipif(shutil.which("c++") is None, reason="there is no C++ compiler")
KERNELS = [
    "product_rows", "product_lanes", "forces_packed", "forces_apart", "forces_padded", "forces_patches", "forces_gathered",
    "springs_packed", "springs_padded", "springs_gathered", "distances",
]  # fmt: skip


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("kernels")


@pytest.fixture
def cupy(folder, monkeypatch):
    made = emulated_cupy.Cupy(folder)
    monkeypatch.setitem(sys.modules, "cupy", made)
    return made


@pytest.fixture(scope="module")
def small():
    return tetrahedra(3)


@pytest.fixture(scope="module")
def flat():
    """Triangles with coordinates, 0 in the third direction."""
    corner = np.arange(30).reshape(5, 6)
    square = [corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]]
    cells = np.concatenate([np.stack([square[i].ravel() for i in three], axis=1) for three in ((0, 1, 2), (0, 2, 3))])
    return np.argwhere(corner >= 0).astype(float), cells


def edges_of(cells):
    pairs = np.sort(cells[:, [0, 1, 0, 2, 0, 3, 1, 2, 1, 3, 2, 3]].reshape(-1, 2), axis=1)
    return np.unique(pairs, axis=0)


@pytest.mark.parametrize("vector_additions", [True, False])
def test_all_kernels_are_right_in_all_orders(cupy, small, vector_additions):
    cupy.vector_additions = vector_additions
    found = meshorder.compare_on_gpu(small)
    assert found.gpu == "emulator" and list(found.kernels) == KERNELS
    names = [order.name for order in found.orders]
    assert names[0] == "original" and len(set(names)) == len(names)
    assert {"hilbert", "rcm", "spectral", "fiedler", "hilbert/original", "scrambled"} <= set(names)
    assert sum(order.by_auto and order.sorts_corners for order in found.orders) == 1
    for order in found.orders:
        assert list(order.times) == KERNELS
        for time in order.times.values():
            assert time.error < 1e-6 and time.milliseconds > 0
            assert time.speedup.low <= time.speedup.ratio <= time.speedup.high
    assert all(time.speedup == (1, 1, 1) for time in found.orders[0].times.values())


def test_counted_additions_are_those_of_gpu_cost(cupy):
    points, cells = tetrahedra(5)
    meshorder.compare_on_gpu((points, cells), [])
    for layout in ("packed", "apart", "padded"):
        assert cupy.counts[f"forces_{layout}"] == meshorder.gpu_cost(cells, layout)[:2]
    for layout in ("packed", "padded"):
        assert cupy.counts[f"springs_{layout}"] == meshorder.gpu_cost(edges_of(cells), layout)[:2]
    for kernel in ("product_rows", "product_lanes", "corner_forces", "sum_corners", "springs_gathered", "distances"):
        assert cupy.counts[kernel] == (0, 0)
    assert 2.5 * cupy.counts["forces_patches"][1] < cupy.counts["forces_packed"][1]


@pytest.mark.parametrize("kernel, old, new", [
    # missing barriers: shared memory is read before it is cleared, or passed on before all additions
    ("forces_patches", "    own[i] = 0;\n  }\n  __syncthreads();", "    own[i] = 0;\n  }"),
    ("forces_patches", "rest, n, e));\n  }\n  __syncthreads();", "rest, n, e));\n  }"),
    # lanes that are left out
    ("product_lanes", "int apart = 4;", "int apart = 2;"),
    ("product_lanes", "offsets[row] + lane;", "offsets[row] + lane + 1;"),
    ("forces_apart", "atomicAdd(numbers + 2 * stride + v, a.z);", ""),
    ("sum_corners", "k = offsets[v]; k < offsets[v + 1]; ++k) {", "k = offsets[v] + 1; k < offsets[v + 1]; ++k) {"),
    ("distances", "q.z - q.w * f.z", "q.z + q.w * f.z"),
])  # fmt: skip
def test_faults_of_kernels_are_found(cupy, small, kernel, old, new):
    cupy.patches = [(old, new)]
    named = "forces_gathered" if kernel == "sum_corners" else kernel
    with pytest.raises(InternalError, match=f"{named} is wrong in the order original: its relative error is"):
        meshorder.compare_on_gpu(small, [])


@pytest.mark.parametrize("old, new, kernel", [
    ("    own[i] = 0;\n  }\n  __syncthreads();", "    own[i] = 0;\n    __syncthreads();\n  }", "forces_patches"),
    ("  for (int apart = 4;", "  if (lane < 7)\n    for (int apart = 4;", "product_lanes"),
])  # fmt: skip
def test_barriers_at_which_not_all_arrive_are_found(cupy, small, old, new, kernel):
    cupy.patches = [(old, new)]
    with pytest.raises(emulated_cupy.Fault, match=rf"{kernel}: line \d+: not all threads of block 0 come here"):
        meshorder.compare_on_gpu(small, [])


def test_a_colour_with_a_shared_vertex_is_found(cupy, small, monkeypatch):
    def merged(cells, *, vertices):
        found = meshorder.colours(cells, vertices=vertices)
        return found._replace(starts=np.delete(found.starts, 1))

    monkeypatch.setattr(gpu_kernels, "colours", merged)
    with pytest.raises(InternalError, match="distances is wrong"):
        meshorder.compare_on_gpu(small, [])


def test_flat_elements_have_no_forces(cupy, small):
    points, cells = small
    points = np.concatenate([points, points[cells[0, :1]], points[cells[0]].mean(axis=0, keepdims=True)])
    none = [cells[0, 0], cells[0, 1], cells[0, 2], len(points) - 2]  # two of its vertices are at one place
    found = meshorder.compare_on_gpu((points, np.vstack([cells, none])), ["hilbert+corners"])
    assert max(time.error for order in found.orders for time in order.times.values()) < 1e-6


def test_surfaces_have_products_and_springs_only(cupy, flat):
    found = meshorder.compare_on_gpu(flat)
    assert list(found.kernels) == [name for name in KERNELS if not name.startswith("forces")]
    assert not any(order.sorts_corners for order in found.orders)


def test_matrices_have_products_only(cupy, tmp_path):
    entries = "".join(f"{i} {i - 1} 1\n" for i in range(2, 41))
    (tmp_path / "a.mtx").write_text(f"%%MatrixMarket matrix coordinate real symmetric\n40 40 39\n{entries}")
    found = meshorder.compare_on_gpu(tmp_path / "a.mtx")
    assert list(found.kernels) == ["product_rows", "product_lanes"] and found.file == str(tmp_path / "a.mtx")
    assert "hilbert" not in [order.name for order in found.orders]


def test_faulty_requests(cupy, small):
    with pytest.raises(meshorder.InvalidArgument, match="unknown vertex order 'rcn'"):
        meshorder.compare_on_gpu(small, ["rcn"])
    with pytest.raises(meshorder.InvalidArgument, match="it has no vertices"):
        meshorder.compare_on_gpu((np.zeros((0, 3)), np.zeros((0, 4), int)))
    with pytest.raises(TypeError, match="unexpected keyword argument 'budget'"):
        meshorder.compare_on_gpu(small, budget=3)


def no_device(cupy):
    cupy.devices = 0


def little_memory(cupy):
    cupy.memory = 1000


def faulty_source(cupy):
    cupy.patches = [("const int row = thread_number() / 8;", "const int row = nothing;")]


@pytest.mark.parametrize("change, words", [
    (no_device, "CuPy finds no GPU: cudaErrorNoDevice: no CUDA-capable device is detected; see what nvidia-smi reports"),
    (little_memory, "the memory of emulator is too small for this mesh in so many orders; name fewer"),
    (faulty_source, "NVRTC cannot compile the kernels: "),
])  # fmt: skip
def test_what_is_missing_is_named_in_one_line(cupy, small, change, words):
    change(cupy)
    with pytest.raises(Unavailable, match=f"^compare on a GPU: {words}[^\n]*$"):
        meshorder.compare_on_gpu(small)


def test_cupy_is_named_where_it_is_missing_or_broken(small, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "cupy", None)
    with pytest.raises(Unavailable, match="CuPy is not installed; pip install 'cupy-cuda12x"):
        meshorder.compare_on_gpu(small)
    monkeypatch.delitem(sys.modules, "cupy")
    (tmp_path / "cupy.py").write_text("raise ImportError('\\nlibnvrtc.so.12: cannot open shared object file\\nmore')")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(Unavailable, match="CuPy cannot be imported: libnvrtc.so.12: cannot open shared object file$"):
        meshorder.compare_on_gpu(small)


@pytest.fixture
def run(cupy, monkeypatch, capfd):
    def command(*arguments):
        monkeypatch.setattr(sys, "argv", ["meshorder", *map(str, arguments)])
        status = _command.main()
        return status, *capfd.readouterr()

    return command


@pytest.fixture
def path(small, tmp_path):
    meshorder.write(meshorder.make_mesh(*small), tmp_path / "a mesh.vtu")
    return tmp_path / "a mesh.vtu"


def test_the_command_prints_a_verdict_and_a_table(run, path):
    status, out, err = run("compare", "--gpu", path, "--methods", "rcm,hilbert+corners")
    lines = out.splitlines()
    assert (status, err) == (0, "")
    assert lines[0].startswith(("Keep the file's order", "Sort by `meshorder order '"))
    assert lines[1].startswith("Layouts in that order, against packed: element forces apart ")
    assert lines[3] == "emulator: how many times faster than in the file's order, the best marked by *"
    assert lines[4].split() == ["product", "element", "forces", "springs"]
    assert [line.split()[0] for line in lines[5:]] == ["order", "original,", "rcm", "hilbert+corners"]
    assert max(map(len, lines[2:])) <= 100 and out.count("*") >= len(KERNELS)


def test_the_command_prints_json(run, path):
    status, out, err = run("compare", path, "--gpu", "--json", "--methods=rcm", "-q", "--threads", "1")
    result = json.loads(out)
    assert (status, err) == (0, "") and result["file"] == str(path) and result["version"] == meshorder.__version__
    assert result["gpu"] == "emulator" and list(result["kernels"]) == KERNELS and result["notes"] == []
    assert [order["name"] for order in result["orders"]] == ["original", "rcm"]
    assert set(result["orders"][1]["times"]["distances"]) == {"milliseconds", "ratio", "low", "high", "error"}
    assert run("compare", path, "--gpu", "-q", "--methods", "original") == (0, "", "")


@pytest.mark.parametrize("words, says", [
    (["--details"], "--details is not possible with --gpu; only --methods, --threads, --json and --quiet are"),
    (["--methods"], "--methods: the value is empty; see meshorder compare --help"),
    (["--methods", "lexmax"], "unknown vertex order 'lexmax'"),
    (["--threads", "two"], "--threads: expected a whole number, not 'two'; see meshorder compare --help"),
    (["other.vtu"], "unexpected argument 'other.vtu'; see meshorder compare --help"),
])  # fmt: skip
def test_the_command_refuses_in_one_line(run, path, words, says):
    status, out, err = run("compare", "--gpu", path, *words)
    assert (status, out) == (2, "") and err.startswith(f"meshorder: {says}") and err.count("\n") == 1
    status, out, err = run("compare", "--gpu", "none.vtu")
    assert (status, out) == (2, "") and err.startswith("meshorder: none.vtu: ") and err.count("\n") == 1


def comparison(**ratios):
    """A comparison of invented times; for each order the ratios of two products, of packed and of padded additions."""
    kernels = {"product_rows": ("product", "rows"), "product_lanes": ("product", "8 lanes"),
               "forces_packed": ("element forces", "packed"), "forces_padded": ("element forces", "padded")}  # fmt: skip
    orders = []
    for name, of_kernels in {"original": (1, 1, 1, 1), **ratios}.items():
        method = name.removesuffix("_corners")
        times = {
            kernel: GpuTime(milliseconds / ratio, Speedup(ratio, 0.99 * ratio, 1.01 * ratio), 1e-7)
            for kernel, milliseconds, ratio in zip(kernels, (2, 4, 6, 3), of_kernels)
        }
        mean = Speedup(*np.exp(np.mean(np.log([time.speedup for time in times.values()]), axis=0)))
        orders.append(GpuOrder(name, method, "lexmax", name == "rcm", name != method, 0.1, times, mean))
    return GpuComparison("H100", kernels, orders, best_of(orders), "a b.vtu.gz", [])


def test_the_verdict_names_the_order_and_its_gains():
    found = comparison(rcm=(1.5, 1.5, 1.25, 2), rcm_corners=(3, 3, 3, 3), hilbert=(1.5, 1.5, 1.25, 1.9))
    assert found.verdict().splitlines() == [
        "Sort by `meshorder order 'a b.vtu.gz' -o 'ordered-a b.vtu' --for gpu`: product 1.50×, element forces 1.25–2.00×.",
        "Layouts in that order, against packed: element forces padded 3.2×.",
    ]
    assert str(found).splitlines()[3:] == [
        "H100: how many times faster than in the file's order, the best marked by *",
        "             product       element forces",
        "order         rows 8 lanes packed padded",
        "original, ms    2       4      6      3",
        "rcm (auto)   1.50    1.50   1.25   2.00",
        "rcm_corners  3.00*   3.00*  3.00*  3.00*",
        "hilbert      1.50    1.50   1.25   1.90",
    ]
    assert all(tag in found._repr_html_() for tag in ("<code>meshorder order", "<table>", "element forces padded"))


@pytest.mark.parametrize("ratios, best", [
    ({"rcm": (1.5, 1.5, 1.2, 1.3), "hilbert": (1.51, 1.51, 1.21, 1.31)}, "rcm"),  # auto is hardly slower
    ({"rcm": (1.5, 1.5, 1.2, 1.3), "hilbert": (1.6, 1.6, 1.3, 1.4)}, "hilbert"),
    ({"rcm": (1.03, 1.03, 1.02, 1.03), "hilbert": (0.5, 0.5, 0.5, 0.5)}, "original"),  # the interval begins at 1.02
    ({"rcm": (0.9, 0.9, 0.9, 0.9), "rcm_corners": (2, 2, 2, 2)}, "original"),  # `meshorder order` sorts no corners
    ({}, "original"),
])  # fmt: skip
def test_the_order_to_take(ratios, best):
    found = comparison(**ratios)
    assert found.best.name == best
    assert found.verdict().startswith("Keep the file's order: " if best == "original" else "Sort by `meshorder order ")
    assert found.as_dict()["best"] == best
    assert ("--vertices hilbert --elements lexmax" in found.verdict()) == (best == "hilbert")


def test_a_speedup_is_the_median_and_its_interval_holds_it():
    assert Speedup.of(np.arange(15.0)[::-1]) == (7, 3, 11)
    random = np.random.default_rng(1)
    held = sum(s.low <= 1 <= s.high for s in (Speedup.of(np.exp(random.normal(size=15))) for _ in range(4000)))
    assert 0.95 < held / 4000 < 0.98

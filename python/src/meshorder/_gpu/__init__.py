# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Runs kernels of simulations on a graphics processor, to compare orders and layouts of a mesh there."""

from .comparison import GpuComparison, GpuOrder, GpuTime, compare_on_gpu


__all__ = ["GpuComparison", "GpuOrder", "GpuTime", "compare_on_gpu"]

# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""−Δu + u = 1 by linear tetrahedra in SfePy: sfepy_poisson.py MESH"""
import sys
import time

import numpy
from sfepy.base.base import output
from sfepy.discrete import Equation, Equations, FieldVariable, Integral, Material, Problem
from sfepy.discrete.fem import FEDomain, Field, Mesh
from sfepy.terms import Term
from solve import conjugate_gradients, report

output.set_output(quiet=True)
domain = FEDomain("domain", Mesh.from_file(sys.argv[1]))
omega = domain.create_region("Omega", "all")
begin = time.process_time()
field = Field.from_args("u", numpy.float64, "scalar", omega, approx_order=1)
u = FieldVariable("u", "unknown", field)
v = FieldVariable("v", "test", field, primary_var_name="u")
integral = Integral("i", order=2)
load = Material("load", val=1.0)
terms = [Term.new(name, integral, omega, **arguments) for name, arguments in (
    ("dw_laplace(v, u)", {"v": v, "u": u}), ("dw_dot(v, u)", {"v": v, "u": u}),
    ("dw_volume_lvf(load.val, v)", {"load": load, "v": v}))]
problem = Problem("poisson", equations=Equations([Equation("balance", terms[0] + terms[1] - terms[2])]))
problem.time_update()
state = problem.get_initial_state() if hasattr(problem, "get_initial_state") else problem.create_state()
problem.update_materials()
evaluator = problem.get_evaluator()
vector = state() if callable(state) else state.get_state()
matrix = evaluator.eval_tangent_matrix(vector, is_full=True)
right = -evaluator.eval_residual(vector, is_full=True)
x, iterations = conjugate_gradients(matrix.tocsr(), right)
report(time.process_time() - begin, right @ x, iterations)

# SPDX-License-Identifier: Apache-2.0
"""Run by dolfinx_test.py on several ranks: reads a mesh with its tags and prints, on rank 0, the number of ranks that have
tets, of tets, their volume, and the area of the triangles with a tag.

usage: mpirun -n N dolfinx_ranks.py MESH.xdmf TAG
"""
import logging
import os
import pathlib
import sys

os.environ.setdefault("OMP_NUM_THREADS", "1")

import dolfinx
import numpy as np
import ufl
from dolfinx import fem, io
from mpi4py import MPI

logging.disable(logging.INFO)  # otherwise every compiled form is logged
path, tag = pathlib.Path(sys.argv[1]), int(sys.argv[2])
world = MPI.COMM_WORLD
with io.XDMFFile(world, str(path), "r") as file:
    mesh = file.read_mesh(name="mesh")
    materials = file.read_meshtags(mesh, name="mesh")
mesh.topology.create_connectivity(2, 3)
with io.XDMFFile(world, str(path.with_name(path.stem + "_facets.xdmf")), "r") as file:
    facets = file.read_meshtags(mesh, name="facet_tags")


def total(measure):
    compiled = fem.form(fem.Constant(mesh, np.float64(1)) * measure, jit_params={"cffi_extra_compile_args": ["-O0", "-g0"]})
    return world.allreduce(fem.assemble_scalar(compiled), MPI.SUM)


volume = total(ufl.Measure("dx", domain=mesh, subdomain_data=materials))
area = total(ufl.Measure("ds", domain=mesh, subdomain_data=facets)(tag))
tets = mesh.topology.index_map(3).size_local
busy = world.allreduce(int(tets > 0), MPI.SUM)
if world.rank == 0:
    print(dolfinx.__version__, busy, mesh.topology.index_map(3).size_global, volume, area)

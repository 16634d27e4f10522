# SPDX-License-Identifier: Apache-2.0
"""Runs dolfinx on tetwright's meshes, with their named materials and surfaces, and compares with closed-form solutions.

usage: dolfinx_test.py TETWRIGHT [--quick]    (Debian's python3-dolfinx; status 77, with the reason, where it is missing;
                                               --quick: the coarser meshes)

Heat in a ball of two conductivities, a cantilever with a load on its tip, and a thick sphere under internal pressure,
each on meshes of two sizes; the errors must decrease at the rates of the elements.
"""
import argparse
import logging
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

SKIPPED = 77  # CTest's status of a skipped test
try:
    # Threads of the linear algebra would only slow each other down on such small meshes.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    import dolfinx
    import numpy as np
    import ufl
    from dolfinx import fem, io
    from dolfinx.fem.petsc import LinearProblem
    from mpi4py import MPI
    from petsc4py import PETSc
except ImportError as reason:
    print(f"skipped: dolfinx is not installed ({reason})")
    sys.exit(SKIPPED)

from surfaces import beam, spheres

DIRECT = {"ksp_type": "preonly", "pc_type": "lu", "pc_factor_mat_solver_type": "mumps"}
# Tolerance of the residual; discretisation errors are larger by many orders of magnitude.
ITERATIVE = {"ksp_type": "cg", "pc_type": "jacobi", "ksp_rtol": 1e-10, "ksp_error_if_not_converged": True}
# Compilation takes longer than these small problems; without optimisation it takes half as long.
COMPILED = {"cffi_extra_compile_args": ["-O0", "-g0"]}
# Exact for squares of elements of order 2; the degree estimated for a closed form would exhaust memory.
QUADRATURE = {"quadrature_degree": 4}
# Relative to the edge of the regular tet with the mean volume.
LONGEST_EDGE = 1.6
failures = []


def check(what, good):
    print(("ok      " if good else "FAILED  ") + what)
    if not good:
        failures.append(what)


class Body:
    """A mesh with tags of its tets and of the triangles on its surfaces, and the tags by name."""

    def __init__(self, path):
        facets = path.with_name(path.stem + "_facets.xdmf")
        with io.XDMFFile(MPI.COMM_SELF, str(path), "r") as file:
            self.mesh = file.read_mesh(name="mesh")
            self.materials = file.read_meshtags(self.mesh, name="mesh")
        self.mesh.topology.create_connectivity(2, 3)
        with io.XDMFFile(MPI.COMM_SELF, str(facets), "r") as file:
            self.facets = file.read_meshtags(self.mesh, name="facet_tags")
        self.material_numbers, self.surface_numbers = names_of(path), names_of(facets)
        self.tets = self.mesh.topology.index_map(3).size_local
        self.place = ufl.SpatialCoordinate(self.mesh)
        self.everywhere = ufl.Measure("dx", domain=self.mesh, subdomain_data=self.materials, metadata=QUADRATURE)

    def inside(self, material):
        return self.everywhere(self.material_numbers[material])

    def on(self, surface):
        return ufl.Measure("ds", domain=self.mesh, subdomain_data=self.facets)(self.surface_numbers[surface])

    def unknowns_on(self, surface, space):
        return fem.locate_dofs_topological(space, 2, self.facets.find(self.surface_numbers[surface]))


def names_of(path):
    """Returns the numbers of names in a file, from the document in an Information element as written by meshio."""
    numbers = {}
    for information in xml.etree.ElementTree.parse(path).iter("Information"):
        for entry in xml.etree.ElementTree.fromstring(information.text):
            numbers[entry.get("key")] = int(entry.text)
    return numbers


def prepare(name, tets, volume, surface, *more):
    """Returns a mesh of tets of nearly uniform size, so that errors decrease with the size."""
    out = surface.with_name(f"{name}_{tets}.xdmf")
    regular_edge = (6 * math.sqrt(2) * volume / tets) ** (1 / 3)
    call = [options.tetwright, "prepare", surface, "-o", out, "--target-tets", str(tets), "--max-edge",
            repr(LONGEST_EDGE * regular_edge), "--quiet", "--no-progress", *more]
    answer = subprocess.run(call, check=False, capture_output=True, text=True)
    # 1: a request was not met; the errors show the mesh's quality.
    if answer.returncode not in (0, 1):
        sys.exit(f"tetwright: {answer.stderr}")
    return Body(out)


def square(vector):
    return ufl.inner(vector, vector)


def integral(integrand):
    return fem.assemble_scalar(fem.form(integrand, jit_params=COMPILED))


def linear_problem(matrix, right_side, conditions, solver):
    return LinearProblem(matrix, right_side, bcs=conditions, petsc_options=solver, jit_params=COMPILED)


def rate(counts, errors):
    """Returns the order of convergence in the edge length, from the first mesh to the last."""
    return math.log(errors[0] / errors[-1]) / math.log((counts[-1] / counts[0]) ** (1 / 3))


def check_rates(what, counts, errors, energy_errors):
    """Checks the rates of linear elements: second order for values, first order for gradients."""
    for kind, found, wanted, slack in (("values", errors, 2, 0.5), ("slopes", energy_errors, 1, 0.2)):
        power = rate(counts, found)
        check(f"{what}: errors of {kind} fall at a rate of {power:.2f}, about {wanted}", abs(power - wanted) < slack)


def ball_of_two_conductivities(folder, sizes):
    """Solves for heat in a core and a shell with the same source, and 0 on the outside."""
    outer, inner, shell, core, source = 1.0, 0.5, 1.0, 5.0, 6.0
    shell_surface, core_surface = spheres(folder / "shell.obj", outer, parts=60), spheres(folder / "core.obj", inner, parts=60)
    counts, errors, energy_errors = [], [], []
    for tets in sizes:
        body = prepare("ball", tets, 4 / 3 * math.pi * outer**3, shell_surface, "--material", f"core={core_surface}")
        in_shell, in_core = body.inside("shell"), body.inside("core")
        # The heat produced in a sphere flows through it, source r / 3 per unit area.
        in_shell_exact = source / (6 * shell) * (outer**2 - square(body.place))
        in_core_exact = source / (6 * shell) * (outer**2 - inner**2) + source / (6 * core) * (inner**2 - square(body.place))
        space = fem.FunctionSpace(body.mesh, ("Lagrange", 1))
        u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
        slopes = ufl.inner(ufl.grad(u), ufl.grad(v))
        cold = fem.dirichletbc(PETSc.ScalarType(0), body.unknowns_on("shell|outside", space), space)
        heat = linear_problem(shell * slopes * in_shell + core * slopes * in_core, source * v * body.everywhere, [cold],
                              DIRECT).solve()
        squares = integral((heat - in_shell_exact) ** 2 * in_shell + (heat - in_core_exact) ** 2 * in_core)
        energy = integral(shell * square(ufl.grad(heat - in_shell_exact)) * in_shell
                          + core * square(ufl.grad(heat - in_core_exact)) * in_core)
        counts.append(body.tets)
        errors.append(math.sqrt(squares / integral(in_shell_exact**2 * in_shell + in_core_exact**2 * in_core)))
        energy_errors.append(math.sqrt(energy / integral(shell * square(ufl.grad(in_shell_exact)) * in_shell
                                                         + core * square(ufl.grad(in_core_exact)) * in_core)))
        print(f"ball of two conductivities, {body.tets} tets: temperatures within {100 * errors[-1]:.3f} %, slopes within "
              f"{100 * energy_errors[-1]:.2f} %")
    check_rates("ball of two conductivities", counts, errors, energy_errors)


def strain(u):
    return ufl.sym(ufl.grad(u))


def stress(u, young, poisson):
    shear = young / (2 * (1 + poisson))
    lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    return 2 * shear * strain(u) + lame * ufl.tr(strain(u)) * ufl.Identity(3)


def cantilever(folder, sizes):
    """Solves for a force on the tip, which bends and shears the beam."""
    length, side, young, force = 10.0, 1.0, 1000.0, 1.0
    inertia, area, shear = side**4 / 12, side**2, young / 2  # Poisson's ratio 0, so that the root can be clamped
    # Timoshenko, with the coefficient 5/6 of a square.
    sag = force * length**3 / (3 * young * inertia) + force * length / (5 / 6 * shear * area)
    surface = beam(folder / "beam.obj", length, side)
    errors = {1: [], 2: []}
    counts = []
    for tets in sizes:
        body = prepare("beam", tets, area * length, surface)
        counts.append(body.tets)
        check(f"cantilever, {body.tets} tets: the tip has its area", abs(integral(1.0 * body.on("tip")) / area - 1) < 1e-9)
        for order, found in errors.items():
            space = fem.VectorFunctionSpace(body.mesh, ("Lagrange", order))
            u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
            clamped = fem.dirichletbc(np.zeros(3, dtype=PETSc.ScalarType), body.unknowns_on("root", space), space)
            bent = linear_problem(ufl.inner(stress(u, young, 0), strain(v)) * body.everywhere,
                                  -force / area * v[2] * body.on("tip"), [clamped], DIRECT).solve()
            reached = -integral(bent[2] * body.on("tip")) / area
            found.append(abs(reached / sag - 1))
            print(f"cantilever, elements of order {order}, {body.tets} tets: sag {reached:.5g} of {sag:.5g} "
                  f"({100 * (reached / sag - 1):+.2f} %)")
    check("cantilever: elements of order 2 are within 1 % of the closed form", max(errors[2]) < 0.01)
    check(f"cantilever: linear elements converge, at a rate of {rate(counts, errors[1]):.2f}", rate(counts, errors[1]) > 1)


def rigid_motions(space):
    """Returns the six rigid motions as vectors of the space's unknowns, one column each."""
    places = space.tabulate_dof_coordinates()
    columns = [np.tile(np.eye(3)[axis], (len(places), 1)) for axis in range(3)]
    columns += [np.cross(np.eye(3)[axis], places) for axis in range(3)]
    return np.linalg.qr(np.array([c.ravel() for c in columns]).T)[0]


def without_rigid_motions(problem, motions):
    """Returns the solution of a problem without supports, free of rigid motions."""
    vectors = []
    for column in motions.T:
        vector = problem.A.createVecLeft()
        vector.setArray(column)
        vectors.append(vector)
    problem.A.setNullSpace(PETSc.NullSpace().create(vectors=vectors))
    return problem.solve()


def pressurised_sphere(folder, sizes):
    inner, outer, young, poisson, pressure = 1.0, 2.0, 1000.0, 0.3, 10.0
    surface = spheres(folder / "thick.obj", outer, inner, parts=60)
    counts, errors, energy_errors = [], [], []
    for tets in sizes:
        body = prepare("thick", tets, 4 / 3 * math.pi * (outer**3 - inner**3), surface)
        # Lame (Timoshenko & Goodier, Theory of Elasticity, section 142).
        scale = pressure * inner**3 / (young * (outer**3 - inner**3))
        radial = lambda r: scale * ((1 - 2 * poisson) + (1 + poisson) * outer**3 / (2 * r**3))
        exact = body.place * radial(ufl.sqrt(square(body.place)))
        space = fem.VectorFunctionSpace(body.mesh, ("Lagrange", 1))
        u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
        energy = lambda a, b: ufl.inner(stress(a, young, poisson), strain(b)) * body.everywhere
        motions = rigid_motions(space)
        solution = without_rigid_motions(
            linear_problem(energy(u, v), -pressure * ufl.inner(ufl.FacetNormal(body.mesh), v) * body.on("inner"), [],
                           ITERATIVE), motions)
        places = space.tabulate_dof_coordinates()
        wanted = (places * radial(np.linalg.norm(places, axis=1))[:, None]).ravel()
        difference = solution.x.array - wanted
        difference = difference - motions @ (motions.T @ difference)
        counts.append(body.tets)
        errors.append(np.linalg.norm(difference) / np.linalg.norm(wanted))
        energy_errors.append(math.sqrt(integral(energy(solution - exact, solution - exact)) / integral(energy(exact, exact))))
        print(f"pressurised sphere, {body.tets} tets: displacements within {100 * errors[-1]:.2f} % (rms), strains within "
              f"{100 * energy_errors[-1]:.2f} %")
    check_rates("pressurised sphere", counts, errors, energy_errors)


def parts_on_two_ranks(folder):
    """Reads a mesh in two parts on two ranks, each of which gets tets."""
    length, side, parts = 4.0, 1.0, 2
    out = folder / "parts.xdmf"
    call = [options.tetwright, "prepare", beam(folder / "parts.obj", length, side), "-o", out, "--target-tets", "600", "--parts",
            str(parts), "--quiet", "--no-progress"]
    answer = subprocess.run(call, check=False, capture_output=True, text=True)
    if answer.returncode not in (0, 1):
        sys.exit(f"tetwright: {answer.stderr}")
    tets = Body(out).tets
    tag = names_of(out.with_name("parts_facets.xdmf"))["tip"]
    # MPI, which this process has started, would take these for its own ranks.
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("OMPI_", "PMIX_", "OPAL_"))}
    ranks = subprocess.run(["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(parts), sys.executable,
                            pathlib.Path(__file__).with_name("dolfinx_ranks.py"), out, str(tag)],
                           check=False, capture_output=True, text=True, env=environment)
    if ranks.returncode != 0:
        sys.exit(f"mpirun: {ranks.stderr}")
    _, busy, found, volume, area = ranks.stdout.split()
    check(f"parts: {busy} of {parts} ranks have tets", int(busy) == parts)
    check(f"parts: {found} tets of {tets} on all ranks", int(found) == tets)
    check("parts: the volume and the area of the tip", abs(float(volume) / (side**2 * length) - 1) < 1e-9
          and abs(float(area) / side**2 - 1) < 1e-9)


logging.disable(logging.INFO)  # otherwise every compiled form is logged
parser = argparse.ArgumentParser()
parser.add_argument("tetwright", type=pathlib.Path)
parser.add_argument("--quick", action="store_true")
options = parser.parse_args()
options.tetwright = options.tetwright.resolve()
print(f"dolfinx {dolfinx.__version__}")
with tempfile.TemporaryDirectory(prefix="tetwright-dolfinx-") as name:
    scratch = pathlib.Path(name)
    ball_of_two_conductivities(scratch, (1000, 8000) if options.quick else (1000, 8000, 64000))
    cantilever(scratch, (600, 4000) if options.quick else (600, 4000, 30000))
    pressurised_sphere(scratch, (2000, 12000) if options.quick else (2000, 12000, 72000))
    parts_on_two_ranks(scratch)
sys.exit(1 if failures else 0)

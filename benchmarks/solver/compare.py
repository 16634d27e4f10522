# SPDX-License-Identifier: Apache-2.0
"""Meshes the same bodies with Tetwright, Gmsh, TetGen and Netgen and compares how well the meshes suit a solver.

usage: compare.py [--help]    (Debian's python3; gmsh, tetgen and python3-netgen if they are installed)

Tetwright meshes a scan to a target number of tets, once by default and once with a bound on edge lengths that makes
all tets about the same size. The others fill the boundary of each of these meshes with the same number of tets, within
a few percent: they keep the triangles of their input surface, and a scan has far too many for such a number. All meshes
thus have the same surface of well-shaped triangles and differ only inside.
"""
import argparse
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from off_surface import read_off, write_stl

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PYTHON = "/usr/bin/python3"  # another Python on the path may not have Debian's modules
COUNT_TOLERANCE = 0.02
MOST_TRIALS = 10
SECONDS_FOR_A_MESH = 600
# Maximum edge length, relative to the edge of the regular tet with the mean volume: well-shaped tets of about equal
# size have edges up to this; a much shorter bound leads to more tets than the target.
LONGEST_EDGE = 1.6
SCANS = {"bunny": "scans/bunny_pmp.off", "armadillo": "scans/armadillo_libigl.obj", "dragon": "scans/dragon_quartet.obj"}
SAMPLES = ("knot", "sphere", "torus", "cube")


def run(*command, folder=None):
    """Returns the standard output of a program; prints a line on stderr and returns None if it failed or took too
    long."""
    command = [str(c) for c in command]
    try:
        answer = subprocess.run(command, cwd=folder, check=False, capture_output=True, text=True, errors="replace",
                                timeout=SECONDS_FOR_A_MESH)
    except subprocess.TimeoutExpired:
        print(f"{command[0]}: more than {SECONDS_FOR_A_MESH} s", file=sys.stderr)
        return None
    # Status 1: tetwright's mesh does not meet a request. A mesh that exists is judged by its measures.
    if answer.returncode not in (0, 1):
        print(f"{command[0]}: status {answer.returncode}: {(answer.stderr or answer.stdout)[-300:]}", file=sys.stderr)
        return None
    return answer.stdout


class Gmsh:
    """Delaunay with Gmsh's own optimisation; the parameter is the edge length inside."""
    name, first, power = "Gmsh", None, -3

    @staticmethod
    def missing():
        return None if shutil.which("gmsh") else "gmsh is not installed"

    @staticmethod
    def version():
        return subprocess.run(["gmsh", "--version"], check=True, capture_output=True, text=True).stderr.strip()

    def begin(self, surface, target, folder):
        pass

    @staticmethod
    def mesh(surface, size, out):
        script = out.with_suffix(".geo")
        script.write_text(f'Merge "{surface.with_suffix(".stl")}";\nSurface Loop(1) = {{1}};\nVolume(1) = {{1}};\n'
                          "Mesh.MeshSizeExtendFromBoundary = 0;\n"
                          f"Mesh.MeshSizeMax = {size!r};\nMesh.MshFileVersion = 2.2;\nMesh.SaveAll = 1;\n"
                          "Mesh.Optimize = 1;\nMesh.OptimizeThreshold = 1;\n")
        file = out.with_suffix(".msh")
        run("gmsh", "-3", script, "-o", file)
        if not file.exists():
            return None, 0
        elements = file.read_text().split("$Elements")[1].splitlines()
        return file, sum(line.split(maxsplit=2)[1:2] == ["4"] for line in elements)


class TetGen:
    """Quality Delaunay that keeps the surface; the parameter is the maximum volume.

    Uses the strictest bound on shapes (ratio of circumradius to shortest edge / dihedral angle) that by itself does not
    lead to more tets than the target.
    """
    name, first, power = "TetGen", None, -1
    BOUNDS = ("1.2/10", "1.3/5", "1.414", "2", "3", "5")

    @staticmethod
    def missing():
        return None if shutil.which("tetgen") else "tetgen is not installed"

    @staticmethod
    def version():
        answer = subprocess.run(["dpkg-query", "-W", "-f=${Version}", "tetgen"], check=False, capture_output=True, text=True)
        return answer.stdout.split("-")[0]

    def __init__(self):
        self.bounds = self.BOUNDS[0]

    def begin(self, surface, target, folder):
        for self.bounds in self.BOUNDS:
            file, count = self.mesh(surface, None, folder / "tetgen_bounds")
            if file and count <= target:
                break

    def mesh(self, surface, volume, out):
        copy = out.with_suffix(".off")
        shutil.copy(surface, copy)
        text = run("tetgen", f"-pYq{self.bounds}" + (f"a{volume:.17g}" if volume else ""), copy)
        count = re.search(r"Mesh tetrahedra: (\d+)", text or "")
        return (copy.with_suffix(".1.ele"), int(count[1])) if count else (None, 0)


class Netgen:
    """Advancing front and Delaunay with Netgen's optimisation; the parameter is the grading."""
    name, first, power = "Netgen", 0.5, -0.5

    @staticmethod
    def missing():
        answer = subprocess.run([PYTHON, "-c", "import netgen"], check=False, capture_output=True)
        return None if answer.returncode == 0 else "python3-netgen is not installed"

    @staticmethod
    def version():
        answer = subprocess.run(["dpkg-query", "-W", "-f=${Version}", "netgen"], check=False, capture_output=True, text=True)
        return answer.stdout.split("+dfsg")[0]

    def begin(self, surface, target, folder):
        pass

    @staticmethod
    def mesh(surface, grading, out):
        file = out.with_suffix(".msh")
        text = run(PYTHON, HERE / "netgen_mesh.py", surface, repr(grading), file)
        count = re.search(r"^tets (\d+)", text or "", re.M)
        return (file, int(count[1])) if count else (None, 0)


def search(program, surface, target, first, folder):
    """Meshes with different parameters until the number of tets is reached; returns the file with the nearest number.

    If two trials enclose the target, the next parameter lies on the straight line through the logarithms of both,
    shifted towards the middle; otherwise it follows from the power law between parameter and number.
    """
    program.begin(surface, target, folder)
    below = above = best = None  # (parameter, count) on either side of the target; (miss, file, count)
    parameter = first
    for trial in range(MOST_TRIALS):
        file, count = program.mesh(surface, parameter, folder / f"{program.name.lower()}_{trial}")
        if file is None:
            break
        miss = abs(count / target - 1)
        if best is None or miss < best[0]:
            best = (miss, file, count)
        if miss <= COUNT_TOLERANCE:
            break
        if count < target:
            below = (parameter, count)
        else:
            above = (parameter, count)
        if below and above:
            share = (math.log(target) - math.log(below[1])) / (math.log(above[1]) - math.log(below[1]))
            share = 0.5 * share + 0.25
            parameter = math.exp((1 - share) * math.log(below[0]) + share * math.log(above[0]))
        else:
            parameter *= max(0.5, min(2.0, (target / count) ** (1 / program.power)))
    return best[1] if best else None


def regular_edge(volume):
    return (6 * math.sqrt(2) * volume) ** (1 / 3)


def prepare(surface, target, options, folder, *more):
    """Returns Tetwright's mesh, its number of tets and its volume; writes its boundary to surface.off and
    surface.stl."""
    folder.mkdir(parents=True, exist_ok=True)
    mesh, stats, skin = folder / "tetwright.vtu", folder / "tetwright.json", folder / "surface.off"
    run(options.bin / "tetwright", "prepare", surface, "-o", mesh, "--target-tets", target, "--boundary", skin,
        "--stats", stats, "--quiet", "--no-progress", *more)
    if not mesh.exists():
        sys.exit(f"tetwright made no mesh of {surface}")
    write_stl(*read_off(skin), skin.with_suffix(".stl"))
    result = json.loads(stats.read_text())["result"]
    return mesh, result["tets"], result["volume"]


def fill(name, mesh, count, volume, programs):
    """Returns the meshes of the surface, including Tetwright's, by the name of their program."""
    meshes = {"Tetwright": mesh}
    for program in programs:
        first = {"Gmsh": regular_edge(volume / count), "TetGen": 2 * volume / count}.get(program.name, program.first)
        file = search(program, mesh.with_name("surface.off"), count, first, mesh.parent)
        if file is None:
            print(f"{program.name} made no mesh of {name}", file=sys.stderr)
        else:
            meshes[program.name] = file
    return meshes


def measure(name, surface, meshes, options):
    """Prints the solver program's measures of the meshes as a table and returns them by program."""
    report = meshes["Tetwright"].with_name("measured.json")
    run(options.bin / "solver", *meshes.values(), "--surface", surface, "--json", report)
    rows = dict(zip(meshes, json.loads(report.read_text())))
    print_table(name, rows)
    return rows


def print_table(name, rows):
    own = rows["Tetwright"]
    print(f"\n{name}: {own['boundary_triangles']:,} triangles, {own['from_surface_percent']:.3f} % of the diagonal from the "
          "given surface (rms)\n\n| program | tets | nodes | sr, smallest / mean | dihedrals | CG heat / elasticity | "
          "time step | eigenvalue heat / elasticity | error L2 / energy, % |\n" + "| --- " * 9 + "|")
    for program, r in rows.items():
        if "error" in r:
            print(f"| {program} | {r['error']} |" + " |" * 7)
            continue
        print(f"| {program} | {r['tets']:,} | {r['nodes']:,} | {r['min_solid_angle']:.3f} / {r['mean_solid_angle']:.3f} | "
              f"{r['min_dihedral']:.1f}-{r['max_dihedral']:.1f} | {r['heat_iterations']} / {r['elastic_iterations']} | "
              f"{r['relative_time_step']:.3f} | {r['heat_eigenvalue']:.1f} / {r['elastic_eigenvalue']:.1f} | "
              f"{100 * r['l2_error']:.2f} / {100 * r['energy_error']:.1f} |")
    sys.stdout.flush()


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bodies", default="bunny,knot",
                        help=f"separated by commas; scans: {', '.join(SCANS)}; samples: {', '.join(SAMPLES)}")
    parser.add_argument("--tets", default="20000,60000", help="counts, separated by commas")
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path(os.environ.get("TETWRIGHT_DATA", "../shared/data")),
                        help="folder of the scans (default: TETWRIGHT_DATA, else ../shared/data)")
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/release/bin",
                        help="folder of tetwright and solver (default: build/release/bin)")
    parser.add_argument("--write", type=pathlib.Path, help="keep the meshes in this folder")
    parser.add_argument("--json", type=pathlib.Path, help="write all that was measured to this file")
    return parser.parse_args()


def main():
    options = arguments()
    options.bin = options.bin.resolve()
    programs = []
    for program in (Gmsh(), TetGen(), Netgen()):
        reason = program.missing()
        print(f"{program.name} is skipped: {reason}" if reason else f"{program.name} {program.version()}")
        if not reason:
            programs.append(program)
    everything = []
    with tempfile.TemporaryDirectory(prefix="tetwright-solver-") as scratch:
        folder = (options.write or pathlib.Path(scratch)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        for body in options.bodies.split(","):
            surface = (options.data / SCANS[body]).resolve() if body in SCANS else folder / f"{body}.ply"
            if body in SCANS and not surface.exists():
                print(f"{body} is skipped: there is no {surface}")
                continue
            if body not in SCANS and run(options.bin / "tetwright", "sample", body, "-o", surface) is None:
                continue
            for target in map(int, options.tets.split(",")):
                own = folder / f"{body}_{target}"
                mesh, count, volume = prepare(surface, target, options, own)
                name = f"{body}, {target:,} tets"
                meshes = fill(name, mesh, count, volume, programs)
                everything.append({"name": name, "programs": measure(name, surface, meshes, options)})

                longest = LONGEST_EDGE * regular_edge(volume / count)
                own = own.with_name(own.name + "_even")
                mesh, count, volume = prepare(surface, target, options, own, "--max-edge", longest)
                name += " of one size"
                meshes = fill(name, mesh, count, volume, programs)
                everything.append({"name": name, "programs": measure(name, surface, meshes, options)})
    if options.json:
        options.json.write_text(json.dumps(everything, indent=1) + "\n")


main()

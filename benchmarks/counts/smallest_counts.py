# SPDX-License-Identifier: Apache-2.0
"""Compares the smallest count that `tetwright prepare` estimates for a body with the one that it really takes.

usage: smallest_counts.py [--help] [NAME...]

A count holds if the mesh has that many tets within 10 % and at most 2 % of them are below 0.1 sr. The smallest such
count is searched from 500 and from the estimate on in steps of a factor of 1.6, then between two such steps until it is known
within 1.3. The result is the range from the largest count that failed to the smallest that held.
"""
import argparse
import functools
import json
import math
import os
import pathlib
import subprocess
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
MAX_POOR_PERCENT = 2
COUNT_TOLERANCE = 0.1
STEP = 1.6
MAX_STEPS = 7
SECONDS_FOR_A_MESH = 200
FEWEST_TETS = 20


def plate(length, thickness, file):
    """A box of two large faces."""
    corners = [(x, y, z) for z in (0, thickness) for y in (0, length) for x in (0, length)]
    faces = ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"]
    file.write_text("".join("v %g %g %g\n" % c for c in corners) + "".join(f"f {f}\n" for f in faces), encoding="ascii")


def volume(size, label, file):
    """Labels of voxels of size 1 as an .nrrd file.

    label(x, y, z) -- the label of a voxel, with the origin in the centre of the volume
    """
    centre = [(n - 1) / 2 for n in size]
    voxels = bytes(label(x - centre[0], y - centre[1], z - centre[2])
                   for z in range(size[2]) for y in range(size[1]) for x in range(size[0]))
    header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: %d %d %d\nencoding: raw\n\n" % tuple(size)
    file.write_bytes(header.encode("ascii") + voxels)


def shell_label(thickness, x, y, z):
    radius = math.hypot(x, y, z)
    return 2 if radius < 22 else 1 if radius < 22 + thickness else 0


def plate_label(thickness, x, y, z):
    return int(max(abs(x), abs(y)) < 20 and abs(z) < thickness / 2)


def blocks_label(x, y, z):
    return 1 + (x > 0) + 2 * (y > 0) + 4 * (z > 0) if max(abs(x), abs(y), abs(z)) < 20 else 0


def layers_label(x, y, z):
    return 1 + int((z + 15) // 10) if max(abs(x), abs(y)) < 20 and abs(z) < 15 else 0


class Inputs:
    """The inputs by name, written or found when they are asked for."""

    def __init__(self, program, data, folder):
        self.program, self.data, self.folder = program, data, folder
        self.by_name = {
            "plate of 10 x 10 x 1": lambda: self.plate(10),
            "plate of 40 x 40 x 1": lambda: self.plate(40),
            "sphere": lambda: [self.sample("sphere", ".ply")],
            "torus": lambda: [self.sample("torus", ".ply")],
            "knot": lambda: [self.sample("knot", ".ply")],
            "sphere, layer of 0.05": lambda: [self.sample("sphere", ".ply"), "--layer", "skin=0.05"],
            "heater (five boxes)": lambda: [self.sample("heater_" + k, ".obj")
                                            for k in ("below", "left", "core", "right", "above")],
            "bunny": lambda: [self.data / "scans/bunny_pmp.off"],
            "hand": lambda: [self.data / "scans/hand_ntut.ply"],
            "armadillo": lambda: [self.data / "scans/armadillo_libigl.obj"],
            "lucy": lambda: [self.data / "scans/lucy_vtkdata.ply"],
            "rotor": lambda: [self.data / "cad/rotor_cgal.off"],
            "joint": lambda: [self.data / "cad/joint_cgal.off"],
            "pinion": lambda: [self.data / "cad/pinion_cgal.off"],
            "shell of 0.1 around a body of 0.9": lambda: [self.sample("sphere", ".obj"), self.scaled_sphere(0.9, 0.9, 0.9)],
            "flat ellipsoid, 1 x 1 x 0.025": lambda: [self.scaled_sphere(1, 1, 0.025)],
            "labels: plate of 40 x 40 x 4": lambda: self.volume("plate4", (48, 48, 20), functools.partial(plate_label, 4)),
            "labels: plate of 40 x 40 x 1": lambda: self.volume("plate1", (48, 48, 19), functools.partial(plate_label, 1)),
            "labels: shell of 1 around a ball of 22": lambda: self.volume("shell1", (52, 52, 52), functools.partial(shell_label, 1)),
            "labels: shell of 2 around a ball of 22": lambda: self.volume("shell2", (54, 54, 54), functools.partial(shell_label, 2)),
            "labels: shell of 3 around a ball of 22": lambda: self.volume("shell3", (56, 56, 56), functools.partial(shell_label, 3)),
            "labels: eight blocks": lambda: self.volume("blocks", (44, 44, 44), blocks_label),
            "labels: three layers": lambda: self.volume("layers", (44, 44, 34), layers_label),
            "organs": lambda: [self.sample("organs", ".nrrd")],
            "organs, labels 1-3,5": lambda: [self.sample("organs", ".nrrd"), "--labels", "1-3,5"],
            "bone, --iso 600": lambda: [self.sample("bone", ".nrrd"), "--iso", "bone=600"],
            "foam": lambda: [self.sample("foam", ".nrrd")],
            "mickey": lambda: [self.data / "volumes/mickey_cleaver.nrrd"],
            "liver": lambda: [self.data / "volumes/liver_cgal.nrrd"],
        }

    def sample(self, name, extension):
        file = self.folder / (name + extension)
        if not file.exists():
            subprocess.run([self.program, "sample", name, "-o", file], check=True)
        return file

    def scaled_sphere(self, *factors):
        lines = self.sample("sphere", ".obj").read_text(encoding="ascii").splitlines()
        file = self.folder / ("sphere_%g_%g_%g.obj" % factors)
        with file.open("w", encoding="ascii") as out:
            for line in lines:
                words = line.split()
                if words and words[0] == "v":
                    line = "v " + " ".join(f"{f * float(x):.17g}" for f, x in zip(factors, words[1:4]))
                out.write(line + "\n")
        return file

    def plate(self, length):
        file = self.folder / f"plate{length}.obj"
        plate(length, 1, file)
        return [file]

    def volume(self, name, size, label):
        file = self.folder / (name + ".nrrd")
        volume(size, label, file)
        return [file]


class Trials:
    """Meshes of one input with several counts."""

    def __init__(self, program, arguments, folder):
        self.program, self.arguments, self.folder = program, arguments, folder
        self.estimate = None
        self.warned = {}

    def holds(self, count):
        """Whether a count holds; None if there is no mesh in time."""
        stats = self.folder / "stats.json"
        command = [self.program, "prepare", *self.arguments, "-o", self.folder / "out.vtu", "--target-tets", count,
                   "--threads", 1, "--stats", stats]
        try:
            answer = subprocess.run([str(c) for c in command], check=False, capture_output=True, text=True,
                                    timeout=SECONDS_FOR_A_MESH)
        except subprocess.TimeoutExpired:
            return None
        if answer.returncode > 1:
            raise RuntimeError(answer.stderr)
        run = json.loads(stats.read_text(encoding="utf-8"))
        self.estimate = sum(m["tets"] for m in run["min_tets"])
        self.warned[count] = "too small for good shapes" in answer.stderr
        result = run["result"]
        return (result["percent_below_threshold"] <= MAX_POOR_PERCENT and
                abs(result["tets"] - count) <= COUNT_TOLERANCE * count)

    def search(self):
        """The largest count that fails and the smallest that holds; None where none was found."""
        failed = held = None
        count = 500
        found = self.holds(count)
        for _ in range(MAX_STEPS):
            if found is None:
                return failed, held
            if found:
                held = count
            else:
                failed = count
            if failed and held:
                break
            beyond = count > STEP * self.estimate if found else count < self.estimate / STEP
            next_count = max(FEWEST_TETS, round(self.estimate if beyond else count / STEP if found else count * STEP))
            if next_count == count:
                break
            count = next_count
            found = self.holds(count)
        while failed and held and held > 1.3 * failed:
            count = round(math.sqrt(failed * held))
            found = self.holds(count)
            if found is None:
                break
            if found:
                held = count
            else:
                failed = count
        return failed, held


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="beginnings of the names of inputs; default: all")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/tetwright")
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path(os.environ.get("TETWRIGHT_DATA", ROOT / "../shared/data")))
    line = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        inputs = Inputs(line.program, line.data, folder)
        print("| input | estimate | fails with | holds with | false warnings |\n| --- | --- | --- | --- | --- |")
        for name, arguments in inputs.by_name.items():
            if line.names and not any(name.startswith(n) for n in line.names):
                continue
            trials = Trials(line.program, arguments(), folder)
            failed, held = trials.search()
            false = [n for n, warned in trials.warned.items() if warned and held and n >= held]
            estimate = "" if trials.estimate is None else f"{trials.estimate:.0f}"
            print(f"| {name} | {estimate} | {failed or ''} | {held or ''} | {false or ''} |", flush=True)


if __name__ == "__main__":
    main()

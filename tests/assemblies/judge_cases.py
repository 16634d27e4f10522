#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Meshes cases that make_inputs.py wrote and has them judged.

usage: judge_cases.py PROGRAM JUDGE_FOLDER FOLDER [CASE...] [--tets N ...] [--threads 2] [--timeout 300]

PROGRAM is `tetwright`, JUDGE_FOLDER holds `judge_assembly.py`, FOLDER the cases; a CASE may be a pattern. Each case is
meshed with each number of tets. A line for each run says: ok or the number of unmet expectations, the exit status, seconds,
tets, percent of tets below 0.1 sr; then each unmet expectation. A run that fails or takes too long is a line like any
other. Status 1 if a run is not ok. Needs Debian's python3 with numpy, scipy and meshio.
"""
import argparse
import fnmatch
import json
import pathlib
import re
import subprocess
import sys
import time

import numpy as np
from scipy.optimize import linear_sum_assignment

PYTHON = "/usr/bin/python3"


def bounded(command, folder, timeout):
    """Runs a command in a folder; returns its exit status, None if it took too long, and its output."""
    process = subprocess.Popen(list(map(str, command)), cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True, errors="replace")
    try:
        out, error = process.communicate(timeout=timeout)
        return process.returncode, out, error
    except subprocess.TimeoutExpired:
        process.kill()
        out, error = process.communicate()
        return None, out, error


def call(program, case, tets, threads, output):
    """Returns the command; the first input is a material by the name of its file."""
    command = [program, "prepare"]
    for k, (name, file) in enumerate(case["inputs"]):
        command += [file] if k == 0 else ["--material", f"{name}={file}"]
    return command + [*case["options"], "--target-tets", tets, "--threads", threads, "-o", output]


def tags_by_position(mesh, places):
    """Returns for each tag of the case that of the mesh, or None where there is no such material."""
    import meshio
    read = meshio.read(mesh)
    field = next(f for f in ("material", "gmsh:physical") if f in read.cell_data)
    tets = np.vstack([b.data for b in read.cells if b.type == "tetra"])
    tags = np.concatenate([np.ravel(read.cell_data[field][k]) for k, b in enumerate(read.cells) if b.type == "tetra"])
    corners = read.points[tets]
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1]))
    found = np.unique(tags)
    centers = np.array([np.average(corners[tags == t].mean(axis=1), axis=0, weights=volumes[tags == t]) for t in found])
    wanted = {int(k): np.array(p) for k, p in places.items()}
    distance = np.linalg.norm(np.array(list(wanted.values()))[:, None] - centers[None], axis=2)
    out = dict.fromkeys(wanted)
    for row, column in zip(*linear_sum_assignment(distance)):
        out[list(wanted)[row]] = int(found[column])
    return out


def renamed(case, tags):
    """Returns the expectations and bodies of a case with the tags of the mesh."""

    def key(text):
        if found := re.fullmatch(r"material (\d+)", text):
            return f"material {tags[int(found[1])]}"
        if found := re.fullmatch(r"interface (\d+)\|(\d+)", text):
            return "interface {}|{}".format(*sorted((tags[int(found[1])], tags[int(found[2])])))
        if found := re.fullmatch(r"interface (\d+)\|outside", text):
            return f"interface {tags[int(found[1])]}|outside"
        return text

    expect = {key(k): v for k, v in case["expect"].items()}
    for part in ("volume", "bodies"):
        if part in expect:
            expect[part] = {str(tags[int(k)]): v for k, v in expect[part].items()}
    return expect, {str(tags[int(k)]): v for k, v in case["bodies"].items()}


def patch_misses(mesh, patches):
    """Compares the areas of the named triangles of a mesh."""
    import meshio
    read = meshio.read(mesh)
    names = {name: int(np.ravel(v)[0]) for name, v in read.field_data.items()}
    out = []
    for name, area in patches.items():
        found = 0.0
        for k, block in enumerate(read.cells):
            if block.type == "triangle" and name in names:
                a, b, c = (read.points[block.data[np.ravel(read.cell_data["gmsh:physical"][k]) == names[name], j]]
                           for j in range(3))
                found += np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
        if abs(found - area) > 0.01 * area:
            out.append(f"patch {name} has the area {found:.6g}, not {area:.6g}")
    return out


def without_repeats(misses):
    """Puts the rows of what is missing altogether into one."""
    return list(dict.fromkeys(re.sub(r"^(.*): \w+ is None, not .*", r"\1 is missing", miss) for miss in misses))


def judged(judge, case, folder, mesh, timeout):
    """Returns the number of tets, the percent below 0.1 sr and the unmet expectations."""
    expect, bodies = case["expect"], case["bodies"]
    if "places" in case:
        tags = tags_by_position(folder / mesh, case["places"])
        if lost := [str(k) for k, t in tags.items() if t is None]:
            return None, None, [f"there are no materials at the positions of {', '.join(lost)}"]
        expect, bodies = renamed(case, tags)
    command = [PYTHON, judge / "judge_assembly.py", mesh, "--json", "--expect", "expect.json"]
    (folder / "expect.json").write_text(json.dumps(expect))
    for tag, file in bodies.items():
        command += ["--body", f"{tag}={file}"]
    for name, file in case["sheets"].items():
        command += ["--sheet", f"{name}={file}"]
    status, out, error = bounded(command, folder, timeout)
    if status is None:
        return None, None, ["the judge took too long"]
    if status == 2:
        return None, None, [error.strip().split("\n")[-1]]
    # Readers of some formats print lines of their own before.
    rows, end = json.JSONDecoder().raw_decode(out, out.index("{"))
    (folder / "judged.json").write_text(json.dumps(rows, indent=1) + "\n")
    short = without_repeats([line.removeprefix("not as expected: ") for line in out[end:].strip().split("\n") if line])
    if "patches" in case:
        short += patch_misses(folder / mesh, case["patches"])
    return rows["tets"], rows["below"], short


def run(a, name, tets):
    """Prints the line of one run; returns whether all is as expected."""
    folder = a.folder / name
    command, status, seconds, count, below, short = [], None, 0, None, None, []
    try:
        case = json.loads((folder / "case.json").read_text())
        mesh = case["output"].replace("out.", f"out_{tets}.")
        (folder / mesh).unlink(missing_ok=True)
        command = call(a.program, case, tets, a.threads, mesh)
        begin = time.monotonic()
        status, _, error = bounded(command, folder, a.timeout)
        seconds = time.monotonic() - begin
        if status is None:
            short.append(f"it took more than {a.timeout:g} s")
        elif status not in case["status"]:
            last = error.strip().split("\n")[-1]
            short.append(f"the exit status is {status}, not {' or '.join(map(str, case['status']))}: {last}")
        if status in (0, 1) and (folder / mesh).exists() and case["expect"]:
            count, below, more = judged(a.judge, case, folder, mesh, a.timeout)
            short += more
    except Exception as fault:  # noqa: BLE001: the next case must run
        short.append(f"{type(fault).__name__}: {fault}")
    if a.below is not None and below is not None and below > a.below:
        short.append(f"{below:.3g} % of the tets are below 0.1 sr, more than {a.below:g} %")
    quality = "" if count is None else f", {count} tets, {below:.3g} % below 0.1 sr"
    print(f"{name} {tets}: {'ok' if not short else f'{len(short)} unmet'}, status {status}, {seconds:.1f} s{quality}")
    for text in short:
        print(f"    {text}")
    if a.calls:
        print(f"    {' '.join(map(str, command))}")
    sys.stdout.flush()
    return not short


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("judge", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("folder", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("cases", nargs="*", metavar="CASE")
    parser.add_argument("--tets", type=int, nargs="+", action="extend", metavar="N", help="numbers of tets (default 5000)")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--timeout", type=float, default=300, help="seconds of a run, and of the judge")
    parser.add_argument("--below", type=float, metavar="PERCENT", help="more tets below 0.1 sr are unmet, too")
    parser.add_argument("--calls", action="store_true", help="print the calls")
    a = parser.parse_intermixed_args()
    names = sorted(p.parent.name for p in a.folder.glob("*/case.json"))
    chosen = [n for n in names if not a.cases or any(fnmatch.fnmatchcase(n, c) for c in a.cases)]
    if not chosen:
        sys.exit("judge_cases.py: no case matches; call make_inputs.py first")
    good = [run(a, name, tets) for name in chosen for tets in (a.tets or [5000])]
    print(f"{sum(good)} of {len(good)} runs are as expected")
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())

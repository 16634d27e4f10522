#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests tetwright-mpi: the same bytes for any number of ranks, errors, and ranks that are killed.

ranks_test.py TETWRIGHT TETWRIGHT_MPI [VOXELS GRAINS]   size of the foam; default: 64 20, in eight bricks
"""
import glob
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

program, with_mpi = map(os.path.abspath, sys.argv[1:3])
voxels, grains = sys.argv[3:5] if len(sys.argv) > 4 else ("64", "20")
root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def start(ranks, *arguments):
    command = ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(ranks), with_mpi, *arguments]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                            env={**os.environ, **root})


def run(ranks, *arguments):
    process = start(ranks, *arguments)
    out, err = process.communicate(timeout=600)
    return process.returncode, out, err


def content(file):
    with open(file, "rb") as f:
        return f.read()


def job(out, *more):
    return ["prepare", "foam.nrrd", "-o", out, "--target-tets", "2000", "--voxel-size", "1", "--bricks", "32",
            "--threads", "1", "--quiet", *more]


def processes(pid):
    """Processes of the program under an mpirun, by rank."""
    found = {}
    for status in glob.glob("/proc/[0-9]*/status"):
        try:
            folder = os.path.dirname(status)
            parent = next(line for line in open(status) if line.startswith("PPid:")).split()[1]
            if int(parent) != pid:
                continue
            values = dict(v.split("=", 1) for v in open(folder + "/environ").read().split("\0") if "=" in v)
            found[int(values["OMPI_COMM_WORLD_RANK"])] = int(os.path.basename(folder))
        except (OSError, KeyError, StopIteration):
            continue
    return found


def expect(condition, what):
    if not condition:
        sys.exit(f"ranks_test: {what}")


def same_bytes():
    subprocess.run([program, *job("alone.vtu")], check=True)
    for ranks in (1, 2, 3, 4, 8):
        status, _, err = run(ranks, *job(f"{ranks}.vtu", "--stats", "s.json"))
        expect(status == 0, f"{ranks} ranks end with {status}: {err}")
        expect(content(f"{ranks}.vtu") == content("alone.vtu"), f"{ranks} ranks give other bytes")
        with open("s.json") as f:
            expect(json.load(f)["dense"]["bricks"]["count"] >= 8, "there are fewer than eight bricks")


def rounds():
    subprocess.run([program, *job("rounds.vtu", "--brick-rounds", "2")], check=True)
    expect(content("rounds.vtu") != content("alone.vtu"), "a second round changes nothing")
    status, _, err = run(3, *job("3.vtu", "--brick-rounds", "2"))
    expect(status == 0, f"two rounds end with {status}: {err}")
    expect(content("3.vtu") == content("rounds.vtu"), "two rounds give other bytes with three ranks")


def errors():
    for arguments, expected, said in (
            (job("x.vtu")[:1] + ["missing.nrrd"] + job("x.vtu")[2:], 3, "missing.nrrd"),
            (["sample", "sphere", "-o", "x.ply"], 2, "tetwright-mpi"),
            (job("x.vtu", "--uniform"), 2, "--uniform"),
            (["prepare", "foam.nrrd", "-o", "x.vtu", "--target-tets", "2000", "--bricks", "off"], 2, "--bricks off")):
        status, _, err = run(3, *arguments)
        lines = [line for line in err.splitlines() if line.startswith("tetwright: ")]
        expect(status == expected, f"{arguments} ends with {status}, not {expected}: {err}")
        expect(len(lines) == 1 and said in lines[0], f"{arguments} says {lines}")
        expect(not os.path.exists("x.vtu"), f"{arguments} writes a mesh")
    status, out, _ = run(3, "--version")
    expect(status == 0 and out.count("tetwright") == 1, f"--version says {out!r}")


def killed_rank(rank):
    """Kills a rank once there is a finished brick, and lets the same call go on."""
    process = start(3, *job("killed.vtu", "--scratch", "bricks"))
    end = time.monotonic() + 300
    while not glob.glob("bricks/brick-*") and process.poll() is None and time.monotonic() < end:
        time.sleep(0.01)
    ranks = processes(process.pid)
    expect(rank in ranks, f"rank {rank} ended before it could be killed")
    os.kill(ranks[rank], signal.SIGKILL)
    process.communicate(timeout=300)
    expect(process.returncode != 0, f"status 0 after rank {rank} was killed")
    expect(not os.path.exists("killed.vtu"), f"a mesh is written after rank {rank} was killed")
    finished = len(glob.glob("bricks/brick-*"))
    expect(finished > 0, f"no finished brick is left after rank {rank} was killed")
    status, _, err = run(2, *job("killed.vtu", "--scratch", "bricks", "--stats", "s.json"))
    expect(status == 0, f"the same call ends with {status}: {err}")
    expect(content("killed.vtu") == content("alone.vtu"), f"other bytes after rank {rank} was killed")
    with open("s.json") as f:
        resumed = json.load(f)["dense"]["bricks"]["resumed"]
    expect(resumed == finished, f"{finished} bricks were finished, and {resumed} were used")
    expect(not os.path.exists("bricks"), "the scratch folder is left")
    os.remove("killed.vtu")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    subprocess.run([program, "sample", "foam", "--voxels", voxels, "--grains", grains, "-o", "foam.nrrd", "--quiet"],
                   check=True)
    same_bytes()
    rounds()
    errors()
    killed_rank(0)
    killed_rank(2)
print("ranks_test: 1, 2, 3, 4 and 8 ranks give the same bytes; errors and killed ranks end as they should")

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests tetwright-mpi: the same bytes for any number of ranks and rounds, errors, and ranks that are killed.

ranks_test.py TETWRIGHT TETWRIGHT_MPI [VOXELS GRAINS]   size of the foam; default: 64 20, in eight bricks
"""
import glob
import json
import math
import os
import resource
import shutil
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


def bricks_of(stats):
    with open(stats) as f:
        return json.load(f)["dense"]["bricks"]


def job(out, *more, volume="foam.nrrd"):
    return ["prepare", volume, "-o", out, "--target-tets", "2000", "--voxel-size", "1", "--bricks", "32",
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


def wait_for(pattern, process):
    """Waits for a file, or for the end of the process."""
    end = time.monotonic() + 300
    while not glob.glob(pattern) and process.poll() is None and time.monotonic() < end:
        time.sleep(0.01)


def expect(condition, what):
    if not condition:
        sys.exit(f"ranks_test: {what}")


def same_bytes(volume, numbers):
    subprocess.run([program, *job("alone.vtu", volume=volume)], check=True)
    for ranks in numbers:
        status, _, err = run(ranks, *job(f"{ranks}.vtu", "--stats", "s.json", volume=volume))
        expect(status == 0, f"{ranks} ranks end with {status}: {err}")
        expect(content(f"{ranks}.vtu") == content("alone.vtu"), f"{ranks} ranks give other bytes")
        expect(bricks_of("s.json")["count"] >= 8, "there are fewer than eight bricks")
        made = bricks_of("s.json")["by_helpers"]
        expect(len(made) == 1 and (made[0] > 0) == (ranks > 1), f"{ranks} ranks: helpers made {made} bricks")


def rounds():
    """Helpers have neither the memory nor the scratch folder of rank 0."""
    for number in ("1", "2", "3"):
        rounds_of = ["--brick-rounds", number]
        alone = subprocess.run([program, *job(f"rounds{number}.vtu", *rounds_of, volume="small.nrrd")])
        expect(alone.returncode == 0, f"{number} rounds end with {alone.returncode}")
        for ranks, more in ((2, []), (3, ["--scratch", "bricks"]))[int(number == "1"):]:
            call = job("r.vtu", *rounds_of, "--stats", "s.json", *more, volume="small.nrrd")
            status, _, err = run(ranks, *call)
            expect(status == 0, f"{number} rounds of {ranks} ranks end with {status}: {err}")
            expect(content("r.vtu") == content(f"rounds{number}.vtu"), f"{number} rounds of {ranks} ranks: other bytes")
            made = bricks_of("s.json")["by_helpers"]
            expect(len(made) == int(number) and min(made) > 0, f"{ranks} ranks: helpers made {made} bricks")
            expect(not os.path.exists("bricks"), "the scratch folder is left")
    expect(len({content(f"rounds{number}.vtu") for number in ("1", "2", "3")}) == 3, "further rounds change nothing")


def repeats():
    """A gap of a voxel between two bricks, whose boundaries move by more than that."""
    def label(x, y, z):
        at = 32 + 3 * math.sin(y / 3.5) * math.cos(z / 3.85)
        if min(x, y, z) < 3 or max(y, z) > 28 or x > 60:
            return 0
        return 1 if x < at - 0.5 else 2 if x > at + 0.5 else 0

    with open("gap.nrrd", "wb") as f:
        f.write(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 64 32 32\nspacings: 1 1 1\nencoding: raw\n\n")
        f.write(bytes(label(x, y, z) for z in range(32) for y in range(32) for x in range(64)))
    call = ["prepare", "gap.nrrd", "--target-tets", "150", "--voxel-size", "1", "--bricks", "32", "--brick-rounds", "2",
            "--quiet", "--threads", "1"]
    status = subprocess.run([program, *call, "-o", "gap.vtu"], stderr=subprocess.DEVNULL).returncode
    expect(status <= 1, f"the gap ends with {status}")
    with_ranks, _, err = run(3, *call, "-o", "r.vtu", "--stats", "s.json")
    expect(with_ranks == status, f"the gap ends with {with_ranks}, not {status}: {err}")
    expect(content("r.vtu") == content("gap.vtu"), "the gap has other bytes with three ranks")
    expect(bricks_of("s.json")["surfaces_kept"] >= 2, "no brick is made again")


def output():
    """All ranks write pieces. A limit on the size of files lets all but rank 0 fail."""
    for index, name in enumerate(("p.pvtu", "p.msh")):
        for ranks, folder in ((1, "one"), (3, "three")):
            os.makedirs(folder, exist_ok=True)
            call = job(f"{folder}/{name}", "--parts", "7", "--brick-rounds", "1", volume="small.nrrd")
            if ranks == 1:
                subprocess.run([program, *call], check=True)
                continue
            status, _, err = run(ranks, *call, "--stats", "s.json")
            expect(status == 0, f"{name} of {ranks} ranks ends with {status}: {err}")
            with open("s.json") as f:
                expect(0 < json.load(f)["parts"]["by_helpers"] <= 7, f"{name}: only rank 0 writes pieces")
        files = sorted(os.listdir("one"))
        expect(len(files) == (8, 15)[index] and sorted(os.listdir("three")) == files, f"{name}: other files: {files}")
        for file in files:
            expect(content(f"one/{file}") == content(f"three/{file}"), f"{file} has other bytes with three ranks")
    os.mkdir("limited")
    process = start(3, *job("limited/p.pvtu", "--parts", "7", "--scratch", "bricks", volume="small.nrrd"))
    wait_for("bricks/brick-*", process)
    for rank, pid in processes(process.pid).items():
        if rank > 0:
            resource.prlimit(pid, resource.RLIMIT_FSIZE, (1000, 1000))
    _, err = process.communicate(timeout=600)
    lines = [line for line in err.splitlines() if line.startswith("tetwright: ")]
    expect(process.returncode == 5, f"a rank that cannot write ends with {process.returncode}: {err}")
    expect(len(lines) == 1 and "limited/p_" in lines[0] and "(rank" in lines[0], f"a rank that cannot write: {lines}")
    expect(not os.listdir("limited"), f"a failed run leaves {os.listdir('limited')}")
    shutil.rmtree("bricks")


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


def killed_rank(rank, number):
    """Kills a rank once there is a finished brick of the last round, and lets the same call go on."""
    more = ["--scratch", "bricks", "--brick-rounds", number]
    of_round = "bricks/brick-*" if number == "1" else f"bricks/brick-*-round-{number}*"
    process = start(3, *job("killed.vtu", *more, volume="small.nrrd"))
    wait_for(of_round, process)
    ranks = processes(process.pid)
    expect(rank in ranks, f"rank {rank} ended before it could be killed")
    os.kill(ranks[rank], signal.SIGKILL)
    process.communicate(timeout=300)
    expect(process.returncode != 0, f"status 0 after rank {rank} was killed")
    expect(not os.path.exists("killed.vtu"), f"a mesh is written after rank {rank} was killed")
    finished = len(glob.glob("bricks/brick-*"))
    expect(glob.glob(of_round), f"no finished brick is left after rank {rank} was killed")
    status, _, err = run(2, *job("killed.vtu", *more, "--stats", "s.json", volume="small.nrrd"))
    expect(status == 0, f"the same call ends with {status}: {err}")
    expect(content("killed.vtu") == content(f"rounds{number}.vtu"), f"other bytes after rank {rank} was killed in round {number}")
    resumed = bricks_of("s.json")["resumed"]
    expect(resumed == finished, f"{finished} bricks were finished, and {resumed} were used")
    expect(not os.path.exists("bricks"), "the scratch folder is left")
    os.remove("killed.vtu")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    subprocess.run([program, "sample", "foam", "--voxels", voxels, "--grains", grains, "-o", "foam.nrrd", "--quiet"],
                   check=True)
    subprocess.run([program, "sample", "foam", "--voxels", "48", "--grains", "8", "-o", "small.nrrd", "--quiet"],
                   check=True)
    same_bytes("small.nrrd", (1, 2, 3, 4, 8))
    same_bytes("foam.nrrd", (3,) if len(sys.argv) < 5 else (1, 2, 3, 4, 8))
    rounds()
    repeats()
    output()
    errors()
    killed_rank(0, "2")
    killed_rank(2, "1")
print("ranks_test: 1, 2, 3, 4 and 8 ranks give the same bytes, two and three in further rounds and pieces of a mesh, too; "
      "errors and killed ranks end as they should")

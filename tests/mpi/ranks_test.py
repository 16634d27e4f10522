#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests tetwright-mpi: the same bytes for any number of ranks and rounds, errors, and ranks that are killed.

ranks_test.py TETWRIGHT TETWRIGHT_MPI [VOXELS GRAINS]   with a foam of this size, too
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
root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def start(ranks, *arguments, program=with_mpi, environment={}):
    command = ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(ranks), program, *arguments]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                            env={**os.environ, **root, **environment})


def run(ranks, *arguments, **how):
    process = start(ranks, *arguments, **how)
    out, err = process.communicate(timeout=600)
    return process.returncode, out, err


def content(file):
    with open(file, "rb") as f:
        return f.read()


def bricks_of(stats):
    with open(stats) as f:
        return json.load(f)["dense"]["bricks"]


def job(out, *more, volume="small.nrrd"):
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


def runs(pid):
    try:
        with open(f"/proc/{pid}/stat") as f:
            return f.read().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def wait_for(pattern, process):
    """Waits for a file, or for the end of the process."""
    end = time.monotonic() + 300
    while not glob.glob(pattern) and process.poll() is None and time.monotonic() < end:
        time.sleep(0.01)


def expect(condition, what):
    if not condition:
        sys.exit(f"ranks_test: {what}")


def messages(err):
    return [line for line in err.splitlines() if line.startswith("tetwright: ")]


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
        alone = subprocess.run([program, *job(f"rounds{number}.vtu", *rounds_of)])
        expect(alone.returncode == 0, f"{number} rounds end with {alone.returncode}")
        for ranks, more in ((2, []), (3, ["--scratch", "bricks"]))[int(number == "1"):]:
            call = job("r.vtu", *rounds_of, "--stats", "s.json", *more)
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
    """All ranks write pieces."""
    for index, name in enumerate(("p.pvtu", "p.msh")):
        for ranks, folder in ((1, "one"), (3, "three")):
            os.makedirs(folder, exist_ok=True)
            call = job(f"{folder}/{name}", "--parts", "7", "--brick-rounds", "1")
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
    limited_rank()


def limited_rank():
    """Files of other ranks than rank 0 may have 1,000 bytes."""
    os.mkdir("limited")
    process = start(3, *job("limited/p.pvtu", "--parts", "7", "--scratch", "bricks"))
    wait_for("bricks/brick-*", process)
    for rank, pid in processes(process.pid).items():
        if rank > 0:
            resource.prlimit(pid, resource.RLIMIT_FSIZE, (1000, 1000))
    _, err = process.communicate(timeout=600)
    lines = messages(err)
    expect(process.returncode == 5, f"a rank that cannot write ends with {process.returncode}: {err}")
    expect(len(lines) == 1 and "limited/p" in lines[0] and "(rank" in lines[0],
           f"a rank that cannot write: {lines}")
    os.rmdir("limited")  # it is empty
    shutil.rmtree("bricks")


def hdf5_contents(file):
    """Everything that h5diff compares."""
    import h5py
    found = {}

    def add(name, item):
        attributes = {key: (value.dtype, value.tolist()) if hasattr(value, "dtype") else value
                      for key, value in item.attrs.items()}
        data = (item.dtype, item.shape, item[()].tobytes()) if isinstance(item, h5py.Dataset) else None
        found[name] = (attributes, data)

    with h5py.File(file, "r") as f:
        f.visititems(add)
    return found


def beside(name):
    return os.path.join(os.path.dirname(with_mpi), name)


def same_hdf5(one, other):
    expect(hdf5_contents(one) == hdf5_contents(other), f"{other} has other contents than {one}")
    compared = subprocess.run(["h5diff", one, other], capture_output=True, text=True)
    expect(compared.returncode == 0, f"h5diff {one} {other}: {compared.stdout}{compared.stderr}")


def hdf5():
    """All ranks write HDF5 files together, if the build has parallel HDF5: then arrays lie elsewhere."""
    together = b"H5Pset_fapl_mpio" in content(with_mpi)
    for name in ("h.vtkhdf", "h.xdmf"):
        os.mkdir("alone")
        subprocess.run([program, *hdf5_job(f"alone/{name}")], check=True)
        files = sorted(os.listdir("alone"))
        for ranks in (1, 2, 3):
            os.mkdir("all")
            status, _, err = run(ranks, *hdf5_job(f"all/{name}", "--stats", "s.json"))
            expect(status == 0, f"{name} of {ranks} ranks ends with {status}: {err}")
            with open("s.json") as f:
                wrote = json.load(f)["parts"].get("hdf5_ranks")
            expect(wrote == (ranks if together else None), f"{wrote} of {ranks} ranks write {name}")
            expect(sorted(os.listdir("all")) == files, f"{name}: other files: {os.listdir('all')}")
            for file in files:
                if not together or file.endswith(".xdmf"):
                    expect(content(f"alone/{file}") == content(f"all/{file}"), f"{file} has other bytes with {ranks} ranks")
                else:
                    same_hdf5(f"alone/{file}", f"all/{file}")
            shutil.rmtree("all")
        shutil.rmtree("alone")
    if together:
        shapes()
        failing_ranks()


def hdf5_job(out, *more):
    call = job(out, "--parts", "7", "--order", "2", "--brick-rounds", "1", *more, volume="tiny.nrrd")
    call[call.index("--target-tets") + 1] = "300"
    return call


def shapes():
    """Arrays without chunks, with fewer than ranks, and with a part of one."""
    for ranks in (1, 3):
        status, _, err = run(ranks, "together.h5", "alone.h5", program=beside("test_parallel_hdf5"))
        expect(status == 0, f"test_parallel_hdf5 of {ranks} ranks ends with {status}: {err}")
        same_hdf5("alone.h5", "together.h5")


def failing_ranks():
    """A rank cannot write or sync, also where the others wait within the HDF5 library."""
    os.mkdir("full")
    for rank in (0, 1, 2):
        for write in ("1", "last"):
            failing_rank(rank, write, "h.h5")
    # All ranks write the first of four files and the third one.
    for rank, write, name in ((0, "1", "h.vtkhdf"), (2, "1", "h.vtkhdf"), (1, "sync", "h.vtkhdf"), (2, "last", "h.xdmf")):
        failing_rank(rank, write, name)
    os.rmdir("full")
    status, _, err = run(3, "together.h5", "alone.h5", "1", program=beside("test_parallel_hdf5"))
    lines = messages(err)
    expect(status == 5 and len(lines) == 1 and "a lost message (rank 1)" in lines[0] and not os.path.exists("together.h5"),
           f"a rank that throws ends with {status}, and {lines}")


def failing_rank(rank, write, name):
    """Lets the write with this number fail in this rank, "last": the last one, "sync": syncing."""
    call, how = (["full/h.h5", "alone.h5"], {"program": beside("test_parallel_hdf5")}) if name == "h.h5" else (hdf5_job(f"full/{name}"), {})
    environment = {"LD_PRELOAD": beside("failing_writes.so"), "FAIL_FOLDER": "/full", "FAIL_RANK": str(rank)}
    if write == "last":
        status, _, err = run(3, *call, environment={**environment, "FAIL_COUNTED": os.path.abspath("counted")}, **how)
        expect(status == 0, f"{call} ends with {status}: {err}")
        write = content("counted").decode().strip()
        for file in glob.glob("full/*"):
            os.remove(file)
    if not how:
        with open(f"full/{name}", "w") as f:
            f.write("before")
    failure = {"FAIL_SYNC": "1"} if write == "sync" else {"FAIL_WRITE": write}
    status, _, err = run(3, *call, environment={**environment, **failure}, **how)
    what = f"{name}, whose rank {rank} has {failure},"
    expect(status == 5, f"{what} ends with {status}: {err}")
    lines = messages(err)
    expect(len(lines) == 1 and "cannot write full/h" in lines[0] and f"(rank {rank})" in lines[0], f"{what} says {lines}")
    expect(os.listdir("full") == ([] if how else [name]), f"{what} leaves {os.listdir('full')}")
    if not how:
        expect(content(f"full/{name}") == b"before", f"{what} changes the file")
        os.remove(f"full/{name}")


def errors():
    for arguments, expected, said in (
            (job("x.vtu")[:1] + ["missing.nrrd"] + job("x.vtu")[2:], 3, "missing.nrrd"),
            (["sample", "sphere", "-o", "x.ply"], 2, "tetwright-mpi"),
            (job("x.vtu", "--uniform"), 2, "--uniform"),
            (["prepare", "small.nrrd", "-o", "x.vtu", "--target-tets", "2000", "--bricks", "off"], 2, "--bricks off")):
        status, _, err = run(3, *arguments)
        lines = messages(err)
        expect(status == expected, f"{arguments} ends with {status}, not {expected}: {err}")
        expect(len(lines) == 1 and said in lines[0], f"{arguments} says {lines}")
        expect(not os.path.exists("x.vtu"), f"{arguments} writes a mesh")
    status, out, _ = run(3, "--version")
    expect(status == 0 and out.count("tetwright") == 1, f"--version says {out!r}")


def killed_rank(rank, number):
    """Kills a rank once there is a finished brick of the last round, and lets the same call go on."""
    more = ["--scratch", "bricks", "--brick-rounds", number]
    of_round = "bricks/brick-*" if number == "1" else f"bricks/brick-*-round-{number}*"
    process = start(3, *job("killed.vtu", *more))
    wait_for(of_round, process)
    ranks = processes(process.pid)
    expect(rank in ranks, f"rank {rank} ended before it could be killed")
    os.kill(ranks[rank], signal.SIGKILL)
    process.communicate(timeout=300)
    expect(process.returncode != 0, f"status 0 after rank {rank} was killed")
    expect(not os.path.exists("killed.vtu"), f"a mesh is written after rank {rank} was killed")
    finished = len(glob.glob("bricks/brick-*"))
    expect(glob.glob(of_round), f"no finished brick is left after rank {rank} was killed")
    status, _, err = run(2, *job("killed.vtu", *more, "--stats", "s.json"))
    expect(status == 0, f"the same call ends with {status}: {err}")
    expect(content("killed.vtu") == content(f"rounds{number}.vtu"), f"other bytes after rank {rank} was killed in round {number}")
    resumed = bricks_of("s.json")["resumed"]
    expect(resumed == finished, f"{finished} bricks were finished, and {resumed} were used")
    expect(not os.path.exists("bricks"), "the scratch folder is left")
    os.remove("killed.vtu")


def failing_helper():
    """A rank has no memory left in the second round."""
    process = start(3, *job("x.vtu", "--scratch", "bricks", "--brick-rounds", "2"))
    wait_for("bricks/brick-*-round-2*", process)
    pid = processes(process.pid).get(2)
    expect(pid, "rank 2 ended before its memory could be limited")
    resource.prlimit(pid, resource.RLIMIT_AS, (1, 1))
    _, err = process.communicate(timeout=300)
    lines = messages(err)
    expect(process.returncode == 5, f"a rank without memory ends with {process.returncode}: {err}")
    expect(len(lines) == 1 and "memory" in lines[0] and "(rank 2)" in lines[0], f"a rank without memory says {lines}")
    expect(not glob.glob("x.vtu") and glob.glob("bricks/brick-*"), "a rank without memory: a mesh, or no bricks")
    shutil.rmtree("bricks")


def interrupted():
    """Ctrl-C leaves only finished bricks."""
    os.mkdir("output")
    process = start(3, *job("output/x.vtu", "--scratch", "bricks"))
    wait_for("bricks/brick-*", process)
    ranks = processes(process.pid)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=300)
    expect(process.returncode != 0, f"Ctrl-C ends with {process.returncode}: {err}")
    expect(len(messages(err)) == 1 and "goes on" in messages(err)[0], f"Ctrl-C says {messages(err)}")
    end = time.monotonic() + 10
    while any(map(runs, ranks.values())) and time.monotonic() < end:
        time.sleep(0.01)
    expect(len(ranks) == 3 and not any(map(runs, ranks.values())), "a rank outlives Ctrl-C")
    expect(glob.glob("bricks/brick-*"), "Ctrl-C leaves no finished brick")
    os.rmdir("output")  # it is empty
    shutil.rmtree("bricks")


def time_limit():
    for seconds, expected in (("0.001", 5), ("1000", 0)):
        status, _, err = run(2, *job("limit.vtu", "--time-limit", seconds, volume="tiny.nrrd"))
        expect(status == expected and os.path.exists("limit.vtu") == (expected == 0), f"{seconds} s end with {status}: {err}")
        expect(expected == 0 or (len(messages(err)) == 1 and "out of time" in messages(err)[0]), f"{seconds} s say {err}")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    # Eight bricks, and a single one.
    for name, voxels, grains in (("small", "48", "8"), ("tiny", "12", "2"), ("foam", *sys.argv[3:5]))[:3 if len(sys.argv) > 4 else 2]:
        subprocess.run([program, "sample", "foam", "--voxels", voxels, "--grains", grains, "-o", f"{name}.nrrd", "--quiet"],
                       check=True)
        if name != "tiny":
            same_bytes(f"{name}.nrrd", (1, 2, 3, 4, 8))
    rounds()
    repeats()
    output()
    hdf5()
    errors()
    killed_rank(0, "2")
    killed_rank(2, "1")
    failing_helper()
    interrupted()
    time_limit()
print("ranks_test: 1, 2, 3, 4 and 8 ranks give the same bytes, two and three in further rounds and pieces of a mesh, too; "
      "errors, ranks that fail or are killed, and Ctrl-C end as they should")

# SPDX-License-Identifier: Apache-2.0
"""Tests full disks, missing permissions, too little memory, too few file handles, and concurrent processes."""
import collections
import os
import resource
import subprocess
import time

from common import STATUSES, temporaries

OLD = b"what was there before\n"


def expect(p, what, status, error, allowed, out, states):
    """Checks a run; `states` are the permitted contents of the output."""
    if status not in allowed:
        p.wrong(f"{what}: status {status}: {error.strip()}", out)
    if status not in (0, 1) and not error.startswith("tetwright: "):
        p.wrong(f"{what}: says '{error.strip()}'")
    content = out.read_bytes() if out.exists() else None
    if content not in states:
        p.wrong(f"{what}: half-written output", out)
    if temporaries(out.parent):
        p.wrong(f"{what}: leaves temporary files")
    return f"{what}: status {status}"


def limit(kind, value):
    return lambda: resource.setrlimit(kind, (value, value))


def full_disk(p, arguments, out, new):
    """Tests limits on the size of files, up to the size needed."""
    outcomes = collections.Counter()
    size = len(new)
    for share in (0, 0.01, 0.3, 0.6, 0.999, 1):
        out.write_bytes(OLD)
        status, error = p.run(arguments, preexec_fn=limit(resource.RLIMIT_FSIZE, int(share * size)))
        allowed, states = ({0}, [new]) if share == 1 else ({5}, [OLD])
        outcomes[expect(p, "a disk that fills", status, error, allowed, out, states)] += 1
    return outcomes


def read_only_folder(p, arguments, out, new, seconds):
    """Tests a folder that is read-only, or becomes so while the program works."""
    outcomes = collections.Counter()
    # root may write everywhere, unless it lacks this capability
    prefix = ["setpriv", "--inh-caps=-dac_override", "--bounding-set=-dac_override"] if os.geteuid() == 0 else []
    for delay in (None, 0.3 * seconds, 0.7 * seconds):
        out.unlink(missing_ok=True)
        if delay is None:
            out.parent.chmod(0o555)
        process = p.start(arguments, prefix=prefix)
        if delay is not None:
            time.sleep(delay)
            out.parent.chmod(0o555)
        error = process.communicate()[1]
        out.parent.chmod(0o755)
        allowed = {5} if delay is None else {0, 5}
        if process.returncode == 5 and delay is not None:
            # A temporary file that existed when the folder became read-only cannot be removed.
            for file in temporaries(out.parent):
                file.unlink()
        outcomes[expect(p, "a read-only folder", process.returncode, error, allowed, out,
                        [new] if process.returncode == 0 else [None])] += 1
    return outcomes


def two_processes(p, arguments, out):
    """Checks that two processes with the same output both succeed, and that the file is that of one of them."""
    outcomes = collections.Counter()
    results = []
    for seed in ("1", "2"):
        p.must([*arguments, "--seed", seed])
        results.append(out.read_bytes())
    for _ in range(3):
        processes = [p.start([*arguments, "--seed", seed]) for seed in ("1", "2")]
        # Both have ended before the folder is examined: one that still writes has a temporary file.
        errors = [process.communicate()[1] for process in processes]
        for process, error in zip(processes, errors):
            outcomes[expect(p, "two processes with one output", process.returncode, error, {0}, out, results)] += 1
    return outcomes


def little_memory(p, arguments, out, new):
    outcomes = collections.Counter()
    for megabytes in (20, 40, 60, 80, 100, 150, 200, 300, 500):
        out.write_bytes(OLD)
        status, error = p.run(arguments, preexec_fn=limit(resource.RLIMIT_AS, megabytes << 20))
        # With too little memory the libraries cannot be loaded, or log4cplus, which OpenVDB uses, ends the process
        # before main() since it cannot start a thread; then nothing works at all.
        if p.run(["--version"], preexec_fn=limit(resource.RLIMIT_AS, megabytes << 20))[0] != 0:
            outcomes["little memory: the program cannot be loaded"] += 1
            if out.read_bytes() != OLD:
                p.wrong("little memory: half-written output", out)
            continue
        content = out.read_bytes()
        states = [OLD] if status == 5 else [content]  # a smaller mesh if memory determines the cells
        outcomes[expect(p, "little memory", status, error, {0, 1, 5}, out, states)] += 1
        if status in (0, 1) and subprocess.run([p.path, "check", out], capture_output=True).returncode != 0:
            p.wrong("little memory: the mesh is not valid", out)
    return outcomes


def few_files(p, arguments, out, new):
    outcomes = collections.Counter()
    for files in (3, 4, 5, 6, 8, 16):
        out.write_bytes(OLD)
        status, error = p.run(arguments, preexec_fn=limit(resource.RLIMIT_NOFILE, files))
        if status == 127:
            outcomes["few open files: the program cannot be loaded"] += 1
            continue
        outcomes[expect(p, "few open files", status, error, STATUSES - {130}, out,
                        [new] if status == 0 else [OLD])] += 1
    return outcomes


def run(p):
    scan, out = p.folder / "scan.ply", p.folder / "out" / "mesh.vtu"
    out.parent.mkdir()
    p.must(["sample", "torus", "-o", scan])
    arguments = ["prepare", scan, "--target-tets", "1000", "--resolution", "24", "--accept-changes", "-o", out]
    start = time.monotonic()
    p.must(arguments)
    seconds = time.monotonic() - start
    new = out.read_bytes()
    outcomes = full_disk(p, arguments, out, new)
    outcomes += read_only_folder(p, arguments, out, new, seconds)
    outcomes += little_memory(p, arguments, out, new)
    outcomes += few_files(p, arguments, out, new)
    outcomes += two_processes(p, arguments, out)
    return outcomes

# SPDX-License-Identifier: Apache-2.0
"""Tests signals at times distributed over whole runs."""
import collections
import json
import random
import signal
import subprocess
import time

from common import TIMEOUT, temporaries

CATCHABLE = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
SIGNALS = (signal.SIGKILL, *CATCHABLE)
OLD = b"what was there before\n"


def commands(p):
    """Returns runs with several outputs, about a second long: name, arguments, outputs."""
    folder = p.folder
    p.must(["sample", "knot", "-o", folder / "scan.ply"])
    p.must(["sample", "organs", "-o", folder / "organs.nrrd"])
    p.must(["mesh", folder / "scan.ply", "--resolution", "48", "-o", folder / "dense.vtu"])
    out = folder / "out"
    out.mkdir()

    def outputs(*names):
        return [out / name for name in names]

    return [
        ("prepare", ["prepare", folder / "scan.ply", "--target-tets", "3000", "-o", out / "a.vtu", "--boundary",
                     out / "a.ply", "--stats", out / "a.json"], outputs("a.vtu", "a.ply", "a.json")),
        ("mesh", ["mesh", folder / "organs.nrrd", "--labels", "1-3", "-o", out / "b.msh", "--stats", out / "b.json", "--write-sdf",
                  out / "b.vdb"], outputs("b.msh", "b.json", "b.vdb")),
        ("simplify", ["simplify", folder / "dense.vtu", "--target-tets", "3000", "-o", out / "c.xdmf", "--stats",
                      out / "c.json"], outputs("c.xdmf", "c.h5", "c.json")),
        ("improve", ["improve", folder / "dense.vtu", "-o", out / "d.node", "--stats", out / "d.json"],
         outputs("d.node", "d.ele", "d.face", "d.json")),
    ]


def kept_whole(path, new):
    """Returns "old", "new", or None for other contents. Statistics contain times, so any complete JSON counts as
    new."""
    content = path.read_bytes()
    if content == OLD:
        return "old"
    if path.suffix == ".json":
        try:
            json.loads(content)
            return "new"
        except ValueError:
            return None
    return "new" if content == new[path.name] else None


def run_one(p, arguments, outputs, new, number, delay):
    for path in outputs:
        path.write_bytes(OLD)
    folder = outputs[0].parent
    process = p.start(arguments)
    time.sleep(delay)
    process.send_signal(number)
    try:
        error = process.communicate(timeout=TIMEOUT)[1]
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        p.wrong(f"{arguments[0]}: hangs after {number.name}")
        return "hang"
    status = process.returncode
    states = [kept_whole(path, new) for path in outputs]
    what = f"{arguments[0]} after {number.name}"
    if None in states:
        p.wrong(f"{what}: half-written {outputs[states.index(None)].name}", *outputs)
    left = temporaries(folder)
    for file in left:
        file.unlink()
    if number == signal.SIGKILL:
        allowed = {0, -signal.SIGKILL}
    else:
        # A signal that arrives before the handler is installed ends the process by default.
        allowed = {0, 130, -number}
        if left:
            p.wrong(f"{what}: leaves {len(left)} temporary files")
        if len(set(states)) > 1:
            p.wrong(f"{what}: some outputs are new, and some old: {states}")
        if status == 130 and ("nothing was written" in error) != (states[0] == "old"):
            p.wrong(f"{what}: says '{error.strip()}', and the files are {states[0]}")
    if status not in allowed:
        p.wrong(f"{what}: status {status}: {error.strip()}")
    return f"{number.name}: status {status}, outputs {'/'.join(sorted(set(map(str, states))))}"


def run_batch(p, number, delay):
    """Checks that a killed batch can be continued without repeating finished jobs."""
    folder = p.folder / "batch"
    folder.mkdir(exist_ok=True)
    jobs, results = folder / "jobs.jsonl", folder / "results.jsonl"
    results.unlink(missing_ok=True)
    lines = [{"id": f"job {i}", "args": ["prepare", str(p.folder / "scan.ply"), "--target-tets", str(500 + i),
                                         "--resolution", "20", "--accept-changes", "-o", str(folder / f"{i}.vtu")]} for i in range(6)]
    jobs.write_text("".join(json.dumps(line) + "\n" for line in lines))
    call = ["batch", jobs, "--results", results, "--quiet"]
    process = p.start(call)
    time.sleep(delay)
    process.send_signal(number)
    process.communicate(timeout=TIMEOUT)
    before = results.read_bytes() if results.exists() else b""
    whole = before[:before.rfind(b"\n") + 1]
    finished = {json.loads(line)["id"] for line in whole.splitlines()}
    for name in finished:
        if not (folder / f"{name.split()[1]}.vtu").is_file():
            p.wrong(f"batch after {number.name}: '{name}' is finished, and its mesh is not there")
    status, error = p.run(call)
    after = results.read_bytes()
    ended = [json.loads(line)["id"] for line in after.splitlines()]
    if status != 0 or not after.startswith(whole) or sorted(ended) != sorted(line["id"] for line in lines):
        p.wrong(f"batch after {number.name}: the second call ends with {status}, jobs {sorted(ended)}: {error}", results)
    for file in temporaries(folder):
        file.unlink()
    return f"batch, {number.name}: {len(finished)} of {len(lines)} jobs were finished, none done twice"


def run(p, count, seed):
    outcomes = collections.Counter()
    cases = []
    for name, arguments, outputs in commands(p):
        start = time.monotonic()
        p.must(arguments)
        cases.append((arguments, outputs, {path.name: path.read_bytes() for path in outputs},
                      time.monotonic() - start))
    start = time.monotonic()
    outcomes[run_batch(p, signal.SIGTERM, 0.01)] += 1
    batch_seconds = time.monotonic() - start
    draw = random.Random(seed)
    for i in range(count):
        number = SIGNALS[i % len(SIGNALS)]
        # Every fifth round of signals tests batches.
        if i // len(SIGNALS) % 5 == 4:
            outcomes[run_batch(p, number, draw.uniform(0, batch_seconds))] += 1
            continue
        arguments, outputs, new, seconds = cases[i // len(SIGNALS) % len(cases)]
        outcomes[run_one(p, arguments, outputs, new, number, draw.uniform(0, 1.1 * seconds))] += 1
    return outcomes

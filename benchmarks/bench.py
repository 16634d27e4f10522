#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Implements tools/bench --ci and --compare; benchmarks/README.md explains the results.

Each benchmark runs in a separate process, so that its peak memory is measured alone.

When is HEAD worse than BASE? For each benchmark both are run in turn, ROUNDS times.
  time     the median of the ratios (head / base, round by round) is above 1.10, and head's median is above every
           time of base's; for a stage of a benchmark also by 5 ms or more
  memory   the ratio of the medians is above 1.05, and head's median is above every peak of base's
  poor     head's median of the percentage of tets under 0.1 sr is above base's by 0.05 points and by a tenth of it,
           and above every one of base's
Anything else is noise or an improvement. A benchmark that only one of the two has is listed.
"""
import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PROGRAM = "ci_benchmarks"
SOURCE = "benchmarks/ci/ci_benchmark.cpp"

TIME_RATIO = 1.10
STAGE_SECONDS = 0.005
MEMORY_RATIO = 1.05
POOR_POINTS = 0.05
POOR_SHARE = 0.10

CI_ROUNDS = 3
CI_NO_NEW_ROUND_AFTER = 100  # seconds
UNITS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}


def fail(message, status=2):
    print("tools/bench: " + message, file=sys.stderr)
    sys.exit(status)


def output_of(command, **options):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, **options).stdout


def git(*arguments):
    return output_of(["git", "-C", ROOT] + list(arguments)).strip()


def build(folder):
    """Builds the suite of a checkout; returns its program, or None if that checkout has no suite."""
    if not os.path.exists(os.path.join(folder, SOURCE)):
        return None
    os.makedirs(os.path.join(folder, "build"), exist_ok=True)
    log = os.path.join(folder, "build", "bench.log")
    with open(log, "w") as out:
        for command in (["cmake", "--preset", "release"],
                        ["cmake", "--build", "--preset", "release", "--target", PROGRAM]):
            if subprocess.run(command, cwd=folder, stdout=out, stderr=subprocess.STDOUT).returncode != 0:
                fail("building %s failed; %s says why" % (folder, log))
    return os.path.join(folder, "build/release/bin", PROGRAM)


def names_in(program, wanted):
    if program is None:
        return []
    names = output_of([program, "--benchmark_list_tests"]).split()
    return [n for n in names if re.search(wanted, n)]


def run_once(program, name):
    """Returns {metric: value} of one run, in seconds, MB and percent."""
    text = output_of([program, "--benchmark_filter=^%s$" % re.escape(name), "--benchmark_format=json",
                      "--benchmark_min_time=0.3"], stderr=subprocess.DEVNULL)
    result = json.loads(text)["benchmarks"][0]
    if result.get("error_occurred"):
        fail("%s: %s" % (name, result.get("error_message")), 1)
    metrics = {"time": result["real_time"] * UNITS[result["time_unit"]]}
    for key, value in result.items():
        if key.endswith("_s") and isinstance(value, (int, float)):
            metrics["time of " + key[:-2]] = value
    if "peak_MB" in result:
        metrics["memory"] = result["peak_MB"]
    if "poor_%" in result:
        metrics["poor"] = result["poor_%"]
    return metrics


def add(values, metrics):
    for metric, value in metrics.items():
        values.setdefault(metric, []).append(value)


def label(name):
    return name.replace("/real_time", "")


def in_unit(metric, value):
    if metric.startswith("time"):
        return "%.4g ms" % (1000 * value)
    return ("%.1f MB" if metric == "memory" else "%.4f %%") % value


def spread(values):
    """Returns half of the difference between the largest and the smallest value, relative to the median."""
    middle = statistics.median(values)
    return (max(values) - min(values)) / 2 / middle if middle else 0.0


def verdict(metric, base, head):
    """Returns 'WORSE', 'better' or '' by the rule above."""
    b, h = statistics.median(base), statistics.median(head)

    def worse(base, head, b, h):
        if h <= max(base):
            return False
        if metric.startswith("time"):
            ratios = [y / x for x, y in zip(base, head) if x > 0]
            enough = metric == "time" or h - b >= STAGE_SECONDS
            return bool(ratios) and statistics.median(ratios) > TIME_RATIO and enough
        if metric == "memory":
            return h > MEMORY_RATIO * b
        return h - b > max(POOR_POINTS, POOR_SHARE * b)

    return "WORSE" if worse(base, head, b, h) else "better" if worse(head, base, h, b) else ""


def summary(values):
    return {metric: {"median": statistics.median(v), "min": min(v), "max": max(v), "values": v}
            for metric, v in values.items()}


def write(path, data):
    if path:
        with open(path, "w") as out:
            json.dump(data, out, indent=1)
            out.write("\n")


def about(commit, dirty):
    return {"commit": commit, "uncommitted_changes": dirty, "cores": os.cpu_count()}


def ci(options):
    program = build(ROOT)
    names = names_in(program, options.filter)
    if not names:
        fail("no benchmark matches '%s'" % options.filter)
    started = time.time()
    values = {n: {} for n in names}
    rounds = 0
    while rounds < (options.rounds or CI_ROUNDS):
        for n in names:
            add(values[n], run_once(program, n))
        rounds += 1
        if not options.rounds and time.time() - started > CI_NO_NEW_ROUND_AFTER:
            break
    print("%-40s %14s %8s %12s %12s" % ("median of %d" % rounds, "time", "+-", "memory", "poor tets"))
    for n in names:
        for metric in [m for m in values[n] if m.startswith("time")]:
            v = values[n][metric]
            whole = metric == "time"
            text = label(n) if whole else "  " + metric[8:]
            extra = [in_unit(m, statistics.median(values[n][m])) if whole and m in values[n] else ""
                     for m in ("memory", "poor")]
            line = "%-40s %14s %6.1f %% %12s %12s" % (
                text, in_unit(metric, statistics.median(v)), 100 * spread(v), extra[0], extra[1])
            print(line.rstrip())
    print("%.0f s" % (time.time() - started))
    data = about(git("rev-parse", "HEAD"), bool(git("status", "--porcelain")))
    data["rounds"] = rounds
    data["benchmarks"] = {label(n): summary(values[n]) for n in names}
    write(options.out, data)
    return 0


def checkout(side, commit):
    """Returns a worktree of a commit under build/; it is kept, so that the next comparison builds less."""
    folder = os.path.join(ROOT, "build", "bench", side)
    if os.path.exists(os.path.join(folder, ".git")):
        git("-C", folder, "checkout", "--quiet", "--force", "--detach", commit)
    else:
        git("worktree", "prune")
        git("worktree", "add", "--quiet", "--force", "--detach", folder, commit)
    return folder


def commit_of(name):
    found = subprocess.run(["git", "-C", ROOT, "rev-parse", "--quiet", "--verify", name + "^{commit}"],
                           stdout=subprocess.PIPE, text=True)
    if found.returncode != 0:
        fail("'%s' is no commit of this repository" % name)
    return found.stdout.strip()


def compare(options):
    commits = {"base": commit_of(options.compare), "head": commit_of(options.head)}
    if options.head == "HEAD" and git("status", "--porcelain", "--untracked-files=no"):
        print("note: what is not committed is not measured")
    programs = {side: build(checkout(side, commits[side])) for side in commits}
    names = {side: names_in(programs[side], options.filter) for side in commits}
    for side in commits:
        if programs[side] is None:
            print("note: %s, %s, has no %s" % (side, commits[side][:12], SOURCE))
    common = [n for n in names["head"] if n in names["base"]]
    values = {side: {n: {} for n in common} for side in commits}
    rounds = options.rounds or 5
    for r in range(rounds):
        for n in common:
            for side in ("base", "head") if r % 2 == 0 else ("head", "base"):
                add(values[side][n], run_once(programs[side], n))
    print("base %s, head %s, %d rounds; +-: half the range, of the median" %
          (commits["base"][:12], commits["head"][:12], rounds))
    print("%-32s %-16s %12s %8s %12s %8s %7s" % ("", "", "base", "+-", "head", "+-", "ratio"))
    worse = []
    results = {}
    for n in common:
        base, head = values["base"][n], values["head"][n]
        results[label(n)] = {"base": summary(base), "head": summary(head), "verdict": {}}
        for metric in [m for m in head if m in base]:
            b, h = base[metric], head[metric]
            said = verdict(metric, b, h)
            results[label(n)]["verdict"][metric] = said
            ratio = statistics.median(h) / statistics.median(b) if statistics.median(b) else float("nan")
            if metric.startswith("time"):
                ratio = statistics.median([y / x if x else float("nan") for x, y in zip(b, h)])
            line = "%-32s %-16s %12s %6.1f %% %12s %6.1f %% %7.3f %s" % (
                label(n), metric, in_unit(metric, statistics.median(b)), 100 * spread(b),
                in_unit(metric, statistics.median(h)), 100 * spread(h), ratio, said)
            print(line.rstrip())
            if said == "WORSE":
                worse.append("%s, %s: %.3f" % (label(n), metric, ratio))
    for side, other in (("base", "head"), ("head", "base")):
        for n in names[side]:
            if n not in names[other]:
                print("only in %s: %s" % (side, label(n)))
    write(options.out, {"base": commits["base"], "head": commits["head"], "rounds": rounds,
                        "cores": os.cpu_count(), "worse": worse, "benchmarks": results,
                        "only_in_base": [label(n) for n in names["base"] if n not in names["head"]],
                        "only_in_head": [label(n) for n in names["head"] if n not in names["base"]]})
    for line in worse:
        print("worse than base: " + line)
    return 1 if worse else 0


def main():
    parser = argparse.ArgumentParser(prog="tools/bench", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--ci", action="store_true", help="run the suite of this checkout")
    what.add_argument("--compare", metavar="BASE", help="run that of a commit and of HEAD in turn")
    parser.add_argument("--head", default="HEAD", help="what is compared with BASE (default: HEAD)")
    parser.add_argument("--out", metavar="FILE", help="write all that was measured as JSON")
    parser.add_argument("--rounds", type=int, help="times each benchmark is run (default: 5; --ci: up to 3)")
    parser.add_argument("--filter", default=".", metavar="REGEX", help="only benchmarks whose name it matches")
    options = parser.parse_args()
    if options.rounds is not None and options.rounds < 1:
        fail("--rounds %d: give 1 or more" % options.rounds)
    return ci(options) if options.ci else compare(options)


if __name__ == "__main__":
    sys.exit(main())

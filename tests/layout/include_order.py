#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Checks every #include of common/, mesher/ and simplify/ against the order of folders given in their READMEs.

A README states "Folders include each other in this order only: `a` < `b` < the files in this folder." for its own
folder, or "Folders of `io/` include ..." for a subfolder. Prints the violations; status 1 if there are any.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Folders of the project that the files of a folder may include.
ALLOWED = {
    "common": ("common",),
    "simplify": ("simplify", "common"),
    "mesher": ("mesher", "common"),
}
# Allowed only here; the programs and tests on top of the libraries may include anything.
FOLDERS_OF_LIBRARIES = {
    "common/io": ("blosc.h", "gdcm", "hdf5.h", "libdeflate.h", "lz4.h", "lzma.h", "netcdf", "nlohmann/", "pugixml.hpp", "tiffio.h",
                  "zip.h", "zlib.h", "zstd.h"),
}
FILES_OF_LIBRARIES = {
    "scotch.h": ("tools/parts/scotch_graph.cpp",),
    "oneapi/": ("common/parallel/tbb_loop.cpp",),
    "tbb/": ("common/parallel/tbb_loop.cpp",),
    "openvdb/": ("mesher/level_sets/openvdb_types.h", "mesher/level_sets/openvdb_grids.cpp",
                 "mesher/level_sets/openvdb_conversion.cpp"),
}
OPENVDB_TYPES = "mesher/level_sets/openvdb_types.h"


def orders():
    """Returns for each folder with an order its subfolders, lowest first; "" stands for the files in the folder
    itself."""
    found = {}
    for top in ALLOWED:
        text = (ROOT / top / "README.md").read_text(encoding="utf-8")
        for inner, order in re.findall(r"Folders (?:of `([\w/]+?)/?` )?include\s+each\s+other\s+in\s+this\s+order\s+only:\s*([^.]*)\.",
                                       text):
            parts = [" ".join(part.split()) for part in order.split("<")]
            found[f"{top}/{inner}" if inner else top] = [
                "" if part == "the files in this folder" else part.strip("`").strip("/") for part in parts]
    return found


def rank(path, top, order):
    """Returns the position of a file's folder in the order of `top`; None if the order does not contain it."""
    inner = path[len(top) + 1:]
    folder = inner.split("/")[0] if "/" in inner else ""
    return order.index(folder) if folder in order else None


PUBLIC = {"tetwright/" + path.name: path.relative_to(ROOT).as_posix()
          for path in ROOT.glob("**/include/tetwright/*.h") if "build" not in path.relative_to(ROOT).parts}


def includes(path):
    for number, line in enumerate((ROOT / path).read_text(encoding="utf-8").splitlines(), 1):
        match = re.match(r'\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)', line)
        if match:
            yield number, PUBLIC.get(match.group(1), match.group(1)), match.group(2)


def check_own(path, number, included, all_orders):
    top, other = path.split("/")[0], included.split("/")[0]
    if other in ("common", "simplify", "mesher", "tools", "tests", "benchmarks") and other not in ALLOWED[top]:
        yield f"{path}:{number}: {top}/ includes {included}"
    if top != "common" and included.startswith("common/io/"):
        yield f"{path}:{number}: {top}/ includes {included}, and does without files"
    if included == OPENVDB_TYPES and path not in FILES_OF_LIBRARIES["openvdb/"]:
        yield f"{path}:{number}: OpenVDB's headers are for {' '.join(FILES_OF_LIBRARIES['openvdb/'])}"
    if "/include/tetwright/" in path + included:
        return  # public headers belong to all folders of their library
    for folder, order in all_orders.items():
        if not (path.startswith(folder + "/") and included.startswith(folder + "/")):
            continue
        mine, its = rank(path, folder, order), rank(included, folder, order)
        for name, place in ((path, mine), (included, its)):
            if place is None:
                yield f"{path}:{number}: the order in {folder.split('/')[0]}/README.md has no folder of {name}"
        if mine is not None and its is not None and its > mine:
            yield f"{path}:{number}: {included} is above it: {' < '.join(f or 'the files in ' + folder for f in order)}"


def check_library(path, number, included):
    for folder, headers in FOLDERS_OF_LIBRARIES.items():
        if included.startswith(headers) and not path.startswith(folder + "/"):
            yield f"{path}:{number}: <{included}> is for {folder}/ only"
    for prefix, files in FILES_OF_LIBRARIES.items():
        if included.startswith(prefix) and path not in files:
            yield f"{path}:{number}: <{included}> is for {' '.join(files)} only"


def main():
    all_orders = orders()
    wrong = [f"{top}/README.md says no order of its folders" for top in (*ALLOWED, "common/io") if top not in all_orders]
    files = count = 0
    for top in ALLOWED:
        for path in sorted((ROOT / top).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            name = path.relative_to(ROOT).as_posix()
            files += 1
            for number, own, library in includes(name):
                count += 1
                wrong += check_own(name, number, own, all_orders) if own else check_library(name, number, library)
    if files < 100:
        wrong.append(f"only {files} files found in {ROOT}")
    print("\n".join(wrong) if wrong else f"{count} includes of {files} files are in order")
    return 1 if wrong else 0


sys.exit(main())

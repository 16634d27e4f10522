# SPDX-License-Identifier: Apache-2.0
"""Tests inputs of all formats with bytes flipped, truncated, deleted, repeated or inserted."""
import collections
import gzip
import io
import json
import random
import shutil
import struct
import zipfile
import zlib
from pathlib import Path

import h5py
import numpy
import tifffile

SURFACES = ("ply", "obj", "stl", "off", "vtp")
SEEDS = Path(__file__).parents[1] / "fuzz" / "seeds"
TETS = ("vtu", "msh", "mesh", "meshb", "vtk", "inp", "bdf", "xdmf", "node")
# Damage to a header has the largest effect, so about half of the damage is near the beginning.
HEADER = 400


def damaged(data, draw):
    data = bytearray(data)
    if not data:
        return bytes(data)
    near = HEADER if draw.random() < 0.5 else len(data)
    at = draw.randrange(min(len(data), near))
    length = min(len(data) - at, 1 + int(draw.expovariate(1 / 20)))
    kind = draw.randrange(6)
    if kind == 0:  # flipped
        for _ in range(draw.choice((1, 1, 2, 8, 64))):
            data[draw.randrange(min(len(data), near))] ^= 1 << draw.randrange(8)
    elif kind == 1:  # truncated
        del data[at:]
    elif kind == 2:  # deleted
        del data[at:at + length]
    elif kind == 3:  # repeated
        data[at:at] = data[at:at + length] * draw.choice((1, 2, 50))
    elif kind == 4:  # inserted
        data[at:at] = bytes(draw.randrange(256) for _ in range(length))
    else:  # a digit is replaced, for example by a huge number
        digits = [i for i in range(len(data)) if 48 <= data[i] <= 57]
        for _ in range(min(len(digits), draw.choice((1, 1, 3)))):
            i = draw.choice(digits)
            data[i:i + 1] = draw.choice((b"0", b"9", b"-1", b"999999999", b"1e300", b"nan", b"", b" "))
    return bytes(data)


def volumes(folder):
    """Writes a ball of labels in all formats; returns the files that are read by name."""
    side = 12
    labels = bytes((2 if x < 6 else 1) if (x - 5.5) ** 2 + (y - 5.5) ** 2 + (z - 5.5) ** 2 < 25 else 0
                   for z in range(side) for y in range(side) for x in range(side))
    nrrd = ("NRRD0004\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\nsizes: 12 12 12\n"
            "space directions: (1,0,0) (0,1,0) (0,0,1.5)\nspace origin: (3,4,5)\nencoding: {}\n{}\n")
    meta = ("ObjectType = Image\nNDims = 3\nDimSize = 12 12 12\nElementSpacing = 1 1 1.5\nElementType = MET_UCHAR\n"
            "ElementDataFile = {}\n")
    inr = "#INRIMAGE-4#{{\nXDIM=12\nYDIM=12\nZDIM=12\nVDIM=1\nTYPE=unsigned fixed\nPIXSIZE=8 bits\nVX=1\nVY=1\nVZ=1.5\n"
    inr = inr.replace("{{", "{").ljust(252, "\n") + "##}\n"
    nifti = struct.pack("<i36x8h14x2h2x8f3fh2b", 348, 3, 12, 12, 12, 1, 1, 1, 1, 2, 8, 1, 1, 1, 1.5, 1, 1, 1, 1, 352,
                        1, 0, 0, 0, 0).ljust(344, b"\0") + b"n+1\0" + bytes(4)
    contents = {
        "raw.nrrd": nrrd.format("raw", "").encode() + labels,
        "gzip.nrrd": nrrd.format("gzip", "").encode() + gzip.compress(labels, mtime=0),
        "detached.nhdr": nrrd.format("raw", "data file: detached.raw\n").encode(),
        "detached.raw": labels,
        "local.mha": meta.format("LOCAL").encode() + labels,
        "apart.mhd": meta.format("apart.raw").encode(),
        "apart.raw": labels,
        "plain.nii": nifti + labels,
        "packed.nii.gz": gzip.compress(nifti + labels, mtime=0),
        "plain.inr": inr.encode() + labels,
        "packed.inr.gz": gzip.compress(inr.encode() + labels, mtime=0),
    }
    for name, content in contents.items():
        (folder / name).write_bytes(content)
    return [folder / name for name in contents if not name.endswith(".raw")]


def arrays(folder):
    """Writes a ball of labels as arrays and images; returns files to damage, each with the name by which it is read."""
    z, y, x = numpy.mgrid[:12, :12, :12]
    labels = (((x - 5.5)**2 + (y - 5.5)**2 + (z - 5.5)**2 < 25) * (1 + (x < 6))).astype("<u2")
    found = []
    tifffile.imwrite(folder / "stack.tif", labels)
    tifffile.imwrite(folder / "packed.tif", labels, tile=(16, 16), compression="zlib")
    with h5py.File(folder / "array.h5", "w") as file:
        file.create_dataset("labels", data=labels, chunks=(6, 6, 6), compression="gzip", fletcher32=True)
        file["labels"].attrs["element_size_um"] = [1.5, 1, 1]
    found += [(folder / name, folder / name) for name in ("stack.tif", "packed.tif", "array.h5")]

    second = {"zarr_format": 2, "shape": [12, 12, 12], "chunks": [6, 12, 12], "dtype": "<u2", "order": "C", "fill_value": 0,
              "filters": None, "compressor": {"id": "zlib"}}
    image = {"multiscales": [{"axes": [{"name": n, "type": "space"} for n in "zyx"], "datasets": [
        {"path": "0", "coordinateTransformations": [{"type": "scale", "scale": [1.5, 1, 1]}]}]}]}
    little = {"name": "bytes", "configuration": {"endian": "little"}}
    third = {"zarr_format": 3, "node_type": "array", "shape": [12, 12, 12], "data_type": "uint16", "fill_value": 0,
             "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [12, 12, 12]}},
             "chunk_key_encoding": {"name": "default"}, "attributes": {},
             "codecs": [{"name": "sharding_indexed", "configuration": {"chunk_shape": [6, 12, 12],
                         "codecs": [little, {"name": "gzip"}], "index_codecs": [little]}}]}
    halves = [labels[:6].tobytes(), labels[6:].tobytes()]
    stored = [gzip.compress(half, mtime=0) for half in halves]
    index = struct.pack("<4Q", 0, len(stored[0]), len(stored[0]), len(stored[1]))
    contents = {
        "second.zarr/.zgroup": b'{"zarr_format": 2}',
        "second.zarr/.zattrs": json.dumps(image).encode(),
        "second.zarr/0/.zarray": json.dumps(second).encode(),
        "second.zarr/0/0.0.0": zlib.compress(halves[0]),
        "second.zarr/0/1.0.0": zlib.compress(halves[1]),
        "third.zarr/zarr.json": json.dumps(third).encode(),
        "third.zarr/c/0/0/0": b"".join(stored) + index,
    }
    for name, content in contents.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
        found.append((path, folder / name.split("/")[0]))
    return found


def damaged_file(path, data, draw):
    """Damages the stored model in a .3mf: damage to the archive itself would fail at its checksums."""
    if path.name != "stored.3mf" or draw.random() < 0.2:
        return damaged(data, draw)
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    result = io.BytesIO()
    with zipfile.ZipFile(result, "w") as archive:
        for name, content in parts.items():
            archive.writestr(name, damaged(content, draw) if name == "3D/3dmodel.model" else content)
    return result.getvalue()


def inputs(p):
    """Returns files, each with the calls that read it."""
    folder = p.folder / "in"
    folder.mkdir()
    p.must(["sample", "cube", "-o", folder / "s.ply"])
    p.must(["sample", "organs", "-o", folder / "v.nrrd"])
    p.must(["mesh", folder / "v.nrrd", "-o", folder / "small.vtu", "--voxel-size", "4", "--uniform"])
    found = []
    for ext in SURFACES:
        p.must(["sample", "cube", "-o", folder / f"surface.{ext}"])
        found.append((folder / f"surface.{ext}", ["mesh", "--resolution", "8"]))
    for seed in ("vtk_surface/polydata.vtk", "vtk_surface/grid.vtk", "3mf/stored.3mf", "3mf/deflated.3mf", "glb/cubes.glb"):
        path = folder / Path(seed).name
        shutil.copy(SEEDS / seed, path)
        found.append((path, ["mesh", "--resolution", "8"]))
    tets = folder / "few.vtu"
    p.must(["simplify", folder / "small.vtu", "--target-tets", "300", "-o", tets])
    for ext in TETS:
        p.must(["improve", tets, "-o", folder / f"tets.{ext}"])
        found.append((folder / f"tets.{ext}", ["improve"]))
    pieces = folder / "pieces.pvtu"
    p.must(["improve", tets, "-o", pieces, "--parts", "2"])
    found += [(pieces, ["improve"]), (folder / "pieces_1.vtu", ["improve", pieces])]
    for other in ("h5", "ele", "face"):
        main = folder / ("tets.xdmf" if other == "h5" else "tets.node")
        if (folder / f"tets.{other}").exists():
            found.append((folder / f"tets.{other}", ["improve", main]))
    for ext in ("msh41", "msh41-binary"):
        path = folder / f"{ext}.msh"
        p.must(["improve", tets, "-o", path, "--output-format", ext])
        found.append((path, ["improve"]))
    for path in volumes(folder):
        call = ["mesh", "--uniform", "--accept-changes"]
        p.must([*call, path, "-o", folder / "volume.vtu"])
        found.append((path, call))
    for path, read in arrays(folder):
        call = ["mesh", "--uniform", "--accept-changes", read]
        p.must([*call, "-o", folder / "volume.vtu"])
        found.append((path, call))
    p.must(["mesh", folder / "s.ply", "-o", folder / "s.vtu", "--resolution", "12", "--write-sdf",
            folder / "fields.vdb"])
    found.append((folder / "fields.vdb", ["mesh", "--resolution", "8"]))
    return found


def one(p, path, call, draw):
    name = path.name
    original = path.read_bytes()
    out = p.folder / "out.vtu"
    out.unlink(missing_ok=True)
    # One of two files is damaged in place; the other one stays intact.
    path.write_bytes(damaged_file(path, original, draw))
    try:
        other = [argument for argument in call if isinstance(argument, Path)]
        arguments = [*call, *([] if other else [path]), "-o", out, "--quiet",
                     "--threads", "1", "--time-limit", "60", "--memory-limit", "2"]
        status, error = p.run(arguments)
        what = f"damaged {name}"
        kind = path.suffix
        if status is None:
            p.wrong(f"{what}: hangs", path)
            return f"{kind}: hang"
        if status in (0, 1):
            if status == 1 and not error.startswith("tetwright: "):
                p.wrong(f"{what}: status 1 and nothing said", path)
            if p.run(["check", out, "--quiet"])[0] == 0:
                return "a valid mesh, status %d" % status
            # A moved point may leave a readable mesh with inverted tets, which `improve` reports and keeps if it cannot
        # repair them.
            if call[0] != "improve" or p.run(["check", *(other or [path]), "--quiet"])[0] == 0:
                p.wrong(f"{what}: the mesh is not valid", path)
            return "a mesh with the inverted tets or intersections of its input"
        if status not in (2, 3, 4, 5):
            p.wrong(f"{what}: status {status}: {error.strip()[:200]}", path)
            return f"status {status}"
        lines = error.strip().split("\n")
        if len(lines) != 1 or not lines[0].startswith("tetwright: "):
            p.wrong(f"{what}: says '{error.strip()[:200]}'", path)
        elif status in (2, 3, 4) and (other or [path])[0].stem not in lines[0]:
            p.wrong(f"{what}: the message does not name the file: '{lines[0][:200]}'", path)
        if out.exists():
            p.wrong(f"{what}: status {status}, and an output is there", path)
        return f"refused, status {status}"
    finally:
        path.write_bytes(original)


def run(p, count, seed):
    outcomes = collections.Counter()
    draw = random.Random(seed)
    files = inputs(p)
    for i in range(count):
        path, call = files[i % len(files)]
        outcomes[one(p, path, call, draw)] += 1
    return outcomes

# SPDX-License-Identifier: Apache-2.0
"""Writes segmented volumes with zarr, tifffile and h5py in many encodings, reads them by boxes, and compares every label,
the spacing and the origin. Also meshes each kind once, and compares the mesh with that of the same labels as NRRD.

usage: read_volumes.py VOLUME_LABELS TETWRIGHT    (Debian's python3 with zarr, numcodecs, tifffile, h5py and numpy)
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numcodecs
import numpy as np
import tifffile
import zarr

VOLUME_LABELS, TETWRIGHT = sys.argv[1:]
failures = []
count = 0

draw = np.random.default_rng(5)
# Smooth enough to compress, with z, y, x.
LABELS = np.kron(draw.integers(0, 120, (9, 14, 11)), np.ones((5, 5, 7), int))[:41, :67, :73].astype(np.uint8)


def failed(message):
    failures.append(message)
    print("FAILED", message)


def compare(path, labels=LABELS, spacing=(1, 1, 1), origin=(0, 0, 0), in_memory=0):
    """Compares a file; spacing and origin are those of x, y and z."""
    global count
    count += 1
    out = pathlib.Path(folder, "labels.raw")
    done = subprocess.run([VOLUME_LABELS, path, out], capture_output=True, text=True, check=False)
    if done.returncode:
        failed(f"{path}: {done.stderr}")
        return
    said = [float(word) for word in done.stdout.split()]
    if not np.array_equal(said[:3], labels.shape[::-1]):
        failed(f"{path}: size {said[:3]}")
    elif not np.array_equal(np.fromfile(out, np.int32).reshape(labels.shape), labels):
        failed(f"{path}: labels differ")
    if not np.allclose(said[3:9], [*spacing, *origin], rtol=1e-6):
        failed(f"{path}: spacing and origin {said[3:9]}")
    if said[9] != in_memory:
        failed(f"{path}: in memory: {said[9]}")


def refused(path, *parts):
    """Expects a message of one line with the parts."""
    done = subprocess.run([VOLUME_LABELS, path, pathlib.Path(folder, "labels.raw")], capture_output=True, text=True, check=False)
    if done.returncode != 3 or done.stderr.count("\n") != 1 or not all(p in done.stderr for p in (str(path), *parts)):
        failed(f"{path}: status {done.returncode}, {done.stderr!r}")


def zarrs():
    compressors = {"none": None, "zlib": numcodecs.Zlib(3), "gzip": numcodecs.GZip(3), "zstd": numcodecs.Zstd(3)}
    for codec in numcodecs.blosc.list_compressors():
        for shuffle in (0, 1, 2):
            compressors[f"{codec}{shuffle}"] = numcodecs.Blosc(cname=codec, clevel=5, shuffle=shuffle)
    for name, compressor in compressors.items():
        for order, separator, dtype in (("C", ".", "<u2"), ("F", "/", ">i4")):
            path = f"{folder}/{name}{order}.zarr"
            zarr.open_array(path, "w", shape=LABELS.shape, chunks=(16, 17, 18), dtype=dtype, order=order,
                            compressor=compressor, dimension_separator=separator)[:] = LABELS
            compare(path)
    for dtype in ("|b1", "|i1", "|u1", "<i2", "<u4", "<i8", ">u8", "<f4", ">f8"):
        labels = LABELS > 50 if dtype == "|b1" else LABELS
        path = f"{folder}/type_{dtype[1:]}.zarr"
        zarr.open_array(path, "w", shape=LABELS.shape, chunks=(50, 30, 20), dtype=dtype)[:] = labels
        compare(path, labels)
    path = f"{folder}/sparse.zarr"
    array = zarr.open_array(path, "w", shape=(100, 90, 80), chunks=(20, 20, 20), dtype="<u2", fill_value=3,
                            write_empty_chunks=False)
    labels = np.full((100, 90, 80), 3, np.uint16)
    array[41:50, 3:30, 70:] = labels[41:50, 3:30, 70:] = 17
    compare(path, labels)
    assert len(list(pathlib.Path(path).iterdir())) < 10

    # OME-Zarr 0.4 with two resolutions and an axis of channels.
    path = f"{folder}/image.ome.zarr"
    group = zarr.open_group(path, "w")
    for level in (0, 1):
        small = LABELS[::2, ::2, ::2] if level else LABELS
        group.create_dataset(str(level), data=small[None], chunks=(1, 16, 32, 32), dimension_separator="/")
    group.attrs["multiscales"] = [{
        "version": "0.4",
        "axes": [{"name": "c", "type": "channel"}, *({"name": n, "type": "space", "unit": "micrometer"} for n in "zyx")],
        "datasets": [{"path": str(level), "coordinateTransformations": [
            {"type": "scale", "scale": [1, 2.0 * 2**level, 0.5 * 2**level, 0.25 * 2**level]},
            {"type": "translation", "translation": [0, 1.5 * level, 2, 3]}]} for level in (0, 1)]}]
    compare(path, spacing=(0.25, 0.5, 2), origin=(3, 2, 0))
    compare(path + "/0", spacing=(0.25, 0.5, 2), origin=(3, 2, 0))
    compare(path + "/1", LABELS[::2, ::2, ::2], spacing=(0.5, 1, 4), origin=(3, 2, 1.5))

    group = zarr.open_group(f"{folder}/group", "w")
    group.create_dataset("labels", data=LABELS, chunks=(16, 32, 32))
    compare(f"{folder}/group/labels")
    refused(f"{folder}/group", "group of zarr arrays")
    group.create_dataset("filtered", data=LABELS, filters=[numcodecs.Delta("|u1")])
    refused(f"{folder}/group/filtered", "filters")
    group.create_dataset("bz2", data=LABELS, compressor=numcodecs.BZ2())
    refused(f"{folder}/group/bz2", "compressor \"bz2\"")
    group.create_dataset("channels", data=np.stack([LABELS] * 3), chunks=(1, 16, 32, 32))
    refused(f"{folder}/group/channels", "axis 0 has 3 items")

    # Version 3: chunks of numcodecs, metadata by hand.
    path = pathlib.Path(folder, "third.zarr")
    codec = numcodecs.Blosc(cname="zstd")
    for z, y, x in np.ndindex(3, 4, 5):
        chunk = np.zeros((16, 17, 18), "<u2")
        part = LABELS[16 * z:16 * z + 16, 17 * y:17 * y + 17, 18 * x:18 * x + 18]
        chunk[:part.shape[0], :part.shape[1], :part.shape[2]] = part
        file = path / f"c/{z}/{y}/{x}"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(codec.encode(chunk))
    (path / "zarr.json").write_text(json.dumps({
        "zarr_format": 3, "node_type": "array", "shape": LABELS.shape, "data_type": "uint16",
        "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [16, 17, 18]}},
        "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}}, "fill_value": 0,
        "codecs": [{"name": "bytes", "configuration": {"endian": "little"}},
                   {"name": "blosc", "configuration": {"cname": "zstd", "clevel": 5, "shuffle": "shuffle", "typesize": 2}}],
        "attributes": {}, "dimension_names": ["z", "y", "x"]}))
    compare(path)


def tiffs():
    for number, options in enumerate(({}, {"bigtiff": True}, {"byteorder": ">"}, {"compression": "zlib"},
                                      {"tile": (32, 48)}, {"tile": (16, 16), "compression": "zlib"}, {"rowsperstrip": 5},
                                      {"photometric": "minisblack", "metadata": None})):
        for dtype in (np.uint8, np.int16, np.uint16, np.uint32, np.float32):
            path = f"{folder}/{number}{np.dtype(dtype).name}.tif"
            tifffile.imwrite(path, LABELS.astype(dtype), **options)
            compare(path)
    path = f"{folder}/imagej.tif"
    tifffile.imwrite(path, LABELS, imagej=True, resolution=(4, 2), metadata={"spacing": 3.5, "unit": "um", "axes": "ZYX"})
    compare(path, spacing=(0.25, 0.5, 3.5))
    path = f"{folder}/ome.ome.tif"
    tifffile.imwrite(path, LABELS, ome=True, metadata={"axes": "ZYX", "PhysicalSizeX": 0.25, "PhysicalSizeY": 0.5,
                                                       "PhysicalSizeZ": 3.5})
    compare(path, spacing=(0.25, 0.5, 3.5))
    stack = pathlib.Path(folder, "slices")
    stack.mkdir()
    for z, page in enumerate(LABELS):
        tifffile.imwrite(stack / f"slice_{z}.tif", page, compression="zlib" if z % 2 else None)
    compare(stack)
    tifffile.imwrite(stack / "slice_7.tif", LABELS[0, :, :30])
    refused(stack, "slice_7.tif", "30 x 67 pixels")
    path = f"{folder}/rgb.tif"
    tifffile.imwrite(path, np.zeros((4, 30, 30, 3), np.uint8), photometric="rgb")
    refused(path, "page 1", "3 samples")
    path = f"{folder}/half.tif"
    labels = LABELS.astype(np.float32)
    labels[3, 2, 1] = 0.5
    tifffile.imwrite(path, labels)
    refused(path, "page 4", "voxel (1, 2, 3) has the value 0.5")


def hdf5s():
    path = f"{folder}/all.h5"
    with h5py.File(path, "w") as file:
        for name, options in {"plain": {}, "chunked": {"chunks": (16, 17, 18)}, "auto": {"chunks": True},
                              "gzip": {"chunks": (16, 17, 18), "compression": "gzip", "shuffle": True},
                              "checked": {"chunks": (5, 70, 80), "maxshape": (None, 70, 80), "fletcher32": True}}.items():
            for dtype in ("|u1", "<i2", ">u2", "<u4", "<f4"):
                file.create_dataset(f"g/{name}{dtype[1:]}", data=LABELS.astype(dtype), **options)
        file["g/plainu1"].attrs["element_size_um"] = [3.5, 0.5, 0.25]
        file.create_dataset("bool", data=LABELS > 50, chunks=True)
        file.create_dataset("lzf", data=LABELS, compression="lzf")
        file.create_dataset("ilastik", data=LABELS[..., None], chunks=True)
        file["ilastik"].attrs["axistags"] = json.dumps({"axes": [{"key": k} for k in "zyxc"]})
        names = [f"g/{n}" for n in file["g"]]
    for name in names:
        compare(f"{path}:/{name}", spacing=(0.25, 0.5, 3.5) if name == "g/plainu1" else (1, 1, 1))
    compare(f"{path}:/bool", LABELS > 50)
    compare(f"{path}:/ilastik")
    refused(f"{path}", "datasets of three axes")
    done = subprocess.run([VOLUME_LABELS, f"{path}:/lzf", "/dev/null"], capture_output=True, text=True, check=False)
    if done.returncode != 3 or "filter \"lzf\"" not in done.stderr:
        failed(f"lzf: {done.stderr}")


def meshes():
    """Meshes of the same labels have the same bytes, whatever the format."""
    z, y, x = np.mgrid[:24, :26, :28]
    ball = ((z - 12)**2 + (y - 12)**2 + (x - 12)**2 < 90).astype(np.uint8) * (1 + (x > 12)).astype(np.uint8)
    nrrd = pathlib.Path(folder, "ball.nrrd")
    nrrd.write_bytes(b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 28 26 24\nencoding: raw\n\n" + ball.tobytes())
    zarr.open_array(f"{folder}/ball.zarr", "w", shape=ball.shape, chunks=(10, 10, 10), dtype="|u1")[:] = ball
    tifffile.imwrite(f"{folder}/ball.tif", ball)
    with h5py.File(f"{folder}/ball.h5", "w") as file:
        file["a/labels"] = ball
    slices = pathlib.Path(folder, "ball_slices")
    slices.mkdir()
    for number, page in enumerate(ball):
        tifffile.imwrite(slices / f"{number}.tif", page)
    wanted = None
    for name in ("ball.nrrd", "ball_slices", "ball.zarr", "ball.tif", "ball.h5", "ball.h5:/a/labels"):
        out = pathlib.Path(folder, "ball.vtu")
        done = subprocess.run([TETWRIGHT, "prepare", f"{folder}/{name}", "-o", out, "--target-tets", "500", "--quiet"],
                              capture_output=True, text=True, check=False)
        if done.returncode:
            failed(f"{name}: {done.stderr}")
            continue
        mesh = out.read_bytes()
        if wanted is None:
            wanted = mesh
        elif mesh != wanted:
            failed(f"{name}: another mesh than that of ball.nrrd")


with tempfile.TemporaryDirectory() as folder:
    zarrs()
    tiffs()
    hdf5s()
    meshes()
print(f"{count} volumes compared, {len(failures)} failures")
sys.exit(1 if failures else 0)

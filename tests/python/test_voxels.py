# SPDX-License-Identifier: Apache-2.0
"""Arrays of voxels: images, surfaces among labels, and arrays that are read block by block."""
import importlib.util

import numpy as np
import pytest

import tetwright
from tetwright import _voxels

SHAPE = (20, 18, 22)


class Lazy:
    """An array whose parts are made when they are asked for, and which counts them."""

    def __init__(self, values, chunks=None):
        self.values, self.chunks = values, chunks
        self.shape, self.dtype = values.shape, values.dtype
        self.largest, self.read = 0, 0

    def __getitem__(self, key):
        part = self.values[key]
        self.largest = max(self.largest, part.size)
        self.read += part.size
        return part

    def __array__(self, *_):
        raise AssertionError("the array was read as a whole")


def labels():
    grid = np.indices(SHAPE)
    radius = np.linalg.norm(grid - np.reshape([9.5, 8.5, 10.5], (3, 1, 1, 1)), axis=0)
    return ((radius < 8).astype(np.uint8) + (radius < 4)).astype(np.uint8)


def values():
    return (100.0 * np.indices(SHAPE)[0] + np.indices(SHAPE)[2]).astype(np.float32)


@pytest.fixture
def small_blocks(monkeypatch):
    monkeypatch.setattr(_voxels, "BLOCK_BYTES", 4096)


def same(a, b):
    return np.array_equal(a.points, b.points) and np.array_equal(a.tets, b.tets) and \
        np.array_equal(a.materials, b.materials)


def test_labels_are_read_block_by_block(small_blocks):
    expected = tetwright.mesh(labels())
    for chunks in (None, (8, 8, 8), ((16, 4), (9, 9), (11, 11)), (1, 18, 22)):
        lazy = Lazy(labels(), chunks)
        assert same(tetwright.mesh(lazy), expected)
        assert lazy.largest <= 4096
        assert lazy.read <= labels().size + 1  # each voxel once, and one for the type
    # Floats that are labels all the same.
    assert same(tetwright.mesh(Lazy(labels().astype(np.float64), (8, 8, 8))), expected)
    assert same(tetwright.mesh(np.asfortranarray(labels())), expected)


def test_images_are_read_block_by_block(small_blocks):
    image = values()
    expected = tetwright.mesh(image + 0.25, iso=900)
    lazy = Lazy(image + np.float32(0.25), (8, 8, 8))
    assert same(tetwright.mesh(lazy, iso=900), expected)
    assert lazy.largest <= 1024 and lazy.read == image.size + 1
    channels = np.stack([image / 4000, 1 - image / 4000], axis=3)
    lazy = Lazy(channels, (8, 8, 8, 1))
    assert same(tetwright.mesh(lazy, outside_probability=0.1), tetwright.mesh(channels, outside_probability=0.1))
    assert lazy.largest <= 1024


def test_values_and_masks_are_read_block_by_block(small_blocks):
    expected = tetwright.mesh(labels(), values={"q": values()}, values_mask=labels())
    image, mask = Lazy(values(), (8, 8, 8)), Lazy(labels(), (4, 18, 22))
    mesh = tetwright.mesh(labels(), values={"q": image}, values_mask=mask)
    assert np.array_equal(mesh.fields["q"], expected.fields["q"])
    assert image.largest <= 1024 and image.read == image.values.size
    assert mask.largest <= 4096 and mask.read == mask.values.size


@pytest.mark.parametrize("module", [name for name in ("h5py", "zarr", "dask") if importlib.util.find_spec(name)])
def test_arrays_of_libraries(module, tmp_path):
    library = importlib.import_module("dask.array" if module == "dask" else module)
    if module == "h5py":
        file = library.File(tmp_path / "a.h5", "w")
        array = file.create_dataset("labels", data=labels(), chunks=(8, 8, 8))
        image = file.create_dataset("values", data=values())
    elif module == "zarr":
        array, image = (library.array(v, chunks=(8, 8, 8)) for v in (labels(), values()))
    else:
        array, image = (library.from_array(v, chunks=(8, 8, 8)) for v in (labels(), values()))
    expected = tetwright.mesh(labels(), values={"q": values()}, spacing=0.5)
    mesh = tetwright.mesh(array, values={"q": image}, spacing=0.5)
    assert same(mesh, expected) and np.array_equal(mesh.fields["q"], expected.fields["q"])


def test_what_is_wrong_is_named_by_its_place_in_the_array(small_blocks):
    wrong = labels().astype(np.int64)
    wrong[17, 3, 20] = 2**40
    with pytest.raises(tetwright.InputError, match=r"at \(17, 3, 20\)"):
        tetwright.mesh(Lazy(wrong, (8, 8, 8)))
    image = values()
    image[17, 3, 20] = np.nan
    with pytest.raises(tetwright.InputError, match=r"voxel \(17, 3, 20\) has the value nan"):
        tetwright.mesh(Lazy(image, (8, 8, 8)), iso=900)
    with pytest.raises(tetwright.InputError, match="three axes"):
        tetwright.mesh(labels(), values_mask=Lazy(np.zeros(SHAPE + (2,), np.uint8)), values={"q": values()})


def test_too_large_arrays_are_refused_before_they_are_read():
    class Huge:
        shape, dtype = (4000, 4000, 4000), np.dtype(np.uint8)

        def __getitem__(self, key):
            assert all(part.stop - part.start == 1 for part in key), "a block was read"
            return np.zeros((1, 1, 1), np.uint8)

    with pytest.raises(tetwright.OutputError, match="238.4.* GB"):
        tetwright.mesh(Huge(), memory_limit=8)
    image = Lazy(values())
    with pytest.raises(tetwright.OutputError, match="beside the"):
        tetwright.mesh(labels(), values={"a": image, "b": image}, memory_limit=5e-5)


def test_images():
    axis = np.arange(20) - 9.5
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    inside = 7 - np.sqrt(x * x + y * y + z * z)  # distance, positive inside
    mesh = tetwright.mesh(inside, iso={"core": 4, "shell": 0}, voxel_size=0.5)
    volumes = {m["name"]: m["volume"] for m in mesh.stats["result"]["materials"]}
    ball = lambda r: 4 / 3 * np.pi * r**3
    assert abs(volumes["core"] - ball(3)) < 0.1 * ball(3)  # the trilinear image cuts off what is convex
    assert abs(volumes["shell"] - (ball(7) - ball(3))) < 0.02 * ball(7)
    assert len(tetwright.mesh(inside, iso="auto").tets) > 0
    maps = np.stack([1 / (1 + np.exp(-inside - 3)), np.zeros_like(inside)], axis=3)
    assert len(tetwright.mesh(maps, outside_probability=0.5, smooth=0.5).tets) > 0
    for probability in (-0.1, 1.5):
        with pytest.raises(tetwright.UsageError, match=str(probability)):
            tetwright.mesh(maps, outside_probability=probability)
    with pytest.raises(tetwright.InputError, match="--iso"):
        tetwright.mesh(inside)
    with pytest.raises(tetwright.Error, match="from"):
        tetwright.mesh(inside, iso=50)


def test_arrays_of_fractions_are_images():
    image = np.zeros((4, 4, 4), np.float64)
    image[1, 2, 3] = 0.5
    with pytest.raises(tetwright.InputError, match=r"voxel \(1, 2, 3\) has the value 0.5, not a whole number; .*--iso"):
        tetwright.mesh(image)
    image[1, 2, 3] = np.nan
    with pytest.raises(tetwright.InputError, match=r"voxel \(1, 2, 3\) has the value nan, not a finite number"):
        tetwright.mesh(image)
    with pytest.raises(tetwright.InputError, match="2 channels; a volume with one label per voxel is needed"):
        tetwright.mesh(np.zeros((4, 4, 4, 2), np.float32))
    with pytest.raises(tetwright.InputError, match="not finite or lie in a plane"):
        tetwright.mesh(np.full((4, 4, 4), 0.5), affine=np.zeros((4, 4)))


def test_surfaces_carve_labels():
    labels = np.zeros((16, 16, 16), np.uint8)
    labels[2:14, 2:14, 2:8] = 1
    labels[2:14, 2:14, 8:14] = 2
    low, high = np.array([5.2, 5.3, 4.9]), np.array([9.1, 9.4, 11.2])
    points = np.array([np.where([k & 1, k & 2, k & 4], high, low) for k in range(8)])
    triangles = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6),
                 (0, 6, 2), (1, 3, 7), (1, 7, 5)]
    def volumes(**options):
        mesh = tetwright.mesh(labels, material={"block": (points, np.array(triangles))}, **options)
        return {m["name"]: m["volume"] for m in mesh.stats["result"]["materials"]}
    assert abs(volumes()["block"] - np.prod(high - low)) < 1e-3
    for kept in ([2], [(2, 5)], ["label_2"], 2):
        assert abs(volumes(protect_labels=kept)["label_2"] - 12 * 12 * 6) < 0.01 * 12 * 12 * 6, kept
    with pytest.raises(tetwright.UsageError, match="'bone'"):
        volumes(protect_labels=["bone"])


def test_counts_too_small_for_a_thin_label_are_noted():
    grid = np.indices((24, 24, 24)) - 11.5
    radius = np.linalg.norm(grid, axis=0)
    skinned = (radius < 9).astype(np.uint8) + (radius < 10.5)
    with pytest.warns(tetwright.ShortfallWarning):
        few = tetwright.prepare(skinned, target_tets=300, threads=1)
    needs = {m["name"]: m["tets"] for m in few.stats["min_tets"]}
    assert needs["label_1"] > 3 * needs["label_2"]
    assert [d.code for d in few.diagnostics].count("target-too-small") == 1
    assert any("300 is too small for good shapes: the materials take at least about " in note for note in few.notes)

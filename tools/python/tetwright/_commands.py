# SPDX-License-Identifier: Apache-2.0
"""The program's commands as functions."""
from __future__ import annotations

import os
import pathlib
import sys
import warnings
from typing import Any, Callable, Optional, Union

from . import _core
from ._embedding import Embedding, embedding_of
from ._inputs import Inputs, is_file
from ._mesh import CheckResult, ShortfallWarning, TetMesh
from ._options import arguments_of, images_of, materials_of
from ._text import file_name, plain_text

Progress = Union[bool, Callable[[str, float], None], None]


def prepare(scan: Any, *, target_tets: Optional[int] = None, tolerance: Union[float, str, None] = None,
            spacing: Any = None, origin: Any = None, affine: Any = None, progress: Progress = None,
            **options: Any) -> TetMesh:
    """Turns scans or a segmented volume into a simulation mesh.

    scan -- a surface, a list of surfaces, or a dict from names of materials to surfaces (names are kept unchanged;
        later surfaces carve earlier ones); or one array of labels of shape (nx, ny, nz), whole numbers, where 0 is
        outside; other floats, and arrays of shape (nx, ny, nz, channels), are images. Arrays of zarr, h5py, dask and
        alike are read block by block
    target_tets -- target number of tets; without it `tolerance` or `size_field` is required
    size_field -- edge lengths by location: a file, arrays (points (n, 3), tets (m, 4) or triangles (m, 3), lengths
        (n,)), or a mesh of meshio or pyvista whose points have them as "size"
    tolerance -- maximum distance between the surfaces of mesh and scan, in input units or "0.2%" of the diagonal
    spacing, origin -- for an array of voxels (and spacing alone for a volume in a file): distance between voxels, in input units (one number or three), and the
        centre of voxel (0, 0, 0); alternatively affine, a (4, 4) matrix that maps indices to positions
    progress -- a function of (stage, fraction from 0 to 1), called from this thread; True shows a bar, using tqdm if
        it is installed
    options -- those of `tetwright prepare --help`: threads=2, seed=7, min_solid_angle=0.1, material={"bone": surface},
        layer={"skin": 2.0}, keep_outside=True, order=2, labels=[1, (5, 9)]; output="file.vtu" also writes the mesh

    Raises a subclass of Error; issues a ShortfallWarning for each request that was not met.
    """
    inputs = Inputs(spacing, origin, affine, options.get("memory_limit"))
    options.update(target_tets=target_tets, tolerance=tolerance)
    return _run("prepare", inputs, _scans(scan, inputs, options), options, progress)


def mesh(scan: Any, *, tolerance: Union[float, str, None] = None, spacing: Any = None, origin: Any = None,
         affine: Any = None, progress: Progress = None, **options: Any) -> TetMesh:
    """Turns scans or a segmented volume into a dense mesh, as `prepare` does before it simplifies. Arguments are
    those of `prepare`, options those of `tetwright mesh --help`: resolution=128, voxel_size=0.5."""
    inputs = Inputs(spacing, origin, affine, options.get("memory_limit"))
    options.update(tolerance=tolerance)
    return _run("mesh", inputs, _scans(scan, inputs, options), options, progress)


def simplify(tets: Any, *, target_tets: Optional[int] = None, tolerance: Union[float, str, None] = None,
             progress: Progress = None, **options: Any) -> TetMesh:
    """Simplifies a tet mesh to fewer tets. The mesh is a TetMesh, a file, (points, tets) or (points, tets, materials)
    arrays of shapes (n, 3), (m, 4) and (m,), or a mesh of meshio or pyvista. Options are those of `tetwright simplify
    --help`."""
    inputs = Inputs()
    options.update(target_tets=target_tets, tolerance=tolerance)
    return _run("simplify", inputs, [inputs.add(tets, "mesh")], options, progress)


def improve(tets: Any, *, progress: Progress = None, **options: Any) -> TetMesh:
    """Improves the shapes of a tet mesh at about the same number of tets. The mesh is as for `simplify`; options are
    those of `tetwright improve --help`: only_below=0.1, free_count=True."""
    inputs = Inputs()
    return _run("improve", inputs, [inputs.add(tets, "mesh")], options, progress)


def values(tets: Any, images: Any, *, spacing: Any = None, origin: Any = None, affine: Any = None,
           progress: Progress = None, **options: Any) -> TetMesh:
    """Adds the values of images to a tet mesh, which otherwise stays as it is: the mean over each tet as a field of
    the tets, and the value at each point as a point field.

    tets -- as for `simplify`
    images -- a dict from the names of the fields to images: files, arrays of values of shape (nx, ny, nz), also of
        zarr, h5py and dask, or images of nibabel
    spacing, origin, affine -- for arrays, as for `prepare`
    options -- those of `tetwright values --help`: values_mask=array, values_statistics=["min", "max"],
        bins={"density": 8}, modulus={"density": [6850, 1.49]}, min_modulus=1
    """
    inputs = Inputs(spacing, origin, affine, options.get("memory_limit"))
    if not isinstance(images, dict):
        raise _core.UsageError(f"images is a {type(images).__name__}; give a dict from names of fields to images")
    names = [inputs.add(tets, "mesh")]
    return _run("values", inputs, names + images_of(images, inputs), options, progress)


def embed(mesh: Any, surface: Any, *, progress: Progress = None, **options: Any) -> Embedding:
    """Finds the weights by which a tet mesh carries the points of a finer surface, for simulations of soft bodies: for
    each point the tet that contains it and its barycentric coordinates there; outside the mesh those of the nearest
    point of the nearest tet, and the distance.

    mesh -- as for `simplify`
    surface -- a file, (points, triangles), or a mesh of trimesh, meshio or pyvista
    options -- those of `tetwright embed --help`: threads=2; output="weights.npz" also writes the arrays

    `Embedding.carry(points)` moves the surface along with the mesh.
    """
    inputs = Inputs()
    names = [inputs.add(mesh, "mesh"), inputs.add(surface, "surface")]
    arguments = arguments_of("embed", names, options, inputs)
    inputs.finish()
    with _shown(progress) as callback:
        return embedding_of(*_core.embed(arguments, inputs.core, callback))


def check(tets: Any, *, surface: Any = None, before: Any = None, tolerance: Union[float, str, None] = None,
          progress: Progress = None, **options: Any) -> CheckResult:
    """Checks validity, topology and quality of a tet mesh, and measures its distance from surfaces.

    surface -- one or several surfaces (list or dict) with which the mesh is compared: proven bounds of the largest
        distances in both directions
    before -- another mesh, which must have the same topology
    tolerance -- the result is true only if the distance between mesh and surfaces is proven to be at most this

    The result has the contents of `tetwright check --json`; bool(result) tells whether the mesh passed.
    """
    inputs = Inputs()
    if isinstance(surface, dict):
        inputs.reserve(map(str, surface))
    names = [inputs.add(tets, "mesh")]
    if before is not None:
        options["before"] = inputs.add(before, "mesh before")
    if surface is not None:
        options["surface"] = _several(surface, inputs)
    options["tolerance"] = tolerance
    arguments = arguments_of("check", names, options, inputs)
    inputs.finish()
    with _shown(progress) as callback:
        return CheckResult(*_core.check(arguments, inputs.core, callback))


def read(path: Union[str, os.PathLike], *, material_field: str = "") -> TetMesh:
    """Reads a tet mesh from a file in any format that the program can read."""
    return TetMesh(_core.read(file_name(path, "path"), plain_text(material_field, "material_field")))


def _run(command: str, inputs: Inputs, names: list[bytes], options: dict[str, Any], progress: Progress) -> TetMesh:
    if (spacing := inputs.spacing_of_files()) is not None:
        options["spacing"] = spacing
    arguments = arguments_of(command, names, options, inputs)
    inputs.finish()
    with _shown(progress) as callback:
        result = TetMesh(_core.run(arguments, inputs.core, callback))
    for message in result.shortfall:
        warnings.warn(message, ShortfallWarning, stacklevel=3)
    return result


def _several(value: Any, inputs: Inputs) -> list[bytes]:
    """Returns the names of one or several surfaces; a tuple of two arrays is one surface."""
    if isinstance(value, dict):
        return [inputs.add(v, str(k), made_up=False) for k, v in value.items()]
    if isinstance(value, list):
        inputs.reserve(pathlib.PurePath(os.fsdecode(v)).stem for v in value if is_file(v))
        return [inputs.add(v, f"surface_{i + 1}") for i, v in enumerate(value)]
    return [inputs.add(value, "surface")]


def _scans(value: Any, inputs: Inputs, options: dict[str, Any]) -> list[bytes]:
    """Returns the positional inputs; files in a dict become materials with the names of their keys."""
    materials = materials_of(options.pop("material", None))
    layers = options.get("layer")
    named = [name for name, _ in materials] + [str(k) for k in (layers if isinstance(layers, dict) else ())]
    inputs.reserve(named)
    of_options = isinstance(value, dict) and any(is_file(v) for v in value.values())
    names = [] if of_options else _several(value, inputs)
    if of_options:
        materials = materials_of(value) + materials
    if materials:
        options["material"] = materials
    return names


class _shown:
    """The progress callback of a call: the caller's, that of a bar, or none."""

    def __init__(self, progress: Progress):
        self._bar = None
        self._stage = ""
        self.callback = self._show if progress is True else progress if callable(progress) else None

    def __enter__(self) -> Optional[Callable[[str, float], None]]:
        return self.callback

    def __exit__(self, *_: Any) -> None:
        if self._bar is not None:
            self._bar.close()
        elif self._stage:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)

    def _show(self, stage: str, fraction: float) -> None:
        try:
            from tqdm.auto import tqdm
        except ImportError:
            print(f"\r\x1b[K{stage} {fraction:.0%}", end="", file=sys.stderr, flush=True)
        else:
            if self._bar is None:
                self._bar = tqdm(total=1.0, bar_format="{desc} {percentage:3.0f}%|{bar}| {elapsed}")
            if stage != self._stage:
                self._bar.reset()
                self._bar.set_description(stage)
            self._bar.n = fraction
            self._bar.refresh()
        self._stage = stage

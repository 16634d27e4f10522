# SPDX-License-Identifier: Apache-2.0
"""Compares the Python package with the program: the same bytes, views without copies, errors, cancellation, threads."""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import threading
import time
import types
import warnings

import meshio
import nibabel
import numpy as np
import pytest
import tetwright

PROGRAM = os.environ["TETWRIGHT_PROGRAM"]


def run_program(*arguments, status=0):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == status, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def ball(tmp_path_factory):
    path = tmp_path_factory.mktemp("data") / "ball.ply"
    run_program("sample", "sphere", "-o", path)
    return path


@pytest.fixture(scope="module")
def ball_arrays(ball):
    read = meshio.read(ball)
    return read.points, read.cells_dict["triangle"]


@pytest.fixture(scope="module")
def prepared(ball):
    return tetwright.prepare(ball, target_tets=800)


def labels_of_two_balls():
    x, y, z = np.meshgrid(*[np.arange(24)] * 3, indexing="ij")
    labels = np.zeros((24, 24, 24), np.uint8)
    labels[(x - 11.5) ** 2 + (y - 11.5) ** 2 + (z - 11.5) ** 2 < 100] = 1
    labels[(x - 11.5) ** 2 + (y - 11.5) ** 2 + (z - 14.5) ** 2 < 25] = 7
    return labels


def test_gives_the_bytes_of_the_program(tmp_path, ball, ball_arrays, prepared):
    run_program("prepare", ball, "--target-tets", 800, "-o", tmp_path / "program.vtu")
    expected = (tmp_path / "program.vtu").read_bytes()
    prepared.write(tmp_path / "python.vtu")
    assert (tmp_path / "python.vtu").read_bytes() == expected
    # Arrays instead of a file, with the file's name, on one thread.
    tetwright.prepare({"ball": ball_arrays}, target_tets=800, threads=1).write(tmp_path / "arrays.vtu")
    assert (tmp_path / "arrays.vtu").read_bytes() == expected
    # Written by the call.
    tetwright.prepare(str(ball), target_tets=800, output=tmp_path / "output.vtu", stats=tmp_path / "s.json")
    assert (tmp_path / "output.vtu").read_bytes() == expected
    assert (tmp_path / "s.json").exists()


def test_several_arrays_are_masks():
    masks = {name: np.zeros((12, 12, 12), np.uint8) for name in ("liver", "tumour")}
    masks["liver"][2:8, 2:10, 2:10] = 1
    masks["tumour"][6:11, 2:10, 2:10] = 255
    mesh = tetwright.mesh(masks)
    assert mesh.material_names == {1: "liver", 2: "tumour"}
    assert "128 voxels in several masks, in 1 pair" in mesh.notes[0]
    with pytest.raises(tetwright.InputError, match="overlap in 128 voxels"):
        tetwright.mesh(masks, on_overlap="error")


def test_labels_give_the_bytes_of_the_program(tmp_path):
    labels = labels_of_two_balls()
    with open(tmp_path / "v.nrrd", "wb") as file:
        file.write(b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 24 24 24\nencoding: raw\nspace dimension: 3\n"
                   b"space directions: (2,0,0) (0,2,0) (0,0,3)\nspace origin: (1,2,3)\n\n")
        file.write(labels.tobytes(order="F"))
    run_program("prepare", tmp_path / "v.nrrd", "--target-tets", 900, "-o", tmp_path / "program.vtu")
    mesh = tetwright.prepare(labels, spacing=(2, 2, 3), origin=(1, 2, 3), target_tets=900)
    mesh.write(tmp_path / "python.vtu")
    assert (tmp_path / "python.vtu").read_bytes() == (tmp_path / "program.vtu").read_bytes()
    assert mesh.material_names == {1: "label_1", 7: "label_7"}
    affine = np.diag([2, 2, 3, 1.0])
    affine[:3, 3] = 1, 2, 3
    image = types.SimpleNamespace(affine=affine, dataobj=labels.astype(float))
    for again in (tetwright.prepare(labels, affine=affine, target_tets=900),
                  tetwright.prepare(image, target_tets=900)):
        assert np.array_equal(again.points, mesh.points) and np.array_equal(again.tets, mesh.tets)
    only = tetwright.prepare(labels, target_tets=300, labels=[(5, 9)])
    assert set(only.materials.tolist()) == {7}


def test_values_of_images_are_those_of_the_program(tmp_path):
    labels = labels_of_two_balls()
    gray = 10.0 * np.indices((24, 24, 24))[0] + 0.5
    header = b"dimension: 3\nsizes: 24 24 24\nencoding: raw\nendian: little\nspace dimension: 3\n" \
             b"space directions: (2,0,0) (0,2,0) (0,0,3)\nspace origin: (1,2,3)\n\n"
    for name, kind, data in (("v", b"uchar", labels), ("gray", b"float", gray.astype("<f4"))):
        (tmp_path / f"{name}.nrrd").write_bytes(b"NRRD0004\ntype: " + kind + b"\n" + header + data.tobytes(order="F"))
    run_program("prepare", tmp_path / "v.nrrd", "--target-tets", 900, "-o", tmp_path / "program.inp", "--values",
                f"gray={tmp_path / 'gray.nrrd'}", "--values-mask", "labels", "--values-statistics", "min,max", "--bins",
                "gray=3", "--modulus", "gray=2,1.5,0.1,1", "--min-modulus", 1)
    options = dict(target_tets=900, values_mask="labels", values_statistics=["min", "max"], bins={"gray": 3},
                   modulus={"gray": [2, 1.5, 0.1, 1]}, min_modulus=1)
    mesh = tetwright.prepare(labels, spacing=(2, 2, 3), origin=(1, 2, 3), values={"gray": gray}, **options)
    mesh.write(tmp_path / "python.inp")
    assert (tmp_path / "python.inp").read_bytes() == (tmp_path / "program.inp").read_bytes()
    assert (tmp_path / "python_bins.csv").read_text() == (tmp_path / "program_bins.csv").read_text()
    assert set(mesh.fields) == {"gray", "gray_min", "gray_max", "gray_bin"} and set(mesh.point_fields) == {"gray"}
    assert [b["name"] for b in mesh.stats["bins"][0]["each"]][0] == "label_1_001"
    # On a mesh from elsewhere, by arrays, files and images of nibabel, and a mask.
    centres = mesh.points[mesh.tets].mean(axis=1)
    expected = 10 * (centres[:, 0] - 1) / 2 + 0.5
    affine = np.diag([2, 2, 3, 1.0])
    affine[:3, 3] = 1, 2, 3
    arrays = (mesh.points, mesh.tets)
    for image, placed in ((gray, dict(affine=affine)), (tmp_path / "gray.nrrd", {}),
                          (types.SimpleNamespace(affine=affine, dataobj=gray), {})):
        again = tetwright.values(arrays, {"g": image}, **placed)
        assert np.array_equal(again.tets, mesh.tets) and np.allclose(again.fields["g"], expected, atol=1e-4)
    masked = tetwright.values(arrays, {"g": gray}, affine=affine, values_mask=(gray > 100).astype(int))
    assert masked.fields["g"].min() >= 100.5
    better = tetwright.improve(mesh, values={"g": tmp_path / "gray.nrrd"})
    assert better.fields["g"].shape == (len(better.tets),)
    with pytest.raises(tetwright.InputError, match="no part of the image is in mesh"):
        tetwright.values(arrays, {"g": gray}, origin=(500, 0, 0))
    with pytest.raises(tetwright.UsageError, match="give a dict from names of fields to images"):
        tetwright.values(arrays, gray)
    both = tetwright.values(arrays, {"a": gray, "b": gray}, bins={"a": 2, "b": [50.0]}, affine=affine)
    assert {"a_bin", "b_bin"} < set(both.fields) and [b["values"] for b in both.stats["bins"]] == ["a", "b"]
    with pytest.raises(tetwright.UsageError, match="only one is possible"):
        tetwright.values(arrays, {"a": gray, "b": gray}, bins={"a": 2, "b": 2}, modulus={"a": [1, 1], "b": [1, 1]})


def test_bricks_give_the_bytes_of_the_program(tmp_path):
    labels = np.zeros((40, 20, 20), np.uint8)
    labels[3:37, 3:17, 3:17] = 1
    labels[25:31, 6:14, 6:14] = 2
    with open(tmp_path / "v.nrrd", "wb") as file:
        file.write(b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 40 20 20\nencoding: raw\nspacings: 1 1 1\n\n")
        file.write(labels.tobytes(order="F"))
    run_program("prepare", tmp_path / "v.nrrd", "--target-tets", 900, "--voxel-size", 1, "--bricks", 32,
                "-o", tmp_path / "program.vtu")
    expected = meshio.read(tmp_path / "program.vtu")
    for options in (dict(bricks=32), dict(bricks=np.int64(32), scratch=tmp_path / "bricks")):
        mesh = tetwright.prepare(labels, target_tets=900, voxel_size=1, **options)
        assert np.array_equal(mesh.tets, expected.cells_dict["tetra"])
        assert np.array_equal(mesh.points - mesh.points[0], expected.points - expected.points[0])
        assert mesh.stats["dense"]["bricks"]["count"] == 2
    assert not (tmp_path / "bricks").exists()
    with pytest.raises(tetwright.UsageError, match="--bricks: '33' is not auto, off or a power of two"):
        tetwright.prepare(labels, target_tets=900, bricks=33)


def test_images_of_nibabel(tmp_path):
    labels = labels_of_two_balls()
    affine = np.diag([2, 2, 3, 1.0])
    affine[:3, 3] = 1, 2, 3
    made = nibabel.Nifti1Image(labels.astype(np.uint8), affine)
    nibabel.save(made, tmp_path / "v.nii.gz")
    expected = tetwright.prepare(labels, affine=affine, target_tets=900)
    # In memory, loaded on demand from the file, and by Tetwright's own reader.
    for image in (made, nibabel.load(tmp_path / "v.nii.gz"), tmp_path / "v.nii.gz"):
        mesh = tetwright.prepare(image, target_tets=900)
        assert np.array_equal(mesh.points, expected.points) and np.array_equal(mesh.tets, expected.tets)
        assert np.array_equal(mesh.materials, expected.materials)


def test_arrays_are_views_that_keep_the_mesh_alive(ball):
    mesh = tetwright.mesh(ball, resolution=16)
    points, tets = mesh.points, mesh.tets
    assert points.dtype == np.float64 and points.shape[1] == 3
    assert tets.dtype == np.uint32 and tets.shape[1] == 4
    assert mesh.materials.shape == (len(tets),)
    assert np.shares_memory(points, mesh.points) and np.shares_memory(tets, mesh.tets)
    faces = mesh.interfaces
    assert np.shares_memory(faces.triangles, faces.triangles) and faces.on_boundary.all()
    assert faces.material.tolist() == [1] * len(faces)
    with pytest.raises(ValueError):
        points[0, 0] = 1
    before = points.copy()
    del mesh, faces
    assert np.array_equal(points, before)
    volume = np.linalg.det(points[tets[:, 1:]] - points[tets[:, :1]]).sum() / 6
    assert volume == pytest.approx(4 / 3 * np.pi, rel=0.1)


def test_options_and_stats(ball):
    mesh = tetwright.prepare(ball, target_tets=500, seed=7, min_solid_angle=0.05, keep_outside=True)
    assert mesh.stats["command"] == "prepare"
    assert mesh.stats["result"]["tets"] == len(mesh.tets)
    assert "outside" in mesh.material_names.values()
    two = tetwright.mesh(ball, resolution=16, layer={"skin": 0.2}, feature_angle="off")
    assert set(two.material_names.values()) == {"ball", "skin"}
    assert not two.interfaces.on_boundary.all()
    assert not two.interfaces.on_sheet.any()


def test_simplify_improve_and_check(ball, prepared):
    fewer = tetwright.simplify(prepared, target_tets=400)
    assert len(fewer.tets) == pytest.approx(400, rel=0.02)
    as_arrays = tetwright.simplify((prepared.points, prepared.tets, prepared.materials), target_tets=400)
    assert len(as_arrays.tets) == pytest.approx(400, rel=0.02)
    better = tetwright.improve(fewer, free_count=True)
    assert tetwright.check(better, before=prepared)
    near = tetwright.check(prepared, surface=ball, tolerance="5%")
    assert near and near["tolerance"]["held"]
    far = tetwright.check(prepared, surface={"ball": ball}, tolerance=1e-3)
    assert not far and far["surface"]["from_mesh"]["upper"] > 1e-3
    # Several calls may use the same mesh.
    assert len(tetwright.simplify(prepared, target_tets=400).tets) == len(fewer.tets)


def test_second_order(tmp_path, ball):
    mesh = tetwright.prepare(ball, target_tets=300, order=2)
    assert mesh.tets10.shape == (len(mesh.tets), 10)
    assert mesh.tets10.max() == len(mesh.points) + len(mesh.midside_points) - 1
    mesh.write(tmp_path / "ten.vtu")
    assert np.array_equal(meshio.read(tmp_path / "ten.vtu").cells_dict["tetra10"], mesh.tets10)


def test_other_libraries_objects(ball_arrays, prepared):
    points, triangles = ball_arrays
    polygons = np.hstack([np.full((len(triangles), 1), 3), triangles]).ravel()
    surfaces = [meshio.Mesh(points, [("triangle", triangles)]),
                types.SimpleNamespace(vertices=points, faces=triangles),  # trimesh
                types.SimpleNamespace(points=points, faces=polygons)]     # pyvista
    for surface in surfaces:
        assert len(tetwright.mesh(surface, resolution=8, accept_changes=True).tets) > 0
    mesh = prepared.to_meshio()
    assert [block.type for block in mesh.cells] == ["tetra", "triangle"]
    assert len(tetwright.simplify(mesh, target_tets=400).tets) == pytest.approx(400, rel=0.02)


def test_size_fields_are_files_arrays_or_meshes(tmp_path, ball):
    corners = np.array([[-9, -9, -9], [27, -9, -9], [-9, 27, -9], [-9, -9, 27]], float)
    tets, lengths = np.array([[0, 1, 2, 3]]), np.array([0.5, 0.9, 0.5, 0.5])
    grid = meshio.Mesh(corners, {"tetra": tets}, point_data={"size": lengths})
    grid.write(tmp_path / "sizes.vtu")
    dense = tetwright.mesh(ball, resolution=8)
    by_file = tetwright.simplify(dense, size_field=tmp_path / "sizes.vtu")
    assert by_file.stats["edge_lengths"]["field"] == "size"
    for field in (corners, tets, lengths), grid:
        assert np.array_equal(tetwright.simplify(dense, size_field=field).points, by_file.points)
    # Lengths at the points of a surface, growing away from it.
    surface = meshio.read(ball)
    assert tetwright.simplify(dense, size_field=(surface.points, surface.cells_dict["triangle"],
                                                 np.full(len(surface.points), 0.5))).stats["edge_lengths"]["edges"]
    with pytest.raises(tetwright.InputError, match="one for each of the 4 points"):
        tetwright.simplify(dense, size_field=(corners, tets, lengths[:3]))
    with pytest.raises(tetwright.InputError, match="refers to point 4"):
        tetwright.simplify(dense, size_field=(corners, tets + 1, lengths))
    del grid.point_data["size"]
    with pytest.raises(tetwright.InputError, match="no field size"):
        tetwright.simplify(dense, size_field=grid)


def test_sizes_that_cannot_be_measured_and_large_integers():
    points, tets = np.vstack([np.zeros(3), np.eye(3)]), np.array([[0, 1, 2, 3]])
    for scale in 1e150, 1e-150:
        with pytest.raises(tetwright.InputError, match="too large or too small"):
            tetwright.check((points * scale, tets))
    mesh = meshio.Mesh(points, {"tetra": tets}, point_data={"id": np.array([1, 2, 3, 2**53 + 1])})
    assert any("2^53" in note for note in tetwright.improve(mesh).notes)
    mesh.point_data["id"][3] = 2**53 - 1
    assert not any("2^53" in note for note in tetwright.improve(mesh).notes)


def test_report_is_written(tmp_path, ball):
    tetwright.prepare(ball, target_tets=800, output=tmp_path / "out.vtu", report=tmp_path / "page.html")
    page = (tmp_path / "page.html").read_text()
    assert page.startswith("<!doctype html>") and "solid angle" in page


def test_errors_carry_the_programs_message(ball, ball_arrays):
    points, triangles = ball_arrays
    with pytest.raises(tetwright.UsageError, match="there is no option --target-tet of prepare") as caught:
        tetwright.prepare(ball, target_tet=5)
    assert caught.value.status == 2 and isinstance(caught.value, ValueError)
    with pytest.raises(tetwright.UsageError, match="--target-tets is required"):
        tetwright.prepare(ball)
    with pytest.raises(tetwright.UsageError, match="affine includes spacing"):
        tetwright.prepare(labels_of_two_balls(), target_tets=9, spacing=1, affine=np.eye(4))
    with pytest.raises(tetwright.UsageError, match="no input is one"):
        tetwright.prepare(ball, target_tets=9, spacing=1)
    with pytest.raises(tetwright.InputError, match="nowhere.ply"):
        tetwright.prepare("nowhere.ply", target_tets=5)
    with pytest.raises(tetwright.InputError, match="refers to point 99999999"):
        tetwright.mesh((points, np.array([[0, 1, 99999999]])))
    with pytest.raises(tetwright.InputError, match="refers to point -1"):
        tetwright.mesh((points, np.array([[0, 1, -1]])))
    with pytest.raises(tetwright.InputError, match="not finite"):
        tetwright.mesh((np.full((3, 3), np.nan), np.array([[0, 1, 2]])))
    with pytest.raises(tetwright.InputError, match="give one of shape"):
        tetwright.mesh((points[:, :2], triangles))
    with pytest.raises(tetwright.InputError, match="not a whole number"):
        tetwright.mesh(np.full((4, 4, 4), 0.5))
    with pytest.raises(tetwright.InputError, match="is a int"):
        tetwright.mesh(5)
    with pytest.raises(tetwright.NothingToMeshError):
        tetwright.mesh(np.zeros((4, 4, 4), int))
    with pytest.raises(tetwright.OutputError) as caught:
        tetwright.mesh(ball, resolution=8, accept_changes=True).write("/nowhere/at/all.vtu")
    assert isinstance(caught.value, OSError)


def test_arrays_and_files_of_numpy(tmp_path):
    labels = labels_of_two_balls()
    expected = tetwright.mesh(labels, spacing=(1, 2, 3), resolution=12)
    # In a file the axis that varies fastest is x.
    np.save(tmp_path / "c.npy", np.ascontiguousarray(labels.transpose()))
    np.save(tmp_path / "f.npy", np.asfortranarray(labels.astype(np.float32)))
    labels.transpose().astype(">i4").tofile(tmp_path / "v.raw")
    for file, options in (("c.npy", {}), ("f.npy", {}),
                          ("v.raw", dict(dimensions=labels.shape, voxel_type="int32be"))):
        made = tetwright.mesh(tmp_path / file, spacing=(1, 2, 3), resolution=12, **options)
        assert np.array_equal(made.points, expected.points) and np.array_equal(made.tets, expected.tets), file
    assert np.array_equal(tetwright.mesh(labels.astype(float), spacing=(1, 2, 3), resolution=12).points,
                          expected.points)


def test_what_falls_short_is_a_warning(ball):
    with pytest.warns(tetwright.ShortfallWarning, match="tolerance"):
        mesh = tetwright.prepare(ball, target_tets=200, tolerance="1%", resolution=12)
    assert mesh.shortfall
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert tetwright.prepare(ball, target_tets=800).shortfall == []


def test_progress_comes_in_the_callers_thread(ball):
    seen = []
    tetwright.prepare(ball, target_tets=5000, progress=lambda stage, f: seen.append((stage, f, threading.get_ident())))
    assert len({stage for stage, _, _ in seen}) > 1
    assert all(0 <= fraction <= 1 and thread == threading.get_ident() for _, fraction, thread in seen)
    tetwright.prepare(ball, target_tets=800, progress=True)

    def fail(stage, fraction):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        tetwright.prepare(ball, target_tets=50000, progress=fail)


def test_ctrl_c_cancels(ball):
    threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        tetwright.mesh(ball, resolution=600)
    assert time.monotonic() - start < 60


def test_calls_run_side_by_side(ball, prepared):
    results = {}

    def work(threads):
        results[threads] = tetwright.prepare(ball, target_tets=800, threads=threads)

    workers = [threading.Thread(target=work, args=(n,)) for n in (1, 2, 3)]
    ticks = 0
    for worker in workers:
        worker.start()
    while any(worker.is_alive() for worker in workers):
        ticks += 1  # the interpreter's lock is released
        time.sleep(0.001)
    assert ticks > 5
    for mesh in results.values():
        assert np.array_equal(mesh.points, prepared.points) and np.array_equal(mesh.tets, prepared.tets)


def test_documentation_and_version():
    for name in tetwright.__all__:
        assert getattr(tetwright, name).__doc__ or name == "__version__", name
    assert tetwright.__version__ in run_program("--version")
    root = pathlib.Path(os.environ["TETWRIGHT_SOURCE"])
    assert f'version = "{tetwright.__version__}"' in (root / "pyproject.toml").read_text()


def test_the_example_runs(tmp_path, ball):
    example = pathlib.Path(os.environ["TETWRIGHT_SOURCE"]) / "tools/python/examples/scan_and_labels.py"
    done = subprocess.run([sys.executable, example, ball, tmp_path / "scan.vtu"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "tets" in done.stdout and (tmp_path / "scan.vtu").exists()


def test_pip_installs_it(tmp_path):
    # From a copy of the required files, since setuptools writes into its source folder.
    root = pathlib.Path(os.environ["TETWRIGHT_SOURCE"])
    copy = tmp_path / "source"
    (copy / "tools").mkdir(parents=True)
    for file in ("pyproject.toml", "README.md"):
        shutil.copy(root / file, copy)
    shutil.copytree(root / "tools/python", copy / "tools/python")
    done = subprocess.run([sys.executable, "-m", "pip", "install", "--no-build-isolation", "--no-deps", "--no-index",
                           "--disable-pip-version-check", "--target", tmp_path / "site", copy],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    program = "import tetwright; print(tetwright.__file__, tetwright.__version__)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": str(tmp_path / "site")})
    assert done.returncode == 0, done.stderr
    assert str(tmp_path / "site") in done.stdout and tetwright.__version__ in done.stdout
    check_linkage(next((tmp_path / "site" / "tetwright").glob("*.so")))


def check_linkage(module):
    """Checks linkage as auditwheel would: Tetwright's code is entirely within the module, no folder of the build is
    searched for libraries, and all other libraries are Debian's."""
    listing = subprocess.run(["readelf", "-d", module], capture_output=True, text=True, check=True).stdout
    assert "RPATH" not in listing and "RUNPATH" not in listing, listing
    needed = {line.split("[lib")[1].split(".so")[0].split("-")[0] for line in listing.splitlines() if "(NEEDED)" in line and "[lib" in line}
    of_systems = {"c", "m", "gcc_s", "stdc++"}
    named = {"openvdb", "tbb", "boost_iostreams", "Imath", "hdf5_serial", "z", "deflate", "lz4", "lzma", "pugixml", "scotch",
             "scotcherr", "zip", "zstd", "blosc", "tiff", "gdcmCommon", "gdcmDICT", "gdcmDSED", "gdcmMSFF", "netcdf"}
    assert needed <= of_systems | named, needed - of_systems - named
    found = subprocess.run(["ldd", module], capture_output=True, text=True, check=True).stdout
    assert "not found" not in found and "tetwright" not in found.replace(str(module), ""), found


@pytest.mark.parametrize("order", [1, 2])
def test_meshio_reads_the_fields_of_every_format_that_has_them(tmp_path, order):
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1.], [2, 0, 1]])
    tets = np.array([[0, 1, 2, 3], [1, 2, 3, 4], [1, 4, 3, 5]])
    data = {"material": [np.array([4, 9, 4])], "id": [np.array([7, 2**40, 5])], "E": [np.array([0.5, 1.5, 2.5])]}
    made = tetwright.improve(meshio.Mesh(points, [("tetra", tets)], cell_data=data, point_data={"u": points}),
                             fix_boundary=True, order=order)

    def by_place(places, values):
        return {tuple(np.round(p, 9)): v for p, v in zip(np.asarray(places), np.asarray(values, float).ravel().tolist())}
    expected = {name: by_place(made.points[made.tets].mean(axis=1), made.fields[name]) for name in ("id", "E")}
    # In msh22 files it splits the fields of several kinds of cells at the wrong positions; in binary files it requires
    # the cells in the order of their numbers.
    for name, output_format, alone in (("m.vtu", "", False), ("m.vtk", "", False), ("m.xdmf", "", False),
                                       ("a.msh", "msh22", True), ("b.msh", "msh41", False)):
        made.write(tmp_path / name, output_format=output_format, no_boundary=alone)
        read = meshio.read(tmp_path / name)
        np.testing.assert_allclose(read.point_data["u"], read.points, atol=1e-12, err_msg=name)
        for field in expected:
            blocks = [(b.data[:, :4], values) for b, values in zip(read.cells, read.cell_data[field])
                      if b.type.startswith("tetra")]
            cells, values = (np.concatenate(parts) for parts in zip(*blocks))
            assert by_place(read.points[cells].mean(axis=1), values) == expected[field], (name, field)
    handed_on = made.to_meshio()
    np.testing.assert_allclose(handed_on.point_data["u"], handed_on.points, atol=1e-12)
    beside = handed_on.points[made.interfaces.triangles].mean(axis=1)
    assert handed_on.cell_data["E"][0].tolist() == made.fields["E"].tolist()
    assert len(handed_on.cell_data["E"][1]) == len(beside)
    np.testing.assert_array_equal(handed_on.cell_data["E"][1], made.fields["E"][made.interfaces.tets])
    for triangle, tet in zip(made.interfaces.triangles.tolist(), made.interfaces.tets.tolist()):
        assert set(triangle) < set(made.tets[tet].tolist())


def test_what_a_file_has_no_place_for_is_noted(tmp_path):
    made = tetwright.improve(meshio.Mesh(np.vstack([np.zeros(3), np.eye(3)]), [("tetra", [[0, 1, 2, 3]])],
                                         cell_data={"heat": [np.array([1.5])], "a\tb": [np.array([2.5])],
                                                    "a_b": [np.array([3.5])]}), fix_boundary=True)
    assert {n: v[0] for n, v in made.fields.items()} == {"heat": 1.5, "a_b": 2.5, "a_b_2": 3.5}
    assert "original names of fields" in made.notes[0]
    made.write(tmp_path / "m.inp")
    assert "m.inp: 3 fields (not written; .inp cannot hold them)" in made.notes[-1]


def test_tets_lost_to_single_precision_are_a_shortfall(tmp_path, prepared):
    far = prepared.points + [2.0**24, 0, 0]
    meshio.Mesh(far, {"tetra": prepared.tets}).write(tmp_path / "far.vtu")
    mesh = tetwright.read(tmp_path / "far.vtu")
    mesh.write(tmp_path / "far.vtk")
    assert mesh.shortfall == []
    mesh.write(tmp_path / "far.usda")
    assert "flat or negative in single precision" in mesh.shortfall[0]

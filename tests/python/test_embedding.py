# SPDX-License-Identifier: Apache-2.0
"""Tests tetwright.embed: inputs, weights, files, and what carries a surface along."""
import json
import types

import meshio
import numpy as np
import pytest
import tetwright

# A cube of six tets around its diagonal from 0 to (1, 1, 1).
POINTS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
TETS = np.array([[0, 4, 6, 7], [0, 6, 2, 7], [0, 2, 3, 7], [0, 3, 1, 7], [0, 1, 5, 7], [0, 5, 4, 7]])
MESH = POINTS, TETS


def surface(count=200, low=0.0, high=1.0):
    """Returns points in a cube, as the corners of triangles."""
    points = np.random.default_rng(1).uniform(low, high, (count, 3))
    return points, np.arange(count - count % 3).reshape(-1, 3)


def test_points_within_are_carried_exactly():
    points, triangles = surface()
    found = tetwright.embed(MESH, (points, triangles))
    assert found.tets.shape == found.distances.shape == (200,) and found.nodes.shape == found.weights.shape == (200, 4)
    assert found.tets.dtype == found.nodes.dtype == np.int64 and found.weights.dtype == found.distances.dtype == np.float64
    assert (found.nodes == TETS[found.tets]).all()
    assert (found.weights >= 0).all() and np.allclose(found.weights.sum(1), 1, rtol=0, atol=1e-15)
    assert (found.distances == 0).all() and found.notes == [] and len(found) == 200
    linear = np.array([[2, 1, 0], [0, 3, -1], [1, 0, 1]])
    assert np.allclose(found.carry(POINTS @ linear + 5), points @ linear + 5, rtol=0, atol=1e-14)
    assert np.allclose(found.carry(POINTS[:, 1]), points[:, 1], rtol=0, atol=1e-15)
    assert found.stats["embedding"]["points"] == 200
    assert repr(found) == "<tetwright.Embedding: 200 points in 6 tets, 0 outside>"


def test_points_outside_have_the_nearest_point():
    points, triangles = surface(low=-1, high=2)
    found = tetwright.embed(MESH, (points, triangles))
    nearest = np.clip(points, 0, 1)
    assert np.allclose(found.carry(POINTS), nearest, atol=1e-15)
    assert np.allclose(found.distances, np.linalg.norm(points - nearest, axis=1), atol=1e-15)
    outside = found.stats["embedding"]
    assert outside["outside"] == np.count_nonzero(found.distances) > 100
    assert outside["largest_distance"] == found.distances.max()
    assert np.allclose(outside["place"], points[found.distances.argmax()])
    assert len(found.notes) == 1 and "points outside the mesh" in found.notes[0]
    with pytest.raises(tetwright.InputError, match="does not meet"):
        tetwright.embed(MESH, (points + 5, triangles))


def test_files_hold_the_arrays(tmp_path):
    points, triangles = surface(low=-0.2, high=1.2)
    found = tetwright.embed(MESH, (points, triangles), output=tmp_path / "w.npz", stats=tmp_path / "s.json", threads=2)
    with np.load(tmp_path / "w.npz") as arrays:
        assert sorted(arrays) == ["distances", "nodes", "tets", "weights"]
        for name in arrays:
            assert arrays[name].dtype == getattr(found, name).dtype
            assert (arrays[name] == getattr(found, name)).all()
    tetwright.embed(MESH, (points, triangles), output=str(tmp_path / "w.json"))
    text = json.loads((tmp_path / "w.json").read_text())
    assert all((np.array(text[name]) == getattr(found, name)).all() for name in text)
    assert json.loads((tmp_path / "s.json").read_text())["embedding"]["points"] == 200
    with pytest.raises(tetwright.UsageError, match=r"supported: \.npz \.json"):
        tetwright.embed(MESH, (points, triangles), output=tmp_path / "w.npy")
    with pytest.raises(tetwright.UsageError, match="standard output"):
        tetwright.embed(MESH, (points, triangles), output="-", output_format="json")


def test_inputs_are_files_or_objects(tmp_path):
    points, triangles = surface()
    expected = tetwright.embed(MESH, (points, triangles))
    meshio.Mesh(points, [("triangle", triangles)]).write(tmp_path / "s.ply")
    meshio.Mesh(POINTS, [("tetra", TETS)]).write(tmp_path / "m.vtu")
    solid = tetwright.read(tmp_path / "m.vtu")
    for mesh in tmp_path / "m.vtu", solid, meshio.Mesh(POINTS, [("tetra", TETS)]):
        for carried in (str(tmp_path / "s.ply"), meshio.Mesh(points, [("triangle", triangles)]),
                        types.SimpleNamespace(vertices=points, faces=triangles)):  # as trimesh has them
            found = tetwright.embed(mesh, carried)
            assert (found.tets == expected.tets).all() and (found.weights == expected.weights).all()


def test_wrong_calls_are_refused():
    points, triangles = surface()
    with pytest.raises(tetwright.InputError, match="none of its 6 tets has a positive volume"):
        tetwright.embed((POINTS, TETS[:, [1, 0, 2, 3]]), (points, triangles))
    with pytest.raises(tetwright.UsageError, match="no option --target-tets"):
        tetwright.embed(MESH, (points, triangles), target_tets=3)
    found = tetwright.embed(MESH, (points, triangles))
    for values in POINTS[:7], 3.0, POINTS.reshape(2, 4, 3), ["a"] * 8:
        with pytest.raises(tetwright.InputError, match="carry"):
            found.carry(values)

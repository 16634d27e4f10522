# SPDX-License-Identifier: Apache-2.0
"""Interfaces that part, cohesive elements and sets of faces, from Python."""
import numpy as np
import pytest

import tetwright

FACES = np.array([[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
                  [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]])


def box(low, high):
    points = np.array([[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)], float)
    return points, FACES


@pytest.fixture(scope="module")
def bodies():
    return {"base": box((0, 0, 0), (2, 1, 1)), "punch": box((0, 0, 1), (2, 1, 2))}


def test_both_sides_have_points_and_names(bodies):
    mesh = tetwright.prepare(bodies, target_tets=400, split_interface=("base", "punch"))
    (parted,) = mesh.parted
    assert (parted.name, parted.sides, parted.cohesive) == (
        "base|punch", ("base|punch:base", "base|punch:punch"), False)
    assert len(mesh.wedges) == 0
    a, b = parted.pairs.T
    assert len(a) > 4 and (a != b).all() and (mesh.points[a] == mesh.points[b]).all()
    assert len(np.unique(parted.pairs)) == parted.pairs.size
    numbers = {name: number for number, name in mesh.interfaces.group_names.items()}
    for side, points in zip(parted.sides, (a, b)):
        of_side = mesh.interfaces.triangles[mesh.interfaces.group == numbers[side]]
        assert set(np.unique(of_side)) == set(points)
    assert mesh.interfaces.on_boundary.all()
    assert mesh.stats["parted"][0]["pairs"] == len(a)


def test_cohesive_elements_survive_files_and_commands(tmp_path, bodies):
    mesh = tetwright.prepare(bodies, target_tets=400, cohesive="all", select={"top": "plane:z=max and normal:0,0,1,5"})
    wedges = mesh.wedges
    assert wedges.shape[1] == 6 and len(wedges) > 4
    assert (mesh.points[wedges[:, :3]] == mesh.points[wedges[:, 3:]]).all()
    assert mesh.stats["selections"][0]["area"] == pytest.approx(2)
    mesh.write(tmp_path / "m.vtu")
    assert (tmp_path / "m_pairs.csv").exists()
    assert len(tetwright.read(tmp_path / "m.vtu").wedges) == len(wedges)
    coarse = tetwright.simplify(mesh, target_tets=200)
    assert coarse.parted[0].cohesive and 0 < len(coarse.wedges) < len(wedges)
    assert tetwright.check(coarse)
    assert tetwright.check(tmp_path / "m.vtu", before=coarse)
    # A format without wedges says what it lacks.
    coarse.write(tmp_path / "c.mesh")
    assert any("cohesive elements" in note for note in coarse.notes)


def test_lists_and_errors(bodies):
    mesh = tetwright.mesh(bodies, resolution=8, split_interface=["base,punch", ("punch", "base")],
                          select=["left=plane:x=min", "right=plane:x=max"])
    assert [s["name"] for s in mesh.stats["selections"]] == ["left", "right"]
    assert len(mesh.parted) == 1
    with pytest.warns(tetwright.ShortfallWarning, match="no faces to part"):
        tetwright.mesh(bodies, resolution=8, split_interface="base,nothing")
    with pytest.warns(tetwright.ShortfallWarning, match="the nearest face misses"):
        tetwright.mesh(bodies, resolution=8, select={"far": "plane:z=9"})
    with pytest.raises(tetwright.UsageError, match="is no rule"):
        tetwright.mesh(bodies, resolution=8, select={"bad": "plan:z=9"})
    with pytest.raises(tetwright.UsageError, match="second order"):
        tetwright.mesh(bodies, resolution=8, cohesive="all", order=2)

# SPDX-License-Identifier: Apache-2.0
"""Tests the inputs that the Python package accepts and rejects: cells, names, options, files, on cubes."""
import json
import os
import types

import meshio
import numpy as np
import pytest
import tetwright

CUBE_POINTS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
CUBE_QUADS = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
CUBE_TRIANGLES = np.concatenate([CUBE_QUADS[:, [0, 1, 2]], CUBE_QUADS[:, [0, 2, 3]]])
CUBE = CUBE_POINTS, CUBE_TRIANGLES
FAR_CUBE = CUBE_POINTS + 3, CUBE_TRIANGLES
TWO_TETS = np.array([[0, 4, 2, 1], [7, 6, 5, 3]])


@pytest.fixture(scope="module")
def cube_mesh():
    return tetwright.mesh(CUBE, resolution=8)


def tets_of_two_kinds(**data):
    """Returns two tets of a cube's corners as a meshio mesh."""
    return meshio.Mesh(CUBE_POINTS, [("tetra", TWO_TETS)], **data)


def test_one_file_cannot_be_two(tmp_path, cube_mesh):
    (tmp_path / "other.ply").symlink_to(tmp_path / "same.ply")
    (tmp_path / "same.ply").write_bytes(b"")
    for boundary in "same.ply", "other.ply":
        with pytest.raises(tetwright.UsageError, match="is also the file of -o"):
            cube_mesh.write(tmp_path / "same.ply", boundary=tmp_path / boundary, output_format="vtu")
    assert (tmp_path / "same.ply").read_bytes() == b""
    cube_mesh.write(tmp_path / "a.vtu", boundary=tmp_path / "a.ply")
    assert (tmp_path / "a.vtu").exists() and (tmp_path / "a.ply").exists()


def test_meshes_are_written_in_parts(tmp_path, cube_mesh):
    cube_mesh.write(tmp_path / "m.pvtu", parts=3)
    assert {p.name for p in tmp_path.iterdir()} == {"m.pvtu", "m_0.vtu", "m_1.vtu", "m_2.vtu"}
    assert tetwright.check(tmp_path / "m.pvtu")["mesh"]["tets"] == len(cube_mesh.tets)
    with pytest.raises(tetwright.UsageError, match="--parts"):
        cube_mesh.write(tmp_path / "m.mesh", parts=3)


def test_every_code_has_cause_and_remedy():
    kinds = tetwright.diagnostic_kinds()
    assert len(kinds) > 70
    assert all(kind.title and kind.cause and kind.remedy for kind in kinds.values())
    assert {kind.severity for kind in kinds.values()} == {"note", "shortfall", "warning", "error"}
    # accept_changes concerns shortfalls alone, and a note that is not certain is no warning
    assert {kind.severity for kind in kinds.values() if kind.acceptable} == {"shortfall"}
    assert [name for name, kind in kinds.items() if not kind.certain] == [
        "target-too-small", "solid-uncertain", "thin-parts-uncertain", "base-added", "sheet-thickened"]
    assert kinds["solid-changed"].acceptable and not kinds["target-missed"].acceptable


def test_diagnostics_have_codes_and_severities(cube_mesh):
    assert cube_mesh.diagnostics == []
    with pytest.warns(tetwright.ShortfallWarning):
        made = tetwright.prepare((CUBE_POINTS, CUBE_TRIANGLES[1:]), target_tets=300, min_solid_angle=0.55)
    codes = {d.code: d for d in made.diagnostics}
    assert codes["holes-closed"].severity == "note" and codes["holes-closed"].file == "surface"
    assert codes["angle-missed"].severity == "shortfall" and codes["angle-missed"].asked == 0.55
    assert codes["angle-missed"].reached == made.stats["result"]["min_solid_angle"]
    assert [d.message for d in made.diagnostics if d.severity == "shortfall"] == made.shortfall


def test_second_order_needs_a_format_that_holds_it(tmp_path):
    mesh = tetwright.prepare(CUBE, target_tets=300, order=2)
    with pytest.raises(tetwright.UsageError, match=r"without ten-node tets; write one of .*\.xdmf"):
        mesh.write(tmp_path / "four.mesh")
    assert not list(tmp_path.iterdir())
    mesh.write(tmp_path / "ten.xdmf")


def test_cells_that_cannot_be_read_are_refused():
    wedge = np.array([[0, 1, 2, 4, 5, 6]])
    for cells in [("tetra", TWO_TETS), ("hexahedron", [range(8)])], [("triangle", CUBE_TRIANGLES), ("wedge", wedge)]:
        with pytest.raises(tetwright.InputError, match="1 (hexahedra|wedges); only triangles, polygons and tets"):
            tetwright.simplify(meshio.Mesh(CUBE_POINTS, cells), target_tets=1)
    pyvista = types.SimpleNamespace(points=CUBE_POINTS, cells_dict={10: TWO_TETS, 12: np.array([range(8)])},
                                    celltypes=np.array([10, 10, 12]), cell_data={})
    with pytest.raises(tetwright.InputError, match="1 hexahedra"):
        tetwright.improve(pyvista)


def test_polygons_are_triangles():
    some = [("triangle", CUBE_TRIANGLES[[0, 6]]), ("quad", CUBE_QUADS[1:4]), ("polygon", CUBE_QUADS[4:])]
    expected = tetwright.mesh({"cube": CUBE}, resolution=8)
    made = tetwright.mesh({"cube": meshio.Mesh(CUBE_POINTS, some)}, resolution=8)
    assert made.notes == [] and len(made.tets) == len(expected.tets)
    pixels = types.SimpleNamespace(points=CUBE_POINTS, cells_dict={8: CUBE_QUADS[:, [0, 1, 3, 2]]},
                                   celltypes=np.full(6, 8), cell_data={})
    assert len(tetwright.mesh(pixels, resolution=8).tets) == len(expected.tets)


def test_curved_cells_are_taken_by_their_corners(cube_mesh):
    middles = np.arange(6) + 8
    points = np.vstack([CUBE_POINTS, np.random.default_rng(1).random((6, 3))])
    ten = np.hstack([TWO_TETS, np.stack([middles, middles])])
    made = tetwright.improve(meshio.Mesh(points, [("tetra10", ten)], point_data={"heat": np.arange(14.0)}))
    assert made.stats["input"]["points"] == 8
    assert "6 midside nodes; tets of ten nodes are reduced to their corners (dropped)" in made.notes[0]
    six = np.hstack([CUBE_TRIANGLES, CUBE_TRIANGLES[:, [1, 2, 0]]])
    made = tetwright.mesh(meshio.Mesh(CUBE_POINTS, [("triangle6", six)]), resolution=8)
    assert "triangles of 6 points are reduced to their corners" in made.notes[0]
    assert len(made.tets) == len(cube_mesh.tets)
    second = tetwright.mesh(CUBE, resolution=8, order=2)
    assert "midside nodes" in tetwright.improve(second, free_count=True).notes[0]


def test_fields_and_groups_of_objects_are_kept_or_noted():
    data = {"domain": [np.array([4, 9])], "heat": [np.array([0.5, 1.5])], "text": [np.array(["a", "b"])]}
    mesh = tets_of_two_kinds(cell_data=data, point_data={"depth": np.arange(8.0)},
                             cell_sets={"hard": [np.array([0])]})
    made = tetwright.improve(mesh, fix_boundary=True)
    # As in a file, the only field of whole numbers is the material.
    assert set(made.materials.tolist()) == {4, 9} and made.stats["input"]["material_field"] == "domain"
    assert set(made.fields) == {"heat"} and set(made.point_fields) == {"depth"}
    assert '1 fields of cells ("text") (dropped)' in made.notes[0] and '1 sets of cells ("hard")' in made.notes[0]
    mesh.cell_data["part"] = [np.array([1, 2])]
    asked = tetwright.improve(mesh, material_field="part", fix_boundary=True)
    assert set(asked.materials.tolist()) == {1, 2}
    with pytest.raises(tetwright.InputError, match='no cell field "nothing"'):
        tetwright.improve(mesh, material_field="nothing")
    of_gmsh = tets_of_two_kinds(cell_data={"gmsh:physical": [np.array([4, 9])]},
                                field_data={"bone": np.array([4, 3]), "wall": np.array([5, 2])})
    made = tetwright.improve(of_gmsh, fix_boundary=True)
    assert made.material_names == {4: "bone"}
    assert '1 names of physical groups of faces, lines or points ("wall") (dropped)' in made.notes[0]
    surface = meshio.Mesh(CUBE_POINTS, [("triangle", CUBE_TRIANGLES), ("line", [[0, 1]])],
                          cell_data={"gmsh:physical": [np.ones(12, int), np.array([2])]},
                          point_data={"heat": np.zeros(8)}, field_data={"wall": np.array([1, 2])})
    note = tetwright.mesh(surface, resolution=8).notes[0]
    for what in '1 lines', 'fields of points ("heat")':
        assert what in note


def outer_triangles(mesh, groups):
    """Returns the boundary of a mesh as meshio cells, with a group for each triangle."""
    return [("tetra", mesh.tets), ("triangle", mesh.interfaces.triangles)], [np.ones(len(mesh.tets), int), groups]


def names_of_surfaces(mesh):
    used = set(mesh.interfaces.group.tolist())
    return {n for number, n in mesh.interfaces.group_names.items() if number in used}


def test_groups_of_faces_are_patches(cube_mesh, tmp_path):
    top = (cube_mesh.points[cube_mesh.interfaces.triangles][:, :, 2] > 0.99).all(axis=1)
    assert top.any() and not top.all()
    cells, groups = outer_triangles(cube_mesh, np.where(top, 5, 0))
    named = meshio.Mesh(cube_mesh.points, cells, cell_data={"gmsh:physical": groups},
                        field_data={"wall": np.array([5, 2])})
    made = tetwright.improve(named)
    of_set = tetwright.improve(meshio.Mesh(cube_mesh.points, cells, cell_sets={"wall": [None, np.flatnonzero(top)]}))
    named.write(tmp_path / "named.msh", file_format="gmsh22")  # a format that the program reads
    for mesh in made, of_set, tetwright.improve(tmp_path / "named.msh"):
        assert names_of_surfaces(mesh) == {"wall", "material_1|outside"} and "(dropped)" not in str(mesh.notes)
        on_wall = np.array([mesh.interfaces.group_names[g] == "wall" for g in mesh.interfaces.group.tolist()])
        assert (mesh.points[mesh.interfaces.triangles[on_wall]][:, :, 2] > 0.99).all() and on_wall.any()
    # From one call to the next.
    again = tetwright.improve(made.to_meshio())
    assert names_of_surfaces(again) == names_of_surfaces(made) and "(dropped)" not in str(again.notes)
    # A triangle inside the mesh is not on a surface.
    cells[1] = ("triangle", np.vstack([cells[1][1], cube_mesh.tets[:1, :3]]))
    groups[1] = np.append(groups[1], 5)
    note = tetwright.improve(meshio.Mesh(cube_mesh.points, cells, cell_data={"medit:ref": groups})).notes[0]
    assert "1 triangles of groups inside a material (dropped)" in note


def test_groups_of_surfaces_are_patches():
    # Two triangles on each side; the fan of a polygon belongs to a single group.
    sides = np.repeat(np.arange(6), 2)
    names = {"wall": np.array([3, 2])}
    labelled = meshio.Mesh(CUBE_POINTS, [("triangle", CUBE_TRIANGLES)], cell_data={"gmsh:physical": [sides]},
                           field_data=names)
    polygons = types.SimpleNamespace(points=CUBE_POINTS, faces=np.hstack([np.full((6, 1), 4), CUBE_QUADS]).ravel(),
                                     cell_data={"patch": np.arange(6), "heat": np.zeros(6)}, point_data={})
    in_sets = meshio.Mesh(CUBE_POINTS, [("triangle", CUBE_TRIANGLES)],
                          cell_sets={"wall": [np.array([6, 7])], "twice": [np.array([7, 8])]})
    assert names_of_surfaces(tetwright.mesh(labelled, resolution=8)) == {
        "surface|outside", "surface_1", "surface_2", "wall", "surface_4", "surface_5"}
    made = tetwright.mesh(polygons, resolution=8)
    assert len(names_of_surfaces(made)) == 6 and '1 fields of cells ("heat") (dropped)' in made.notes[0]
    made = tetwright.mesh(in_sets, resolution=8)
    assert names_of_surfaces(made) == {"surface|outside", "wall", "twice"}
    assert "1 faces of sets that are in a group already (dropped)" in made.notes[0]


def test_names_of_the_faces_of_a_surface_are_patches():
    polygons = np.hstack([np.full((6, 1), 4), CUBE_QUADS]).ravel()

    def made(names, **others):
        surface = types.SimpleNamespace(points=CUBE_POINTS, faces=polygons, cell_data={"Names": names, **others})
        return tetwright.mesh(surface, resolution=12)
    tissues = ["skin", "skin", "bone", "skin", "", "skin"]
    for names in np.array(tissues), np.array(tissues, "S"), np.array(tissues, object):
        mesh = made(names)
        assert names_of_surfaces(mesh) == {"skin", "bone", "surface|outside"} and not mesh.notes
    assert names_of_surfaces(made(np.full(6, "skin"))) == {"surface|outside"}
    mesh = made(np.array(tissues), RegionId=np.arange(6))
    assert names_of_surfaces(mesh) == {"skin", "bone", "surface|outside"}
    assert 'fields of cells ("RegionId") (dropped)' in mesh.notes[0]
    assert 'fields of cells ("Names") (dropped)' in made(np.array(["a"] * 5, object)).notes[0]


def test_patches_of_one_name_are_qualified_by_their_body():
    def box(x, name):
        in_set = {name: [np.array([2, 8])]}
        return meshio.Mesh(CUBE_POINTS + [x, 0, 0], [("triangle", CUBE_TRIANGLES)], cell_sets=in_set)
    mesh = tetwright.mesh({"heater": box(0, "wall"), "fluid": box(2, "wall"), "case": box(4, "lid")}, resolution=30)
    assert {n for n in names_of_surfaces(mesh) if "|" not in n} == {"heater:wall", "fluid:wall", "lid"}
    assert '"wall" -> "heater:wall"' in mesh.notes[0] and '"wall" -> "fluid:wall"' in mesh.notes[0]
    again = tetwright.simplify(mesh, target_tets=1000)
    assert {n for n in names_of_surfaces(again) if "|" not in n} == {"heater:wall", "fluid:wall", "lid"}


def test_sets_of_cells_are_patches_or_noted(cube_mesh, tmp_path):
    triangles = cube_mesh.interfaces.triangles
    top = np.flatnonzero((cube_mesh.points[triangles][:, :, 2] > 0.99).all(axis=1))
    cells, _ = outer_triangles(cube_mesh, None)

    def improved(**more):
        return tetwright.improve(meshio.Mesh(cube_mesh.points, more.pop("cells", cells), **more))
    # A set may have the name of a material, and a set of all faces does not absorb a smaller one.
    named = improved(cell_data={"gmsh:physical": [np.ones(len(cube_mesh.tets), int), np.zeros(len(triangles), int)]},
                     field_data={"bone": np.array([1, 3]), "rest": np.array([7, 2])},
                     cell_sets={"all": [None, np.arange(len(triangles))], "bone": [np.array([0]), top]})
    assert names_of_surfaces(named) == {"all", "bone"} and named.material_names == {1: "bone"}
    assert f"{len(top)} faces of sets that are in a group already (dropped)" in named.notes[0]
    assert 'names of physical groups of faces, lines or points ("rest") (dropped)' in named.notes[0]
    # To meshio and back, with an additional set, or through a file.
    handed_on = named.to_meshio()
    handed_on.write(tmp_path / "m.msh", file_format="gmsh22")
    again = tetwright.improve(tmp_path / "m.msh")
    assert names_of_surfaces(again) == {"all", "bone_2"} and again.material_names == {1: "bone"}
    plain = improved().to_meshio()
    plain.cell_sets["lid"] = [None, (plain.points[plain.cells[1].data][:, :, 2] > 0.99).all(axis=1)]
    assert names_of_surfaces(tetwright.improve(plain)) == {"lid", "material_1|outside"}
    # Shells, tets in sets, and invalid numbers.
    shells = [*cells, ("triangle", np.array([[0, 1, 2], [1, 2, 3]]) * (len(cube_mesh.points) // 4))]
    made = improved(cells=shells, cell_sets={"shell": [np.array([3]), None, np.array([0, 1])]})
    assert "2 triangles of sets that are not faces of a tet (dropped)" in made.notes[0]
    assert '1 sets of cells ("shell") (dropped)' in made.notes[0] and len(names_of_surfaces(made)) == 1
    zero = [np.zeros(len(c), int) for _, c in cells]
    made = improved(cell_data={"gmsh:physical": zero}, field_data={"zero": np.array([0, 2])})
    assert names_of_surfaces(made) == {"material_0|outside"} and '("zero") (dropped)' in made.notes[0]
    made = improved(cell_data={"surface": [np.arange(len(c)) * 0.5 for _, c in cells]})
    assert set(made.fields) == {"surface"}


def test_groups_that_make_no_sense(cube_mesh):
    cells, groups = outer_triangles(cube_mesh, np.full(len(cube_mesh.interfaces), 2**63 - 1))
    largest = meshio.Mesh(cube_mesh.points, cells, cell_data={"gmsh:physical": groups},
                          cell_sets={"lid": [None, np.array([0])]})
    assert len(tetwright.improve(largest).interfaces.group_names) == 1
    for group, members in ("lid", [9999999]), ("lid", [-1]), ("lid", [0.5]), ("lid", [True, False]), ("\udcff", [0]):
        with pytest.raises(tetwright.Error):
            tetwright.improve(meshio.Mesh(cube_mesh.points, cells, cell_sets={group: [None, np.array(members)]}))
    alone = meshio.Mesh(cube_mesh.points, cells, cell_sets={"\udcff": [np.array([0]), None]})
    assert "sets of cells" in tetwright.improve(alone).notes[0]
    faces = np.hstack([np.full((6, 1), 4), CUBE_QUADS]).ravel()
    labels = [None, {"label": [[1], [2, 3]]}, {"label": np.arange(5)}, {"\udcff": np.arange(6)},
              {"label": np.ma.masked_less(np.arange(6), 3)}, {"label": np.full(6, 2**64 - 1, np.uint64)}]
    for data in labels:
        made = tetwright.mesh(types.SimpleNamespace(points=CUBE_POINTS, faces=faces, cell_data=data, point_data=None),
                              resolution=8)
        assert len(names_of_surfaces(made)) == 1
        assert (made.notes == []) == (data is None)


def test_standard_output_is_the_hosts(cube_mesh, tmp_path):
    for options in {"output": "-", "output_format": "vtu"}, {"output": tmp_path / "m.vtu", "boundary": "-"}:
        with pytest.raises(tetwright.UsageError, match="output"):
            tetwright.mesh(CUBE, resolution=8, **options)
    for options in {"path": "-", "output_format": "vtu"}, {"path": tmp_path / "m.vtu", "boundary": "-"}:
        with pytest.raises(tetwright.UsageError, match="host"):
            cube_mesh.write(**options)


def test_names_of_materials_are_kept_whole():
    for name in "bone.v2", "a/b", "part.vdb", "x=y", "ct.nii.gz":
        assert tetwright.mesh({name: CUBE}, resolution=8).material_names == {1: name}
    two = tetwright.prepare({"L.femur": CUBE, "L.tibia": FAR_CUBE}, target_tets=300)
    assert two.material_names == {1: "L.femur", 2: "L.tibia"}


def test_names_that_meet(tmp_path):
    assert tetwright.prepare(CUBE, material={"surface": FAR_CUBE}, target_tets=300).material_names == {
        1: "surface_2", 2: "surface"}
    assert tetwright.prepare([CUBE], material={"surface_1": FAR_CUBE}, target_tets=300).material_names == {
        1: "surface_1_2", 2: "surface_1"}
    meshio.Mesh(*FAR_CUBE[:1], [("triangle", CUBE_TRIANGLES)]).write(tmp_path / "surface_1.ply")
    assert tetwright.prepare([CUBE, tmp_path / "surface_1.ply"], target_tets=300).material_names == {
        1: "surface_1_2", 2: "surface_1"}
    for scan, material in ({1: CUBE, "1": FAR_CUBE}, None), ({"a": CUBE}, {"a": FAR_CUBE}):
        with pytest.raises(tetwright.UsageError, match="two inputs are called"):
            tetwright.prepare(scan, material=material, target_tets=300)
    mesh = tetwright.mesh(CUBE, resolution=8)
    assert tetwright.check(mesh, surface={"mesh": CUBE}, before=mesh, tolerance="5%")
    with pytest.raises(tetwright.InputError, match="it has no whole-number cell field 'x'"):
        tetwright.check(mesh, before=mesh, material_field="x")
    with pytest.raises(tetwright.UsageError, match="of a file and of an array"):
        tetwright.prepare({"b.ply": CUBE}, material={"c": "b.ply"}, target_tets=300)
    for name in "", "-", "[a]":
        with pytest.raises(tetwright.UsageError, match="cannot be called"):
            tetwright.mesh({name: CUBE}, resolution=8)
    with pytest.raises(tetwright.UsageError, match="without ="):
        tetwright.mesh(CUBE, material={"a=b": FAR_CUBE}, resolution=8)


def test_numbers_of_options():
    expected = tetwright.prepare(CUBE, target_tets=300, seed=3)
    again = tetwright.prepare(CUBE, target_tets=300.0, seed=np.uint8(3), order=1.0, gamma=np.float32(10),
                              keep_outside=np.bool_(False), beta=np.array(5))
    assert np.array_equal(again.points, expected.points) and np.array_equal(again.tets, expected.tets)
    wrong = [dict(resolution=True), dict(threads=False), dict(time_limit=np.bool_(True)), dict(tolerance=False),
             dict(seed=1j), dict(seed=[1, 2]), dict(feature_angle=True), dict(keep_outside="yes"), dict(output=True),
             dict(schedule=3), dict(labels=[1, 2, (3,)]), dict(labels=[True]), dict(material=CUBE),
             dict(material=CUBE[0]), dict(layer={"skin": True}), dict(layer=("skin", 1)), dict(output_format=7), dict(size_field=3)]
    for options in wrong:
        with pytest.raises((tetwright.UsageError, tetwright.InputError), match=next(iter(options))):
            tetwright.prepare(CUBE, **{"target_tets": 300, **options})


def test_help_and_logs_are_the_programs(tmp_path, capfd):
    for options in dict(help=True), dict(version=True):
        with pytest.raises(tetwright.UsageError, match="are not options here"):
            tetwright.prepare(CUBE, target_tets=300, **options)
    for options in {}, {"output": tmp_path / "a.vtu"}:
        with pytest.raises(tetwright.UsageError, match="log_file is for the program only"):
            tetwright.prepare(CUBE, target_tets=300, log_file=tmp_path / "log.txt", **options)
    assert capfd.readouterr().out == "" and not list(tmp_path.iterdir())


def test_what_is_no_input_is_refused():
    void = types.SimpleNamespace
    wrong = [("a.ply", "b.ply"), (CUBE, FAR_CUBE), void(points=CUBE_POINTS, faces=None), void(vertices=None, faces=[]),
             (CUBE_POINTS, None), (None, CUBE_TRIANGLES), (CUBE_POINTS, CUBE_TRIANGLES + 0.9),
             (CUBE_POINTS, [["a"] * 3]),
             (np.ma.array(CUBE_POINTS, mask=CUBE_POINTS > 0), CUBE_TRIANGLES),
             (CUBE_POINTS, np.ma.array(CUBE_TRIANGLES, mask=CUBE_TRIANGLES > 6)), (CUBE_POINTS * 1j, CUBE_TRIANGLES),
             void(points=CUBE_POINTS, cells_dict={"triangle": CUBE_TRIANGLES + 0.5}),
             np.ma.array(np.ones((4, 4, 4), int), mask=np.eye(4, dtype=bool)[None].repeat(4, 0)),
             "\ud800.ply", "a\0.ply", {"a\0b": CUBE}, {"\ud800": CUBE}, ["a\0.ply", CUBE]]
    for scan in wrong:
        with pytest.raises((tetwright.InputError, tetwright.UsageError)) as caught:
            tetwright.mesh(scan, resolution=8)
        assert len(str(caught.value)) > 10
    for tets in [[0.9, 4.9, 2.9, 1.9]], [[0, 4, 2, np.nan]]:
        with pytest.raises(tetwright.InputError, match="tets hold .* which is not the number of a point"):
            tetwright.improve((CUBE_POINTS, tets))
    with pytest.raises(tetwright.InputError, match="materials are masked"):
        tetwright.improve((CUBE_POINTS, TWO_TETS, np.ma.array([1, 2], mask=[True, False])))
    labels = np.ones((4, 4, 4), int)
    for options in dict(spacing=(1, 2)), dict(origin=(1, 2)), dict(affine="x"), dict(spacing="x"), dict(origin=[[1]]):
        with pytest.raises(tetwright.UsageError, match=next(iter(options))):
            tetwright.mesh(labels, **options)


def test_names_of_files_are_whole(tmp_path, cube_mesh, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for options in dict(path="n\0x.vtu"), dict(path="n.vtu", boundary="n\0.ply"), dict(path="\ud800.vtu"), \
            dict(path="n.vtu", output_format="vt\0u"), dict(path=3):
        with pytest.raises(tetwright.UsageError):
            cube_mesh.write(**options)
    for name in "n\0.vtu", "\ud800.vtu":
        with pytest.raises(tetwright.UsageError):
            tetwright.read(name)
        with pytest.raises(tetwright.UsageError):
            tetwright.prepare(CUBE, target_tets=300, output=name)
    assert not list(tmp_path.iterdir())
    # File names on Linux are bytes, and need not be UTF-8.
    strange = os.fsdecode(b"n\xff.vtu")
    cube_mesh.write(strange)
    assert len(tetwright.read(strange).tets) == len(cube_mesh.tets)
    with pytest.raises(tetwright.InputError, match="n\ufffd.ply"):
        tetwright.mesh(os.fsdecode(b"n\xff.ply"), resolution=8)


def test_size_fields_are_named_by_their_argument(cube_mesh):
    lengths = np.full(8, 0.5)
    for field, message in [((CUBE_POINTS, CUBE_TRIANGLES - 1, lengths), "refers to point -1"),
                           ((CUBE_POINTS, CUBE_TRIANGLES + 0.5, lengths), "cells hold 0.5"),
                           ((CUBE_POINTS, CUBE_TRIANGLES, lengths - 0.5), "length of point 0 is 0"),
                           ((CUBE_POINTS, CUBE_TRIANGLES, lengths * np.nan), "length of point 0 is nan"),
                           ((CUBE_POINTS / 4, TWO_TETS, lengths), "sizes end within the body"),
                           ((CUBE_POINTS, CUBE_TRIANGLES, ["a"] * 8), "lengths are of type"),
                           (("a.vtu", CUBE_TRIANGLES, lengths), "names of files")]:
        with pytest.raises(tetwright.InputError, match="^size_field.*" + message):
            tetwright.simplify(cube_mesh, size_field=field)


def test_stats_of_what_failed(tmp_path):
    stats = tmp_path / "st.json"
    with pytest.raises(tetwright.InputError):
        tetwright.prepare("nofile.ply", target_tets=300, output=tmp_path / "a.vtu", stats=stats)
    assert "nofile.ply" in json.loads(stats.read_text())["error"]["message"]
    stats.unlink()
    with pytest.raises(tetwright.InputError):
        tetwright.check("nofile.vtu", stats=stats)
    assert json.loads(stats.read_text())["status"] == 3


def test_what_ran_out_of_time_says_where():
    with pytest.raises(tetwright.OutputError, match=r"\(in stage '[a-z ]+'\)"):
        tetwright.prepare(CUBE, target_tets=300, time_limit=1e-9)


def test_sheets_and_partitions_are_surfaces_by_name():
    sheet = np.array([(0.2, 0.3, 0.3), (0.8, 0.5, 0.3), (0.8, 0.5, 0.7), (0.2, 0.3, 0.7)]), np.array([(0, 1, 2), (0, 2, 3)])
    mesh = tetwright.prepare(CUBE, sheet={"baffle": sheet}, target_tets=800)
    (found,) = mesh.stats["result"]["sheets"]
    assert found["name"] == "baffle" and abs(found["area"] - 0.4 * np.hypot(0.6, 0.2)) < 1e-4
    level = np.array([(-1, -1, 0.4), (2, -1, 0.6), (2, 2, 0.6), (-1, 2, 0.4)]), sheet[1]
    assert len(tetwright.mesh(CUBE, partition={"level": level}, resolution=10).material_names) == 2


def test_caps_of_holes_have_names():
    duct = CUBE_POINTS * (1, 1, 3), np.concatenate([CUBE_QUADS[:4, [0, 1, 2]], CUBE_QUADS[:4, [0, 2, 3]]])  # without ends
    mesh = tetwright.mesh(duct, resolution=12, cap=["inlet@0.5,0.5,0", "outlet@0.5,0.5,3"])
    assert {(cap["name"], cap["centre"][2]) for cap in mesh.stats["caps"]["patches"]} == {("inlet", 0), ("outlet", 3)}
    assert tetwright.mesh(duct, resolution=12, cap="inlet@0.5,0.5,0").stats["caps"]["patches"][1]["name"] == "cap_2"
    with pytest.raises(tetwright.UsageError, match="from the nearest cap"):
        tetwright.mesh(duct, resolution=12, cap="inlet@0.5,0.5,1.5")


def test_surfaces_are_brought_into_the_space_of_the_first(tmp_path):
    far = tmp_path / "far.obj"
    far.write_text("# SPACE=RAS\n" + "".join(f"v {x} {y} {z}\n" for x, y, z in FAR_CUBE[0])
                   + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in CUBE_TRIANGLES))
    made = tetwright.mesh({"near": CUBE, "far": far}, surface_space="LPS", resolution=8)
    assert made.points.min(axis=0) == pytest.approx([-4, -4, 0]) and "far.obj' (brought into that of" in str(made.notes)
    with pytest.raises(tetwright.UsageError, match="'LAS' is not LPS or RAS"):
        tetwright.mesh(CUBE, surface_space="LAS", resolution=8)


def test_surfaces_are_brought_into_the_space_of_a_mesh(tmp_path):
    def write(name, space, factor):
        path = tmp_path / name
        path.write_text(f"# SPACE={space}\n" + "".join(f"v {factor * x} {factor * y} {z}\n" for x, y, z in FAR_CUBE[0])
                        + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in CUBE_TRIANGLES))
        return path
    mesh = tetwright.mesh(write("ras.obj", "RAS", 1), resolution=8)
    assert mesh.space == mesh.stats["input"]["space"] == "right-anterior-superior"
    mesh.write(tmp_path / "m.vtu")
    assert tetwright.read(tmp_path / "m.vtu").space == mesh.space
    assert "(brought into that of the first input" in str(tetwright.check(mesh, surface=write("lps.obj", "LPS", -1)).notes)
    with pytest.raises(tetwright.InputError, match="does not meet"):
        tetwright.check(mesh, surface=write("lps.obj", "LPS", 1))
    # Values in memory are in the coordinates of the mesh.
    assert tetwright.check(mesh, surface=FAR_CUBE).notes == []
    assert tetwright.embed(mesh, FAR_CUBE).notes == []
    found = tetwright.check(mesh, surface=write("lps.obj", "LPS", -1))
    assert [d["code"] for d in found["diagnostics"]] == ["space-converted"]

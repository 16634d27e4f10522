# SPDX-License-Identifier: Apache-2.0
"""A case: the files, the call and what the judge must find."""
import dataclasses
import json

import numpy as np

import surfaces as sf

CASES = {}


@dataclasses.dataclass(frozen=True)
class Tolerance:
    """Shares of the true value (area, volume) and of the body's diagonal (distance, crease)."""
    area: float
    volume: float
    distance: float
    crease: float


FLAT = Tolerance(area=1e-3, volume=1e-3, distance=1e-3, crease=1e-6)
# A few thousand tets have chords on round surfaces: 30 around a cylinder lose 0.7 % of its volume and 0.3 % of the
# diagonal, and bodies of an assembly share the tets.
ROUND = Tolerance(area=0.02, volume=0.02, distance=0.02, crease=0.005)
# Bodies that touch in a line are joined over a few cells.
STRIP = Tolerance(area=0.05, volume=0.01, distance=0.05, crease=0.02)


@dataclasses.dataclass
class Input:
    """A surface of the call. `groups` names the part of each triangle; `closed` is whether it is one closed, oriented
    manifold."""
    name: str
    surface: tuple
    suffix: str = ".off"
    groups: list = None
    closed: bool = True

    @property
    def file(self):
        return self.name + self.suffix


@dataclasses.dataclass
class Case:
    """Bodies are the surfaces as meant, by tag. With `by_position` the program may number them in another order.
    `status` holds the exit statuses that are right."""
    inputs: list
    expect: dict = dataclasses.field(default_factory=dict)
    bodies: dict = dataclasses.field(default_factory=dict)
    sheets: list = dataclasses.field(default_factory=list)     # inputs of --sheet
    walls: list = dataclasses.field(default_factory=list)      # inputs of --partition
    judged_sheets: dict = dataclasses.field(default_factory=dict)
    options: list = dataclasses.field(default_factory=list)
    patches: dict = dataclasses.field(default_factory=dict)
    places: dict = dataclasses.field(default_factory=dict)
    status: tuple = (0,)
    raw_files: dict = dataclasses.field(default_factory=dict)  # name to bytes, written instead of an input's surface
    note: str = ""

    def moved(self, move):
        """Returns the case with all its surfaces moved."""
        def inputs(all_inputs):
            return [dataclasses.replace(i, surface=(move(i.surface[0]), i.surface[1])) for i in all_inputs]

        def named(all_surfaces):
            return {k: (move(p), t) for k, (p, t) in all_surfaces.items()}

        return dataclasses.replace(
            self, inputs=inputs(self.inputs), sheets=inputs(self.sheets), walls=inputs(self.walls),
            bodies=named(self.bodies), judged_sheets=named(self.judged_sheets),
            places={k: move(np.array([p]))[0] for k, p in self.places.items()})

    def write(self, folder, name):
        folder.mkdir(parents=True, exist_ok=True)
        for i in (*self.inputs, *self.sheets, *self.walls):
            if i.file not in self.raw_files:
                sf.write(folder / i.file, *i.surface, i.groups)
        for file, content in self.raw_files.items():
            (folder / file).write_bytes(content)
        bodies = {}
        for tag, surface in self.bodies.items():
            bodies[str(tag)] = f"meant_{tag}.off"
            sf.write(folder / bodies[str(tag)], *surface)
        judged = {}
        for sheet, surface in self.judged_sheets.items():
            judged[sheet] = f"meant_{sheet}.off"
            sf.write(folder / judged[sheet], *surface)
        options = [*self.options]
        for option, surfaces in (("--sheet", self.sheets), ("--partition", self.walls)):
            for i in surfaces:
                options += [option, f"{i.name}={i.file}"]
        row = {"case": name, "inputs": [[i.name, i.file] for i in self.inputs], "options": options,
               # Only .msh names triangles.
               "output": "out.msh" if judged or self.patches else "out.vtu",
               "bodies": bodies, "sheets": judged, "status": list(self.status), "expect": self.expect}
        if self.patches:
            row["patches"] = self.patches
        if self.places:
            row["places"] = {str(k): [float(x) for x in p] for k, p in self.places.items()}
        if self.note:
            row["note"] = self.note
        (folder / "case.json").write_text(json.dumps(row, indent=1) + "\n")


def case(name, turned=False):
    """Registers the function that makes a case; a turned one exists in three rotations, NAME_r0 to NAME_r2."""
    def register(make):
        for k in range(3) if turned else [None]:
            CASES[name if k is None else f"{name}_r{k}"] = (make, k or 0)
        return make
    return register


def around(value, share):
    return [value * (1 - share), value * (1 + share)]


def expectations(topology, bodies, tolerance):
    """Returns what the judge must find: rows of the topology with ranges for areas, and the bodies' shapes."""
    out = {"valid": True, "materials": len(bodies)}
    for name, row in topology.items():
        out[name] = row if row is None else {
            k: around(v, tolerance.area) if k == "area" and not isinstance(v, list) else v for k, v in row.items()}
    out["volume"] = {str(tag): around(sf.volume(*surface), tolerance.volume) for tag, surface in bodies.items()}
    out["bodies"] = {str(tag): {
        "volume_ratio": around(1, tolerance.volume), "crease_p99_rel": [0, tolerance.crease], "corners_missed": 0,
        "mesh_to_surface_rel": [0, tolerance.distance], "surface_to_mesh_rel": [0, tolerance.distance]}
        for tag in bodies}
    return out


def sheet_expectations(surface, tolerance):
    """Returns what the judge must find of a sheet."""
    return {"components": int(sf.pieces(surface[1])[0]), "euler": int(sf.euler(surface[1])), "not_inner_faces": 0,
            "area": around(sf.area(*surface), tolerance.area), "mesh_to_surface_rel": [0, tolerance.distance],
            "surface_to_mesh_rel": [0, tolerance.distance], "border_rel": [0, tolerance.distance]}


def of_partition(partition, inputs, tolerance=FLAT, by_position=False, **more):
    """Makes the case of a partition whose materials are numbered in the order of the bodies."""
    bodies = {m: partition.boundary(m) for m in range(1, partition.count + 1)}
    places = {m: sf.volume_and_center(*surface)[1] for m, surface in bodies.items()} if by_position else {}
    return Case(inputs, expectations(partition.topology(), bodies, tolerance), bodies, places=places, **more)

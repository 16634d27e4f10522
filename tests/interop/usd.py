# SPDX-License-Identifier: Apache-2.0
"""Reads .usda files with a small parser of the text format of USD, and with OpenUSD where its module `pxr` is installed,
and compares them with the mesh as .vtu and its boundary.

usage: usd.py TETWRIGHT    (Debian's python3 with meshio and numpy)
"""
import pathlib
import re
import subprocess
import sys
import tempfile

import meshio
import numpy as np

TETWRIGHT = sys.argv[1]
failures = []


def check(what, good):
    print(("ok      " if good else "FAILED  ") + what)
    if not good:
        failures.append(what)


def run(*arguments):
    return subprocess.run([TETWRIGHT, *map(str, arguments)], check=False, capture_output=True, text=True)


TOKEN = re.compile(r'\s*("(?:[^"\\\n]|\\.)*"|[A-Za-z_][\w:]*(?:\[\])?|-?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[][(){}=,])')


class Parser:
    """Parses prims with attributes: numbers, strings, tuples and lists."""

    def __init__(self, text):
        header, _, body = text.partition("\n")
        assert header == "#usda 1.0", header
        self.tokens, at = [], 0
        body = body.rstrip()
        while at < len(body):
            match = TOKEN.match(body, at)
            assert match, "at: " + body[at:at + 40]
            self.tokens.append(match[1])
            at = match.end()
        self.at = 0

    def peek(self):
        return self.tokens[self.at] if self.at < len(self.tokens) else None

    def take(self, expected=None):
        token = self.tokens[self.at]
        assert expected is None or token == expected, (token, expected)
        self.at += 1
        return token

    def value(self):
        token = self.take()
        if token in ("(", "["):
            closing = {"(": ")", "[": "]"}[token]
            items = []
            while self.peek() != closing:
                items.append(self.value())
                if self.peek() != closing:
                    self.take(",")
            self.take(closing)
            return items
        if token.startswith('"'):
            return re.sub(r"\\(.)", r"\1", token[1:-1])
        return float(token) if re.search(r"[.eE]", token) else int(token)

    def metadata(self):
        found = {}
        if self.peek() == "(":
            self.take()
            while self.peek() != ")":
                name = self.take()
                self.take("=")
                found[name] = self.value()
            self.take()
        return found

    def prim(self):
        self.take("def")
        prim = {"type": self.take(), "name": self.value(), "attributes": {}, "children": []}
        prim["metadata"] = self.metadata()
        self.take("{")
        while self.peek() != "}":
            if self.peek() == "def":
                prim["children"].append(self.prim())
                continue
            words = []
            while self.peek() != "=":
                words.append(self.take())
            self.take()
            name = words[-1]
            assert name not in prim["attributes"], name
            prim["attributes"][name] = (" ".join(words[:-1]), self.value())
        self.take()
        return prim

    def stage(self):
        metadata = self.metadata()
        prims = []
        while self.peek() is not None:
            prims.append(self.prim())
        return metadata, prims


def compare(file, reference, boundary):
    metadata, prims = Parser(file.read_text(encoding="utf-8")).stage()
    check("one prim, the default", [(p["type"], p["name"]) for p in prims] == [("TetMesh", metadata["defaultPrim"])])
    mesh = prims[0]
    get = lambda name, kind: (check(f"{name} is {kind}", mesh["attributes"][name][0] == kind), mesh["attributes"][name][1])[1]
    points = np.array(get("points", "point3f[]"), dtype=np.float32)
    tets = np.array(get("tetVertexIndices", "int4[]"))
    surface = np.array(get("surfaceFaceVertexIndices", "int3[]"))
    check("points in single precision", np.array_equal(points, reference.points.astype(np.float32)))
    check("tets", np.array_equal(tets, reference.cells[0].data))
    check("orientation", get("orientation", "uniform token") == "rightHanded")
    check("extent", np.array_equal(np.array(get("extent", "float3[]"), dtype=np.float32), [points.min(axis=0), points.max(axis=0)]))
    corners = points[tets].astype(float)
    check("right-handed tets", (np.linalg.det(corners[:, 1:] - corners[:, :1]) > 0).all())
    # The faces of right-handed tets that no two tets share, as the documentation of tetVertexIndices orders them.
    faces = np.vstack([tets[:, list(f)] for f in ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    turned = lambda fs: sorted(tuple(np.roll(f, -int(np.argmin(f)))) for f in fs)
    check("the surface has the outer faces, outwards", turned(surface) == turned(faces[first[count == 1]]))
    subsets = {c["name"]: {k: v for k, (_, v) in c["attributes"].items()} for c in mesh["children"]}
    check("subsets have names of their own", len(subsets) == len(mesh["children"]) and all(re.fullmatch(r"[A-Za-z_]\w*", n) for n in subsets))
    by_type = lambda kind: [s for s in subsets.values() if s["elementType"] == kind]
    materials = reference.cell_data["material"][0]
    check("each tet is in one material", sorted(i for s in by_type("tetrahedron") for i in s["indices"]) == list(range(len(tets))))
    for subset in by_type("tetrahedron"):
        check(f"tets of {subset['tetwright:name']!r}", subset["indices"] == list(np.flatnonzero(materials == subset["tetwright:number"])) and subset["familyName"] == "materialBind")
    check("each face is in one group", sorted(i for s in by_type("face") for i in s["indices"]) == list(range(len(surface))))
    check(f"groups {boundary}", {s["tetwright:name"] for s in by_type("face")} == boundary and all(s["familyName"] == "boundary" for s in by_type("face")))
    check("families", mesh["attributes"]["subsetFamily:materialBind:familyType"][1] == "partition")


def compare_by_usd(file, tets):
    try:
        from pxr import Usd, UsdGeom
    except ImportError as reason:
        print(f"without OpenUSD ({reason})")
        return
    prim = Usd.Stage.Open(str(file)).GetDefaultPrim()
    mesh = UsdGeom.TetMesh(prim)
    check("OpenUSD: tets", len(mesh.GetTetVertexIndicesAttr().Get()) == tets)
    faces = UsdGeom.TetMesh.ComputeSurfaceFaces(mesh)
    check("OpenUSD: surface", sorted(map(sorted, faces)) == sorted(map(sorted, mesh.GetSurfaceFaceVertexIndicesAttr().Get())))
    for kind, family in (("tetrahedron", "materialBind"), ("face", "boundary")):
        valid, reason = UsdGeom.Subset.ValidateFamily(UsdGeom.Imageable(prim), kind, family)
        check(f"OpenUSD: family {family} {reason}", valid)


def main(folder):
    run("sample", "two_materials", "-o", folder / "source.vtu")
    call = ["improve", folder / "source.vtu", "--max-iterations", "1", "--only-below", "0"]
    run(*call, "-o", folder / "m.vtu")
    answer = run(*call, "-o", folder / "m.usda")
    check(f"status {answer.returncode}", answer.returncode == 0)
    check("a note about inner faces", "faces between materials and of sheets" in answer.stderr)
    answer = run(*call, "-o", folder / "m.usda", "--boundary", folder / "m.vtp")
    check("no note if --boundary has them", answer.stderr == "")
    reference = meshio.read(folder / "m.vtu")
    compare(folder / "m.usda", reference, {"left|outside", "right|outside"})
    compare_by_usd(folder / "m.usda", len(reference.cells[0].data))
    # Far from the origin tets of a quarter do not survive.
    reference.points = reference.points + [2.0**24, 0, 0]
    reference.write(folder / "far.vtu")
    answer = run("improve", folder / "far.vtu", "--max-iterations", "1", "-o", folder / "far.usda")
    check(f"far away: {answer.stderr.strip()[:120]}", answer.returncode == 1 and "flat or negative in single precision" in answer.stderr)
    answer = run(*call, "-o", folder / "m2.usda", "--order", "2")
    check("ten-node tets are refused", answer.returncode == 2 and not (folder / "m2.usda").exists())


with tempfile.TemporaryDirectory(prefix="tetwright-usd-") as name:
    main(pathlib.Path(name))
sys.exit(1 if failures else 0)

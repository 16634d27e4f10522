# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of README and guide: meshes by the program, drawn by the page of its --report in a headless Chromium.

    pictures.py TETWRIGHT [NAME...]

Needs chromium and python3-pil, for the bunny the Debian package glmark2-data, and for inputs of tests/assemblies
python3-numpy and python3-scipy; those that show other data read it from the folder TETWRIGHT_DATA. Without names all
pictures are made that can be. They are written to data/guide/pictures/.
"""
import io
import json
import math
import os
import subprocess
import sys
import tempfile

from PIL import Image, ImageChops

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(SOURCE, "tests", "report_page"))
import browser  # noqa: E402

PICTURES = os.path.join(SOURCE, "data", "guide", "pictures")
BUNNY = "/usr/share/glmark2/models/bunny.obj"
WIDTH, HEIGHT = 1200, 1040  # of what is drawn; half of it is kept, which smooths edges
COLOURS = 128  # of a palette, so that files are small
MARGIN = 0.04
ASSEMBLIES = os.path.join(SOURCE, "tests", "assemblies", "make_inputs.py")
# As the page colours materials, in their order; sheets have one of their own.
MATERIAL_COLOURS = ((102, 153, 204), (238, 136, 102), (68, 170, 119), (221, 170, 51), (170, 68, 153))
SHEET_COLOUR = MATERIAL_COLOURS[1]
# Adds triangles to what the page draws: nine coordinates each, in input units.
DRAW_TRIANGLES = """
((layers, alone) => {
  const {view, mesh: {about}} = tetwright_page;
  for (const {triangles, colour} of layers) {
    const count = triangles.length / 3, position = new Float32Array(3 * count), normal = new Int8Array(3 * count);
    const corner = new Uint8Array(3 * count), colours = new Uint8Array(3 * count);
    for (let i = 0; i < 3 * count; ++i) {
      position[i] = view.to_world((triangles[i] - about.origin[i % 3]) / about.step, i % 3);
      colours[i] = colour[i % 3];
      corner[i] = Math.floor(i / 3) % 3 === i % 3 ? 1 : 0;
    }
    for (let i = 0; i < 3 * count; i += 9) fill_normal(position, normal, i);
    const geometry = new THREE.BufferGeometry(), add = (name, of, scaled) =>
      geometry.setAttribute(name, new THREE.BufferAttribute(of, 3, scaled));
    add("position", position), add("normal", normal, true), add("colour", colours, true), add("corner", corner);
    const object = new THREE.Mesh(geometry, view.material);
    object.frustumCulled = false;
    view.scene.add(object);
  }
  if (alone) view.object.visible = false;
  view.redraw();
})
"""


def write_obj(path, points, faces):
    with open(path, "w", encoding="utf-8") as file:
        file.writelines(f"v {x:.6g} {y:.6g} {z:.6g}\n" for x, y, z in points)
        file.writelines("f " + " ".join(str(p + 1) for p in face) + "\n" for face in faces)


def gear(path, teeth=14, steps=8):
    """A gear with a raised hub and a bore: rings of points, one above the other, with the same angles."""
    angles, outline = [], []
    for tooth in range(teeth):
        for at, radius in ((0.0, 0.8), (0.28, 0.8), (0.36, 1.0), (0.62, 1.0), (0.70, 0.8)):
            angles.append(2 * math.pi * (tooth + at) / teeth)
            outline.append(radius)
    # Between them points on circles, or the bore would be a polygon of few sides.
    count = len(angles)
    fine_angles, fine_outline = [], []
    for i in range(count):
        a, b = angles[i], angles[(i + 1) % count] + (2 * math.pi if i + 1 == count else 0)
        parts = max(1, round((b - a) / (2 * math.pi / (teeth * steps))))
        for k in range(parts):
            fine_angles.append(a + (b - a) * k / parts)
            fine_outline.append(outline[i] + (outline[(i + 1) % count] - outline[i]) * k / parts)
    hub, bore, thin, thick = 0.42, 0.22, 0.14, 0.30
    # (radius or None for the outline, height), from the bore's lower rim around and back.
    rings = [(bore, -thick), (hub, -thick), (hub, -thin), (None, -thin), (None, thin), (hub, thin), (hub, thick), (bore, thick)]
    n = len(fine_angles)
    points = [(r * math.cos(t), r * math.sin(t), z) for radius, z in rings
              for t, r in ((t, o if radius is None else radius) for t, o in zip(fine_angles, fine_outline))]
    faces = []
    for k in range(len(rings)):
        low, high = k * n, (k + 1) % len(rings) * n
        for i in range(n):
            j = (i + 1) % n
            faces.append((low + i, low + j, high + j, high + i))
    write_obj(path, points, faces)


def read_surface(path):
    """Returns the triangles of an .off or .obj file as lists of three points."""
    with open(path, encoding="utf-8") as file:
        rows = [line.split("#")[0].split() for line in file]
    if path.endswith(".obj"):
        points = [tuple(map(float, r[1:4])) for r in rows if r and r[0] == "v"]
        faces = [[int(x.split("/")[0]) - 1 for x in r[1:]] for r in rows if r and r[0] == "f"]
    else:
        numbers = [x for r in rows for x in r][1:]
        count, face_count = int(numbers[0]), int(numbers[1])
        points = [tuple(map(float, numbers[3 + 3 * k:6 + 3 * k])) for k in range(count)]
        faces, at = [], 3 + 3 * count
        for _ in range(face_count):
            size = int(numbers[at])
            faces.append([int(x) for x in numbers[at + 1:at + 1 + size]])
            at += 1 + size
    return [[points[f[0]], points[f[k]], points[f[k + 1]]] for f in faces for k in range(1, len(f) - 1)]


def moved(triangles, by):
    return [[tuple(x + d for x, d in zip(p, by)) for p in t] for t in triangles]


def behind(triangles, azimuth, elevation, up="z"):
    """Those that face away from the camera, of a closed surface: a view into it."""
    a, e = math.radians(azimuth), math.radians(elevation)
    towards = [0.0, 0.0, 0.0]
    for axis, part in zip({"z": (0, 1, 2), "y": (2, 0, 1)}[up], (math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e))):
        towards[axis] = part

    def faces_camera(t):
        (ax, ay, az), (bx, by, bz) = ([q - p for p, q in zip(t[0], t[k])] for k in (1, 2))
        return sum(n * d for n, d in zip((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx), towards)) > 0

    return [t for t in triangles if not faces_camera(t)]


def layer_of(triangles, colour):
    return {"triangles": [x for t in triangles for p in t for x in p], "colour": colour}


def faces_of(path, choose):
    """The triangles of a .mesh for which `choose` agrees; its argument are the tags of the tets on both sides."""
    points, tets, triangles, section = [], {}, [], None
    with open(path, encoding="utf-8") as file:
        for line in file:
            row = line.split("#")[0].split()
            if not row:
                continue
            if row[0][0].isalpha():
                section = row[0]
            elif section == "Vertices" and len(row) == 4:
                points.append(tuple(map(float, row[:3])))
            elif section == "Triangles" and len(row) == 4:
                triangles.append([int(x) - 1 for x in row[:3]])
            elif section == "Tetrahedra" and len(row) == 5:
                ids = [int(x) - 1 for x in row[:4]]
                for k in range(4):
                    tets.setdefault(tuple(sorted(ids[:k] + ids[k + 1:])), []).append(row[4])
    return [[points[p] for p in t] for t in triangles if choose(tets[tuple(sorted(t))])]


def is_sheet(sides):
    return len(sides) == 2 and sides[0] == sides[1]


class Studio:
    """Makes meshes in a folder and takes pictures of their pages."""

    def __init__(self, program, folder):
        self._program = os.path.abspath(program)
        self._folder = folder

    def tetwright(self, *arguments):
        done = subprocess.run([self._program, *map(str, arguments)], cwd=self._folder, capture_output=True, text=True, check=False)
        if done.returncode > 1:
            raise SystemExit(f"{arguments}: {done.stderr}")

    def path(self, name):
        return os.path.join(self._folder, name)

    def case(self, name):
        """Writes the input of a case of tests/assemblies; returns its inputs, by name, and its options."""
        subprocess.run(["/usr/bin/python3", ASSEMBLIES, self._folder, name], check=True)
        with open(self.path(os.path.join(name, "case.json")), encoding="utf-8") as file:
            row = json.load(file)
        options = [o.replace("=", f"={name}/") for o in row["options"]]
        return {n: os.path.join(name, f) for n, f in row["inputs"]}, options

    def assembly(self, name, inputs, options, tets):
        """Meshes surfaces by name; returns the page, beside which lies NAME.mesh."""
        first, *others = inputs.items()
        named = [x for n, f in others for x in ("--material", f"{n}={f}")]
        self.tetwright("prepare", first[1], *named, *options, "-o", name + ".mesh", "--target-tets", tets, "--report", name + ".html")
        return name + ".html"

    def pair(self, name, page, before, after):
        """Surfaces and mesh side by side. `before`: the address of the page and what to draw in place of the mesh; `after`: the
        address and what to draw besides."""
        images = [self._shot(page, state, layers, alone) for (state, layers), alone in ((before, True), (after, False))]
        both = Image.new("RGB", (2 * images[0].width, images[0].height), "white")
        for k, image in enumerate(images):
            both.paste(image, (k * image.width, 0))
        self._save(name, both.quantize(COLOURS, dither=Image.Dither.NONE))

    def picture(self, name, page, state, whole_page=False):
        image = self._shot(page, state, whole_page=whole_page)
        # The page has texts and swatches, whose colours a palette would change.
        self._save(name, image if whole_page else image.quantize(COLOURS, dither=Image.Dither.NONE))

    def _shot(self, page, state, layers=(), alone=False, whole_page=False):
        width, height = (1280, 860) if whole_page else (WIDTH, HEIGHT)
        with browser.Browser(width=width, height=height) as tab:
            tab.open(self.path(page), state)
            tab.wait_for("window.tetwright_page !== undefined")
            if not whole_page:
                tab.run("for (const id of ['controls', 'marks', 'legend']) document.getElementById(id).hidden = true;"
                        "document.body.style.cssText = 'margin: 0; padding: 0; max-width: none';"
                        "document.querySelector('header').hidden = true;"
                        "document.querySelectorAll('.notice').forEach(n => n.hidden = true);"
                        f"document.getElementById('view').style.cssText = 'flex: none; border: 0; border-radius: 0;"
                        f" background: #ffffff; width: {width}px; height: {height}px';"
                        "tetwright_page.view.set_background('#ffffff'); tetwright_page.view.redraw()")
            if layers:
                tab.run(f"{DRAW_TRIANGLES}({json.dumps(layers)}, {json.dumps(alone)})")
            tab.settle()
            tab.settle()
            image = Image.open(io.BytesIO(tab.screenshot(None if whole_page else "#view"))).convert("RGB")
        return image if whole_page else framed(image)

    @staticmethod
    def _save(name, image):
        os.makedirs(PICTURES, exist_ok=True)
        path = os.path.join(PICTURES, name + ".png")
        image.save(path, optimize=True)
        print(f"{name}.png: {image.width} x {image.height}, {os.path.getsize(path) // 1000} KB")


def framed(image):
    """Cut to what is drawn, with a margin, in the middle of a frame of one size."""
    box = ImageChops.difference(image, Image.new("RGB", image.size, "white")).getbbox()
    drawn = image.crop(box)
    width, height = WIDTH // 2, HEIGHT // 2
    scale = min(width * (1 - 2 * MARGIN) / drawn.width, height * (1 - 2 * MARGIN) / drawn.height)
    drawn = drawn.resize((round(drawn.width * scale), round(drawn.height * scale)), Image.Resampling.LANCZOS)
    frame = Image.new("RGB", (width, height), "white")
    frame.paste(drawn, ((width - drawn.width) // 2, (height - drawn.height) // 2))
    return frame


def scan(studio):
    """The Stanford bunny as 10,000 tets."""
    studio.tetwright("prepare", BUNNY, "-o", "bunny.vtu", "--target-tets", 10000, "--report", "bunny.html")
    studio.picture("scan", "bunny.html", "up=y&look=28,14,1.9")


def organs(studio):
    """A segmented volume, cut open."""
    studio.tetwright("sample", "organs", "-o", "organs.nrrd")
    studio.tetwright("prepare", "organs.nrrd", "-o", "organs.vtu", "--target-tets", 20000, "--report", "organs.html")
    studio.picture("organs", "organs.html", "cut=y,0.5&look=-68,20,1.9")


def implant(studio):
    """A surface in a segmented volume, cut open."""
    studio.tetwright("sample", "organs", "-o", "organs.nrrd")
    studio.tetwright("sample", "lead", "-o", "lead.stl")
    studio.tetwright("prepare", "organs.nrrd", "--labels", "1-3", "--material", "lead=lead.stl", "-o", "implant.vtu",
                     "--target-tets", 20000, "--report", "implant.html")
    studio.picture("implant", "implant.html", "cut=y,0.5&look=-68,20,1.9")


def part(studio):
    """A part whose edges stay sharp."""
    gear(studio.path("gear.obj"))
    studio.tetwright("prepare", "gear.obj", "-o", "gear.vtu", "--target-tets", 12000, "--report", "gear.html")
    studio.picture("part", "gear.html", "look=-50,48,2.2")


def layers(studio):
    """Layers under the surface of a scan."""
    studio.tetwright("prepare", BUNNY, "--layer", "skin=0.06", "--layer", "fat=0.12", "-o", "layers.vtu", "--target-tets", 20000,
                     "--report", "layers.html")
    studio.picture("layers", "layers.html", "up=y&cut=z,0.5&look=24,12,1.9")


def report(studio):
    """The page itself."""
    studio.tetwright("sample", "organs", "-o", "organs.nrrd")
    studio.tetwright("prepare", "organs.nrrd", "--labels", "1-3,5", "-o", "organs.vtu", "--target-tets", 5000, "--report", "organs.html")
    studio.picture("report", "organs.html", "cut=y,0.5&look=-72,20,1.75", whole_page=True)


def exploded(studio, inputs, shares):
    """Surfaces moved apart, as layers to draw; shares: of each body's movement, in input units."""
    return [layer_of(moved(read_surface(studio.path(file)), by), colour)
            for file, by, colour in zip(inputs.values(), shares, MATERIAL_COLOURS)]


def heater(studio):
    """Five bodies that share faces."""
    inputs = {part: part + ".obj" for part in ("below", "left", "core", "right", "above")}
    for part, file in inputs.items():
        studio.tetwright("sample", "heater_" + part, "-o", file)
    page = studio.assembly("heater", inputs, [], 12000)
    parts = exploded(studio, inputs, ((0, -0.5, 0), (-0.5, 0, 0), (0, 0, 0), (0.5, 0, 0), (0, 0.5, 0)))
    studio.pair("heater", page, ("up=y&look=28,24,2.4", parts), ("up=y&cut=z,0.5&look=28,24,1.9", ()))


def contact(studio):
    """A punch on its base: both sides of the interface have points of their own."""
    inputs = {}
    for name, low, high in (("base", (0, 0, 0), (2, 1, 1)), ("punch", (0.5, 0.2, 1), (1.5, 0.8, 2))):
        inputs[name] = name + ".obj"
        corners = [tuple((low, high)[i >> k & 1][k] for k in range(3)) for i in range(8)]
        write_obj(studio.path(inputs[name]), corners,
                  [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)])
    page = studio.assembly("contact", inputs, ["--split-interface", "base,punch"], 1500)
    of_mesh = [[t for t in faces_of(studio.path("contact.mesh"), lambda sides, tag=str(tag): sides == [tag])] for tag in (1, 2)]
    parts = [layer_of(moved(triangles, by), colour)
             for triangles, by, colour in zip(of_mesh, ((0, 0, 0), (0, 0, 0.5)), MATERIAL_COLOURS)]
    studio.pair("contact", page, ("look=-62,24,2.6", parts), ("cut=y,0.5&look=-62,24,2.3", ()))


def rock(studio):
    """Five layers that share their surfaces."""
    inputs, options = studio.case("layers_five_files")
    page = studio.assembly("rock", inputs, options, 15000)
    parts = exploded(studio, inputs, [(0, 0, 0.25 * k) for k in range(5)])
    studio.pair("rock", page, ("look=-55,18,2.6", parts), ("cut=y,0.5&look=-55,18,1.9", ()))


def vessel(studio):
    """A vessel that enters a box."""
    inputs, options = studio.case("vessel_into_box")
    page = studio.assembly("vessel", inputs, options, 8000)
    block, tube = (read_surface(studio.path(f)) for f in inputs.values())
    surfaces = [layer_of(behind(block, -55, 22), MATERIAL_COLOURS[0]), layer_of(tube, MATERIAL_COLOURS[1])]
    whole = faces_of(studio.path("vessel.mesh"), lambda sides: sides.count("2") == 1)
    studio.pair("vessel", page, ("look=-55,22,2.7", surfaces), ("cut=y,0.5&look=-55,22,2.7", [layer_of(whole, MATERIAL_COLOURS[1])]))


def with_sheets(studio, name, case, tets, look, cut):
    inputs, options = studio.case(case)
    page = studio.assembly(name, inputs, options, tets)
    sheets = [t for o in options if "=" in o for t in read_surface(studio.path(o.split("=")[1]))]
    body = read_surface(studio.path(next(iter(inputs.values()))))
    azimuth, elevation, _ = look
    state = "look=" + ",".join(map(str, look))
    surfaces = [layer_of(behind(body, azimuth, elevation), MATERIAL_COLOURS[0]), layer_of(sheets, SHEET_COLOUR)]
    of_mesh = [layer_of(faces_of(studio.path(name + ".mesh"), is_sheet), SHEET_COLOUR)]
    studio.pair(name, page, (state, surfaces), (f"cut={cut}&{state}", of_mesh))


def fan(studio):
    """Blades without thickness in a duct."""
    with_sheets(studio, "fan", "blades_obj", 8000, (-62, 24, 2.7), "y,0.5")


def horizons(studio):
    """Horizons in a block of rock."""
    if "TETWRIGHT_DATA" not in os.environ:
        print("horizons: left out, since TETWRIGHT_DATA is not set")
        return
    inputs, options = studio.case("data_horizons_partition")
    page = studio.assembly("horizons", inputs, options, 6000)
    sheets = [t for o in options if "=" in o for t in read_surface(studio.path(o.split("=")[1]))]
    block = read_surface(studio.path(next(iter(inputs.values()))))
    surfaces = [layer_of(behind(block, 28, 22, "y"), MATERIAL_COLOURS[0]), layer_of(sheets, SHEET_COLOUR)]
    studio.pair("horizons", page, ("up=y&look=28,22,2.7", surfaces), ("up=y&cut=z,0.5&look=28,22,2.4", ()))


PICTURES_BY_NAME = {make.__name__: make for make in (scan, organs, implant, part, layers, report, heater, contact, rock, vessel, fan, horizons)}


def main():
    program, *names = sys.argv[1:]
    with tempfile.TemporaryDirectory(prefix="tetwright-pictures-") as folder:
        studio = Studio(program, folder)
        for name in names or PICTURES_BY_NAME:
            PICTURES_BY_NAME[name](studio)


if __name__ == "__main__":
    main()

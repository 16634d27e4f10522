# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of README and guide: meshes by the program, drawn by the page of its --report in a headless Chromium.

    pictures.py TETWRIGHT [NAME...]

Needs chromium and python3-pil, and for the bunny the Debian package glmark2-data. Without names all
pictures are made. They are written to data/guide/pictures/.
"""
import io
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

    def picture(self, name, page, state, whole_page=False):
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
            tab.settle()
            tab.settle()
            image = Image.open(io.BytesIO(tab.screenshot(None if whole_page else "#view"))).convert("RGB")
        if not whole_page:
            image = framed(image)
        os.makedirs(PICTURES, exist_ok=True)
        path = os.path.join(PICTURES, name + ".png")
        # The page has texts and swatches, whose colours a palette would change.
        (image if whole_page else image.quantize(COLOURS, dither=Image.Dither.NONE)).save(path, optimize=True)
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


PICTURES_BY_NAME = {make.__name__: make for make in (scan, organs, part, layers, report)}


def main():
    program, *names = sys.argv[1:]
    with tempfile.TemporaryDirectory(prefix="tetwright-pictures-") as folder:
        studio = Studio(program, folder)
        for name in names or PICTURES_BY_NAME:
            PICTURES_BY_NAME[name](studio)


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: Apache-2.0
"""Tests the page of --report in a headless Chromium: what it draws, and the effects of its controls.

    report_page_test.py TETWRIGHT [--accept] [TEST...]

--accept replaces the reference picture by the current one.
"""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

import browser

FOLDER = os.path.dirname(os.path.abspath(__file__))
REFERENCE = os.path.join(FOLDER, "reference.png")
PROGRAM = ""
ACCEPT = False

# Size of the canvas, small enough for a reference picture.
PICTURE_WIDTH, PICTURE_HEIGHT = 760, 420


def tetwright(*arguments):
    """Runs the program; an unmet request counts as success."""
    done = subprocess.run([PROGRAM, *map(str, arguments), "--quiet"], capture_output=True, text=True)
    if done.returncode > 1:
        raise AssertionError(f"{arguments}: {done.stderr}")
    return done


class Pages:
    """Pages used by tests, each created when it is first requested."""

    def __init__(self, folder):
        self._folder = folder
        self._made = {}

    def path(self, name):
        return os.path.join(self._folder, name)

    def _page(self, name, make):
        if name not in self._made:
            make(self.path(name))
            self._made[name] = self.path(name)
        return self._made[name]

    def simplified(self):
        """A simplified tet mesh of four materials: has histograms before and after."""
        def make(page):
            tetwright("sample", "layers", "-o", self.path("before.vtu"))
            tetwright("simplify", self.path("before.vtu"), "-o", self.path("after.vtu"), "--target-tets", 2000,
                      "--threads", 1, "--report", page)
        return self._page("simplified.html", make)

    def open_sphere(self):
        """A surface with a hole, which is found and located."""
        def make(page):
            tetwright("sample", "open_sphere", "-o", self.path("open.ply"))
            tetwright("prepare", self.path("open.ply"), "-o", self.path("open.vtu"), "--target-tets", 2000,
                      "--threads", 1, "--report", page)
        return self._page("open.html", make)

    def layers(self):
        """A tet mesh that never changes; the reference picture shows it."""
        def make(page):
            tetwright("sample", "layers", "-o", self.path("layers.vtu"))
            tetwright("check", self.path("layers.vtu"), "--report", page)
        return self._page("layers.html", make)


class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="tetwright-report-")
        cls.pages = Pages(cls.folder.name)
        cls.browser = browser.Browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.__exit__()
        cls.folder.cleanup()

    def tearDown(self):
        self.assertEqual(self.browser.complaints, [])

    def open(self, page, state="", tab=None):
        tab = tab or self.browser
        tab.open(page, state)
        tab.wait_for("window.tetwright_page !== undefined")
        tab.settle()

    def drawn(self):
        return self.browser.run("tetwright_page.drawn")

    def picture(self):
        """Copies the canvas's pixels within the page; returns the number of the copy."""
        return self.browser.run("""(() => {
          const gl = tetwright_page.view.renderer.getContext();
          const size = gl.drawingBufferWidth * gl.drawingBufferHeight, bytes = new Uint8Array(4 * size);
          gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
          return (window.pictures = window.pictures || []).push(new Uint32Array(bytes.buffer)) - 1;
        })()""")

    def covered(self):
        """Returns the fraction of the canvas that differs from the background in its corner."""
        return self.browser.run(f"(p => p.filter(pixel => pixel !== p[0]).length / p.length)(pictures[{self.picture()}])")

    def changed(self, before, after):
        """Returns the fraction of the pixels that differ."""
        return self.browser.run(f"((a, b) => a.filter((pixel, i) => pixel !== b[i]).length / a.length)"
                                f"(pictures[{before}], pictures[{after}])")

    def set(self, element, value):
        """Sets a control as a user would."""
        self.browser.run(
            f"(e => {{ if (e.type === 'checkbox' || e.type === 'radio') e.checked = {json.dumps(value)};"
            f" else e.value = {json.dumps(value)};"
            f" for (const kind of ['input', 'change']) e.dispatchEvent(new Event(kind, {{bubbles: true}})); }})"
            f"(document.querySelector({json.dumps(element)}))")
        self.browser.settle()

    def test_draws_the_mesh(self):
        self.open(self.pages.simplified())
        self.assertGreater(self.drawn(), 300)
        self.assertGreater(self.covered(), 0.1)
        self.assertLess(self.covered(), 0.9)

    def test_the_slider_cuts_and_whole_tets_are_seen(self):
        self.open(self.pages.simplified())
        whole, before = self.drawn(), self.picture()
        self.set("[name=axis][value=x]", True)
        half, cut = self.drawn(), self.picture()
        self.assertNotEqual(half, whole)
        self.assertGreater(self.changed(before, cut), 0.02)
        self.set("#cut", "0.25")
        self.assertNotEqual(self.drawn(), half)
        self.assertGreater(self.changed(cut, self.picture()), 0.02)
        # Tets are drawn entirely or not at all: at one end the whole mesh is drawn, at the other nothing.
        self.set("#cut", "1")
        self.assertEqual(self.drawn(), whole)
        self.set("#flip", True)
        self.assertEqual(self.drawn(), 0)
        # The drawn surface is closed: each edge has an even number of triangles.
        self.set("#flip", False)
        self.set("#cut", "0.4")
        self.assertEqual(self.browser.run("""(() => {
          const edges = new Map();
          tetwright_page.visible.each_face(tetwright_page.state, (...c) => {
            for (const [a, b] of [[c[0], c[1]], [c[1], c[2]], [c[2], c[0]]]) {
              const key = Math.min(a, b) + "," + Math.max(a, b);
              edges.set(key, (edges.get(key) || 0) + 1);
            }
          });
          return [...edges.values()].filter(n => n % 2 === 1).length;
        })()"""), 0)

    def test_materials_are_switched_off(self):
        self.open(self.pages.simplified(), "cut=y,0.5")
        before, all_of_them = self.picture(), self.drawn()
        count = self.browser.run("document.querySelectorAll('#materials input').length")
        self.assertGreater(count, 2)
        self.set("#materials label:nth-child(1) input", False)
        self.assertNotEqual(self.drawn(), all_of_them)
        self.assertGreater(self.changed(before, self.picture()), 0.01)
        for i in range(count):
            self.set(f"#materials label:nth-child({i + 1}) input", False)
        self.assertEqual(self.drawn(), 0)

    def test_colours_and_their_legend(self):
        self.open(self.pages.open_sphere())
        options = self.browser.run("[...document.getElementById('colour').options].map(o => o.value)")
        self.assertEqual(options, ["material", "solid", "dihedral", "distance"])
        self.assertTrue(self.browser.run("document.getElementById('legend').hidden"))
        last = self.picture()
        for colour, title in (("solid", "solid angle, sr"), ("dihedral", "angle, degrees"), ("distance", "input units")):
            self.set("#colour", colour)
            self.assertIn(title, self.browser.run("document.getElementById('legend-title').textContent"))
            now = self.picture()
            self.assertGreater(self.changed(last, now), 0.05)
            last = now
        # A mesh that was read has no surface to compare it with.
        self.open(self.pages.layers())
        self.assertNotIn("distance", self.browser.run("[...document.getElementById('colour').options].map(o => o.value)"))

    def test_a_place_is_flown_to(self):
        self.open(self.pages.open_sphere())
        self.assertIn("hole", self.browser.run("document.querySelector('.entries').textContent"))
        target = self.browser.run("tetwright_page.view.look.target")
        self.assertEqual(target, [0, 0, 0])
        self.browser.run("document.querySelector('.entries .mark').click()")
        self.browser.settle()
        target = self.browser.run("tetwright_page.view.look.target")
        self.assertGreater(sum(c * c for c in target), 0.1)
        # The mark of the location is in the middle of the view.
        x, y = self.browser.run("(m => { const r = m.getBoundingClientRect(), v = document.getElementById('view')"
                                ".getBoundingClientRect(); return [(r.x + r.width / 2 - v.x) / v.width,"
                                " (r.y + r.height / 2 - v.y) / v.height]; })(document.querySelector('#marks .mark'))")
        self.assertAlmostEqual(x, 0.5, places=1)
        self.assertAlmostEqual(y, 0.5, places=1)

    def test_mouse_wheel_and_keys_turn_and_zoom(self):
        self.open(self.pages.layers())
        x, y = self.browser.run("(r => [r.x + r.width / 2, r.y + r.height / 2])"
                                "(document.getElementById('canvas').getBoundingClientRect())")
        look = "[tetwright_page.view.look.azimuth, tetwright_page.view.look.elevation, tetwright_page.view.look.distance]"
        start, before = self.browser.run(look), self.picture()

        def mouse(kind, right=0, **more):
            self.browser.call("Input.dispatchMouseEvent", type=kind, x=x + right, y=y, **more)
        mouse("mousePressed", button="left", clickCount=1)
        mouse("mouseMoved", 80, button="left", buttons=1)
        mouse("mouseReleased", 80, button="left", clickCount=1)
        self.browser.settle()
        turned = self.browser.run(look)
        self.assertNotAlmostEqual(turned[0], start[0], places=2)
        self.assertGreater(self.changed(before, self.picture()), 0.02)
        mouse("mouseWheel", deltaX=0, deltaY=-200)
        self.browser.settle()
        self.assertLess(self.browser.run(look)[2], start[2])
        self.browser.run("document.getElementById('view').focus()")
        for key in ("ArrowUp", "-"):
            self.browser.call("Input.dispatchKeyEvent", type="keyDown", key=key)
        self.browser.settle()
        self.assertNotAlmostEqual(self.browser.run(look)[1], turned[1], places=2)

    def test_a_click_prints_the_option_that_selects_the_patch(self):
        self.open(self.pages.layers())
        box = self.browser.run("(r => [r.x, r.y, r.width, r.height])"
                               "(document.getElementById('canvas').getBoundingClientRect())")

        def click(right=0.5, down=0.5, drag=0):
            x, y = box[0] + right * box[2], box[1] + down * box[3]
            for kind, at in (("mousePressed", x), ("mouseMoved", x + drag), ("mouseReleased", x + drag)):
                self.browser.call("Input.dispatchMouseEvent", type=kind, x=at, y=y, button="left", buttons=1, clickCount=1)
            self.browser.settle()
            return self.browser.run("(o => o.hidden ? '' : o.textContent)(document.getElementById('selection'))")
        self.assertEqual(click(0.01, 0.01), "")
        option = click()
        self.assertRegex(option, r"^--select NAME=patch-at:[-0-9.e]+,[-0-9.e]+,[-0-9.e]+$")
        stats = self.pages.path("selected.json")
        tetwright("improve", self.pages.path("layers.vtu"), "-o", self.pages.path("selected.msh"), "--stats", stats,
                  *option.split())
        with open(stats, encoding="utf-8") as file:
            selected = json.load(file)["selections"]
        self.assertEqual([s["name"] for s in selected], ["NAME"])
        self.assertGreater(selected[0]["faces"], 0)
        self.assertEqual(click(0.01, 0.01), "")
        self.assertEqual(click(drag=40), "")
        self.open(self.pages.layers(), "cut=z,0.5&look=-40,80,2")
        self.assertIn("inside the mesh", click())

    def test_without_webgl_the_figures_are_there(self):
        with browser.Browser(webgl=False) as tab:
            self.open(self.pages.simplified(), tab=tab)
            self.assertIn("no WebGL", tab.run("document.getElementById('message').textContent"))
            self.assertFalse(tab.run("document.getElementById('message').hidden"))
            self.assertTrue(tab.run("document.getElementById('controls').hidden"))
            self.assertGreaterEqual(tab.run("document.querySelectorAll('svg path').length"), 10)
            self.assertIn("smallest solid angle", tab.run("document.querySelector('table').textContent"))
            self.assertEqual(tab.complaints, [])

    def test_dark_and_light_differ(self):
        self.open(self.pages.layers())
        corner = ("(p => (p[0] & 255) + (p[0] >> 8 & 255) + (p[0] >> 16 & 255))(pictures[%d])")
        light = self.browser.run(corner % self.picture())
        self.browser.prefer(dark=True)
        self.browser.settle()
        dark = self.browser.run(corner % self.picture())
        self.browser.prefer(dark=False)
        self.assertGreater(light, dark + 300)

    def test_names_cannot_become_markup(self):
        name = "<img src></script><script>broken()</script>\"'&amp;<!--"  # without =, which ends a name
        surface = self.pages.path("a\"><script>window.broken=2<!--.ply")
        tetwright("sample", "sphere", "-o", surface)
        page = self.pages.path("names.html")
        tetwright("mesh", "--material", f"{name}={surface}", "--resolution", 16, "-o",
                  self.pages.path("names.vtu"), "--accept-changes", "--report", page)
        self.open(page)
        self.assertIsNone(self.browser.run("window.broken === undefined ? null : window.broken"))
        self.assertIn(name, self.browser.run("document.getElementById('materials').textContent"))
        self.assertIn(name, self.browser.run("document.querySelector('main').textContent"))
        self.assertEqual(self.browser.run("document.querySelectorAll('img').length"), 0)

    def test_nothing_of_the_network_is_wanted(self):
        with open(self.pages.simplified(), encoding="utf-8") as file:
            text = re.sub(r'<script type="text/plain".*?</script>', "", file.read())
        self.assertIsNone(re.search(r'(src|href)\s*=\s*"(?!#)', text.split("<!-- three.js")[0]))

    def test_the_picture_is_the_reference(self):
        with browser.Browser(width=PICTURE_WIDTH, height=PICTURE_HEIGHT) as tab:
            self.open(self.pages.layers(), "cut=y,0.5&look=-60,25,2.6", tab=tab)
            tab.run("document.getElementById('controls').hidden = document.getElementById('marks').hidden = true;"
                    "document.getElementById('view').style.cssText = 'flex: none; width: 240px; height: 180px; min-height: 0'")
            tab.settle()
            tab.settle()
            width, height, rows = browser.pixels(tab.screenshot("#view"))
            self.assertEqual(tab.complaints, [])
        if ACCEPT:
            with open(REFERENCE, "wb") as file:
                file.write(browser.to_png(width, height, rows))
        with open(REFERENCE, "rb") as file:
            expected = browser.pixels(file.read())
        self.assertEqual((width, height), expected[:2])
        # With another version of the browser edges may move by a pixel, faces may not.
        tolerance, max_share = 24, 0.03
        off = sum(max(abs(a - b) for a, b in zip(one[i:i + 3], two[i:i + 3])) > tolerance
                  for one, two in zip(rows, expected[2]) for i in range(0, len(one), 3))
        self.assertLess(off / (width * height), max_share)


def main():
    global PROGRAM, ACCEPT
    PROGRAM = sys.argv[1]
    ACCEPT = "--accept" in sys.argv
    if not browser.executable():
        sys.exit("Chromium is not installed; tools/setup test installs it")
    unittest.main(argv=[sys.argv[0], *(a for a in sys.argv[2:] if a != "--accept")])


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: Apache-2.0
"""Controls a headless Chromium through its debugging protocol over pipes, with only the standard library."""
import base64
import json
import os
import select
import shutil
import struct
import subprocess
import tempfile
import time
import zlib

# Software rendering: the same pixels on every machine, within a tolerance.
ARGUMENTS = [
    "--headless=new", "--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
    "--hide-scrollbars", "--mute-audio", "--no-first-run", "--disable-extensions", "--disable-background-networking",
    "--disable-dev-shm-usage", "--force-color-profile=srgb", "--force-device-scale-factor=1", "--remote-debugging-pipe",
]


def executable():
    """Returns the path of Chromium, or None."""
    return shutil.which("chromium") or shutil.which("chromium-browser")


class Browser:
    """A browser with one tab. Use it as a context manager, which ends it and removes its profile."""

    def __init__(self, width=900, height=700, webgl=True):
        self._profile = tempfile.mkdtemp(prefix="tetwright-browser-")
        read_commands, self._commands = os.pipe()
        self._answers, write_answers = os.pipe()

        def to_three_and_four():
            # Through unused numbers, since one pipe may already have the number of the other.
            commands, answers = os.dup(read_commands), os.dup(write_answers)
            os.dup2(commands, 3)
            os.dup2(answers, 4)

        arguments = [executable(), *ARGUMENTS, f"--user-data-dir={self._profile}", f"--window-size={width},{height}"]
        if not webgl:
            arguments += ["--disable-3d-apis"]
        self._process = subprocess.Popen(
            arguments + ["about:blank"], preexec_fn=to_three_and_four, close_fds=False, stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(read_commands)
        os.close(write_answers)
        self._buffer = b""
        self._number = 0
        self._session = None
        self.complaints = []  # errors and warnings on the console, exceptions, and requests for anything but the page
        targets = self.call("Target.getTargets")["targetInfos"]
        page = next(t for t in targets if t["type"] == "page")
        self._session = self.call("Target.attachToTarget", targetId=page["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.prefer(dark=False)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self._session = None
            self.call("Browser.close")
            self._process.wait(20)
        except Exception:  # it may end before it answers
            self._process.kill()
            self._process.wait()
        os.close(self._commands)
        os.close(self._answers)
        shutil.rmtree(self._profile, ignore_errors=True)

    def prefer(self, dark):
        """Sets the user's preferences: dark or light colours, and never any motion."""
        self.call("Emulation.setEmulatedMedia", features=[
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"},
            {"name": "prefers-reduced-motion", "value": "reduce"}])

    def call(self, method, **parameters):
        """Calls a method of the protocol and returns its result."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self._commands, data):]
        while True:
            answer = self._receive()
            if answer.get("id") == self._number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self._note(answer)

    def _receive(self, seconds=120):
        end = time.monotonic() + seconds
        while b"\0" not in self._buffer:
            ready, _, _ = select.select([self._answers], [], [], max(0, end - time.monotonic()))
            if not ready:
                raise TimeoutError("the browser does not answer")
            part = os.read(self._answers, 1 << 20)
            if not part:
                raise RuntimeError("the browser has ended")
            self._buffer += part
        message, self._buffer = self._buffer.split(b"\0", 1)
        return json.loads(message)

    def _note(self, event):
        method, parameters = event.get("method"), event.get("params", {})
        if method == "Runtime.exceptionThrown":
            self.complaints.append(json.dumps(parameters["exceptionDetails"]))
        elif method == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "warning", "assert"):
            self.complaints.append(json.dumps(parameters["args"]))
        elif method == "Log.entryAdded" and parameters["entry"]["level"] == "error":
            self.complaints.append(json.dumps(parameters["entry"]))
        elif method == "Network.requestWillBeSent":
            url = parameters["request"]["url"]
            if not url.startswith(("file:", "data:", "about:")):
                self.complaints.append("request of " + url)

    def open(self, path, state=""):
        """Opens a file, with the part of its address after #, and waits until it has been drawn."""
        self.complaints = []
        self.call("Page.navigate", url="about:blank")
        self.call("Page.navigate", url="file://" + os.path.abspath(path) + ("#" + state if state else ""))
        self.wait_for("document.readyState === 'complete' && location.protocol === 'file:'")
        self.settle()

    def settle(self):
        """Waits until changes have been drawn."""
        self.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))")

    def run(self, script):
        """Returns the value of an expression in the page, or the result of a promise."""
        result = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{script}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def wait_for(self, condition, seconds=60):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if self.run(f"Boolean({condition})"):
                return
            time.sleep(0.02)
        raise TimeoutError(condition)

    def screenshot(self, selector=None):
        """Returns a PNG of the visible page, or of one element."""
        clip = {}
        if selector:
            box = self.run(f"(r => [r.x + scrollX, r.y + scrollY, r.width, r.height])"
                           f"(document.querySelector({json.dumps(selector)}).getBoundingClientRect())")
            clip = {"clip": dict(zip(("x", "y", "width", "height"), map(round, box)), scale=1)}
        return base64.b64decode(self.call("Page.captureScreenshot", format="png", **clip)["data"])


def pixels(png):
    """Returns width, height and rows of (r, g, b) bytes of a PNG with 8 bits per channel and without interlacing."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    at, data = 8, b""
    width = height = channels = 0
    while at < len(png):
        size, kind = struct.unpack(">I4s", png[at:at + 8])
        chunk = png[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlace = struct.unpack(">IIBBBBB", chunk)
            channels = {2: 3, 6: 4}[colour]
            assert depth == 8 and interlace == 0
        elif kind == b"IDAT":
            data += chunk
        at += size + 12
    data = zlib.decompress(data)
    stride, rows, above = width * channels, [], bytearray(width * channels)
    for y in range(height):
        begin = y * (stride + 1)
        row = unfiltered(data[begin], bytearray(data[begin + 1:begin + 1 + stride]), above, channels)
        rows.append(b"".join(bytes(row[i:i + 3]) for i in range(0, stride, channels)))
        above = row
    return width, height, rows


def unfiltered(kind, row, above, channels):
    """Undoes the filter of a row of a PNG in place (PNG specification, section 9)."""
    for i in range(len(row)):
        left = row[i - channels] if i >= channels else 0
        corner = above[i - channels] if i >= channels else 0
        if kind == 1:
            guess = left
        elif kind == 2:
            guess = above[i]
        elif kind == 3:
            guess = (left + above[i]) // 2
        elif kind == 4:
            nearness = [abs(above[i] - corner), abs(left - corner), abs(left + above[i] - 2 * corner)]
            guess = (left, above[i], corner)[nearness.index(min(nearness))]
        else:
            guess = 0
        row[i] = (row[i] + guess) & 255
    return row


def to_png(width, height, rows):
    """Encodes rows of (r, g, b) bytes as a PNG."""
    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
    data = zlib.compress(b"".join(b"\0" + row for row in rows), 9)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", data) + chunk(b"IEND", b""))

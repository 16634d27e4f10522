#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that the source files named in comments and READMEs exist.

Prints each name that is neither a tracked file's path, nor the end of one, nor listed below; status 1 if there is one.
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Files of other projects, of the build and of users.
OTHERS = {
    "FindOpenVDB.cmake", "MeshGmshLoader.cpp", "MeshVTKLoader.cpp",
    "blosc.h", "hdf5.h", "judge_assembly.py", "libdeflate.h", "lz4.h", "lzma.h", "main.cpp", "scotch.h", "sysexits.h", "three.js", "three.min.js", "tiffio.h", "vtkCellType.h", "zip.h", "zlib.h", "zstd.h",
}
OTHER_PREFIXES = ("FEBio",)
NAME = re.compile(r"(?<![\w./<-])((?:[\w-]+/)*[\w-]+\.(?:h|cpp|py|js|css|cmake))\b(?![\w/(])")
COMMENT = {
    ".h": re.compile(r"//.*"), ".cpp": re.compile(r"//.*"), ".js": re.compile(r"//.*"),
    ".py": re.compile(r"#.*|\"\"\".*?\"\"\"", re.S), ".txt": re.compile(r"#.*"), ".cmake": re.compile(r"#.*"),
    "": re.compile(r"#.*"), ".md": re.compile(r".*"),
}


def main():
    tracked = subprocess.run(["git", "-C", ROOT, "ls-files"], capture_output=True, text=True, check=True).stdout.split("\n")[:-1]
    ends = {"/".join(parts[k:]) for parts in (path.split("/") for path in tracked) for k in range(len(parts))}
    wrong = 0
    for path in tracked:
        suffix = pathlib.PurePath(path).suffix
        if suffix not in COMMENT or path == "CHANGELOG.md" or not (ROOT / path).is_file():
            continue
        text = (ROOT / path).read_text(encoding="utf-8", errors="replace")
        for comment in COMMENT[suffix].finditer(text):
            for name in NAME.findall(comment[0]):
                file = name.split("/")[-1]
                if name not in ends and file not in OTHERS and not file.startswith(OTHER_PREFIXES):
                    print(f"{path}:{text.count(chr(10), 0, comment.start()) + 1}: there is no file {name}")
                    wrong += 1
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

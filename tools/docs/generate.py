# SPDX-License-Identifier: Apache-2.0
"""Makes the generated pages of the guide: options, formats, statistics and messages.

    generate.py TETWRIGHT [--check]

Options come from the program's --help, their ranges from what it says of a value that none of them takes. What a format
holds is found out by writing a mesh that has everything. Statistics come from data/stats.schema.json, messages from diagnostic_kinds() of the Python module, which must be
found on the path. With --check nothing is written, and the status is 1 if a page would change.
"""
import difflib
import json
import os
import re
import subprocess
import sys
import tempfile

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
GUIDE = os.path.join(SOURCE, "data", "guide")
NOTICE = "<!-- Made by tools/docs/generate.py (cmake --build build/release --target docs). Changes here are lost. -->\n\n"

# Units of the options that are numbers; the program's own definitions have none.
UNITS = {
    "--threads": "threads", "--memory-limit": "GB (2^30 bytes)", "--time-limit": "seconds", "--seed": "",
    "--target-tets": "tets", "--tolerance": "input units, or % of the diagonal", "--max-edge": "input units, or % of the diagonal",
    "--min-edge": "input units, or % of the diagonal", "--min-gap": "input units, or % of the diagonal",
    "--min-thickness": "input units, or % of the diagonal", "--grading": "length per length", "--min-solid-angle": "steradians",
    "--only-below": "steradians", "--max-iterations": "iterations", "--beta": "ideal edges", "--gamma": "", "--resolution": "cells",
    "--voxel-size": "input units", "--adaptivity": "finest cells", "--max-refinement": "halvings", "--feature-angle": "degrees",
    "--voxels": "voxels", "--grains": "grains", "--layer": "input units", "--region": "input units", "--cap": "input units", "--contact-tolerance": "input units, or % of the diagonal", "--extend": "input units, or % of the diagonal",
    "--base": "input units", "--thicken": "input units, or % of the diagonal", "--min-voxels": "voxels", "--spacing": "input units", "--dimensions": "voxels", "--outside-label": "label", "--labels": "labels", "--protect-labels": "labels", "--order": "", "--min-modulus": "of the modulus", "--bins": "of the image", "--parts": "parts", "--jobs": "jobs",
}
NAMED_TYPES = ("NAME=FILE", "NAME=THICKNESS", "NAME=IMAGE", "NAME=N|A,B,...", "NAME=A,B[,S,T]")
COMMANDS_ORDER = ("prepare", "mesh", "simplify", "improve", "values", "embed", "check", "batch", "sample")


class Program:
    """The program, called in an empty folder."""

    def __init__(self, path, folder):
        self._path = os.path.abspath(path)
        self._folder = folder

    def run(self, *arguments):
        return subprocess.run([self._path, *arguments], cwd=self._folder, capture_output=True, text=True, check=False)

    def help(self, *command):
        return self.run(*command, "--help").stdout

    def write(self, name, text):
        with open(os.path.join(self._folder, name), "w", encoding="utf-8") as file:
            file.write(text)


def cell(text):
    """A text as a cell of a table."""
    return text.replace("|", "\\|").replace("\n", " ").strip()


def sentence(text):
    """Begins with a capital and ends with a stop."""
    text = text.strip()
    return text if not text or text[-1] in ".!?" else text + "."


def options_of(help_text):
    """(names, type, default, required, description) of each option of a command, from its help."""
    found = []
    lines = help_text.splitlines()
    for i, line in enumerate(lines):
        head = re.match(r"^  ((?:-\w,)?--[a-z][a-z-]*)(.*)$", line)
        if not head:
            continue
        rest = head[2]
        split = re.match(r"^(| \S.*?)(?:\s{2,}(\S.*))?$", rest)
        value, description = split[1].strip(), split[2]
        if description is None:
            description = lines[i + 1].strip()
        required = value.endswith(" REQUIRED")
        value = value.removesuffix(" REQUIRED").removesuffix(" ...")
        # NAME=FILE is a type, N=3 a type with a default.
        kind, default = value, ""
        if "=" in value and value not in NAMED_TYPES:
            kind, default = value.split("=", 1)
        elif bracketed := re.match(r"^(\S+) \[(.*)\]$", value):  # CLI11 2.4
            kind, default = bracketed[1], bracketed[2]
        found.append((head[1].split(","), kind, default, required, description))
    return found


def range_of(program, command, option, kind):
    """What the program says that a value must be, by giving it none of that kind."""
    answer = program.run(command, option, "x=?" if "=" in kind else "?").stderr
    found = re.search(r"'(?:x=)?\?' is (?:not one of |not (?:an? )?|neither an? )(.*?)(?: \(tetwright|$)", answer, re.M)
    if not found:
        return ""
    text = re.sub(r"^(?:whole )?number (?:from |of )?|^(?:solid )?angle from |^length (?=above)", "", found[1])
    text = text.replace(" nor ", " or ").replace(" in input units, or in percent of the diagonal, such as 0.2%", "")
    return re.sub(r"\d{5,}", lambda digits: f"{int(digits[0]):,}", text)


def options_page(program):
    text = NOTICE + "# Options\n\nEach option of each command, as the program defines it. A flag has no value. Lengths with % are of the diagonal of the bounding box.\n" \
        "In Python `--min-solid-angle 0.1` is `min_solid_angle=0.1`, a flag is `True`.\n"
    ranges = {}
    for command in COMMANDS_ORDER:
        help_text = program.help(command)
        usage = help_text.splitlines()[0]
        text += f"\n## {command}\n\n{cell(usage)}.\n\n"
        block = re.search(r"^Positionals:\n((?: {2}.*\n)+)", help_text, re.M)
        for positional in re.finditer(r"^  (\S+)(.*?)\n((?: {10,}.*\n)?)", block[1] if block else "", re.M):
            described = re.sub(r"^.*?\s{2,}", "", positional[2]) if re.search(r"\s{2,}\S", positional[2]) else positional[3]
            text += f"**{positional[1]}**: {cell(sentence(described.strip()))}\n\n"
        text += "| option | value | unit | default | range | effect |\n| --- | --- | --- | --- | --- | --- |\n"
        for names, kind, default, required, description in options_of(help_text):
            if "--help" in names:
                continue
            option = names[-1]
            numeric = kind in ("N", "NUMBER", "LENGTH", "LABEL", "LIST", "NAME=THICKNESS") or "DEGREES" in kind
            if numeric and option not in UNITS:
                raise SystemExit(f"generate.py: {option} has no unit in UNITS")
            if option not in ranges:
                ranges[option] = range_of(program, command, option, kind) if kind and kind not in ("FILE", "NAME=FILE", "NAME=IMAGE") else ""
            text += "| " + " | ".join(cell(c) for c in (
                ", ".join(f"`{n}`" for n in names), f"`{kind}`" if kind else "flag", UNITS.get(option, ""),
                "required" if required else f"`{default}`" if default else "", ranges[option],
                sentence(description))) + " |\n"
    return text


# A cube of six tets in two materials, with a named patch, and a field of points and one of tets: whatever a format may hold.
EVERYTHING = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
3 1 "bone"
3 2 "soft"
2 7 "inlet"
$EndPhysicalNames
$Nodes
8
1 0 0 0
2 1 0 0
3 0 1 0
4 1 1 0
5 0 0 1
6 1 0 1
7 0 1 1
8 1 1 1
$EndNodes
$Elements
8
1 4 2 1 1 1 2 4 8
2 4 2 1 1 1 4 3 8
3 4 2 1 1 1 3 7 8
4 4 2 2 2 1 7 5 8
5 4 2 2 2 1 5 6 8
6 4 2 2 2 1 6 2 8
7 2 2 7 7 1 3 4
8 2 2 7 7 1 4 2
$EndElements
$NodeData
1
"heat"
1
0
3
0
1
8
1 1
2 2
3 3
4 4
5 5
6 6
7 7
8 8
$EndNodeData
$ElementData
1
"load"
1
0
3
0
1
6
1 1
2 2
3 3
4 4
5 5
6 6
$EndElementData
"""

# The programs that read each format.
USES = {
    "vtu": "ParaView, PyVista, VTK", "pvtu": "ParaView and parallel solvers", "vtkhdf": "ParaView, VTK", "msh22": "Gmsh, most readers of `.msh`", "msh41": "Gmsh 4", "msh41-binary": "Gmsh 4, large meshes",
    "medit": "mmg, Medit, FreeFEM", "medit-binary": "the same, large meshes", "vtk": "SOFA, deal.II, ParaView", "abaqus": "Abaqus, CalculiX",
    "nastran": "Nastran", "febio": "FEBio", "exodus": "MOOSE, Cubit, ParaView", "usd": "OpenUSD", "xdmf": "dolfinx, ParaView", "tetgen": "TetGen and its readers",
}


def listed_extensions(text):
    return re.findall(r"\.[a-z0-9]+(?:\.gz)?", text)


def effect_of(help_text, option):
    return next(described for names, _, _, _, described in options_of(help_text) if option in names)


def tet_formats(program):
    """Rows: format, extension, what it holds, ten-node tets, read."""
    program.write("everything.msh", EVERYTHING)
    help_text = program.help("prepare")
    names = re.search(r"of -o -: (.*?);", effect_of(help_text, "--output-format"))[1].split()
    readable = listed_extensions(re.search(r"Tet mesh: (.*)", program.help("improve"))[1])
    extensions = {"vtu": ".vtu", "pvtu": ".pvtu", "vtkhdf": ".vtkhdf", "medit": ".mesh", "medit-binary": ".meshb", "vtk": ".vtk", "abaqus": ".inp", "nastran": ".bdf", "febio": ".feb", "exodus": ".exo", "usd": ".usda",
                  "xdmf": ".xdmf", "tetgen": ".node"}
    rows = []
    for name in names:
        extension = extensions.get(name, ".msh" if name.startswith("msh") else "")
        if not extension:
            raise SystemExit(f"generate.py: the format {name} has no extension in tet_formats()")
        file = "out_" + name.replace("-", "_") + extension
        done = program.run("improve", "everything.msh", "-o", file, "--output-format", name, "--feature-angle", "off", "--stats", "stats.json")
        if done.returncode not in (0, 1):
            raise SystemExit(f"generate.py: {name}: {done.stderr}")
        notes = done.stderr
        second = program.run("improve", "everything.msh", "-o", file, "--output-format", name, "--order", "2", "--quiet").returncode != 2

        def holds(what):
            return "no" if re.search(rf"\d {what} \(not written", notes) else "yes"
        patches = holds("named patches")
        if patches == "yes" and holds("names of patches") == "no":
            patches = "numbers"
        rows.append((f"`{name}`", f"`{extension}`", "yes" if extension in readable else "no", holds("names of materials"), patches,
                     holds("fields"), "yes" if second else "no", USES.get(name, "")))
    return rows


def formats_page(program):
    with open(os.path.join(SOURCE, "tools", "docs", "formats.md.in"), encoding="utf-8") as file:
        template = file.read()
    table = "| `--output-format` | extension | read | names of materials | patches | fields | `--order 2` | for |\n" + "| --- " * 8 + "|\n"
    table += "".join("| " + " | ".join(row) + " |\n" for row in tet_formats(program))
    help_text = program.help("prepare")
    scans = re.search(r"^  INPUT.*?\n?\s{2,}(Surfaces \(.*)$", help_text, re.M)[1]
    surfaces = listed_extensions(re.search(r"Surfaces \((.*?)\)", scans)[1])
    volumes = listed_extensions(re.search(r"segmented volume \((.*)\)", scans)[1].replace(".vdb of whole numbers", ""))
    meshes = listed_extensions(re.search(r"Tet mesh: (.*)", program.help("improve"))[1])
    boundary = listed_extensions(effect_of(help_text, "--boundary"))
    sample = effect_of(program.help("sample"), "--output")
    written_volumes = listed_extensions(sample.split("segmented volumes:")[1])
    code = lambda extensions: " ".join(f"`{e}`" for e in extensions)
    return NOTICE + template.format(tet_formats=table.rstrip(), surfaces=code(surfaces), volumes=code(volumes), meshes=code(meshes),
                                    boundary=code(boundary), written_volumes=code(written_volumes))


def type_of(schema):
    if "enum" in schema:
        return ", ".join(f"`{value}`" for value in schema["enum"])
    kind = schema.get("type", "object" if "properties" in schema else "")
    if isinstance(kind, list):
        kind = " or ".join(kind)
    if kind == "array":
        items, size = schema.get("items", {}), schema.get("minItems")
        many = f"{size} " if size and size == schema.get("maxItems") else ""
        inner = type_of(items)
        plural = inner.replace("array of", "arrays of", 1) if inner.startswith("array") else inner + "s"
        return f"array of {many}{plural if inner else 'values'}"
    return kind


def statistics_rows(name, schema, definitions, required, rows):
    if "$ref" in schema:
        description = schema.get("description", "")
        schema = {**definitions[schema["$ref"].split("/")[-1]], **({"description": description} if description else {})}
    for choice in schema.get("oneOf", []) + schema.get("anyOf", []):
        if choice.get("type") != "null":
            choice = definitions[choice["$ref"].split("/")[-1]] if "$ref" in choice else choice
            schema = {**choice, **{k: v for k, v in schema.items() if k not in ("oneOf", "anyOf")}}
    if name:
        rows.append((f"`{name}`", type_of(schema), "" if required else "sometimes", schema.get("description", "")))
    inner = schema
    while inner.get("type") == "array" and isinstance(inner.get("items"), dict):
        inner = inner["items"]
        inner = definitions[inner["$ref"].split("/")[-1]] if "$ref" in inner else inner
        name += "[]"
    for key, value in inner.get("properties", {}).items():
        statistics_rows(f"{name}.{key}" if name else key, value, definitions, key in inner.get("required", []), rows)


def statistics_page(_):
    text = NOTICE + "# Statistics\n\n`--stats FILE.json` writes these keys ([schema](../stats.schema.json)), `check --json` those of the second table " \
        "([schema](../check.schema.json)). `[]` stands for each entry of an array. Lengths are in input units, angles in degrees, solid angles in steradians. " \
        "In Python `mesh.stats` and the result of `check` are these objects.\n"
    for title, file in (("--stats", "stats.schema.json"), ("check --json", "check.schema.json")):
        with open(os.path.join(SOURCE, "data", file), encoding="utf-8") as schema_file:
            schema = json.load(schema_file)
        rows = []
        statistics_rows("", schema, schema.get("definitions", {}), True, rows)
        text += f"\n## {title}\n\n| key | type | there | what it is |\n| --- | --- | --- | --- |\n"
        text += "".join("| " + " | ".join(cell(c) for c in row) + " |\n" for row in rows)
    return text


def messages_page(_):
    """The template with a table for each {{kinds FIRST LAST}}: the codes from FIRST to LAST."""
    import tetwright  # this page alone needs it
    kinds = tetwright.diagnostic_kinds()
    names = list(kinds)
    listed = []

    def table(found):
        chosen = names[names.index(found[1]):names.index(found[2]) + 1]
        listed.extend(chosen)
        rows = "| code | severity | message | cause | remedy |\n" + "| --- " * 5 + "|\n"
        for name in chosen:
            kind = kinds[name]
            severity = kind.severity + (" (a)" if kind.acceptable else "")
            rows += "| " + " | ".join([f"`{name}`", severity, *map(cell, (kind.message, kind.cause, kind.remedy))]) + " |\n"
        return rows.rstrip()

    with open(os.path.join(SOURCE, "tools", "docs", "messages.md.in"), encoding="utf-8") as file:
        text = re.sub(r"\{\{kinds (\S+) (\S+)\}\}", table, file.read())
    # Errors have one code for many messages, which the template lists.
    missing = [name for name in names if name not in listed and f"\n| `{name}` | error, status " not in text]
    if missing or len(listed) != len(set(listed)):
        raise SystemExit(f"generate.py: tools/docs/messages.md.in must list each code once; it lacks {missing}")
    return NOTICE + text


PAGES = {"options.md": options_page, "formats.md": formats_page, "statistics.md": statistics_page, "messages.md": messages_page}


def main():
    if len(sys.argv) < 2 or sys.argv[2:] not in ([], ["--check"]) or not os.access(sys.argv[1], os.X_OK):
        raise SystemExit("usage: generate.py TETWRIGHT [--check]")
    program, check = sys.argv[1], sys.argv[2:] == ["--check"]
    changed = False
    with tempfile.TemporaryDirectory(prefix="tetwright-docs-") as folder:
        for name, make in PAGES.items():
            path = os.path.join(GUIDE, name)
            made = make(Program(program, folder))
            old = ""
            if os.path.exists(path):
                with open(path, encoding="utf-8") as file:
                    old = file.read()
            if made == old:
                continue
            changed = True
            if check:
                sys.stdout.writelines(difflib.unified_diff(old.splitlines(True), made.splitlines(True), "committed/" + name, "made/" + name, n=0))
            else:
                with open(path, "w", encoding="utf-8") as file:
                    file.write(made)
    if check and changed:
        print("generated pages are not what tools/docs/generate.py makes: cmake --build build/release --target docs")
        sys.exit(1)


if __name__ == "__main__":
    main()

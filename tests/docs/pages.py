# SPDX-License-Identifier: Apache-2.0
"""Reads the Markdown pages of README and guide: fenced blocks, links, anchors, and text in code."""
import dataclasses
import os
import re

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

FENCE = re.compile(r"^```(.*)$")


@dataclasses.dataclass
class Block:
    """A fenced block: its language, the attributes after it, its text and its first line."""
    language: str
    attributes: dict
    text: str
    line: int


def guide_pages():
    """Returns the paths of README.md, CONTRIBUTING.md and the pages of the guide."""
    guide = os.path.join(SOURCE, "data", "guide")
    names = sorted(name for name in os.listdir(guide) if name.endswith(".md"))
    return [os.path.join(SOURCE, "README.md"), os.path.join(SOURCE, "CONTRIBUTING.md"),
            *(os.path.join(guide, name) for name in names)]


def all_pages():
    """Returns all Markdown pages of the source: guide_pages() and the READMEs of folders."""
    found = []
    for folder, folders, names in os.walk(SOURCE):
        folders[:] = [name for name in folders if name not in ("build", "out", "shared") and not name.startswith(".")]
        found += [os.path.join(folder, name) for name in names if name.endswith(".md")]
    return sorted(found)


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def attributes_of(words):
    """Parses `no-run status=1` into a dict; an attribute without a value is True."""
    out = {}
    for word in words:
        name, equals, value = word.partition("=")
        out[name] = value if equals else True
    return out


def blocks(text):
    """Returns the fenced blocks of a page, in order."""
    found, lines, begin = [], [], None
    for number, line in enumerate(text.splitlines(), 1):
        fence = FENCE.match(line)
        if fence and begin is None:
            begin, words, lines = number, fence[1].split(), []
        elif fence:
            language = words[0] if words else ""
            found.append(Block(language, attributes_of(words[1:]), "\n".join(lines) + "\n", begin))
            begin = None
        elif begin is not None:
            lines.append(line)
    if begin is not None:
        raise ValueError(f"the block that begins in line {begin} has no end")
    return found


def prose(text):
    """Returns a page without its fenced blocks; their lines become empty, so that the other lines keep their
    numbers."""
    out, inside = [], False
    for line in text.splitlines():
        if FENCE.match(line):
            inside = not inside
            out.append("")
        else:
            out.append("" if inside else line)
    return "\n".join(out)


def without_code(text):
    """Returns prose without `code`."""
    return re.sub(r"`[^`\n]*`", lambda code: " " * len(code[0]), prose(text))


def links(text):
    """Returns (target, line) of each link and picture."""
    found = []
    for number, line in enumerate(without_code(text).splitlines(), 1):
        found += [(target, number) for target in re.findall(r"\]\(([^)\s]+)\)", line)]
        found += [(target, number) for target in re.findall(r'<(?:img|a)\b[^>]*?(?:src|href)="([^"]+)"', line)]
    return found


def anchors(text):
    """Returns the anchors that GitHub generates for a page's headings."""
    found, seen = set(), {}
    for line in prose(text).splitlines():
        heading = re.match(r"#+\s+(.*)", line)
        if not heading:
            continue
        name = re.sub(r"[^\w\- ]", "", re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1]).lower()).replace(" ", "-")
        count = seen.get(name, 0)
        seen[name] = count + 1
        found.add(name if count == 0 else f"{name}-{count}")
    return found

# SPDX-License-Identifier: Apache-2.0
"""Exchanges surfaces between the programs: reads .off files written by tetwright, and writes .stl files for Gmsh."""


def read_off(path):
    """Returns points as triples of numbers and triangles as triples of their indices."""
    with open(path, encoding="ascii") as file:
        words = iter(file.read().split())
    if next(words) != "OFF":
        raise ValueError(f"{path}: not an OFF file")
    points, triangles, _ = (int(next(words)) for _ in range(3))
    places = [[float(next(words)) for _ in range(3)] for _ in range(points)]
    faces = []
    for _ in range(triangles):
        if next(words) != "3":
            raise ValueError(f"{path}: a face that is no triangle")
        faces.append([int(next(words)) for _ in range(3)])
    return places, faces


def write_stl(places, faces, path):
    """Writes text with all digits, so that equal points stay equal; readers compute the normals."""
    with open(path, "w", encoding="ascii") as file:
        file.write("solid body\n")
        for face in faces:
            file.write("facet normal 0 0 0\nouter loop\n")
            for corner in face:
                file.write("vertex " + " ".join(map(repr, places[corner])) + "\n")
            file.write("endloop\nendfacet\n")
        file.write("endsolid body\n")

# SPDX-License-Identifier: Apache-2.0
"""Cases of the folder `assemblies` in that of TETWRIGHT_DATA, which is not part of this repository."""
import os
import pathlib

import numpy as np

import surfaces as sf
from case import FLAT, ROUND, Case, Input, case, expectations, of_partition, sheet_expectations
from cases_walls import patches_of
from partition import conforming


def data(file):
    folder = os.environ.get("TETWRIGHT_DATA")
    if not folder:
        raise FileNotFoundError("TETWRIGHT_DATA is not set")
    return pathlib.Path(folder) / "assemblies" / file


def as_it_is(name, file):
    """Returns an input and the bytes of its file."""
    path = data(file)
    return Input(name, (np.zeros((0, 3)), np.zeros((0, 3), int)), path.suffix, closed=False), path.read_bytes()


def of_files(files, partition, tolerance, **more):
    """Makes the case of files as they are; `files` is name to file."""
    inputs, raw = [], {}
    for name, file in files.items():
        one, content = as_it_is(name, file)
        inputs.append(one)
        raw[one.file] = content
    return of_partition(partition, inputs, tolerance, raw_files=raw, **more)


def bodies(*files):
    return conforming([sf.read_off(data(file)) for file in files])


@case("data_two_rot")
def _():
    return of_files({"a": "two_rot_a.off", "b": "two_rot_b.off"}, bodies("two_rot_a.off", "two_rot_b.off"), FLAT)


@case("data_rings")
def _():
    files = ("ring_H1H2.off", "ring_H2H3.off", "ring_H3H4.off")
    return of_files({file[5:-4]: file for file in files}, bodies(*files), ROUND)


def layers():
    return conforming(list(sf.read_stl_solids(data("layers69_solids.stl")).values()))


@case("data_layers_solids")
def _():
    return of_files({"layers": "layers69_solids.stl"}, layers(), ROUND, options=["--split-solids"])


@case("data_layers_one_file")
def _():
    return of_files({"layers": "layers69.off"}, layers(), ROUND, by_position=True)


SUBDOMAINS = tuple(f"cgal3897_sub{k}.off" for k in (1, 2, 3))


@case("data_subdomains")
def _():
    return of_files({file[9:-4]: file for file in SUBDOMAINS}, bodies(*SUBDOMAINS), ROUND)


@case("data_subdomains_one_file")
def _():
    return of_files({"subdomains": "cgal3897_one_file.off"}, bodies(*SUBDOMAINS), ROUND, by_position=True)


@case("data_subdomains_patches")
def _():
    """The sheets of the one file, each in a file of its own: connected across edges of two triangles."""
    points, triangles = sf.read_off(data("cgal3897_one_file.off"))
    return of_partition(bodies(*SUBDOMAINS), patches_of(points, triangles), ROUND, by_position=True)


def horizons():
    block = sf.read_off(data("cgal_horizons-domain.off"))
    block = block[0], sf.oriented(*block)
    sheets = sf.read_off(data("cgal_horizons.off"))
    return block, sheets


def horizon_inputs():
    domain, block_bytes = as_it_is("block", "cgal_horizons-domain.off")
    sheet, sheet_bytes = as_it_is("horizons", "cgal_horizons.off")
    return domain, sheet, {domain.file: block_bytes, sheet.file: sheet_bytes}


@case("data_horizons_sheet")
def _():
    block, sheets = horizons()
    domain, sheet, raw = horizon_inputs()
    expect = expectations(conforming([block]).topology(), {1: block}, FLAT)
    expect["sheets"] = {"horizons": sheet_expectations(sheets, ROUND)}
    return Case([domain], expect, {1: block}, sheets=[sheet], judged_sheets={"horizons": sheets}, raw_files=raw)


@case("data_horizons_partition")
def _():
    """The sheets end before the walls, and how they are continued is up to the program: areas have wide ranges, and there
    is no surface of a layer to compare with. The layers are stacked along y."""
    block, (points, triangles) = horizons()
    domain, sheet, raw = horizon_inputs()
    count, piece = sf.pieces(triangles)
    parts = sorted((triangles[piece == k] for k in range(count)), key=lambda t: points[np.unique(t), 1].mean())
    low, high = block[0].min(axis=0), block[0].max(axis=0)
    section = (high[0] - low[0]) * (high[2] - low[2])
    expect = {"valid": True, "materials": count + 1, "domain": conforming([block]).topology()["domain"]}
    levels = [low[1], *(points[np.unique(t), 1].mean() for t in parts), high[1]]
    for k in range(1, count + 2):
        expect[f"material {k}"] = dict(expect["domain"])
    for k, part in enumerate(parts, 1):
        own = sf.area(points, part)
        projected = np.abs(sf.normals(points, part)[:, 1]).sum() / 2
        expect[f"interface {k}|{k + 1}"] = {"components": 1, "euler": 1,
                                            "area": [own * (1 - ROUND.area), 1.1 * own * section / projected]}
    expect["interface 1|3"] = None
    total = sf.volume(*block)
    middle = (low + high) / 2
    places = {k + 1: np.array((middle[0], (levels[k] + levels[k + 1]) / 2, middle[2])) for k in range(count + 1)}
    # Sheets that bend: a layer has half to twice the volume of a flat one between mean levels.
    expect["volume"] = {str(k + 1): [total * (levels[k + 1] - levels[k]) / (high[1] - low[1]) * f for f in (0.5, 2)]
                        for k in range(count + 1)}
    return Case([domain], expect, walls=[sheet], places=places, raw_files=raw,
                options=["--extend", "25%"], note="the horizons end before the walls, so that they have to be continued")

# SPDX-License-Identifier: Apache-2.0
"""Fills a closed surface with Netgen's tets; keeps the surface's triangles.

usage: netgen_mesh.py SURFACE.off GRADING OUT.msh    (Debian's python3-netgen; prints the number of tets)

GRADING tells how fast tets may grow away from the surface, and thus controls the number of tets.
"""
import sys

from netgen.meshing import Element2D, FaceDescriptor, Mesh, MeshingParameters, MeshPoint, Pnt

from off_surface import read_off


def main():
    path, grading, out = sys.argv[1], float(sys.argv[2]), sys.argv[3]
    places, faces = read_off(path)
    mesh = Mesh(3)
    numbers = [mesh.Add(MeshPoint(Pnt(*place))) for place in places]
    surface = mesh.Add(FaceDescriptor(bc=1, domin=1, surfnr=1))
    for face in faces:
        mesh.Add(Element2D(surface, [numbers[i] for i in face]))
    mesh.GenerateVolumeMesh(MeshingParameters(grading=grading))
    mesh.OptimizeVolumeMesh()
    mesh.Export(out, "Gmsh2 Format")
    print(f"tets {len(mesh.Elements3D())}")


main()

# SPDX-License-Identifier: Apache-2.0
"""A scan and an array of labels to tet meshes: scan_and_labels.py SCAN OUTPUT"""
import sys

import numpy as np
import tetwright

mesh = tetwright.prepare(sys.argv[1], target_tets=2000, tolerance="1%")
print(f"{len(mesh.tets)} tets, smallest solid angle {mesh.stats['result']['min_solid_angle']:.3f} sr")
mesh.write(sys.argv[2])

grid = np.indices((32, 32, 32)) - 15.5
labels = (np.linalg.norm(grid, axis=0) < 12).astype(int) + (np.linalg.norm(grid, axis=0) < 6)
organ = tetwright.prepare(labels, spacing=0.8, target_tets=3000)
print(organ, organ.material_names, f"{organ.interfaces.on_boundary.sum()} faces on the boundary")

// SPDX-License-Identifier: Apache-2.0
"use strict";
// The mesh of the page: decodes its arrays, finds the faces between tets, and says which of them can be seen.

/** The bytes of the element `id`, or null where the page has none. */
function bytes_of(id) {
  const element = document.getElementById(id);
  if (!element) return null;
  const text = atob(element.textContent);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** Little-endian whole numbers of `size` bytes each. */
function numbers_of(id, size) {
  const bytes = bytes_of(id);
  if (!bytes) return null;
  const count = bytes.length / size;
  const numbers = size === 1 ? bytes : size === 2 ? new Uint16Array(count) : new Uint32Array(count);
  if (size > 1)
    for (let i = 0, at = 0; i < count; ++i) {
      let value = 0;
      for (let k = 0; k < size; ++k) value += bytes[at++] * 2 ** (8 * k);
      numbers[i] = value;
    }
  return numbers;
}

function read_mesh() {
  const about = JSON.parse(document.getElementById("description").textContent);
  const indices = about.index_bytes, materials = about.material_bytes;
  return {
    about,
    points: numbers_of("points", 2),
    tets: numbers_of("tets", indices) || new Uint16Array(0),
    tags: numbers_of("tags", materials) || new Uint8Array(0),
    solid: bytes_of("solid") || new Uint8Array(0),
    dihedral: bytes_of("dihedral") || new Uint8Array(0),
    layer: bytes_of("layer"),
    triangles: numbers_of("triangles", indices),
    sides: numbers_of("sides", materials),
    distance: numbers_of("distance", 2),
  };
}

// Face i of a positive tet lies opposite its corner i; its normal points out.
const FACES = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
const NONE = 0xffffffff;

/**
 * All faces once, as 4 * tet + face of the first tet and, or NONE, of the second. Faces are found by their smallest
 * corner, in whose list the other two are looked for.
 */
function find_faces(tets, point_count) {
  const count = tets.length;  // four faces a tet, as many as corners
  const first = new Uint32Array(count), second = new Uint32Array(count);
  const middle = new Uint32Array(count), last = new Uint32Array(count), next = new Uint32Array(count);
  const head = new Uint32Array(point_count).fill(NONE);
  let faces = 0;
  for (let f = 0; f < count; ++f) {
    const at = f & ~3, local = FACES[f & 3];
    const a = tets[at + local[0]], b = tets[at + local[1]], c = tets[at + local[2]];
    const low = Math.min(a, b, c), high = Math.max(a, b, c), between = a + b + c - low - high;
    let found = head[low];
    while (found !== NONE && (middle[found] !== between || last[found] !== high || second[found] !== NONE))
      found = next[found];
    if (found !== NONE) {
      second[found] = f;
      continue;
    }
    first[faces] = f;
    second[faces] = NONE;
    middle[faces] = between;
    last[faces] = high;
    next[faces] = head[low];
    head[low] = faces++;
  }
  return {first: first.slice(0, faces), second: second.slice(0, faces)};
}

/** Sums of the corners' coordinates along an axis, for each tet (corners = 4) or triangle (3). */
function centre_sums(indices, corners, points, axis) {
  const sums = new Float32Array(indices.length / corners);
  for (let t = 0, i = 0; t < sums.length; ++t) {
    let sum = 0;
    for (let k = 0; k < corners; ++k) sum += points[3 * indices[i++] + axis];
    sums[t] = sum;
  }
  return sums;
}

/**
 * The visible part of the mesh. A whole tet is shown if its material is on and its centre is behind the cut. Calls
 * `emit(a, b, c, tet, on_interface, on_boundary)` for each face to draw, corners counter-clockwise. For a triangle of the skin of
 * a mesh that the page holds only partly, tet is -1 - material.
 */
class VisibleMesh {
  constructor(mesh) {
    this.mesh = mesh;
    this.faces = find_faces(mesh.tets, mesh.about.points);
    this.shown = new Uint8Array(mesh.tags.length);
    this.sums = {};
  }

  sums_along(axis) {
    const {tets, triangles, points} = this.mesh;
    if (!this.sums[axis])
      this.sums[axis] = {
        tets: centre_sums(tets, 4, points, axis),
        triangles: triangles && centre_sums(triangles, 3, points, axis),
      };
    return this.sums[axis];
  }

  /** state: {axis: -1 to 2, cut: coordinate, flip, on: flag of each material} */
  each_face(state, emit) {
    this.show_tets(state);
    const {tets, tags, about} = this.mesh, {first, second} = this.faces, shown = this.shown;
    for (let f = 0; f < first.length; ++f) {
      const one = first[f], two = second[f];
      const sees_one = shown[one >> 2], sees_two = two !== NONE && shown[two >> 2];
      if (sees_one === 1 ? sees_two === 1 : sees_two !== 1) continue;
      const from = sees_one === 1 ? one : two, at = from & ~3, local = FACES[from & 3];
      const border = about.whole && (two === NONE || tags[one >> 2] !== tags[two >> 2]);
      emit(tets[at + local[0]], tets[at + local[1]], tets[at + local[2]], from >> 2, border, about.whole && two === NONE);
    }
    if (!about.whole) this.each_skin_triangle(state, emit);
  }

  show_tets(state) {
    const {tags, layer, about} = this.mesh, shown = this.shown;
    const cutting = state.axis >= 0, limit = 4 * state.cut;
    const sums = cutting ? this.sums_along(state.axis).tets : null;
    for (let t = 0; t < shown.length; ++t) {
      let is_shown = state.on[tags[t]];
      if (cutting) is_shown &&= state.flip ? sums[t] > limit : sums[t] <= limit;
      // A layer shows only the tets that its own cut exposes.
      if (!about.whole) is_shown &&= cutting && (layer[t] >> state.axis & 1) === 1;
      shown[t] = is_shown ? 1 : 0;
    }
  }

  each_skin_triangle(state, emit) {
    const {triangles, sides, about} = this.mesh;
    const sums = state.axis >= 0 ? this.sums_along(state.axis).triangles : null, limit = 3 * state.cut;
    const is_on = side => side < about.materials.length && state.on[side];
    for (let t = 0; t < sides.length / 2; ++t) {
      if (sums && (state.flip ? sums[t] <= limit : sums[t] > limit)) continue;
      const behind = is_on(sides[2 * t]), before = is_on(sides[2 * t + 1]);
      if (behind === before) continue;
      const a = triangles[3 * t], b = triangles[3 * t + 1], c = triangles[3 * t + 2];
      if (behind)
        emit(a, b, c, -1 - sides[2 * t], true, sides[2 * t + 1] >= about.materials.length);
      else
        emit(a, c, b, -1 - sides[2 * t + 1], true, sides[2 * t] >= about.materials.length);
    }
  }
}

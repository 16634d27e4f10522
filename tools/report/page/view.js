// SPDX-License-Identifier: Apache-2.0

// The drawing: triangles with flat shading and lines along their edges, and a camera that turns about the mesh.

const VERTEX_SHADER = `
attribute vec3 colour;
attribute vec3 corner;
varying vec3 v_colour, v_corner, v_normal;
void main() {
  v_colour = colour;
  v_corner = corner;
  v_normal = normalMatrix * normal;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

// A light beside the camera, and some from everywhere. Lines are as wide on the screen whatever the triangle.
const FRAGMENT_SHADER = `
uniform float edges;
varying vec3 v_colour, v_corner, v_normal;
void main() {
  float light = 0.5 + 0.55 * abs(dot(normalize(v_normal), normalize(vec3(0.35, 0.55, 1.0))));
  vec3 width = fwidth(v_corner);
  vec3 inside = smoothstep(width * 0.2, width * 1.1, v_corner);
  float line = 1.0 - min(inside.x, min(inside.y, inside.z));
  // Where triangles are a few pixels large lines would be all there is.
  float fine = max(width.x, max(width.y, width.z));
  line *= edges * 0.5 * (1.0 - smoothstep(0.25, 0.7, fine));
  gl_FragColor = vec4(mix(v_colour * light, vec3(0.08, 0.1, 0.14), line), 1.0);
}`;

/** The camera: where it looks, from which side, how far away; angles in radians. */
const START = {azimuth: -0.65, elevation: 0.35, distance: 2.1, target: [0, 0, 0]};
// Which axis of the mesh is which of x, y and z of the camera, of which z points up.
const UPRIGHT = {z: [0, 1, 2], y: [2, 0, 1], x: [1, 2, 0]};
const FIELD_OF_VIEW = 35;

/** Draws on a canvas. World units: the longest side of the mesh is 1, its middle the origin. */
class View {
  /** Throws where there is no WebGL with the derivatives that lines need. */
  constructor(canvas, mesh) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: true, preserveDrawingBuffer: true});
    this.camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 0.001, 100);
    this.up = "z";
    this.scene = new THREE.Scene();
    this.material = new THREE.ShaderMaterial({
      vertexShader: VERTEX_SHADER,
      fragmentShader: FRAGMENT_SHADER,
      uniforms: {edges: {value: 1}},
      side: THREE.DoubleSide,
      extensions: {derivatives: true},
    });
    this.object = null;
    this.place_points(mesh);
    this.look = {...START, target: [...START.target]};
    this.listeners = [];
    this.waiting = false;
  }

  /** Makes world coordinates of those of 16 bits. */
  place_points(mesh) {
    const {points} = mesh, low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < points.length; ++i) {
      low[i % 3] = Math.min(low[i % 3], points[i]);
      high[i % 3] = Math.max(high[i % 3], points[i]);
    }
    const side = Math.max(high[0] - low[0], high[1] - low[1], high[2] - low[2], 1);
    this.low = low;
    this.high = high;
    this.to_world = (value, axis) => (value - (low[axis] + high[axis]) / 2) / side;
    this.positions = new Float32Array(points.length);
    for (let i = 0; i < points.length; ++i) this.positions[i] = this.to_world(points[i], i % 3);
    const size = Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) / side;
    START.distance = 0.5 * size / Math.sin(FIELD_OF_VIEW / 2 * Math.PI / 180);
  }

  /** Draws these triangles from now on: `corners` are indices into the points, `colours` 0 to 255. */
  set_triangles(corners, colours) {
    const count = corners.length, at = this.positions;
    const position = new Float32Array(3 * count), normal = new Int8Array(3 * count), corner = new Uint8Array(3 * count);
    for (let i = 0; i < count; ++i) {
      const p = 3 * corners[i];
      position.set([at[p], at[p + 1], at[p + 2]], 3 * i);
      corner[3 * i + i % 3] = 1;
    }
    for (let i = 0; i < 3 * count; i += 9) fill_normal(position, normal, i);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(normal, 3, true));
    geometry.setAttribute("colour", new THREE.BufferAttribute(colours, 3, true));
    geometry.setAttribute("corner", new THREE.BufferAttribute(corner, 3));
    if (this.object) {
      this.scene.remove(this.object);
      this.object.geometry.dispose();
    }
    this.object = new THREE.Mesh(geometry, this.material);
    this.object.frustumCulled = false;
    this.scene.add(this.object);
    this.redraw();
  }

  set_edges(on) {
    this.material.uniforms.edges.value = on ? 1 : 0;
    this.redraw();
  }

  set_background(colour) {
    this.renderer.setClearColor(new THREE.Color(colour));
    this.redraw();
  }

  /** Calls `listener` after each drawing. */
  on_draw(listener) { this.listeners.push(listener); }

  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.waiting = false;
    const {clientWidth: width, clientHeight: height} = this.canvas.parentElement;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    const {distance, target} = this.look, towards = this.towards();
    this.camera.position.set(...target.map((value, axis) => value + distance * towards[axis]));
    this.camera.up.set(...["x", "y", "z"].map(axis => axis === this.up ? 1 : 0));
    this.camera.near = Math.max(distance / 100, 1e-4);
    this.camera.far = distance + 4;
    this.camera.lookAt(...target);
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
    for (const listener of this.listeners) listener();
  }

  /** The direction from what is looked at to the camera, of length 1. */
  towards() {
    const {azimuth, elevation} = this.look, out = [0, 0, 0], flat = Math.cos(elevation);
    [flat * Math.cos(azimuth), flat * Math.sin(azimuth), Math.sin(elevation)].forEach((value, i) => {
      out[UPRIGHT[this.up][i]] = value;
    });
    return out;
  }

  /** Makes an axis of the mesh, x, y or z, point up. */
  set_up(axis) {
    this.up = axis;
    this.redraw();
  }

  /** Where a place of the world is on the canvas, in pixels, or null behind the camera. */
  on_canvas(place) {
    const p = new THREE.Vector3(...place).project(this.camera);
    if (p.z > 1) return null;
    return [(p.x + 1) / 2 * this.canvas.clientWidth, (1 - p.y) / 2 * this.canvas.clientHeight];
  }

  /** Index of the nearest drawn triangle at a pixel of the canvas; -1 where there is none. */
  pick(x, y) {
    const at = depth => new THREE.Vector3(2 * x / this.canvas.clientWidth - 1, 1 - 2 * y / this.canvas.clientHeight, depth)
      .unproject(this.camera);
    const from = at(-1), along = at(1).sub(from), position = this.object.geometry.getAttribute("position").array;
    const a = new THREE.Vector3(), ab = new THREE.Vector3(), ac = new THREE.Vector3();
    let nearest = Infinity, found = -1;
    for (let i = 0; i < position.length; i += 9) {
      a.fromArray(position, i);
      ab.fromArray(position, i + 3).sub(a);
      ac.fromArray(position, i + 6).sub(a);
      // Moeller & Trumbore 1997.
      const across = along.clone().cross(ac), volume = ab.dot(across);
      if (volume === 0) continue;
      const to = from.clone().sub(a), u = to.dot(across) / volume;
      if (u < 0 || u > 1) continue;
      const beside = to.cross(ab), v = along.dot(beside) / volume, distance = ac.dot(beside) / volume;
      if (v < 0 || u + v > 1 || distance < 0 || distance >= nearest) continue;
      nearest = distance;
      found = i / 9;
    }
    return found;
  }

  turn(right, up) {
    const steepest = Math.PI / 2 - 0.001;
    this.look.azimuth -= right;
    this.look.elevation = Math.min(steepest, Math.max(-steepest, this.look.elevation + up));
    this.redraw();
  }

  /** Moves what is looked at by pixels of the canvas. */
  move(right, down) {
    const scale = 2 * this.look.distance * Math.tan(FIELD_OF_VIEW / 2 * Math.PI / 180) / this.canvas.clientHeight;
    const x = new THREE.Vector3(), y = new THREE.Vector3();
    this.camera.matrix.extractBasis(x, y, new THREE.Vector3());
    const step = x.multiplyScalar(-right * scale).add(y.multiplyScalar(down * scale));
    this.look.target = this.look.target.map((value, i) => value + step.getComponent(i));
    this.redraw();
  }

  zoom(factor) {
    this.look.distance = Math.min(40, Math.max(0.01, this.look.distance * factor));
    this.redraw();
  }

  /** Looks as `goal` says, by a flight unless the reader wants no motion. */
  fly_to(goal) {
    const from = {...this.look}, turn = 2 * Math.PI;
    const around = ((goal.azimuth - from.azimuth) % turn + 1.5 * turn) % turn - turn / 2;
    const milliseconds = matchMedia("(prefers-reduced-motion: reduce)").matches ? 0 : 500;
    const start = performance.now(), flight = this.flight = {};
    const step = now => {
      if (this.flight !== flight) return;
      const share = milliseconds ? Math.min(1, Math.max(0, (now - start) / milliseconds)) : 1;
      const eased = share * share * (3 - 2 * share), mix = (a, b) => a + (b - a) * eased;
      this.look = {
        azimuth: from.azimuth + around * eased,
        elevation: mix(from.elevation, goal.elevation),
        distance: from.distance * (goal.distance / from.distance) ** eased,
        target: goal.target.map((value, i) => mix(from.target[i], value)),
      };
      this.redraw();
      if (share < 1) requestAnimationFrame(step);
    };
    step(start);
  }

  show_all() { this.fly_to(START); }

  /** The angles of a direction of the world; those of now where it has none. */
  angles_of(direction) {
    const steepest = 1.2, [x, y, z] = UPRIGHT[this.up].map(axis => direction[axis]), flat = Math.hypot(x, y);
    return {
      azimuth: flat < 1e-6 ? this.look.azimuth : Math.atan2(y, x),
      elevation: Math.hypot(flat, z) < 1e-6 ? this.look.elevation : Math.max(-steepest, Math.min(steepest, Math.atan2(z, flat))),
    };
  }

  /** Looks at a place from outside, near enough to see the tets about it. */
  show_place(place) {
    this.fly_to({
      ...this.angles_of(place),
      distance: 0.6,
      target: place,
    });
  }
}

/** The normal of the triangle whose nine coordinates begin at `i`, for all of its corners. */
function fill_normal(position, normal, i) {
  const ux = position[i + 3] - position[i], uy = position[i + 4] - position[i + 1], uz = position[i + 5] - position[i + 2];
  const vx = position[i + 6] - position[i], vy = position[i + 7] - position[i + 1], vz = position[i + 8] - position[i + 2];
  const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
  const scale = 127 / (Math.hypot(x, y, z) || 1);
  for (let k = i; k < i + 9; k += 3) {
    normal[k] = Math.round(x * scale);
    normal[k + 1] = Math.round(y * scale);
    normal[k + 2] = Math.round(z * scale);
  }
}

/** Mouse, fingers, wheel and keys. `click` is called with the pixel of a click that is no drag. */
function steer(view, element, click) {
  const pointers = new Map(), max_pixels = 3;
  let dragged = 0;
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  const canvas = view.canvas, radians_per_pixel = 0.008;
  canvas.addEventListener("pointerdown", event => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    view.flight = null;
    dragged = pointers.size > 1 || event.button !== 0 || event.shiftKey ? Infinity : 0;
  });
  canvas.addEventListener("pointermove", event => {
    const last = pointers.get(event.pointerId);
    if (!last) return;
    const right = event.clientX - last.x, down = event.clientY - last.y;
    const before = pointers.size === 2 ? spread() : 0;
    dragged += Math.abs(right) + Math.abs(down);
    pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    if (pointers.size === 2) {
      view.zoom(before / Math.max(1, spread()));
      view.move(right / 2, down / 2);
    } else if (event.shiftKey || event.buttons & 6) {
      view.move(right, down);
    } else {
      view.turn(right * radians_per_pixel, down * radians_per_pixel);
    }
  });
  canvas.addEventListener("pointerup", event => {
    if (!pointers.has(event.pointerId) || dragged > max_pixels) return;
    const {left, top} = canvas.getBoundingClientRect();
    click(event.clientX - left, event.clientY - top);
  });
  for (const kind of ["pointerup", "pointercancel"])
    canvas.addEventListener(kind, event => pointers.delete(event.pointerId));
  canvas.addEventListener("contextmenu", event => event.preventDefault());
  canvas.addEventListener("wheel", event => {
    event.preventDefault();
    view.zoom(Math.exp(Math.max(-1, Math.min(1, event.deltaY * 0.0015))));
  }, {passive: false});
  const step = 0.12, keys = {
    ArrowLeft: () => view.turn(-step, 0),
    ArrowRight: () => view.turn(step, 0),
    ArrowUp: () => view.turn(0, -step),
    ArrowDown: () => view.turn(0, step),
    "+": () => view.zoom(0.85),
    "=": () => view.zoom(0.85),
    "-": () => view.zoom(1 / 0.85),
    0: () => view.show_all(),
  };
  element.addEventListener("keydown", event => {
    if (event.target !== element || event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
    event.preventDefault();
    view.flight = null;
    keys[event.key]();
  });
}

// SPDX-License-Identifier: Apache-2.0

// The controls, and the quantities that colours show.

// Colours that people with any kind of colour vision tell apart (Paul Tol, "bright" and "muted").
const MATERIAL_COLOURS = [
  "#6699cc", "#ee8866", "#44aa77", "#ddaa33", "#aa4499", "#66ccee", "#994455", "#999933", "#4477aa", "#ffaabb",
  "#225555", "#cc6677", "#bbcc33", "#8877bb", "#996633",
];
const OUTSIDE_TAG = 0, OUTSIDE_COLOUR = "#b4b9c2", UNMEASURED = [176, 180, 188];

// From bad to good, by way of light colours (after ColorBrewer's RdYlBu); and from near to far (after viridis).
const BAD_TO_GOOD = ["#a50f26", "#e34a33", "#fdae61", "#f4eda0", "#a6d5e0", "#5b9ac9", "#2f5fa8"];
const NEAR_TO_FAR = ["#fbf6d9", "#f5d66b", "#e99a3e", "#cf5a4f", "#93356f", "#4b1d6b"];

const rgb_of = hex => [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16));

/** 256 colours along a scale, three bytes each. */
function ramp(stops) {
  const colours = stops.map(rgb_of), out = new Uint8Array(256 * 3);
  for (let i = 0; i < 256; ++i) {
    const at = i / 255 * (stops.length - 1), from = Math.min(Math.floor(at), stops.length - 2);
    for (let k = 0; k < 3; ++k)
      out[3 * i + k] = Math.round(colours[from][k] + (colours[from + 1][k] - colours[from][k]) * (at - from));
  }
  return out;
}

/** At most three significant digits, counted from the leading digit of `size`. */
function short(value, size = value) {
  const decimals = size === 0 ? 0 : 2 - Math.floor(Math.log10(Math.abs(size)));
  return decimals <= 20 && decimals >= 0 ? String(Number(value.toFixed(decimals))) : String(Number(value.toPrecision(3)));
}

// Special values of `distance`.
const FARTHEST = 65534, NOT_MEASURED = 65535;

/**
 * Fraction of the largest distance that 98 % of the points are within, or 1 if it is more than a third: the lid of a
 * hole is far from any scan, and would leave one colour for all other points.
 */
function share_of_most(distance) {
  const counts = new Uint32Array(FARTHEST + 1);
  let left = 0;
  for (const d of distance)
    if (d !== NOT_MEASURED) ++counts[d], ++left;
  left *= 0.98;
  let d = 0;
  while (d < FARTHEST && (left -= counts[d]) > 0) ++d;
  return d > FARTHEST / 3 || d === 0 ? 1 : d / FARTHEST;
}

const byId = id => document.getElementById(id);

class Page {
  constructor(mesh, view) {
    this.mesh = mesh;
    this.view = view;
    this.visible = new VisibleMesh(mesh);
    const materials = mesh.about.materials;
    // Colours of the segmentation are used if it has any.
    this.colours = materials.map((m, i) => m.colour ? m.colour.map(part => Math.round(255 * part)) :
      rgb_of(m.tag === OUTSIDE_TAG && m.name === "outside" ? OUTSIDE_COLOUR : MATERIAL_COLOURS[i % MATERIAL_COLOURS.length]));
    this.state = {
      axis: -1,
      cut: 0,
      flip: false,
      // The air around a body would hide it.
      on: materials.map(m => m.tag !== OUTSIDE_TAG || m.name !== "outside" || materials.length === 1),
    };
    this.scales = this.make_scales();
    this.colour = "material";
    this.drawn = 0;
  }

  /** Quantities that colours can show, by their names in the list. */
  make_scales() {
    const {about, solid, dihedral} = this.mesh;
    const scales = {material: {name: "material"}};
    scales.solid = {name: "smallest solid angle", unit: "sr", max: about.solid_angle_max, of_tets: solid, colours: ramp(BAD_TO_GOOD), stops: BAD_TO_GOOD};
    scales.dihedral = {name: "smallest dihedral angle", unit: "degrees", max: about.dihedral_max, of_tets: dihedral, colours: ramp(BAD_TO_GOOD), stops: BAD_TO_GOOD};
    if (this.mesh.distance) {
      const share = share_of_most(this.mesh.distance);
      scales.distance = {name: "distance to " + about.distance_from, unit: "input units", max: share * about.distance_max, largest: about.distance_max, share, colours: ramp(NEAR_TO_FAR), stops: NEAR_TO_FAR};
    }
    return scales;
  }

  /** Writes the colours of a face's three corners. */
  paint(out, at, corners, tet, on_interface) {
    const scale = this.scales[this.colour], {tags, distance} = this.mesh;
    for (let k = 0; k < 3; ++k) {
      let from = UNMEASURED, i = 0;
      if (this.colour === "material") {
        from = this.colours[tet >= 0 ? tags[tet] : -1 - tet];
      } else if (scale.of_tets) {
        if (tet >= 0) from = scale.colours, i = 3 * scale.of_tets[tet];
      } else if (on_interface && distance[corners[k]] !== NOT_MEASURED) {
        from = scale.colours;
        i = 3 * Math.round(Math.min(1, distance[corners[k]] / FARTHEST / scale.share) * 255);
      }
      out[at++] = from[i];
      out[at++] = from[i + 1];
      out[at++] = from[i + 2];
    }
  }

  update() {
    let size = 1 << 12, corners = new Uint32Array(3 * size), colours = new Uint8Array(9 * size), count = 0;
    const on_boundary = [];
    this.visible.each_face(this.state, (a, b, c, tet, on_interface, is_boundary) => {
      if (count === size) {
        size *= 2;
        const more_corners = new Uint32Array(3 * size), more_colours = new Uint8Array(9 * size);
        more_corners.set(corners);
        more_colours.set(colours);
        corners = more_corners;
        colours = more_colours;
      }
      corners.set([a, b, c], 3 * count);
      on_boundary.push(is_boundary);
      this.paint(colours, 9 * count++, [a, b, c], tet, on_interface);
    });
    this.drawn = count;
    this.corners = corners;
    this.on_boundary = on_boundary;
    this.view.set_triangles(corners.subarray(0, 3 * count), colours.slice(0, 9 * count));
    byId("count").textContent = count.toLocaleString("en") + " triangles drawn.";
  }

  // Controls.

  start() {
    this.make_materials();
    this.make_colours();
    this.make_cut();
    this.make_marks();
    byId("edges").addEventListener("change", event => this.view.set_edges(event.target.checked));
    for (const radio of document.getElementsByName("up"))
      radio.addEventListener("change", () => this.view.set_up(radio.value));
    byId("reset").addEventListener("click", () => this.view.show_all());
    byId("controls").hidden = false;
    byId("controls").addEventListener("submit", event => event.preventDefault());
    steer(this.view, byId("view"), (x, y) => this.print_selection(x, y));
    new ResizeObserver(() => this.view.redraw()).observe(byId("view"));
    const background = () => this.view.set_background(getComputedStyle(byId("view")).backgroundColor);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", background);
    background();
    this.read_address();
    this.set_cut();
    this.set_colour();
    this.update();
    window.addEventListener("hashchange", () => {
      this.read_address();
      this.set_cut();
      this.set_colour();
      this.update();
    });
  }

  /** Prints the option that selects the patch of the face at a pixel. */
  print_selection(x, y) {
    const face = this.view.pick(x, y), output = byId("selection");
    output.hidden = face < 0;
    if (face < 0) return;
    if (!this.on_boundary[face]) {
      output.textContent = "This face is inside the mesh; --select is for faces of its boundary.";
      return;
    }
    const {about, points} = this.mesh;
    // As many decimals as the coordinates of 16 bits have.
    const decimals = Math.min(20, Math.max(0, Math.ceil(-Math.log10(about.step)) + 1));
    const centre = [0, 1, 2].map(axis => {
      let sum = 0;
      for (let k = 0; k < 3; ++k) sum += points[3 * this.corners[3 * face + k] + axis];
      return Number((about.origin[axis] + about.step * sum / 3).toFixed(decimals));
    });
    output.textContent = `--select NAME=patch-at:${centre.join(",")}`;
  }

  make_materials() {
    const list = byId("materials");
    this.mesh.about.materials.forEach((material, i) => {
      const label = document.createElement("label"), box = document.createElement("input");
      const swatch = document.createElement("span");
      box.type = "checkbox";
      box.checked = this.state.on[i];
      box.addEventListener("change", () => {
        this.state.on[i] = box.checked;
        this.update();
      });
      swatch.className = "swatch";
      swatch.style.background = `rgb(${this.colours[i]})`;
      label.append(box, swatch, material.name);
      list.append(label);
    });
  }

  make_colours() {
    const list = byId("colour");
    for (const [key, scale] of Object.entries(this.scales)) list.add(new Option(scale.name, key));
    list.addEventListener("change", () => {
      this.colour = list.value;
      this.set_colour();
      this.update();
    });
  }

  set_colour() {
    const scale = this.scales[this.colour], legend = byId("legend");
    byId("colour").value = this.colour;
    legend.hidden = !scale.stops;
    if (!scale.stops) return;
    byId("legend-title").textContent = `${scale.name}, ${scale.unit}`;
    byId("legend-note").textContent = scale.largest > scale.max ? `largest ${short(scale.largest)}` : "";
    byId("legend-bar").style.background = `linear-gradient(to right, ${scale.stops.join(", ")})`;
    byId("legend-ticks").replaceChildren(...[0, 0.5, 1].map(share => {
      const tick = document.createElement("span");
      const beyond = share === 1 && scale.largest > scale.max;
      tick.textContent = (beyond ? "\u2265 " : "") + short(share * scale.max);
      return tick;
    }));
  }

  make_cut() {
    const {whole, layers} = this.mesh.about, slider = byId("cut");
    const changed = () => {
      this.set_cut();
      this.update();
    };
    for (const radio of document.getElementsByName("axis")) {
      if (!whole && radio.value && !layers["xyz".indexOf(radio.value)]) radio.disabled = true;
      radio.addEventListener("change", () => {
        this.face_cut();
        changed();
      });
    }
    slider.addEventListener("input", changed);
    byId("flip").addEventListener("change", changed);
    // Tets of a mesh that is too large are there only behind the middle, seen from one side.
    if (!whole) byId("flip").disabled = true;
  }

  /** Lets the cut be seen: takes away what is on the camera's side, or turns the camera where only one side is there. */
  face_cut() {
    const chosen = [...document.getElementsByName("axis")].find(radio => radio.checked).value;
    if (!chosen) return;
    const axis = "xyz".indexOf(chosen), towards = this.view.towards()[axis];
    if (this.mesh.about.whole)
      byId("flip").checked = towards < 0;
    else if (towards < 0.3)
      this.view.fly_to({...START, ...this.view.angles_of([0, 1, 2].map(i => i === axis ? 1 : 0.4))});
  }

  /** Takes the cut over from the controls. */
  set_cut() {
    const {whole, origin, step} = this.mesh.about, {low, high} = this.view, slider = byId("cut");
    const chosen = [...document.getElementsByName("axis")].find(radio => radio.checked).value;
    const axis = "xyz".indexOf(chosen || "none");
    slider.disabled = axis < 0 || !whole;
    this.state.axis = axis;
    this.state.flip = byId("flip").checked;
    byId("cut-place").textContent = "";
    if (axis < 0) return;
    this.state.cut = low[axis] + (high[axis] - low[axis]) * Number(slider.value);
    byId("cut-place").textContent = `${chosen} = ${short(origin[axis] + step * this.state.cut, step * (high[axis] - low[axis]) / 10)}`;
  }

  make_marks() {
    const {marks, origin, step} = this.mesh.about, layer = byId("marks");
    const places = marks.map(mark => mark.place.map((value, axis) => this.view.to_world((value - origin[axis]) / step, axis)));
    const choose = number => {
      for (const button of document.querySelectorAll(".mark"))
        button.classList.toggle("chosen", Number(button.dataset.mark) === number);
      this.view.show_place(places[number - 1]);
    };
    const buttons = marks.map((mark, i) => {
      const button = document.createElement("button");
      button.type = "button";
      button.className = "mark";
      button.dataset.mark = i + 1;
      button.title = mark.text;
      button.textContent = i + 1;
      layer.append(button);
      return button;
    });
    for (const button of document.querySelectorAll(".mark"))
      button.addEventListener("click", () => {
        choose(Number(button.dataset.mark));
        byId("view").scrollIntoView({block: "nearest"});
      });
    this.view.on_draw(() => buttons.forEach((button, i) => {
      const at = this.view.on_canvas(places[i]);
      button.hidden = !at;
      if (at) button.style.transform = `translate(${at[0].toFixed(1)}px, ${at[1].toFixed(1)}px) translate(-50%, -50%)`;
    }));
    const box = byId("show-marks");
    box.addEventListener("change", () => { layer.hidden = !box.checked; });
    if (marks.length === 0) box.parentElement.hidden = true;
  }

  /**
   * The part of the address behind #: cut=x,0.5&flip=1&colour=solid&off=2,3 (tags)&edges=0&up=y&look=azimuth,elevation in
   * degrees, distance. What is left out stays as it is.
   */
  read_address() {
    const wanted = new URLSearchParams(location.hash.slice(1));
    let cut_is_seen = false;
    if (wanted.has("cut")) {
      const [axis, share] = wanted.get("cut").split(",");
      for (const radio of document.getElementsByName("axis")) radio.checked = radio.value === axis;
      if (share) byId("cut").value = share;
      if (!wanted.has("flip")) cut_is_seen = true;
    }
    if (wanted.has("flip")) byId("flip").checked = wanted.get("flip") === "1";
    if (wanted.has("edges")) {
      byId("edges").checked = wanted.get("edges") === "1";
      this.view.set_edges(byId("edges").checked);
    }
    if (this.scales[wanted.get("colour")]) this.colour = wanted.get("colour");
    if (wanted.has("off")) {
      const off = wanted.get("off").split(",");
      byId("materials").querySelectorAll("input").forEach((box, i) => {
        box.checked = this.state.on[i] = !off.includes(String(this.mesh.about.materials[i].tag));
      });
    }
    if (UPRIGHT[wanted.get("up")]) {
      this.view.set_up(wanted.get("up"));
      for (const radio of document.getElementsByName("up")) radio.checked = radio.value === wanted.get("up");
    }
    const look = (wanted.get("look") || "").split(",").map(Number);
    if (look.length === 3 && look.every(Number.isFinite)) {
      const radians = Math.PI / 180;
      this.view.look = {azimuth: look[0] * radians, elevation: look[1] * radians, distance: look[2], target: [0, 0, 0]};
    }
    if (cut_is_seen) this.face_cut();
  }
}

/** Whether the browser draws: asked first, since three.js reports to the console what it cannot do. */
function has_webgl() {
  try {
    const context = document.createElement("canvas").getContext("webgl");
    return Boolean(context && context.getExtension("OES_standard_derivatives"));
  } catch {
    return false;
  }
}

function start_page() {
  if (!has_webgl()) {
    byId("message").textContent = "This browser has no WebGL, so there is no 3D view; all statistics are below.";
    byId("message").hidden = false;
    return null;
  }
  const mesh = read_mesh();
  const page = new Page(mesh, new View(byId("canvas"), mesh));
  page.start();
  return page;
}

/** For tests and for the console. */
window.tetwright_page = start_page();

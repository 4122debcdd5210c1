// The mesh in 3D: turning, zooming, names, marks and arrows, and the element below the pointer.

import { areaOf, average, dot, edgeName, length, minus, mix, plus, scale, unit } from "./mesh.js";
import { Raster, pixel } from "./raster.js";

// Larger meshes are drawn without the lines of edges, unless they are seen from near.
const MOST_LINES = 60000;
// Meshes with more elements show the names of chosen and read elements only.
const MOST_NAMES = 90;
// Maximum number of irregular vertices that are marked.
const MOST_DOTS = 1000;
// Distance of the eye from the centre, in radii of the mesh.
const EYE = 4.2;
// The time of a turn to an element, and the angle from its normal at which it is seen then.
const TURN_MS = 300;
const ASLANT = 0.3;
// A mesh with more triangles is not turned: to find out what hides an element would take too long.
const MOST_TURNED = 60000;

export class View {
  // `onChoose(name, more)` is called with the element that is clicked; `more` if Shift is pressed.
  constructor(canvas, overlay, onChoose) {
    this.canvas = canvas;
    this.overlay = overlay;
    this.onChoose = onChoose;
    this.raster = new Raster();
    this.names = { vertex: true, edge: false, face: true, valence: false };
    this.marks = [];
    this.reset();
    this.listen();
    new ResizeObserver(() => this.draw()).observe(overlay);
  }

  reset() {
    this.turning = null;
    this.turn = rotation(0.5, 0.45);
    this.zoom = 1;
    this.shift = [0, 0];
  }

  // Shows a mesh, with a mark after the names of its elements. The view stays as it is if the mesh is at about the same
  // place.
  show(model, suffix = "") {
    this.suffix = suffix;
    const before = this.model;
    this.model = model;
    const moved = before && length(minus(before.centre, model.centre)) > 0.6 * model.radius;
    const resized = before && Math.abs(Math.log(before.radius / model.radius)) > 0.5;
    if (!before || moved || resized) {
      this.centre = model.centre;
      this.radius = model.radius;
    }
    this.shades = null;
    this.draw();
  }

  // Marks elements: { place, colour, label, style } each, `style` fill, dot, line, arrow, thin (an arrow) or ring.
  mark(marks) {
    this.marks = marks;
    this.drawOverlay();
  }

  // Draws at the next frame.
  draw() {
    if (this.isWaiting) return;
    this.isWaiting = true;
    requestAnimationFrame(() => {
      this.isWaiting = false;
      this.drawNow();
    });
  }

  drawNow() {
    if (!this.model) return;
    const box = this.overlay.getBoundingClientRect();
    if (box.width < 2 || box.height < 2) return;
    this.size = [box.width, box.height];
    const started = performance.now();
    this.drawMesh();
    // While a large mesh is turned, it is drawn with fewer pixels.
    const isMoving = this.isTurning || this.turning;
    this.coarse = isMoving && performance.now() - started > 30 ? 2 : isMoving ? this.coarse ?? 1 : 1;
    this.drawOverlay();
  }

  drawMesh() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2) / (this.isTurning || this.turning ? this.coarse ?? 1 : 1);
    const { raster, model } = this;
    const [width, height] = this.size.map((side) => Math.max(1, Math.round(side * ratio)));
    raster.resize(width, height);
    const style = getComputedStyle(document.documentElement);
    const colour = (name) => style.getPropertyValue(name).trim();
    raster.clear(pixel(colour("--view")));
    const points = this.projected(ratio);
    this.shades ??= this.lit(colour("--face"), colour("--back"));
    const { triangles } = model;
    for (let i = 0; i < triangles.length; i += 4) {
      const [a, b, c, face] = [3 * triangles[i], 3 * triangles[i + 1], 3 * triangles[i + 2], triangles[i + 3]];
      const turned = (points[b] - points[a]) * (points[c + 1] - points[a + 1]) -
        (points[b + 1] - points[a + 1]) * (points[c] - points[a]) > 0;
      raster.triangle(points[a], points[a + 1], points[a + 2], points[b], points[b + 1], points[b + 2],
        points[c], points[c + 1], points[c + 2], face, this.shades[2 * face + (turned ? 1 : 0)]);
    }
    if (model.edges.size <= MOST_LINES || this.zoom > 6) {
      const line = pixel(colour("--edge"));
      for (const { ends, faces } of model.edges.values()) {
        const [a, b] = [3 * ends[0], 3 * ends[1]];
        raster.line(points[a], points[a + 1], points[a + 2], points[b], points[b + 1], points[b + 2], line,
          (faces.length === 2 ? 1.1 : 2.2) * ratio);
      }
    }
    this.canvas.width = width;
    this.canvas.height = height;
    this.canvas.getContext("2d").putImageData(raster.image, 0, 0);
    this.ratio = ratio;
  }

  // Draws another mesh on a small canvas, from the same side, so that a third one would fill the canvas.
  drawSmall(canvas, model, { centre, radius }) {
    const size = [canvas.clientWidth, canvas.clientHeight];
    if (size[0] < 2) return;
    const small = Object.assign(Object.create(this), { canvas, model, size, centre, radius, raster: new Raster(), shades: null, zoom: 0.9, shift: [0, 0] });
    small.drawMesh();
  }

  // The colours of both sides of each face: light comes from the eye's left shoulder.
  lit(front, back) {
    const light = [-0.35, 0.5, 0.8].map((part) => part / Math.hypot(0.35, 0.5, 0.8));
    const shades = new Uint32Array(2 * this.model.faces.length);
    this.model.faces.forEach((face, f) => {
      if (!face) return;
      const area = areaOf(face.map((v) => this.model.vertices[v]));
      const size = length(area);
      const normal = this.turned(size > 0 ? scale(area, 1 / size) : [0, 0, 0]);
      const facing = normal[0] * light[0] + normal[1] * light[1] + normal[2] * light[2];
      shades[2 * f] = pixel(front, 0.72 + 0.28 * Math.max(0, facing));
      shades[2 * f + 1] = pixel(back, 0.72 + 0.28 * Math.max(0, -facing));
    });
    return shades;
  }

  turned([x, y, z]) {
    const t = this.turn;
    return [t[0] * x + t[1] * y + t[2] * z, t[3] * x + t[4] * y + t[5] * z, t[6] * x + t[7] * y + t[8] * z];
  }

  // Where a point is on the screen: x and y in pixels of the page, and the depth.
  project(point) {
    const [x, y, z] = this.turned(minus(point, this.centre));
    const near = EYE * this.radius - z;
    const depth = near > 1e-3 * this.radius ? this.radius / near : 0;
    const size = 0.46 * Math.min(...this.size) * this.zoom * EYE;
    return [
      this.size[0] / 2 + this.shift[0] + (x / this.radius) * size * depth,
      this.size[1] / 2 + this.shift[1] - (y / this.radius) * size * depth,
      depth,
    ];
  }

  projected(ratio) {
    const { vertices } = this.model;
    const points = new Float32Array(3 * vertices.length);
    vertices.forEach((vertex, v) => {
      if (!vertex) return;
      const [x, y, depth] = this.project(vertex);
      points.set([x * ratio, y * ratio, depth], 3 * v);
    });
    return points;
  }

  // Whether no face is before a point of the mesh.
  isSeen([x, y, depth]) {
    const around = [[0, 0], [2, 0], [-2, 0], [0, 2], [0, -2]];
    const depths = around.map(([dx, dy]) => this.raster.depthAt((x + dx) * this.ratio, (y + dy) * this.ratio));
    return depth * 1.01 >= Math.min(...depths);
  }

  drawOverlay() {
    if (!this.model || !this.size) return;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = this.size;
    if (this.overlay.width !== Math.round(width * ratio) || this.overlay.height !== Math.round(height * ratio)) {
      this.overlay.width = Math.round(width * ratio);
      this.overlay.height = Math.round(height * ratio);
    }
    const pen = this.overlay.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.lineCap = pen.lineJoin = "round";
    const labels = [];
    const placed = [...this.valenceMarks(), ...this.marks].filter(({ place }) => place);
    // Faces are below what lies in them.
    const isBelow = ({ style }) => style === "fill";
    for (const mark of [...placed.filter(isBelow), ...placed.filter((mark) => !isBelow(mark))]) this.drawMark(pen, mark);
    for (const mark of placed) {
      if (mark.label) labels.push({ text: mark.label, at: mark.place.at, isStrong: !mark.isFaint, ...(mark.style === "thin" && thinLabel(mark.place)) });
    }
    labels.sort((a, b) => Number(a.isThin ?? false) - Number(b.isThin ?? false));
    this.drawLabels(pen, [...labels, ...this.ownNames()]);
  }

  drawMark(pen, { place, colour, style }) {
    const points = place.points.map((point) => this.project(point));
    const at = this.project(place.at);
    const isSeen = this.isSeen(at) || points.some((point) => this.isSeen(point));
    pen.globalAlpha = isSeen ? 1 : 0.45;
    pen.strokeStyle = pen.fillStyle = colour;
    pen.setLineDash(isSeen ? [] : [5, 5]);
    pen.beginPath();
    if (style === "fill") {
      points.forEach(([x, y], i) => (i ? pen.lineTo(x, y) : pen.moveTo(x, y)));
      pen.closePath();
      pen.globalAlpha *= 0.5;
      pen.fill();
      pen.globalAlpha *= 2;
      pen.lineWidth = 2;
      pen.stroke();
    } else if (style === "ring") {
      pen.lineWidth = 3;
      pen.arc(at[0], at[1], 10, 0, 2 * Math.PI);
      pen.stroke();
    } else if (style === "dot") {
      pen.arc(at[0], at[1], 6, 0, 2 * Math.PI);
      pen.fill();
    } else {
      pen.lineWidth = style === "thin" ? 2 : 4;
      const [from, to] = [points[0], points.at(-1)];
      pen.moveTo(from[0], from[1]);
      pen.lineTo(to[0], to[1]);
      pen.stroke();
      if (style !== "line") arrowHead(pen, from, to, style === "thin" ? 9 : 14);
    }
    pen.globalAlpha = 1;
    pen.setLineDash([]);
  }

  // The name of a vertex, its valence, or both.
  vertexLabel(v) {
    const name = `v${v}${this.suffix}`;
    if (!this.names.valence) return name;
    const { valence } = this.model.valences[v];
    return this.names.vertex ? `${name}: ${valence}` : String(valence);
  }

  // Dots for irregular vertices, with their valences in a mesh that is too large for all names.
  valenceMarks() {
    const { model, names } = this;
    if (!names.valence) return [];
    const colour = getComputedStyle(document.documentElement).getPropertyValue("--irregular").trim();
    const irregular = [...model.vertices.keys()].filter((v) => model.valences[v]?.isIrregular).slice(0, MOST_DOTS);
    const isNamed = model.vertexCount > MOST_NAMES && irregular.length <= MOST_NAMES;
    return irregular.map((v) => ({
      place: model.place(`v${v}`), colour, style: "dot", label: isNamed ? this.vertexLabel(v) : null, isFaint: true,
    }));
  }

  // The names of the elements that are seen.
  ownNames() {
    const { model, names } = this;
    const kinds = { vertex: model.vertexCount, edge: model.edges.size, face: model.faceCount };
    const labels = [];
    const add = (text, at) => labels.push({ text: text + this.suffix, at });
    if ((names.vertex || names.valence) && kinds.vertex <= MOST_NAMES) {
      model.vertices.forEach((vertex, v) => vertex && labels.push({ text: this.vertexLabel(v), key: v, at: vertex }));
    }
    if (names.edge && kinds.edge <= MOST_NAMES) {
      for (const { name, ends } of model.edges.values()) {
        add(name, mix(model.vertices[ends[0]], model.vertices[ends[1]], 0.5));
      }
    }
    if (names.face && kinds.face <= MOST_NAMES) {
      model.faces.forEach((face, f) => face && add(`f${f}`, average(face.map((v) => model.vertices[v]))));
    }
    return labels;
  }

  // Draws labels that are seen and do not cover one another, the first ones first.
  drawLabels(pen, labels) {
    const style = getComputedStyle(document.documentElement);
    const [ink, paper] = ["--ink", "--paper"].map((name) => style.getPropertyValue(name).trim());
    const drawn = [];
    const texts = new Set();
    for (const { text, key = text, at, isStrong, isThin, others = [] } of labels) {
      const point = this.project(at);
      if (texts.has(key) || (!isStrong && !this.isSeen(point))) continue;
      pen.font = `${isThin ? "italic 13px" : isStrong ? "bold 15px" : "13px"} system-ui, sans-serif`;
      const wide = pen.measureText(text).width + 6;
      const corner = ([left, top]) => [left - wide / 2, top - (isThin || text.startsWith("f") ? 9 : 24)];
      const hasRoom = ([x, y]) => x >= 0 && y >= 0 && x + wide <= this.size[0] && y + 18 <= this.size[1] &&
        !drawn.some((other) => x < other[2] && x + wide > other[0] && y < other[3] && y + 18 > other[1]);
      const found = [point, ...others.map((other) => this.project(other))].map(corner).find(hasRoom);
      if (!found) continue;
      const [x, y] = found;
      drawn.push([x, y, x + wide, y + 18]);
      texts.add(key);
      pen.globalAlpha = isStrong ? 0.95 : 0.75;
      pen.fillStyle = paper;
      pen.beginPath();
      pen.roundRect(x, y, wide, 18, 4);
      pen.fill();
      pen.globalAlpha = 1;
      pen.fillStyle = ink;
      pen.fillText(text, x + 3, y + 14);
    }
  }

  // The element at a point of the page: a vertex if one is near, else an edge, else the face.
  elementAt(x, y, reach = 1) {
    const { model } = this;
    if (!model) return null;
    let found = null;
    let nearest = 12 * reach;
    const face = this.raster.faceAt(x * this.ratio, y * this.ratio);
    // In a large mesh, only the corners of the face below the pointer are near.
    const isLarge = model.vertexCount > 20000 && face !== null;
    const candidates = isLarge ? model.faces[face] : model.vertices.keys();
    for (const v of candidates) {
      if (!model.vertices[v]) continue;
      const point = this.project(model.vertices[v]);
      const distance = Math.hypot(point[0] - x, point[1] - y);
      if (distance < nearest && this.isSeen(point)) [nearest, found] = [distance, `v${v}`];
    }
    if (found) return found;
    nearest = 8 * reach;
    const sides = (corners) => corners.map((v, i) => edgeName(v, corners[(i + 1) % corners.length]));
    const edges = isLarge ? sides(model.faces[face]) : model.edges.keys();
    for (const name of edges) {
      const { ends } = model.edges.get(name);
      const [a, b] = ends.map((v) => this.project(model.vertices[v]));
      const along = [b[0] - a[0], b[1] - a[1]];
      const t = ((x - a[0]) * along[0] + (y - a[1]) * along[1]) / (along[0] ** 2 + along[1] ** 2 || 1);
      const at = mix(a, b, Math.min(1, Math.max(0, t)));
      const distance = Math.hypot(at[0] - x, at[1] - y);
      if (distance < nearest && this.isSeen(at)) [nearest, found] = [distance, name];
    }
    return found ?? (face === null ? null : `f${face}`);
  }

  listen() {
    const { overlay } = this;
    const pointers = new Map();
    let moved = 0;
    overlay.addEventListener("pointerdown", (event) => {
      overlay.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
      if (pointers.size === 1) moved = 0;
    });
    overlay.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
      const now = [event.offsetX, event.offsetY];
      const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
      moved += Math.hypot(dx, dy);
      if (moved < 4) return;
      this.isTurning = true;
      if (pointers.size === 2) {
        const other = [...pointers.entries()].find(([id]) => id !== event.pointerId)[1];
        const spread = (point) => Math.hypot(point[0] - other[0], point[1] - other[1]) || 1;
        this.zoomBy(spread(now) / spread(before));
        this.shift = [this.shift[0] + dx / 2, this.shift[1] + dy / 2];
      } else if (event.shiftKey || event.buttons & 2) {
        this.shift = [this.shift[0] + dx, this.shift[1] + dy];
      } else {
        this.turnBy(dx * 0.01, dy * 0.01);
      }
      pointers.set(event.pointerId, now);
      this.draw();
    });
    const end = (event) => {
      if (!pointers.delete(event.pointerId)) return;
      if (moved < 4 && event.type === "pointerup") {
        const reach = event.pointerType === "touch" ? 1.8 : 1;
        const name = this.elementAt(event.offsetX, event.offsetY, reach);
        if (name) this.onChoose(name, event.shiftKey);
      }
      if (pointers.size === 0 && this.isTurning) {
        this.isTurning = false;
        this.draw();
      }
    };
    overlay.addEventListener("pointerup", end);
    overlay.addEventListener("pointercancel", end);
    overlay.addEventListener("contextmenu", (event) => event.preventDefault());
    overlay.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoomBy(Math.exp(-event.deltaY * 0.0015));
      this.draw();
    }, { passive: false });
    overlay.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[event.key];
      if (step) this.turnBy(...step);
      else if (event.key === "+" || event.key === "=") this.zoomBy(1.15);
      else if (event.key === "-") this.zoomBy(1 / 1.15);
      else if (event.key === "0") this.reset();
      else return;
      event.preventDefault();
      event.stopPropagation();
      this.shades = null;
      this.draw();
    });
  }

  // Turns the mesh so that a place can be seen, if the mesh hides it and the reader does not turn the mesh.
  turnTo({ at }) {
    const { model } = this;
    if (this.isTurning || !model || model.triangles.length > 4 * MOST_TURNED) return;
    const now = unit(this.turn.slice(6));
    const eye = (way) => plus(this.centre, scale(way, EYE * this.radius));
    if (model.isFree(at, eye(now))) return;
    const normal = unit(model.normalAt(at));
    const outwards = unit(minus(at, this.centre));
    const ways = [normal, outwards, scale(normal, -1), scale(outwards, -1), [0, 0, 1], [0, 1, 0], [1, 0, 0]];
    // Aslant the form is seen better than from the front.
    const all = ways.filter((way) => length(way) > 0.5).flatMap((way) => [between(now, way, ASLANT), way]);
    const found = all.find((way) => model.isFree(at, eye(way)));
    if (found) this.turnSoftly(unit(this.turned(found)));
  }

  // Turns the mesh until a direction of the screen points to the reader.
  turnSoftly(way) {
    const angle = Math.acos(Math.max(-1, Math.min(1, way[2])));
    const axis = Math.hypot(way[0], way[1]) > 1e-6 ? unit([way[1], -way[0], 0]) : [0, 1, 0];
    const [from, begun] = [this.turn, performance.now()];
    const turning = {};
    const isAtOnce = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const step = (time) => {
      if (this.turning !== turning) return;
      const part = isAtOnce ? 1 : Math.min(1, Math.max(0, time - begun) / TURN_MS);
      this.turn = multiply(about(axis, angle * part * part * (3 - 2 * part)), from);
      this.shades = null;
      if (part < 1) requestAnimationFrame(step);
      else this.turning = null;
      this.draw();
    };
    this.turning = turning;
    step(begun);
  }

  turnBy(aside, down) {
    this.turning = null;
    this.turn = multiply(rotation(aside, down), this.turn);
    this.shades = null;
  }

  zoomBy(factor) {
    this.zoom = Math.min(200, Math.max(0.2, this.zoom * factor));
  }
}

// A rotation about the vertical axis, then about the horizontal one, as rows of a matrix.
function rotation(aside, down) {
  const [s, c, t, d] = [Math.sin(aside), Math.cos(aside), Math.sin(down), Math.cos(down)];
  return [c, 0, s, t * s, d, -t * c, -d * s, t, d * c];
}

// A rotation about an axis of length 1 (Rodrigues, 1840).
function about([x, y, z], angle) {
  const [s, c] = [Math.sin(angle), Math.cos(angle)];
  const d = 1 - c;
  return [c + x * x * d, x * y * d - z * s, x * z * d + y * s, y * x * d + z * s, c + y * y * d, y * z * d - x * s,
    z * x * d - y * s, z * y * d + x * s, c + z * z * d];
}

// The direction on the way from one to another one that is an angle before the other one.
function between(from, to, rest) {
  const angle = Math.acos(Math.max(-1, Math.min(1, dot(from, to))));
  if (angle <= rest) return from;
  const aside = unit(minus(from, scale(to, dot(from, to))));
  return plus(scale(to, Math.cos(rest)), scale(aside, Math.sin(rest)));
}

function multiply(a, b) {
  const entry = (i) => [0, 1, 2].reduce((sum, k) => sum + a[3 * Math.floor(i / 3) + k] * b[3 * k + (i % 3)], 0);
  return Array.from({ length: 9 }, (_, i) => entry(i));
}

// The label of a thin arrow: it may stand at other points of the arrow.
function thinLabel({ points }) {
  return { isThin: true, others: [0.35, 0.65, 0.85, 0.15, 1.05].map((part) => mix(points[0], points[1], part)) };
}

function arrowHead(pen, from, to, long) {
  const angle = Math.atan2(to[1] - from[1], to[0] - from[0]);
  pen.beginPath();
  pen.moveTo(to[0], to[1]);
  for (const turn of [2.6, -2.6]) pen.lineTo(to[0] + long * Math.cos(angle + turn), to[1] + long * Math.sin(angle + turn));
  pen.closePath();
  pen.fill();
}

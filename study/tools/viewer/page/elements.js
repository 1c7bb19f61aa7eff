// Rods, bodies, springs, vectors and points, in pixels.
const PALETTE = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#8a8a00",
                 "#7a5cc0"];
const BULK = 1500;  // so many rods are drawn in few strokes, without outlines
const inBulk = data.rods.length > BULK;

const visible = (i) => !Number.isNaN(screenAt[3 * i]);
const meanDepth = (list) => list.reduce((sum, i) => sum + screenAt[3 * i + 2], 0) / list.length;
/// How much larger than at the target something at this depth looks.
const nearness = (depth) => (isSpatial ? clamp(camera.distance / depth, 0.2, 5) : 1);
const barWidth = () => clamp(0.055 * data.typical * pixelsPerMetre(), 1.2, 9);

function mix(a, b, share) {
  const channel = (colour, i) => parseInt(colour.slice(1 + 2 * i, 3 + 2 * i), 16);
  return "#" + [0, 1, 2].map((i) => Math.round(channel(a, i) * share + channel(b, i) * (1 - share))
    .toString(16).padStart(2, "0")).join("");
}

/// Strokes the current path twice: an edge, then the inside.
function strokeOutlined(pen, width, inside, edge) {
  pen.lineCap = pen.lineJoin = "round";
  pen.lineWidth = width + 2.2;
  pen.strokeStyle = edge;
  pen.stroke();
  pen.lineWidth = width;
  pen.strokeStyle = inside;
  pen.stroke();
}

function drawRod(pen, [a, b]) {
  pen.beginPath();
  pen.moveTo(screenAt[3 * a], screenAt[3 * a + 1]);
  pen.lineTo(screenAt[3 * b], screenAt[3 * b + 1]);
  strokeOutlined(pen, barWidth() * nearness(meanDepth([a, b])), colours.rod, colours.rodEdge);
}

function drawRodsInBulk(pen) {
  pen.strokeStyle = colours.rod;
  pen.lineWidth = Math.max(1, barWidth());
  pen.lineCap = "butt";
  for (let first = 0; first < data.rods.length; first += 400) {  // long paths are slow to stroke
    pen.beginPath();
    for (const [a, b] of data.rods.slice(first, first + 400)) {
      if (!visible(a) || !visible(b)) continue;
      pen.moveTo(screenAt[3 * a], screenAt[3 * a + 1]);
      pen.lineTo(screenAt[3 * b], screenAt[3 * b + 1]);
    }
    pen.stroke();
  }
}

/// Corners of the convex hull on the screen, in order (monotone chain).
function hull(list) {
  const sorted = [...list].sort((a, b) => screenAt[3 * a] - screenAt[3 * b] ||
                                          screenAt[3 * a + 1] - screenAt[3 * b + 1]);
  const turn = (a, b, c) =>
    (screenAt[3 * b] - screenAt[3 * a]) * (screenAt[3 * c + 1] - screenAt[3 * a + 1]) -
    (screenAt[3 * b + 1] - screenAt[3 * a + 1]) * (screenAt[3 * c] - screenAt[3 * a]);
  const half = (items) => {
    const chain = [];
    for (const item of items) {
      while (chain.length > 1 && turn(chain.at(-2), chain.at(-1), item) <= 0) chain.pop();
      chain.push(item);
    }
    return chain.slice(0, -1);
  };
  return sorted.length < 3 ? sorted : [...half(sorted), ...half(sorted.reverse())];
}

function drawBody(pen, body, index) {
  const hue = PALETTE[index % PALETTE.length], corners = hull(body.points);
  const width = barWidth() * 1.3 * nearness(meanDepth(body.points));
  pen.beginPath();
  for (const i of corners) pen.lineTo(screenAt[3 * i], screenAt[3 * i + 1]);
  if (corners.length === 1) pen.lineTo(screenAt[3 * corners[0]], screenAt[3 * corners[0] + 1]);
  pen.closePath();
  const inside = mix(hue, colours.paper, isSpatial ? 0.5 : 0.4);
  strokeOutlined(pen, corners.length === 1 ? 2.5 * width : width, inside,
                 mix(hue, colours.ink, 0.6));
  pen.fillStyle = inside;
  pen.fill();
  shadeFaces(pen, body.faces, hue);
}

const LIGHT = [0.3, 0.65, 0.7];  // direction towards it: right, above, out of the picture

/// The faces of a solid that are turned to the camera, each as light as it lies to the light.
function shadeFaces(pen, faces, hue) {
  const side = (a, b) => [0, 1, 2].map((axis) => now[3 * b + axis] - now[3 * a + axis]);
  for (const [a, b, c] of faces) {
    const [ax, ay] = screenAt.subarray(3 * a), [bx, by] = screenAt.subarray(3 * b), [cx, cy] = screenAt.subarray(3 * c);
    if ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax) >= 0) continue;  // y is down: seen from inside
    const normal = cross(side(a, b), side(a, c)), length = Math.hypot(...normal) || 1;
    const shine = [camera.right, camera.above, camera.back].reduce((sum, axis, k) =>
      sum + LIGHT[k] * axis.reduce((dot, x, i) => dot + x * normal[i], 0) / length, 0);
    pen.beginPath();
    for (const [x, y] of [[ax, ay], [bx, by], [cx, cy]]) pen.lineTo(x, y);
    pen.closePath();
    pen.fillStyle = pen.strokeStyle = mix(mix(hue, "#ffffff", 0.55), "#000000", 0.6 + 0.4 * Math.max(shine, 0));
    pen.lineWidth = 1;  // over the seam between two triangles
    pen.fill();
    pen.stroke();
  }
}

const COILS = 7;
const springLengths = data.springs.map(([a, b]) => Math.hypot(
  ...points[a].start.map((x, axis) => x - points[b].start[axis])));

function drawSpring(pen, [a, b], index) {
  const x = screenAt[3 * a], y = screenAt[3 * a + 1];
  const dx = screenAt[3 * b] - x, dy = screenAt[3 * b + 1] - y, length = Math.hypot(dx, dy) || 1;
  const near = nearness(meanDepth([a, b]));
  const half = clamp(0.11 * springLengths[index] * pixelsPerMetre(), 3, 11) * near;
  const px = -dy / length * half, py = dx / length * half;
  pen.beginPath();
  pen.moveTo(x, y);
  pen.lineTo(x + 0.14 * dx, y + 0.14 * dy);
  for (let k = 0; k < 2 * COILS; ++k) {
    const s = 0.14 + 0.72 * (k + 0.5) / (2 * COILS), side = k % 2 ? 1 : -1;
    pen.lineTo(x + s * dx + side * px, y + s * dy + side * py);
  }
  pen.lineTo(x + 0.86 * dx, y + 0.86 * dy);
  pen.lineTo(x + dx, y + dy);
  pen.lineJoin = "round";
  pen.lineCap = "round";
  pen.lineWidth = 1.7 * Math.sqrt(near);
  pen.strokeStyle = colours.spring;
  pen.stroke();
}

function drawVector(pen, {vector, at, length}) {
  const ends = new Float64Array(6), mean = [0, 1, 2].map(
    (axis) => at.reduce((sum, i) => sum + now[3 * i + axis], 0) / at.length);
  project(...mean, ends, 0);
  project(...mean.map((x, axis) => x + length * now[3 * vector + axis]), ends, 3);
  if (!Number.isNaN(ends[0] + ends[3])) {
    arrow(pen, ends[0], ends[1], ends[3], ends[4], colours.accent, 1.8);
  }
}

/// A torsion spring: a spiral from one direction to the other and a turn more.
function drawCoil(pen, {first, second, at, length}) {
  const unit = (v) => v.map((x) => x / (Math.hypot(...v) || 1));
  const dot = (v, w) => v.reduce((sum, x, axis) => sum + x * w[axis], 0);
  const [u, w] = [first, second].map(([a, b]) => unit(
    [0, 1, 2].map((axis) => now[3 * b + axis] - now[3 * a + axis])));
  let across = isSpatial ? w.map((x, axis) => x - dot(u, w) * u[axis]) : [-u[1], u[0], 0];
  if (Math.hypot(...across) < 1e-6) {
    const least = u.map(Math.abs).indexOf(Math.min(...u.map(Math.abs)));
    across = cross(u, [0, 1, 2].map((axis) => (axis === least ? 1 : 0)));
  }
  across = unit(across);
  const total = 2 * Math.PI + Math.atan2(dot(across, w), dot(u, w)), place = new Float64Array(3);
  const mean = [0, 1, 2].map((axis) => at.reduce((sum, i) => sum + now[3 * i + axis], 0) / at.length);
  pen.beginPath();
  for (let k = 0; k < 60; ++k) {
    const angle = total * k / 59, radius = length * (0.35 + 0.65 * k / 59);
    project(...mean.map((x, axis) => x + radius * (
      Math.cos(angle) * u[axis] + Math.sin(angle) * across[axis])), place, 0);
    if (Number.isNaN(place[0])) return;
    pen.lineTo(place[0], place[1]);
  }
  pen.lineWidth = 1.7;
  pen.lineJoin = pen.lineCap = "round";
  pen.strokeStyle = colours.spring;
  pen.stroke();
}

// One picture: grid, traces, elements from far to near, points and names.
const canvas = element("view"), pen = canvas.getContext("2d");
const traced = new Map(data.traces.map((point, k) => [point, k]));  // to a number of a colour
const TRACE_COLOURS = 6;
let showsNames = places.length <= 14;
let colours = readColours();

function readColours() {
  const style = getComputedStyle(document.documentElement);
  const get = (name) => style.getPropertyValue(`--${name}`).trim();
  const names = ["paper", "ink", "soft", "line", "grid", "rod", "ground", "driven", "spring",
                 "joint", "accent", "kinetic", "potential", "total", "violation"];
  return {...Object.fromEntries(names.map((name) => [name, get(name)])),
          gridStrong: get("grid-strong"), rodEdge: get("rod-edge"),
          traces: Array.from({length: TRACE_COLOURS}, (_, k) => get(`trace-${k}`))};
}

/// Gives a canvas as many pixels as it has on the screen; returns whether it has any.
function resize(target) {
  const ratio = window.devicePixelRatio || 1;
  const width = target.clientWidth, height = target.clientHeight;
  const columns = Math.round(width * ratio), rows = Math.round(height * ratio);
  if (target.width !== columns || target.height !== rows) {
    target.width = columns;
    target.height = rows;
  }
  target.getContext("2d").setTransform(ratio, 0, 0, ratio, 0, 0);
  return width > 0 && height > 0;
}

function drawStage(t) {
  if (!resize(canvas)) return;
  camera.width = canvas.clientWidth;
  camera.height = canvas.clientHeight;
  if (camera.isFitted) fitView();
  moveTo(t);
  projectAll();
  pen.clearRect(0, 0, camera.width, camera.height);
  drawGrid(pen);
  if (isSpatial && !inBulk) drawShadows();
  for (const [point, k] of traced) drawTrace(point, colours.traces[k], t);
  drawElements();
  drawPoints();
  if (showsNames) drawNames();
}

function drawElements() {
  if (inBulk) drawRodsInBulk(pen);
  const items = [];
  const add = (list, draw, uses) => list.forEach((item, index) => {
    if (!uses(item).length || !uses(item).every(visible)) return;
    items.push([meanDepth(uses(item)), () => draw(pen, item, index)]);
  });
  add(data.bodies, drawBody, (body) => body.points);
  if (!inBulk) add(data.rods, drawRod, (rod) => rod);
  add(data.springs, drawSpring, (spring) => spring);
  if (isSpatial) items.sort((a, b) => b[0] - a[0]);
  for (const [, draw] of items) draw();
  for (const vector of data.arrows) drawVector(pen, vector);
  for (const coil of data.coils) drawCoil(pen, coil);
}

/// What the floor shows of rods and bodies under a light straight above.
function drawShadows() {
  const ends = new Float64Array(6), at = [0, 0, 0];
  const drop = (i, k) => {
    for (let axis = 0; axis < 3; ++axis) at[axis] = now[3 * i + axis];
    at[up] = floorLevel;
    project(...at, ends, k);
  };
  pen.globalAlpha = 0.13;
  pen.strokeStyle = colours.ink;
  pen.lineCap = "round";
  pen.lineWidth = barWidth();
  pen.beginPath();
  const line = (a, b) => {
    drop(a, 0);
    drop(b, 3);
    if (Number.isNaN(ends[0] + ends[3])) return;
    pen.moveTo(ends[0], ends[1]);
    pen.lineTo(ends[3], ends[4]);
  };
  for (const [a, b] of data.rods) line(a, b);
  for (const {points: list} of data.bodies) {
    list.forEach((a, k) => line(a, list[(k + 1) % list.length]));
  }
  pen.stroke();
  pen.globalAlpha = 1;
}

/// The whole way of a point, faint, and what it went lately, strong.
function drawTrace(point, colour, t) {
  const at = [0, 0, 0], way = new Float64Array(3 * times.length);
  for (let frame = 0; frame < times.length; ++frame) {
    project(...positionIn(frame, point, at), way, 3 * frame);
  }
  const stroke = (first, last, alpha, width, end) => {
    pen.beginPath();
    for (let frame = first; frame <= last; ++frame) curveTo(way, frame, frame === first);
    if (end) pen.lineTo(screenAt[3 * point], screenAt[3 * point + 1]);
    pen.globalAlpha = alpha;
    pen.lineWidth = width;
    pen.stroke();
  };
  pen.strokeStyle = colour;
  pen.lineJoin = pen.lineCap = "round";
  stroke(0, times.length - 1, 0.22, 1.3, false);
  const current = frameAt(t);
  for (let part = 3; part >= 1; --part) {
    stroke(frameAt(Math.max(firstTime, t - part * 0.04 * duration)), current, 0.4, 2.2, true);
  }
  pen.globalAlpha = 1;
}

/// Continues the path to a frame of `way` on a cubic with the tangents of the neighbours; places
/// behind the camera (NaN) leave a gap.
function curveTo(way, frame, isFirst) {
  const x = (k) => way[3 * clamp(k, 0, times.length - 1)];
  const y = (k) => way[3 * clamp(k, 0, times.length - 1) + 1];
  if (Number.isNaN(x(frame))) return;
  if (isFirst || Number.isNaN(x(frame - 2) + x(frame - 1) + x(frame + 1))) {
    pen.moveTo(x(frame), y(frame));
    return;
  }
  pen.bezierCurveTo(x(frame - 1) + (x(frame) - x(frame - 2)) / 6,
                    y(frame - 1) + (y(frame) - y(frame - 2)) / 6,
                    x(frame) - (x(frame + 1) - x(frame - 1)) / 6,
                    y(frame) - (y(frame + 1) - y(frame - 1)) / 6, x(frame), y(frame));
}

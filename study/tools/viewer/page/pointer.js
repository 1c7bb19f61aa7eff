// Mouse and fingers on the picture: move, turn, zoom, point at, trace.
const held = new Map();  // pointer id -> [x, y]
let travelled = 0;       // pixels since the first pointer went down

const place = (event) => {
  const box = canvas.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
};

/// The point nearest to a pixel, within `reach` pixels, or -1.
function pointAt([x, y], reach) {
  let best = -1, least = reach;
  for (const i of places) {
    const distance = Math.hypot(screenAt[3 * i] - x, screenAt[3 * i + 1] - y);
    if (distance < least) [best, least] = [i, distance];
  }
  return best;
}

function toggleTrace(point) {
  if (traced.has(point)) {
    traced.delete(point);
  } else {
    const uses = Array.from({length: TRACE_COLOURS}, () => 0);
    for (const k of traced.values()) ++uses[k];
    traced.set(point, uses.indexOf(Math.min(...uses)));
  }
  showTraces();
  redraw();
}

function showTraces() {
  element("traces").replaceChildren(...[...traced].map(([point, k]) => {
    const chip = document.createElement("button"), swatch = document.createElement("i");
    swatch.style.background = `var(--trace-${k})`;
    chip.append(swatch, points[point].name);
    chip.title = `Stop tracing ${points[point].name}`;
    chip.addEventListener("click", () => toggleTrace(point));
    return chip;
  }));
}

function showTip(at) {
  const point = held.size ? -1 : pointAt(at, 14), tip = element("tip");
  canvas.classList.toggle("over", point >= 0);
  tip.hidden = point < 0;
  if (point < 0) return;
  const coordinates = [...now.subarray(3 * point, 3 * point + data.dimension)];
  tip.textContent = `${points[point].name} (${points[point].kind})\n` +
    coordinates.map((x, axis) => `${axisNames[axis]} ${show(x)}`).join("  ") + " m";
  tip.style.left = `${clamp(at[0] + 14, 0, camera.width - tip.offsetWidth - 4)}px`;
  tip.style.top = `${clamp(at[1] + 14, 0, camera.height - tip.offsetHeight - 4)}px`;
}

function drag(event, from, to) {
  const dx = to[0] - from[0], dy = to[1] - from[1];
  travelled += Math.hypot(dx, dy);
  if (held.size === 2) {
    const [other] = [...held].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    const before = Math.hypot(from[0] - other[0], from[1] - other[1]);
    const after = Math.hypot(to[0] - other[0], to[1] - other[1]);
    pan(dx / 2, dy / 2);
    zoom(after / Math.max(before, 1), (to[0] + other[0]) / 2, (to[1] + other[1]) / 2);
  } else if (isSpatial && !event.shiftKey && !(event.buttons & 6)) {
    orbit(dx, dy);
  } else {
    pan(dx, dy);
  }
  redraw();
}

canvas.addEventListener("pointerdown", (event) => {
  canvas.setPointerCapture(event.pointerId);
  if (held.size === 0) travelled = 0;
  held.set(event.pointerId, place(event));
  canvas.classList.add("held");
});
canvas.addEventListener("pointermove", (event) => {
  const to = place(event), from = held.get(event.pointerId);
  if (from) {
    drag(event, from, to);
    held.set(event.pointerId, to);
  }
  if (event.pointerType === "mouse") showTip(to);
});
for (const name of ["pointerup", "pointercancel"]) {
  canvas.addEventListener(name, (event) => {
    const wasAlone = held.size === 1 && held.delete(event.pointerId);
    held.delete(event.pointerId);
    canvas.classList.toggle("held", held.size > 0);
    if (name === "pointercancel" || !wasAlone || travelled > 5) return;
    const point = pointAt(place(event), event.pointerType === "mouse" ? 14 : 26);
    if (point >= 0) toggleTrace(point);
  });
}
canvas.addEventListener("pointerleave", () => { element("tip").hidden = true; });
canvas.addEventListener("contextmenu", (event) => event.preventDefault());
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  const pixels = event.deltaY * (event.deltaMode === 1 ? 16 : 1);
  zoom(Math.exp(-0.0015 * clamp(pixels, -400, 400)), ...place(event));
  redraw();
}, {passive: false});

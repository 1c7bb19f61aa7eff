// The scene and its motion, unpacked from the page; `now` holds all points at the shown time.
const data = JSON.parse(document.getElementById("scene").textContent);
const element = (id) => document.getElementById(id);
const clamp = (x, low, high) => Math.min(high, Math.max(low, x));

const times = data.times, firstTime = times[0], lastTime = times[times.length - 1];
const duration = lastTime - firstTime;
const isSpatial = data.dimension === 3;
const points = data.points;
const isPlace = (point) => point.kind !== "vector" && point.kind !== "hidden";
const places = points.flatMap((point, index) => (isPlace(point) ? [index] : []));

/// Little-endian float32: frame by frame, moving point by moving point, axis by axis.
const packed = (() => {
  const text = atob(element("packed").textContent);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  const view = new DataView(bytes.buffer);
  return Float32Array.from({length: bytes.length / 4}, (_, i) => view.getFloat32(4 * i, true));
})();
const rowLength = data.moving.length * data.dimension;
const slotOf = new Map(data.moving.map((point, slot) => [point, slot]));

const now = new Float64Array(3 * points.length);
points.forEach((point, index) => now.set(point.start, 3 * index));

/// The last frame at or before time t.
function frameAt(t) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle; else high = middle - 1;
  }
  return low;
}

/// Moves `now` to time t, on cubics through the frames (tangents from their neighbours).
function moveTo(t) {
  const last = times.length - 1, i = Math.min(frameAt(t), last - 1);
  const before = Math.max(i - 1, 0), after = Math.min(i + 2, last);
  const h = times[i + 1] - times[i], s = clamp((t - times[i]) / h, 0, 1);
  const h00 = (1 + 2 * s) * (1 - s) ** 2, h01 = s * s * (3 - 2 * s);
  const h10 = s * (1 - s) ** 2 * h / (times[i + 1] - times[before]);
  const h11 = s * s * (s - 1) * h / (times[after] - times[i]);
  const d = data.dimension;
  const [p, q, r, w] = [before, i, i + 1, after].map((frame) => frame * rowLength);
  data.moving.forEach((point, slot) => {
    for (let axis = 0; axis < d; ++axis) {
      const k = slot * d + axis, a = packed[q + k], b = packed[r + k];
      now[3 * point + axis] =
        h00 * a + h01 * b + h10 * (b - packed[p + k]) + h11 * (packed[w + k] - a);
    }
  });
}

/// Position of a point in a frame, written to out[0 … 2].
function positionIn(frame, point, out) {
  const slot = slotOf.get(point), d = data.dimension;
  for (let axis = 0; axis < d; ++axis) {
    out[axis] = slot === undefined ? points[point].start[axis]
                                   : packed[frame * rowLength + slot * d + axis];
  }
  return out;
}

/// A number for people: four digits, a true minus.
function show(value, digits = 4) {
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-3 || size >= 1e5) ? value.toExponential(digits - 2)
                                                         : String(+value.toPrecision(digits));
  return text.replaceAll("-", "−");
}

/// The smallest of 1, 2, 5 times a power of ten that is at least x.
function niceStep(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  return [1, 2, 5, 10].find((digit) => digit * power >= x * (1 - 1e-9)) * power;
}

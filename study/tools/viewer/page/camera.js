// From metres to pixels: a plane that can be moved and zoomed, or an orbiting perspective view.
const camera = {
  width: 1, height: 1,
  x: 0, y: 0, scale: 1,                                  // planar: centre, m; pixels a metre
  target: [0, 0, 0], azimuth: 0.6, elevation: 0.35, distance: 1,  // spatial
  right: [1, 0, 0], above: [0, 1, 0], back: [0, 0, 1],   // unit vectors of the spatial view
  isFitted: true,
};
const screenAt = new Float64Array(3 * points.length);  // x, y in pixels; depth, m

const size = data.high.map((high, axis) => high - data.low[axis]);
const radius = Math.hypot(...size) / 2 || 1;
const middle = [0, 1, 2].map((axis) => ((data.low[axis] ?? 0) + (data.high[axis] ?? 0)) / 2);
const upward = isSpatial ? data.up : [0, 1, 0];
const up = upward.findIndex((x) => x !== 0);
const frontward = up === 2 ? [0, -1, 0] : [0, 0, 1];  // towards the camera at azimuth 0
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0]];
const sideward = cross(upward, frontward);

const focal = () => 1.7 * Math.min(camera.width, camera.height);
/// Pixels a metre where the camera looks.
const pixelsPerMetre = () => (isSpatial ? focal() / camera.distance : camera.scale);

/// Some of the places that points get to, for fitting the view.
const samples = (() => {
  const found = [], frameStep = Math.ceil(times.length / 40), step = Math.ceil(places.length / 200);
  for (let frame = 0; frame < times.length; frame += frameStep) {
    for (let k = 0; k < places.length; k += step) {
      found.push(positionIn(frame, places[k], [0, 0, 0]));
    }
  }
  return found;
})();

function fitView() {
  camera.isFitted = true;
  const width = Math.max(camera.width - 110, 40), height = Math.max(camera.height - 110, 40);
  if (isSpatial) {
    fitSpatial(width, height);
  } else {
    [camera.x, camera.y] = middle;
    const least = 0.02 * radius;
    camera.scale = Math.min(width / Math.max(size[0], least), height / Math.max(size[1], least));
  }
}

/// Nearer or farther and sideways until the samples fill the picture; perspective needs repetition.
function fitSpatial(width, height) {
  turnAxes();
  camera.target = [...middle];
  camera.distance = focal() * radius / (0.44 * Math.min(camera.width, camera.height));
  const at = [0, 0, 0];
  for (let pass = 0; pass < 5; ++pass) {
    const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
    for (const sample of samples) {
      project(...sample, at, 0);
      for (const i of [0, 1]) {
        low[i] = Math.min(low[i], at[i]);
        high[i] = Math.max(high[i], at[i]);
      }
    }
    pan(camera.width / 2 - (low[0] + high[0]) / 2, camera.height / 2 - (low[1] + high[1]) / 2);
    const share = Math.max((high[0] - low[0]) / width, (high[1] - low[1]) / height);
    if (!(share > 0.01)) break;
    camera.distance = Math.max(camera.distance * share, 1.05 * radius);
  }
  camera.isFitted = true;
}

function turnAxes() {
  const {azimuth: a, elevation: e} = camera;
  const level = sideward.map((x, i) => Math.sin(a) * x + Math.cos(a) * frontward[i]);
  camera.back = level.map((x, i) => Math.cos(e) * x + Math.sin(e) * upward[i]);
  camera.right = cross(upward, level);
  camera.above = cross(camera.back, camera.right);
}

/// Projects a place to out[at …]: pixels, depth; NaN behind the camera.
function project(x, y, z, out, at) {
  if (!isSpatial) {
    out[at] = camera.width / 2 + (x - camera.x) * camera.scale;
    out[at + 1] = camera.height / 2 - (y - camera.y) * camera.scale;
    out[at + 2] = 0;
    return;
  }
  const {target, right, above, back} = camera;
  const dx = x - target[0], dy = y - target[1], dz = z - target[2];
  const depth = camera.distance - (dx * back[0] + dy * back[1] + dz * back[2]);
  const scale = depth > 0.02 * camera.distance ? focal() / depth : NaN;
  out[at] = camera.width / 2 + (dx * right[0] + dy * right[1] + dz * right[2]) * scale;
  out[at + 1] = camera.height / 2 - (dx * above[0] + dy * above[1] + dz * above[2]) * scale;
  out[at + 2] = depth;
}

function projectAll() {
  turnAxes();
  for (let i = 0; i < now.length; i += 3) project(now[i], now[i + 1], now[i + 2], screenAt, i);
}

/// Zooms by `factor`; what is under the pixel (px, py) stays there in the plane.
function zoom(factor, px = camera.width / 2, py = camera.height / 2) {
  camera.isFitted = false;
  if (isSpatial) {
    camera.distance = clamp(camera.distance / factor, 1e-4 * radius, 100 * radius);
    return;
  }
  const dx = px - camera.width / 2, dy = camera.height / 2 - py, old = camera.scale;
  camera.scale = clamp(old * factor, 1 / radius, 1e7 / radius);
  camera.x += dx / old - dx / camera.scale;
  camera.y += dy / old - dy / camera.scale;
}

/// Moves the view by pixels.
function pan(dx, dy) {
  camera.isFitted = false;
  const metres = 1 / pixelsPerMetre();
  if (isSpatial) {
    camera.target = camera.target.map(
      (x, i) => x - (dx * camera.right[i] - dy * camera.above[i]) * metres);
  } else {
    camera.x -= dx * metres;
    camera.y += dy * metres;
  }
}

function orbit(dx, dy) {
  camera.isFitted = false;
  camera.azimuth -= 0.008 * dx;
  camera.elevation = clamp(camera.elevation + 0.008 * dy, -1.55, 1.55);
}

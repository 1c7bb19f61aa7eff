// What the motion is measured against: a ruled plane, or a floor with a cross of axes.
const axisNames = ["x", "y", "z"];

function drawGrid(pen) {
  pen.lineWidth = 1;
  pen.font = "11px system-ui, sans-serif";
  if (isSpatial) drawFloor(pen); else drawRules(pen);
}

function drawRules(pen) {
  const {width, height, scale} = camera, step = niceStep(75 / scale);
  const left = camera.x - width / 2 / scale, low = camera.y - height / 2 / scale;
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const text = (k) => (k * step).toFixed(Math.min(digits, 9)).replace("-", "−");
  const line = (x0, y0, x1, y1, strong) => {
    pen.strokeStyle = strong ? colours.gridStrong : colours.grid;
    pen.beginPath();
    pen.moveTo(x0, y0);
    pen.lineTo(x1, y1);
    pen.stroke();
  };
  const columns = [], rows = [];
  for (let k = Math.ceil(left / step); (k * step - left) * scale < width; ++k) {
    const x = Math.round((k * step - left) * scale) + 0.5;
    line(x, 0, x, height, k === 0);
    columns.push([k, x]);
  }
  for (let k = Math.ceil(low / step); (k * step - low) * scale < height; ++k) {
    const y = Math.round(height - (k * step - low) * scale) + 0.5;
    line(0, y, width, y, k === 0);
    rows.push([k, y]);
  }
  pen.fillStyle = colours.soft;
  pen.textAlign = "center";
  pen.textBaseline = "bottom";
  for (const [k, x] of columns) {
    if (x > 55 && x < width - 40) pen.fillText(text(k), x, height - 5);
  }
  pen.textAlign = "left";
  pen.textBaseline = "middle";
  for (const [k, y] of rows) {
    if (y > 12 && y < height - 30) pen.fillText(text(k), 6, y - 7);
  }
  pen.textBaseline = "bottom";
  pen.fillText("y, m", 6, height - 18);
  pen.fillText("x, m", 6, height - 5);
}

const floorLevel = upward[up] > 0 ? data.low[up] - (isSpatial ? 0.06 * radius : 0)
                                  : data.high[up] + 0.06 * radius;
const levelAxes = [0, 1, 2].filter((axis) => axis !== up);

function drawFloor(pen) {
  const step = niceStep(radius / 4), [i, j] = levelAxes;
  const first = levelAxes.map((axis) => Math.floor(data.low[axis] / step - 0.3));
  const last = levelAxes.map((axis) => Math.ceil(data.high[axis] / step + 0.3));
  const at = [0, 0, 0], ends = new Float64Array(6);
  const cell = (a, b, axis) => {  // cell by cell: those behind the camera are left out
    at[up] = floorLevel;
    at[i] = a * step;
    at[j] = b * step;
    project(...at, ends, 0);
    at[axis] += step;
    project(...at, ends, 3);
    if (Number.isNaN(ends[0] + ends[3])) return;
    pen.moveTo(ends[0], ends[1]);
    pen.lineTo(ends[3], ends[4]);
  };
  pen.strokeStyle = colours.gridStrong;
  pen.beginPath();
  for (let a = first[0]; a <= last[0]; ++a) {
    for (let b = first[1]; b <= last[1]; ++b) {
      if (a < last[0]) cell(a, b, i);
      if (b < last[1]) cell(a, b, j);
    }
  }
  pen.stroke();
  drawAxes(pen);
  pen.fillStyle = colours.soft;
  pen.textAlign = "left";
  pen.textBaseline = "bottom";
  pen.fillText(`floor: ${show(step)} m a square`, 86, camera.height - 8);
}

function drawAxes(pen) {
  const x0 = 42, y0 = camera.height - 40, length = 26;
  const order = [0, 1, 2].sort((a, b) => camera.back[a] - camera.back[b]);
  for (const axis of order) {
    const x = x0 + length * camera.right[axis], y = y0 - length * camera.above[axis];
    arrow(pen, x0, y0, x, y, ["#c9403a", "#3c8d40", "#3a6fc9"][axis], 1.8);
    pen.fillStyle = colours.soft;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillText(axisNames[axis], x0 + 1.4 * (x - x0), y0 + 1.4 * (y - y0));
  }
}

function arrow(pen, x0, y0, x1, y1, colour, width) {
  const length = Math.hypot(x1 - x0, y1 - y0);
  pen.strokeStyle = pen.fillStyle = colour;
  pen.lineWidth = width;
  pen.lineCap = "round";
  pen.beginPath();
  pen.moveTo(x0, y0);
  pen.lineTo(x1, y1);
  pen.stroke();
  if (length < 4) return;
  const ux = (x1 - x0) / length, uy = (y1 - y0) / length, h = Math.min(4 * width, length / 2);
  pen.beginPath();
  pen.moveTo(x1 + ux * width, y1 + uy * width);
  pen.lineTo(x1 - h * ux - 0.5 * h * uy, y1 - h * uy + 0.5 * h * ux);
  pen.lineTo(x1 - h * ux + 0.5 * h * uy, y1 - h * uy - 0.5 * h * ux);
  pen.fill();
}

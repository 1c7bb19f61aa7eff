// Points: joints, ground, driven points, and their names.
function drawPoints() {
  const typical = data.typical * pixelsPerMetre();
  const free = clamp(0.035 * typical, 1.8, 4.5), symbol = clamp(0.11 * typical, 4, 11);
  for (const i of places) {
    if (!visible(i)) continue;
    const x = screenAt[3 * i], y = screenAt[3 * i + 1], kind = points[i].kind;
    const near = Math.sqrt(nearness(screenAt[3 * i + 2]));
    if (kind === "fixed") drawGround(x, y, symbol * near);
    if (kind === "driven") drawDriven(x, y, symbol * near);
    if (typical < 9 && !traced.has(i)) continue;
    pen.beginPath();
    pen.arc(x, y, (kind === "marker" ? 0.7 : 1) * free * near, 0, 7);
    pen.fillStyle = colours.traces[traced.get(i)] ?? colours.joint;
    pen.strokeStyle = colours.ink;
    pen.lineWidth = 1.2;
    pen.fill();
    pen.stroke();
  }
}

function drawGround(x, y, s) {
  pen.strokeStyle = colours.ground;
  pen.fillStyle = mix(colours.ground, colours.paper, 0.3);
  pen.lineWidth = 1.3;
  pen.lineJoin = "round";
  pen.beginPath();
  pen.moveTo(x, y);
  pen.lineTo(x - 0.75 * s, y + 1.25 * s);
  pen.lineTo(x + 0.75 * s, y + 1.25 * s);
  pen.closePath();
  pen.fill();
  pen.stroke();
  pen.beginPath();
  pen.moveTo(x - 1.2 * s, y + 1.25 * s);
  pen.lineTo(x + 1.2 * s, y + 1.25 * s);
  for (let k = -1; k <= 1; k += 0.5) {
    pen.moveTo(x + k * s, y + 1.25 * s);
    pen.lineTo(x + (k - 0.3) * s, y + 1.7 * s);
  }
  pen.stroke();
}

function drawDriven(x, y, s) {
  pen.beginPath();
  for (const [dx, dy] of [[s, 0], [0, s], [-s, 0], [0, -s]]) pen.lineTo(x + dx, y + dy);
  pen.closePath();
  pen.fillStyle = mix(colours.driven, colours.paper, 0.3);
  pen.strokeStyle = colours.driven;
  pen.lineWidth = 1.8;
  pen.lineJoin = "round";
  pen.fill();
  pen.stroke();
}

/// Names right of their points, leaving out those that would lie on another.
function drawNames() {
  const taken = new Set();
  pen.font = "12px system-ui, sans-serif";
  pen.textAlign = "left";
  pen.textBaseline = "alphabetic";
  pen.lineJoin = "round";
  for (const i of places) {
    if (!visible(i)) continue;
    const x = screenAt[3 * i] + 7, y = screenAt[3 * i + 1] - 7;
    const cells = [0, 20].map((dx) => `${Math.round((x + dx) / 22)} ${Math.round(y / 15)}`);
    if (cells.some((cell) => taken.has(cell))) continue;
    cells.forEach((cell) => taken.add(cell));
    pen.lineWidth = 3.5;
    pen.strokeStyle = colours.paper;
    pen.strokeText(points[i].name, x, y);
    pen.fillStyle = colours.ink;
    pen.fillText(points[i].name, x, y);
  }
}

// Curves beside the motion, with a cursor at the shown time.
const EDGE = {left: 52, right: 10, top: 8, bottom: 20};  // pixels around a chart's area

const named = (names, all) => names.map((name) => ({name, values: all[name],
                                                    colour: () => colours[name]}));
const charts = data.curves ? [
  {canvas: element("energy"), values: element("energy-values"), isLog: false,
   curves: named(["kinetic", "potential", "total"], {
     kinetic: data.curves.kinetic_energy, potential: data.curves.potential_energy,
     total: data.curves.kinetic_energy.map(
       (kinetic, i) => kinetic + data.curves.potential_energy[i])})},
  {canvas: element("violation"), values: element("violation-values"), isLog: true,
   curves: named(["violation"], {violation: data.curves.constraint_violation})},
] : [];
charts.forEach(prepare);

/// Range and labels of a chart's curves.
function prepare(chart) {
  const all = chart.curves.flatMap((curve) => curve.values)
    .filter((value) => !chart.isLog || value > 0);
  chart.low = all.reduce((a, b) => Math.min(a, b), Infinity);
  chart.high = all.reduce((a, b) => Math.max(a, b), -Infinity);
  chart.isEmpty = all.length === 0;
  chart.values.replaceChildren();
  if (chart.isEmpty) return;
  if (chart.isLog) {
    chart.low = 10 ** Math.floor(Math.log10(chart.low));
    chart.high = 10 ** Math.max(Math.ceil(Math.log10(chart.high)), Math.log10(chart.low) + 1);
    chart.low = Math.max(chart.low, chart.high * 1e-12);
  } else {
    // Rounding of something constant, in 7 digits, is no motion.
    const noise = 1e-6 * Math.max(Math.abs(chart.low), Math.abs(chart.high));
    const range = chart.high - chart.low > noise ? chart.high - chart.low : 0;
    const margin = 0.05 * range || Math.abs(chart.high) || 1;
    chart.low -= margin;
    chart.high += margin;
  }
  for (const curve of chart.curves) {
    const label = document.createElement("span");
    curve.label = document.createElement("b");
    label.append(chart.curves.length > 1 ? `${curve.name} ` : "", curve.label);
    chart.values.append(label);
    curve.holder = label;
  }
}

/// One chart for the scene's own outputs, with a list to choose from; angles and forces come first.
const outputs = Object.entries(data.outputs)
  .sort(([, a], [, b]) => Object.keys(a).length - Object.keys(b).length);
if (outputs.length) {
  const chart = {canvas: element("output"), values: element("output-values"), isLog: false};
  const choose = (index) => {
    const [name, columns] = outputs[index];
    chart.curves = Object.entries(columns).map(([column, values], k) => ({
      name: column.slice(name.length + 1), values, colour: () => colours.traces[k]}));
    prepare(chart);
  };
  element("output-name").append(...outputs.map(([name], index) => new Option(name, index)));
  element("output-name").addEventListener("change", (event) => {
    choose(+event.target.value);
    redraw();
  });
  choose(0);
  charts.push(chart);
}

function drawCharts(t) {
  for (const chart of charts) if (resize(chart.canvas)) drawChart(chart, t);
}

function drawChart(chart, t) {
  const ink = chart.canvas.getContext("2d");
  const width = chart.canvas.clientWidth, height = chart.canvas.clientHeight;
  const inner = width - EDGE.left - EDGE.right, tall = height - EDGE.top - EDGE.bottom;
  const x = (time) => EDGE.left + inner * (time - firstTime) / duration;
  const share = chart.isLog
    ? (value) => Math.log(Math.max(value, chart.low) / chart.low) / Math.log(chart.high / chart.low)
    : (value) => (value - chart.low) / (chart.high - chart.low);
  const y = (value) => EDGE.top + tall * (1 - share(value));
  ink.clearRect(0, 0, width, height);
  ink.font = "11px system-ui, sans-serif";
  if (chart.isEmpty) {
    ink.fillStyle = colours.soft;
    ink.fillText("zero throughout", EDGE.left, EDGE.top + 20);
    return;
  }
  drawTicks(ink, chart, x, y, width, height);
  chart.curves.forEach((curve) => {
    const colour = curve.colour();
    ink.strokeStyle = colour;
    ink.lineWidth = curve.name === "total" || chart.isLog ? 1.1 : 1.6;
    ink.lineJoin = "round";
    ink.beginPath();
    curve.values.forEach((value, i) => ink.lineTo(x(times[i]), y(value)));
    ink.stroke();
    const value = curve.values[nearestFrame(t)];
    ink.fillStyle = colour;
    ink.beginPath();
    ink.arc(x(t), y(value), 3, 0, 7);
    ink.fill();
    curve.label.textContent = show(value);
    curve.holder.style.color = colour;
  });
}

function drawTicks(ink, chart, x, y, width, height) {
  const line = (x0, y0, x1, y1, colour) => {
    ink.strokeStyle = colour;
    ink.lineWidth = 1;
    ink.beginPath();
    ink.moveTo(x0, y0);
    ink.lineTo(x1, y1);
    ink.stroke();
  };
  ink.fillStyle = colours.soft;
  ink.textAlign = "right";
  ink.textBaseline = "middle";
  for (const value of valueTicks(chart, height)) {
    const at = Math.round(y(value)) + 0.5;
    line(EDGE.left, at, width - EDGE.right, at, colours.grid);
    ink.fillText(chart.isLog ? value.toExponential(0).replace("-", "−") : show(value),
                 EDGE.left - 6, at);
  }
  ink.textAlign = "center";
  ink.textBaseline = "bottom";
  const step = niceStep(duration / Math.max(2, width / 55));
  for (let k = Math.ceil(firstTime / step - 1e-9); k * step <= lastTime * (1 + 1e-9); ++k) {
    const at = x(k * step), isLast = (k + 1) * step > lastTime * (1 + 1e-9);
    line(at, height - EDGE.bottom, at, height - EDGE.bottom + 4, colours.soft);
    ink.fillText(show(k * step) + (isLast ? " s" : ""), Math.min(at, width - 14), height - 1);
  }
  line(EDGE.left, height - EDGE.bottom + 0.5, width - EDGE.right, height - EDGE.bottom + 0.5,
       colours.soft);
  line(x(shownTime()), EDGE.top, x(shownTime()), height - EDGE.bottom, colours.accent);
}

function valueTicks(chart, height) {
  const ticks = [], most = Math.max(2, height / 34);
  if (chart.isLog) {
    const first = Math.log10(chart.low), decades = Math.log10(chart.high) - first;
    const step = Math.ceil(decades / most);
    for (let k = 0; k <= decades + 1e-9; k += step) ticks.push(10 ** Math.round(first + k));
    return ticks;
  }
  const step = niceStep((chart.high - chart.low) / most);
  for (let k = Math.ceil(chart.low / step); k * step <= chart.high; ++k) {
    ticks.push(+(k * step).toPrecision(9));
  }
  return ticks;
}

function nearestFrame(t) {
  const i = frameAt(t);
  return i + 1 < times.length && times[i + 1] - t < t - times[i] ? i + 1 : i;
}

// Pictures as SVG: a ranking, and the map with the place of the case. Names are text nodes, never markup.
"use strict";

function element(kind, attributes = {}, ...children) {
  const svg = ["svg", "g", "line", "rect", "circle", "path", "text", "title", "polygon"].includes(kind);
  const node = svg ? document.createElementNS("http://www.w3.org/2000/svg", kind) : document.createElement(kind);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (value !== null && value !== undefined && value !== false) node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.filter((one) => one !== null && one !== undefined && one !== ""));
  return node;
}

// A logarithmic axis: {at(value), ticks}.
function scale(low, high, left, right) {
  const [a, b] = [Math.log(low), Math.log(high)];
  const at = (value) => left + (right - left) * (Math.log(value) - a) / (b - a || 1);
  const within = (steps) => {
    const found = [];
    for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); power++)
      found.push(...steps.map((step) => step * 10 ** power).filter((one) => one >= low * 0.999 && one <= high * 1.001));
    return found;
  };
  const apart = (ticks) => ticks.every((one, i) => !i || Math.abs(at(one) - at(ticks[i - 1])) >= 34);
  const ticks = [[1, 1.1, 1.2, 1.3, 1.4, 1.5, 1.7, 2, 2.5, 3, 4, 5, 6, 7, 8], [1, 1.2, 1.5, 2, 3, 5, 7], [1, 2, 5], [1, 3], [1]].map(within).find(apart);
  return {at, ticks: ticks ?? within([1])};
}

const INK = "var(--ink)", SOFT = "var(--soft)", LINE = "var(--line)";

function drawing(width, height, label) {
  const svg = element("svg", {viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": label,
                              "font-family": "Source Sans 3, Segoe UI, Helvetica Neue, Arial, sans-serif", "font-size": 13});
  svg.append(element("rect", {width, height, fill: "var(--paper)"}));
  return svg;
}

function words(x, y, text, more = {}) {
  return element("text", {x, y, fill: INK, ...more}, text);
}

// A row: {name, value, low, high, colour, hollow, own: {us, value}, group, onclick}. `axis` names the value; `mark`: {value, text}
// is a line, such as a deadline. Where names have no room beside the bars they stand above, in as many lines as they need.
function drawRanking(rows, axis, width, label, mark = null) {
  const narrow = width < 560 || rows.some((one) => one.name.length > 26), left = narrow ? 10 : 190, right = width - (narrow ? 14 : 170);
  const fits = (names) => names.every(([name], i) => 7.2 * name.length + 6.2 * rows[i].text.length < width - 14);
  const whole = rows.map((one) => [one.name]), names = !narrow || fits(whole) ? whole : rows.map((one) => one.name.split(/, (.*)/).filter(Boolean));
  const below = narrow && !fits(names), lines = Math.max(...names.map((one) => one.length)) + below;
  const titles = 6.4 * axis.length < width ? [axis] : axis.split(/; (.*)/).filter(Boolean);
  const step = narrow ? 24 + 16 * lines : 25, top = 10, foot = 26 + 15 * titles.length;
  const height = top + rows.length * step + foot + 5, svg = drawing(width, height, label);
  const all = rows.flatMap((one) => [one.value, one.low, one.high, one.own?.value]).concat(mark?.value).filter((one) => one > 0 && Number.isFinite(one));
  const [least, most] = [Math.min(...all) / 1.06, Math.max(...all) * 1.06], x = scale(least, Math.max(most, least * 1.3), left, right);
  for (const tick of x.ticks) {
    svg.append(element("line", {x1: x.at(tick), x2: x.at(tick), y1: top, y2: height - foot, stroke: LINE}));
    svg.append(words(x.at(tick), height - foot + 16, short(tick), {"text-anchor": "middle", fill: SOFT, "font-size": 12}));
  }
  titles.forEach((one, i) => svg.append(words((left + right) / 2, height - foot + 34 + 15 * i, one, {"text-anchor": "middle", fill: SOFT, "font-size": 12})));
  if (mark) {
    const at = x.at(mark.value);
    svg.append(element("line", {x1: at, x2: at, y1: top, y2: height - foot, stroke: "var(--bad)", "stroke-dasharray": "5 3"}));
    svg.append(words(at - 4, height - foot - 4, mark.text, {"text-anchor": "end", fill: "var(--bad)", "font-size": 11}));
  }
  rows.forEach((row, place) => {
    const begin = top + place * step, y = begin + (narrow ? step - 12 : 13), clamp = (value) => Math.min(Math.max(x.at(value), left), right);
    const group = element("g", {class: "bar", "data-name": row.name, onclick: row.onclick}, element("title", {}, row.title));
    const tied = ["fastest", "as fast"].includes(row.group), at = clamp(row.value), colour = row.colour;
    group.append(element("rect", {x: 0, y: begin, width, height: step, fill: tied ? "var(--wash)" : "transparent"}));
    names[place].forEach((name, i) => group.append(words(narrow ? left : left - 8, narrow ? begin + 16 * (i + 1) : y + 4, name,
      {"text-anchor": narrow ? "start" : "end", "font-weight": row.group === "fastest" && !i ? 600 : 400, ...(i ? {fill: SOFT, "font-size": 12} : {})})));
    group.append(element("rect", {x: left, y: y - 5, width: Math.max(at - left, 1), height: 10, fill: colour, "fill-opacity": row.hollow ? 0.12 : 0.3}));
    if (row.low < row.high)
      group.append(element("line", {x1: clamp(row.low || least), x2: clamp(row.high), y1: y, y2: y, stroke: colour, "stroke-width": 2.5}));
    group.append(element("circle", {cx: at, cy: y, r: 4.5, fill: row.hollow ? "var(--paper)" : colour, stroke: colour, "stroke-width": 1.6}));
    if (row.own?.value > 0) group.append(diamond(clamp(row.own.value), y));
    group.append(words(below ? left : narrow ? width - 4 : right + 10, narrow ? begin + 16 * (below ? lines : 1) : y + 4, row.text,
                       {"text-anchor": narrow && !below ? "end" : "start", "font-size": 12, fill: SOFT}));
    svg.append(group);
  });
  return svg;
}

const diamond = (x, y) => element("polygon", {class: "own", points: `${x},${y - 7} ${x + 6},${y} ${x},${y + 7} ${x - 6},${y}`, fill: "none",
                                              stroke: INK, "stroke-width": 1.8});

// Marks: {n, fill, colour, inner, open, square, title, onclick}; `here`: {n, fill} of the case.
function drawMap(marks, here, width, label) {
  const height = Math.min(440, Math.max(300, width * 0.6)), left = 52, right = width - 22, top = 14, bottom = height - 44;
  const svg = drawing(width, height, label), small = {fill: SOFT, "font-size": 12};
  const spread = (values) => [Math.min(...values) / 1.25, Math.max(...values) * 1.25];
  const x = scale(...spread([...marks.map((one) => one.n), here?.n].filter((one) => one > 0)), left, right);
  const y = scale(...spread([...marks.map((one) => one.fill), here?.fill].filter((one) => one > 0)), bottom, top);
  for (const tick of x.ticks)
    svg.append(element("line", {x1: x.at(tick), x2: x.at(tick), y1: top, y2: bottom, stroke: LINE}),
               words(x.at(tick), bottom + 17, short(tick), {"text-anchor": "middle", ...small}));
  for (const tick of y.ticks)
    svg.append(element("line", {x1: left, x2: right, y1: y.at(tick), y2: y.at(tick), stroke: LINE}),
               words(left - 6, y.at(tick) + 4, short(tick), {"text-anchor": "end", ...small}));
  svg.append(words((left + right) / 2, height - 6, "variables n", {"text-anchor": "middle", ...small}));
  svg.append(words(0, 0, "fill of the tangent, %", {transform: `translate(13 ${(top + bottom) / 2}) rotate(-90)`, "text-anchor": "middle", ...small}));
  for (const one of marks) {
    const [cx, cy] = [x.at(one.n), y.at(one.fill)], more = {fill: one.open ? "var(--paper)" : one.colour, stroke: one.colour, "stroke-width": 2.4};
    const group = element("g", {class: "mark", onclick: one.onclick}, element("title", {}, one.title));
    group.append(one.square ? element("rect", {x: cx - 6, y: cy - 6, width: 12, height: 12, ...more}) : element("circle", {cx, cy, r: 6.5, ...more}));
    if (one.inner && !one.open) group.append(element("circle", {cx, cy, r: 3, fill: one.inner, stroke: "var(--paper)", "stroke-width": 0.8}));
    svg.append(group);
  }
  if (here?.n > 0 && here.fill > 0) svg.append(pin(here, x.at(here.n), y.at(here.fill), width));
  return svg;
}

function pin(here, cx, cy, width) {
  const right = cx > width * 0.7, line = {fill: "none", stroke: INK, "stroke-width": 2};
  return element("g", {id: "pin", "data-n": here.n, "data-fill": here.fill}, element("circle", {cx, cy, r: 13, ...line}),
    element("path", {d: `M${cx - 19} ${cy}h10M${cx + 9} ${cy}h10M${cx} ${cy - 19}v10M${cx} ${cy + 9}v10`, ...line}),
    words(cx + (right ? -18 : 18), cy - 12, "you are here",
          {"text-anchor": right ? "end" : "start", "font-weight": 600, "paint-order": "stroke", stroke: "var(--paper)", "stroke-width": 3}));
}

// An SVG by itself: colours of the page as it is shown, instead of their names; below it a line that says what it is of.
function standalone(svg, line) {
  const style = getComputedStyle(document.documentElement), copy = svg.cloneNode(true), below = 20;
  const [width, height] = ["width", "height"].map((name) => Number(svg.getAttribute(name)));
  const size = Math.min(11, 1.8 * (width - 20) / line.length);  // so that a long one fits
  for (const [name, value] of [["xmlns", "http://www.w3.org/2000/svg"], ["viewBox", `0 0 ${width} ${height + below}`], ["height", height + below]])
    copy.setAttribute(name, value);
  copy.append(element("rect", {y: height, width, height: below, fill: "var(--paper)"}),
              words(10, height + 13, line, {fill: SOFT, "font-size": size}));
  return new XMLSerializer().serializeToString(copy).replace(/var\((--\w+)\)/g, (_, name) => style.getPropertyValue(name).trim());
}

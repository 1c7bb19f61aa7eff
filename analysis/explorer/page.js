// The controls: the question stands in the address, the page shows its answer.
"use strict";

const BOXES = [...KINDS, "penalty", "saddle"], NUMBERS = ["n", "fill", "error", "deadline"];
const PICTURES = [["svg-map", "map", "map.svg"], ["svg-ranking", "near", "ranking.svg"]];  // button, place of the picture, file
let state = {...START}, shown = null;

// The family that is wanted, if a set has it.
const familyIn = (set, wanted) => [wanted, START.family].find((one) => ["", ...familiesOf(set)].includes(one)) ?? "";

function readAddress() {
  const given = new URLSearchParams(location.hash.slice(1)), found = {...START, machine: DATA.sets[0].name};
  const listed = (key) => (given.get(key) ?? "").split(",").filter(Boolean);
  for (const key of NUMBERS) if (given.has(key)) found[key] = positive(key, given.get(key)) ?? (key === "n" ? START.n : null);
  if (DATA.sets.some((one) => one.name === given.get("machine"))) found.machine = given.get("machine");
  const set = setOf(found);
  found.family = familyIn(set, given.get("family"));
  if (set.contests.some((one) => one.scene === given.get("scene"))) found.scene = given.get("scene");
  found.no = listed("no").filter((one) => BOXES.includes(one));
  found.without = listed("without").filter((one) => ABOUT.has(one));
  try {
    if (given.has("mine")) found.mine = checked(JSON.parse(given.get("mine")));
  } catch {
    found.mine = null;
  }
  return found;
}

// What its field takes; null for anything else.
function positive(key, text) {
  const {min, max} = place(key), value = Number(text);
  return value > 0 && bounded(value) && value >= min && (!max || value <= max) ? value : null;
}

function writeAddress() {
  const given = new URLSearchParams(), set = (key, value) => value !== null && value !== "" && String(value) && given.set(key, value);
  if (DATA.sets.length > 1 && state.machine !== DATA.sets[0].name) set("machine", state.machine);
  if (state.mine) set("mine", JSON.stringify(state.mine));
  else if (state.scene) set("scene", state.scene);
  else {
    given.set("family", state.family);
    set("n", state.n);
    set("fill", state.fill);
  }
  for (const key of ["error", "deadline"]) set(key, state[key]);
  for (const key of ["no", "without"]) set(key, state[key].join(","));
  history.replaceState(null, "", `#${given}`);
}

function options(select, groups, value) {
  select.replaceChildren(...groups.map(([title, rows]) => {
    const found = rows.map(([one, text]) => element("option", {value: one, selected: one === value}, text));
    return title ? [element("optgroup", {label: title}, ...found)] : found;
  }).flat());
  select.value = value;
}

function fillControls() {
  const set = setOf(state), asked = caseOf(state);
  options(place("machine"), [["", DATA.sets.map((one) => [one.name, `${machineOf(one, DATA.sets[0])} (${one.date.slice(0, 10)})`])]], set.name);
  const scenes = (family) => [...new Map(set.contests.filter((one) => one.family === family).map((one) => [one.scene, one.n]))].sort((a, b) => a[1] - b[1]);
  options(place("scene"), [["", [["", state.mine ? `mine: ${state.mine.scene}` : "none: the numbers below"]]],
                           ...familiesOf(set).map((family) => [family, scenes(family).map(([scene, n]) => [scene, `${scene} (n = ${n})`])])], state.mine ? "" : state.scene);
  options(place("family"), [["", [["", "any: the nearest by n and fill"], ...familiesOf(set).map((one) => [one, one])]]], asked.family);
  for (const key of NUMBERS) {
    const value = key in asked ? asked[key] : state[key];
    if (document.activeElement !== place(key)) place(key).value = value ? Number(Number(value).toPrecision(6)) : "";
  }
  for (const key of BOXES) place(key).checked = !state.no.includes(key);
  const inside = new Set(set.contests.flatMap((one) => one.able));
  if (!place("contenders").children.length || place("contenders").dataset.set !== set.name) {
    place("contenders").dataset.set = set.name;
    const toggle = (name, on) => change({without: on ? state.without.filter((one) => one !== name) : [...state.without, name]});
    place("contenders").replaceChildren(...DATA.names.filter((one) => inside.has(one.name)).map((one) => element("label", {class: "box"},
      element("input", {type: "checkbox", value: one.name, onchange: (event) => toggle(one.name, event.target.checked)}), ` ${one.name}`,
      one.licence ? element("span", {class: "soft"}, ` ${one.licence}`) : "")));
  }
  for (const box of place("contenders").querySelectorAll("input")) {
    box.disabled = KINDS.some((word) => ABOUT.get(box.value)[word] && state.no.includes(word));
    box.checked = !state.without.includes(box.value) && !box.disabled;
  }
}

function fillMap(found) {
  const marks = [], wins = new Map();
  for (const contest of found.set.contests.filter((one) => one.form === found.form)) {
    const ranking = rankContest(contest, found.names);
    if (!ranking) continue;
    const open = !ranking.settled, others = ranking.equivalent.filter((name) => name !== ranking.winner);
    for (const name of [ranking.winner, ...others]) wins.set(name, (wins.get(name) ?? 0) + 1);
    const title = `${contest.scene}: ${ranking.winner}${open ? " (not decided)" : ""}${others.length ? `; as fast: ${others.join(", ")}` : ""}`;
    marks.push({n: contest.n, fill: contest.fill, colour: colourOf(ranking.winner), inner: others.length ? colourOf(others[0]) : null, open, title,
                square: contest.part === "map", onclick: () => change({scene: contest.scene, mine: null})});
  }
  const here = {n: found.asked.n, fill: found.asked.fill ?? found.features?.fill ?? found.near[0]?.contest.fill};
  const width = Math.max(280, Math.min(900, place("map").clientWidth)), list = [...wins].sort((a, b) => b[1] - a[1]);
  const label = `Map of the fastest of those that are left, over n and fill: ${list.map(([name, count]) => `${name} on ${count}`).join(", ")}`;
  const caption = "A circle is a mechanism, a square the four-bar with its own or artificial fill; inside: another that is as fast; empty: not decided. The "
    + `${found.form} form, ${machineOf(found.set, DATA.sets[0])}, ${found.set.date.slice(0, 10)}. A click takes a mark as the case.`;
  place("map").replaceChildren(...(marks.length ? [drawMap(marks, here, width, label), element("figcaption", {}, caption)] : []));
  place("winners").replaceChildren(element("ul", {}, ...list.map(([name, count]) => element("li", {},
    element("span", {class: "swatch", style: `background:${colourOf(name)}`}), `${name}: in front, or as fast, on ${count} of ${marks.length}`))));
}

function fillCommands(found) {
  const {lines, note} = commandsOf(found, state);
  place("copy").replaceChildren(note && element("p", {class: "soft"}, note), ...lines.map((line) => element("div", {class: "command"},
    element("pre", {tabindex: 0}, line),
    element("button", {type: "button", "aria-label": `copy: ${line}`, onclick: (event) => copy(line, event.target)}, "copy"))));
}

async function copy(text, button) {
  const before = button.dataset.name ??= button.textContent;  // which may still be "copied"
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = "copied";
  } catch {  // pages from a file may not, in some browsers
    window.prompt("copy:", text);
  }
  setTimeout(() => { button.textContent = before; }, 1500);
}

function show() {
  const begin = performance.now();
  show.width = innerWidth;
  shown = answer(state);
  if (state.mine?.machine && state.mine.machine !== shown.set.machine) shown.warnings.push(`yours was measured on ${state.mine.machine}: compare ratios, not times`);
  fillControls();
  fillAnswer(shown, state);
  fillMap(shown);
  fillNear(shown, state.mine);
  fillPredicted(shown, state);
  fillError(shown, state);
  fillCommands(shown);
  for (const [button, from] of PICTURES) place(button).disabled = !place(from).querySelector("svg");
  place("took").textContent = `This answer took ${Math.ceil(performance.now() - begin)} ms here.`;
  window.explorer = {state, shown, ask: (asked) => answer({...START, machine: DATA.sets[0].name, ...asked})};
}

function change(more) {
  state = {...state, ...more};
  if (more.mine === null) place("file").value = place("mine-said").textContent = "";  // so that the same file can be chosen again
  writeAddress();
  show();
}

// `source`: a text, or the promise of one.
async function useText(source) {
  try {
    const text = await source, mine = readScene(text);
    place("mine").value = text;
    change({mine, scene: ""});
    const drawn = new Set([...document.querySelectorAll("polygon.own")].map((one) => one.parentNode.dataset.name)).size;
    place("mine-said").textContent = `${mine.scene}: n = ${mine.n}`
      + (mine.own.length ? `, ${mine.own.length} measurements, ${drawn} drawn as diamonds` : "")
      + (mine.unable.length ? "; those who do not take it are left out" : "");
  } catch (error) {
    place("mine-said").textContent = `not used: ${error.message}`;
  }
}

const textOf = (file) => file.slice(0, MOST_TEXT + 1).text();  // no more than is needed to see that it is too long

const cell = (value) => {
  const text = typeof value !== "string" ? Number.isFinite(value) ? String(value) : ""
    : value.replace(/^(?=[=+@\t\r-])/, "'");  // a spreadsheet would take it for a formula
  return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
};

function asCsv() {
  const {set, near, rows, predicted, form, asked, error, errorRows} = shown, common = [set.machine, set.commit];
  const lines = [["kind", "machine", "commit", "scene", "form", "n", "contender", "group", "ratio", "low", "high", "step_us", "yours_us", "settled"]];
  near.forEach(({contest, ranking}, i) => rows[i].forEach((row) => lines.push([
    "measured", ...common, contest.scene, contest.form, contest.n, row.name, row.group, row.value, row.low, row.high, row.step, row.own?.us,
    String(ranking.settled)])));
  for (const row of predicted)  // ratios are of no use there: low and high are of the time
    lines.push(["interpolated", ...common, asked.scene, form, asked.n, row.name, "", "", row.low, row.high, row.value, "", ""]);
  for (const {point, group, value, low, high} of errorRows ?? [])
    lines.push(["error", ...common, error.curve.scene, point.setting, error.curve.n, point.name, group, value, low, high,
                1e6 * point.time * point.step, "", String(error.ranking.settled)]);
  return lines.map((row) => row.map(cell).join(",")).join("\n") + "\n";
}

// What a saved picture is of: scene or form, machine, day and who was left out, as the boxes say it.
function lineOf(from) {
  const out = [...state.no.map((key) => place(key).parentNode.textContent.trim()), ...state.without, ...(state.mine?.unable ?? [])];
  return [from === "near" ? about(shown.near[0].contest) : `${shown.form} form`, machineOf(shown.set, DATA.sets[0]), shown.set.date.slice(0, 10),
          out.length ? `left out: ${out.join("; ")}` : "nobody left out"].join("; ");
}

function save(name, kind, text) {
  const link = element("a", {href: URL.createObjectURL(new Blob([text], {type: kind})), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

place("machine").addEventListener("change", (event) => {
  const machine = event.target.value, set = setOf({machine}), there = set.contests.some((one) => one.scene === state.scene);
  change({machine, scene: there ? state.scene : "", family: familyIn(set, state.family)});
});
place("scene").addEventListener("change", (event) => change({scene: event.target.value, mine: null}));
place("family").addEventListener("change", (event) =>
  change({...numbers(), family: event.target.value, fill: event.target.value.includes("filled") ? 50 : null, scene: "", mine: null}));
for (const key of NUMBERS)
  place(key).addEventListener("input", (event) => {
    const value = positive(key, event.target.value);
    if (key === "n" && !value) return void event.target.reportValidity();
    change(["n", "fill"].includes(key) ? {...numbers(), family: caseOf(state).family, [key]: value, scene: "", mine: null} : {[key]: value});
  });
for (const key of BOXES)
  place(key).addEventListener("change", (event) => change({no: event.target.checked ? state.no.filter((one) => one !== key) : [...state.no, key]}));
// What the fields show, where a scene has been left for numbers of one's own. The fill of a mechanism goes with its size.
function numbers() {
  const {n, fill, family} = caseOf(state), kept = !state.scene && !state.mine || !family || family.includes("filled");
  return {n, fill: kept ? fill : null};
}

place("reset").addEventListener("click", () => {
  place("mine").value = "";
  change({...START, machine: DATA.sets[0].name, family: familyIn(DATA.sets[0], START.family)});
});
place("link").addEventListener("click", (event) => copy(location.href, event.target));
place("use").addEventListener("click", () => useText(place("mine").value));
place("forget").addEventListener("click", () => { place("mine").value = ""; change({mine: null}); });
place("file").addEventListener("change", (event) => { if (event.target.files[0]) useText(textOf(event.target.files[0])); });
place("mine").addEventListener("paste", () => setTimeout(() => useText(place("mine").value)));
for (const kind of ["dragover", "dragleave", "drop"])
  place("drop").addEventListener(kind, (event) => {
    event.preventDefault();
    place("drop").classList.toggle("drop", kind === "dragover");
    if (kind !== "drop") return;
    const [file] = event.dataTransfer.files;
    useText(file ? textOf(file) : event.dataTransfer.getData("text"));
  });
place("csv").addEventListener("click", () => save("ranking.csv", "text/csv", asCsv()));
for (const [button, from, name] of PICTURES)
  place(button).addEventListener("click", () => save(name, "image/svg+xml", standalone(place(from).querySelector("svg"), lineOf(from))));
place("question").addEventListener("submit", (event) => event.preventDefault());
DARK.addEventListener("change", () => show());
window.addEventListener("hashchange", () => change(readAddress()));
window.addEventListener("resize", () => {  // of the width: a keyboard on the screen changes the height
  clearTimeout(show.later);
  if (innerWidth !== show.width) show.later = setTimeout(show, 150);
});
state = readAddress();
show();

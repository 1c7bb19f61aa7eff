// The answer on the page: sentences, rankings with their raw rows, commands. Each function fills one place.
"use strict";

const GROUPS = {fastest: "fastest", "as fast": "as fast", open: "open", slower: "slower", rough: "slower, by a first look",
                yours: "timed by you alone"};
const place = (id) => document.getElementById(id);
const times = (one) => `${short(one.value)}×` + (one.low < one.high && one.high < Infinity ? ` (${short(one.low)} to ${short(one.high)})` : one.value === 1 ? "" : " (not bounded)");
const about = (contest) => `${contest.scene} (n = ${short(contest.n, 5)}, fill ${short(contest.fill)} %, ${contest.form} form)`;
const DARK = matchMedia("(prefers-color-scheme: dark)");

// The colour of a name in all figures; on a dark page the dark ones are lightened.
function colourOf(name) {
  const parts = (ABOUT.get(name)?.colour ?? "#777777").match(/[0-9a-f]{2}/gi).map((one) => parseInt(one, 16));
  const dim = DARK.matches && 0.3 * parts[0] + 0.59 * parts[1] + 0.11 * parts[2] < 110;
  return `rgb(${parts.map((one) => Math.round(dim ? one + 0.45 * (255 - one) : one)).join(",")})`;
}


function groupOf(ranking, name) {
  return name === ranking.winner ? "fastest" : ranking.equivalent.includes(name) ? "as fast" : ranking.open.includes(name) ? "open" : "slower";
}

// Rows of a contest among those that are left: who was ranked, who was only looked at, then whom the reader alone timed. The reader's
// own times become ratios by the first of the others that has one.
function rowsOf(contest, ranking, names, mine) {
  const rows = ranking.ratios.map(([name, one]) =>
    ({name, ...one, step: stepOf(contest, name), group: groupOf(ranking, name), raw: () => rawOf(contest, name)}));
  const rough = (name, group, value, step, ...why) =>
    rows.push({name, value, low: NaN, high: NaN, step, group, hollow: true, raw: () => [["status", "reason"], why]});
  const base = contest.look.get(ranking.winner);
  for (const {name, status, reason} of contest.lost)
    if (names.has(name) && ["slower", "excluded"].includes(status) && contest.look.has(name) && base > 0)
      rough(name, "rough", contest.look.get(name) / base, contest.look.get(name), status, reason);
  const own = new Map((mine?.own ?? []).map((one) => [one.name, one.us])), first = rows.find((row) => own.has(row.name));
  const ratio = (name) => own.get(name) / own.get(first.name) * first.value;
  for (const name of first ? own.keys() : [])
    if ((names.has(name) || !ABOUT.has(name)) && !rows.some((row) => row.name === name)) rough(name, "yours", ratio(name), NaN, "–", GROUPS.yours);
  for (const row of rows) row.own = own.has(row.name) ? {us: own.get(row.name), value: ratio(row.name)} : null;
  return rows.sort((a, b) => (a.group !== "fastest") - (b.group !== "fastest") || a.value - b.value);
}

const rawOf = (contest, name) => [["process", "environment", "µs a step, sample by sample", "record"],
  ...contest.rows.filter((one) => one[0] === name).map(([, process, samples]) =>
    [String(process.number), process.environment, samples.map((one) => short(one, 5)).join("  "), `raw/${contest.part}/${process.record}`])];

function table(head, rows) {
  return element("table", {}, element("thead", {}, element("tr", {}, ...head.map((one) => element("th", {scope: "col"}, one)))),
                 element("tbody", {}, ...rows.map((row) => element("tr", {}, ...row.map((one) => element("td", {class: "wrap"}, one))))));
}

// A picture of rows and their table; each row opens what it was made of. `columns`: [title, row => text].
function fillRanking(target, id, title, note, rows, axis, columns, mark, beside = 1) {
  const buttons = new Map(), body = element("tbody"), details = element("details", {}, element("summary", {}, "table, and the raw rows behind every bar"));
  const open = (name) => { details.open = true; buttons.get(name).click(); buttons.get(name).focus(); };
  const whole = target.clientWidth, width = Math.max(280, Math.min(760, beside > 1 && whole > 1100 ? whole / 2 - 16 : whole));
  const drawn = rows.map((row) => ({...row, colour: row.colour ?? colourOf(row.name), title: `${row.name}: ${row.text}`, onclick: () => open(row.name)}));
  const figure = element("figure", {}, drawRanking(drawn, axis, width, `${title}: ${drawn.map((row) => row.title).join("; ")}`, mark));
  for (const row of rows) {
    const raw = element("tr", {class: "raw", hidden: true}), all = columns.length + 1;
    const button = element("button", {type: "button", "aria-expanded": "false", onclick: () => {
      if (!raw.firstChild) { const [head, ...found] = row.raw(); raw.append(element("td", {colspan: all}, table(head, found))); }
      raw.hidden = !raw.hidden;
      button.setAttribute("aria-expanded", String(!raw.hidden));
    }}, "rows");
    button.setAttribute("aria-label", `raw rows of ${row.name}`);
    buttons.set(row.name, button);
    body.append(element("tr", {class: ["fastest", "as fast"].includes(row.group) ? "tie" : "", "data-name": row.name},
                        ...columns.map(([, text]) => element("td", {}, text(row))), element("td", {}, button)), raw);
  }
  const head = element("thead", {}, element("tr", {}, ...[...columns.map(([name]) => name), ""].map((one) => element("th", {scope: "col"}, one))));
  target.append(element("div", {id}, element("h3", {}, title), element("p", {class: "soft"}, note), figure, details));
  details.append(element("div", {class: "scroll"}, element("table", {}, head, body)));
}

function fillNear(found, mine) {
  const target = place("near");
  target.replaceChildren();
  found.rows = found.near.map((one) => rowsOf(one.contest, one.ranking, found.names, mine));
  found.near.forEach(({contest, ranking, exact}, i) => {
    const rough = (row) => `about ${short(row.value, 2)}× (${row.group === "yours" ? "yours" : "a look"})`;
    const rows = found.rows[i].map((row) => ({...row, text: row.hollow ? rough(row) : times(row)}));
    const failed = contest.lost.filter((one) => found.names.has(one.name) && !["slower", "excluded", "dropped"].includes(one.status));
    const note = (exact ? "Measured at this very case. " : found.near.length > 1 ? "Measured beside the case. " : "The nearest that was measured. ")
      + (ranking.decided ? "Decided." : ranking.settled ? "Several are as fast, to 5 %." : "Not decided: this run does not tell which of the open ones is fastest.")
      + (failed.length ? ` Not ranked: ${failed.map((one) => `${one.name} (${one.status})`).join(", ")}.` : "");
    fillRanking(target, `near-${i}`, about(contest), note, rows, "time ÷ that of the fastest; lines: 95 % intervals" + (mine?.own.length ? "; diamonds: yours" : ""),
                [["contender", (row) => row.name], ["", (row) => GROUPS[row.group]], ["time ÷ the fastest's", (row) => row.text], ["µs a step", (row) => short(row.step)],
                 ...yours(mine)], null, found.near.length);
  });
  if (!found.near.length) target.append(element("p", {}, "None of those that are left was measured on such a mechanism."));
}

function fillPredicted(found, state) {
  const target = place("model"), own = new Map((state.mine?.own ?? []).map((one) => [one.name, one.us]));
  target.replaceChildren();
  if (!found.predicted.length) {
    target.append(element("p", {}, "No prediction: this set has no rule for those that are left, or the case has no numbers."));
    return;
  }
  const rows = found.predicted.map((one) => ({...one, group: fits(one, state.deadline), hollow: true,
    own: own.has(one.name) ? {us: own.get(one.name), value: own.get(one.name)} : null, text: `${short(one.value)} µs (${range(one)})`,
    raw: () => [["feature", "amount", "µs each", "µs"], ...one.terms.map((term) => [term.feature, short(term.amount, 5), short(term.us), short(term.product)])]}));
  fillRanking(target, "model-0", `µs a step at n = ${short(found.asked.n, 5)}, fill ${short(found.features.fill)} %, ${found.form} form`,
              "Interpolated: sums of the case's numbers, fitted on all mechanisms of the set. mbs describe uses such sums too, but "
              + "puts one of few candidates first. Lines: where nine of ten times lie, judged on families left out. "
              + (found.asked.features?.n > 0 ? "The numbers are those of the scene itself."
                                             : "The numbers of the case are those of the nearest mechanisms, scaled to it."),
              rows, "µs a step, interpolated",
              [["contender", (row) => row.name], ["µs a step", (row) => short(row.value)], ["range", range],
               ...(state.deadline ? [["deadline", (row) => row.group]] : []), ...yours(state.mine)],
              state.deadline ? {value: state.deadline, text: "deadline"} : null);
}

const range = (one) => `${short(one.low)} to ${short(one.high)}`;
const yours = (mine) => mine?.own.length ? [["yours, µs", (row) => row.own ? short(row.own.us) : "–"]] : [];
const fits = (one, deadline) => !deadline ? "" : one.high <= deadline ? "mean below" : one.low > deadline ? "mean above" : "not said";

function fillError(found, state) {
  const target = place("points");
  target.replaceChildren();
  if (!state.error) return void target.append(element("p", {}, "No error was asked for: it decides step and setting."));
  if (!found.error?.ranking)
    return void target.append(element("p", {}, found.error ? `None of those that are left was seen to reach ${short(state.error)} m.`
                                                           : "No errors were measured in this set."));
  const {curve, ranking} = found.error, name = (point) => `${point.name}, ${point.setting}, step ${short(1e3 * point.step)} ms`;
  const raw = (point) => [["process", "s a simulated second", "record"],
    ...curve.rounds.filter((row) => row.point === point && row.seconds !== null).map((row) => [String(row.process), short(row.seconds, 5), ""]),
    ["–", `${short(point.time, 5)} (${point.from})`, point.record.split(" ").map((one) => `raw/accuracy/${one}`).join("\n")]];
  const rows = (ranking.ratios.length ? ranking.ratios : [[ranking.winner, ONE]]).map(([point, one]) => ({
    ...one, point, name: name(point), colour: colourOf(point.name), group: groupOf(ranking, point), text: times(one), raw: () => raw(point)}));
  found.errorRows = rows;
  fillRanking(target, "points-0", `An error of at most ${short(state.error)} m on ${curve.title} (n = ${short(curve.n)}, fill ${short(curve.fill)} %)`,
              `The nearest motion whose error is known. ${ranking.settled ? "" : "Not decided. "}${ranking.candidates} points reach it. `
              + "study/advise finds step and setting for your scene.", rows,
              "time of a simulated second ÷ that of the fastest; lines: 95 % intervals",
              [["contender, setting, step", (row) => row.name], ["", (row) => GROUPS[row.group]], ["time ÷ the fastest's", (row) => row.text],
               ["error, m", (row) => short(row.point.error)], ["s a simulated second", (row) => short(row.point.time)]]);
}

// The machine of a set, with its commit where that is not the one of the set beside it.
const machineOf = (set, beside) => set.machine + (set.commit === beside.commit ? "" : ` at commit ${set.commit.slice(0, 10)}`);

// What the sets of other machines say of the same contest.
function elsewhere(found, contest, winner) {
  return DATA.sets.filter((set) => set !== found.set).map((set) => {
    const there = set.contests.find((one) => one.part === contest.part && one.scene === contest.scene && one.form === contest.form);
    const ranking = there && rankContest(there, found.names), mine = ranking?.ratios.find(([name]) => name === winner)?.[1];
    if (!ranking) return "";
    return ` On ${machineOf(set, found.set)} ${ranking.winner === winner ? "it leads too" : `${ranking.winner} leads${mine ? `, and ${winner} takes ${times(mine)}` : ""}`}.`;
  });
}

function fillAnswer(found, state) {
  const lines = [], [first, second] = found.near, bold = (name) => element("b", {}, name), [best] = found.predicted, point = found.error?.ranking?.winner;
  if (!first) lines.push(["None of those that are left was measured on such a mechanism."]);
  for (const {contest, ranking} of found.near) {
    const others = ranking.equivalent.filter((name) => name !== ranking.winner), known = ranking.decided || ranking.settled;
    lines.push([bold(ranking.winner), ` ${known ? "is fastest" : "leads, not decided,"} on ${about(contest)}, measured: `
                + `${short(stepOf(contest, ranking.winner))} µs a step`, others.length ? `; as fast: ${others.join(", ")}` : "",
                ranking.open.length ? `; open: ${ranking.open.join(", ")}` : "", ranking.second ? `. Next is ${ranking.second}: ${times(ranking.margin)}.` : ".",
                ...elsewhere(found, contest, ranking.winner)]);
  }
  if (first && !first.exact)
    lines.push([!second ? "This is the nearest that was measured."
      : (found.asked.family ? "Your case lies between these" : "These two are the nearest that were measured")
        + (first.ranking.winner === second.ranking.winner ? "; on both the same one leads." : "; another one leads on each: measure yours.")]);
  if (best) lines.push(["Predicted for the case: ", bold(best.name), ` ${short(best.value)} µs a step (${range(best)}).`]);
  const step = first?.exact ? stepOf(first.contest, first.ranking.winner) : best?.value;
  if (state.deadline && step)
    lines.push([`A deadline of ${short(state.deadline)} µs is ${short(state.deadline / step)} times the mean step of the fastest`
                + `${state.deadline > step ? "; single steps take several times the mean" : ": too short"} (`,
                element("a", {href: "realtime.html"}, "distribution"), ")."]);
  if (point) lines.push([`For ${short(state.error)} m on ${found.error.curve.scene}: `, bold(point.name),
                         `, ${point.setting}, step ${short(1e3 * point.step)} ms${found.error.ranking.settled ? "" : " (not decided)"}.`]);
  place("answer").replaceChildren(...lines.map((line) => element("p", {}, ...line)), ...found.warnings.map((one) => element("p", {class: "warn"}, one)));
}

// {scene, note}, as the program takes it: the case itself, or nearly, if its family has sizes, else the nearest that was measured.
function sceneOf({asked, near}) {
  if (asked.scene) return {scene: asked.scene, note: ""};
  const [kind, filled] = asked.family.split(", "), nearest = near[0]?.contest.scene ?? "scene.json";
  const like = nearest.replace(/:\d+|,fill=[\d.]+/g, "");  // of the family with the same options
  const [, more, each, rest] = DATA.sizes.find(([name, options]) => name === kind && name + options === like) ?? [];
  const size = each ? Math.round((asked.n - rest) / each) : 0, n = each * size + rest;
  if (size > 0 && (!filled || asked.fill))
    return {scene: `${kind}:${size}${more}${filled ? `,fill=${short(asked.fill / 100)}` : ""}`,
            note: Math.abs(n - asked.n) < 1e-6 ? "" : `The commands are of the nearest size: ${short(n, 6)} variables, not ${short(asked.n, 6)}.`};
  return {scene: nearest, note: "The case has no name that mbs knows; the commands are those of the nearest scene. Put your own in its place."};
}

// A word of a command line, which is no option of it.
const quoted = (word) => word.startsWith("-") ? quoted(`./${word}`) : /^[\w:.,=/+-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;

function commandsOf(found, state) {
  const {scene, note} = sceneOf(found), ranking = found.near[0]?.ranking, word = quoted(scene), lines = [];
  if (!ranking) return {lines, note: ""};
  const lead = ranking.ratios.slice(0, 4).map(([name]) => name), form = found.form === "saddle-point" ? " --scheme saddle-point" : "";
  lines.push(`build/mbs bench ${word} --implementation=${lead.join(",")}${form}`);
  const best = found.error?.ranking?.winner, there = best && found.error.curve.scene === scene;  // elsewhere its step says nothing
  const simulate = `build/mbs simulate ${word} --implementation`;
  if (there) lines.push(`${simulate} ${best.name} ${DATA.settings[best.setting] ?? ""} --step ${best.step}`.replace(/ {2,}/g, " "));
  else if (!state.error) lines.push(`${simulate} ${ranking.winner}${form}`);
  lines.push(`study/advise ${word} --error ${state.error ?? 1e-3}` + (state.deadline ? ` --deadline-us ${state.deadline}` : "")
             + (state.no.length || state.without.length ? ` --only ${lead.join(" ")}` : ""));
  const whose = `The step above that reaches ${short(state.error)} m was measured on ${found.error?.curve.scene}; study/advise finds yours.`;
  return {lines, note: [note, best && !there ? whose : ""].filter(Boolean).join(" ")};
}

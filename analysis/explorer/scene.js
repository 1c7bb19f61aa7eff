// "My scene": what `mbs describe --json`, `mbs bench` or `mbs bench --benchmark_format=json` printed becomes
// {scene, n, fill, features, form, machine, own: [{name, us}], unable: names of those who do not take it, warnings}. Errors are thrown
// with a line to show.
"use strict";

const MOST_TEXT = 4e6, MOST_OWN = 200, MOST_FEATURES = 100;
const list = (value) => Array.isArray(value) ? value : [];

function readScene(text) {
  if (text.length > MOST_TEXT) throw new Error("this is too long to be what mbs prints of one scene");
  const first = text.search(/\S/);
  if (first < 0) throw new Error("nothing was pasted");
  if (text[first] !== "{") return checked(readTable(text));
  let found;
  try {
    found = JSON.parse(text);
  } catch (error) {
    throw new Error(`this is no whole JSON: ${error.message}`);
  }
  if (Array.isArray(found.benchmarks)) return checked(readBenchmarks(found));
  if (found.features) return checked(readDescribed(found));
  throw new Error("this JSON is neither of mbs describe --json nor of mbs bench --benchmark_format=json");
}

function readDescribed(found) {
  const outside = list(found.rule?.outside).map((name) => PLAIN[name] ?? name), warnings = [...list(found.warnings)];
  if (outside.length)  // before others, of which there may be too many
    warnings.unshift(`the scene lies outside of all that the rule of mbs describe was fitted on (${outside.slice(0, 5).join(", ")}`
                     + `${outside.length > 5 ? ` and ${outside.length - 5} more` : ""}): its times are extrapolated`);
  if (found.singular_start) warnings.push("the scene starts in a singular position");
  const able = list(found.recommendation).map((one) => one?.implementation), form = found.scheme?.take ?? FORMS[0];
  // Of whom the rule has no times, the recommendation says nothing.
  const {times} = DATA.sets.find((one) => one.name === found.rule?.set) ?? DATA.sets[0];
  const unable = able.length ? Object.keys(times).filter((name) => times[name][form] && !able.includes(name)) : [];
  return {scene: found.scene, n: found.variables, fill: 100 * (found.tangent?.fill ?? NaN), features: found.features,
          form, machine: "", own: [], unable, warnings};
}

function readBenchmarks(found) {
  const unable = found.benchmarks.filter((one) => /^unsupported/.test(one?.error_message) && typeof one.name === "string")
    .map((one) => one.name.split("/").slice(0, 2).join("/"));
  const runs = found.benchmarks.filter((one) => typeof one?.name === "string" && one.run_type === "iteration" && !one.error_occurred
    && one.steps > 0 && one.cpu_time > 0 && !one.name.startsWith("null/null/"));  // the control, which does nothing
  if (!runs.length) throw new Error("no contender was timed in this output of mbs bench");
  const split = (name) => name.split("/"), scene = split(runs[0].name).slice(2).join("/");
  const times = new Map();
  for (const one of runs.filter((run) => split(run.name).slice(2).join("/") === scene)) {
    const name = split(one.name).slice(0, 2).join("/");
    times.set(name, [...(times.get(name) ?? []), one.cpu_time / one.steps]);
  }
  return {scene, n: runs[0].variables, fill: runs[0].fill_percent, features: null, form: formOf(found.context?.command),
          machine: found.context?.cpu_model ?? "", unable, warnings: [],
          own: [...times].map(([name, us]) => ({name, us: median(us)}))};
}

const formOf = (command) => /--scheme[= ]saddle-point/.test(command ?? "") ? "saddle-point" : undefined;

// The table that `mbs bench` prints, with or without --summary; of several scenes the first. A summary is as wide as a terminal:
// what does not fit goes on after four blanks. Its last lines say who was left out, after shares of the time, which look like times.
function readTable(printed) {
  const text = printed.replace(/\r?\n {4}(?=\S)/g, " ");
  const head = /^(\S.*): (\d+) variables, \d+ constraints, tangent filled to ([\d.e+-]+) %/m.exec(text);
  if (!head) throw new Error("this is not what mbs describe --json or mbs bench prints");
  const after = text.slice(head.index + head[0].length), next = after.search(/^\S.*: \d+ variables, /m);
  const scene = next < 0 ? after : after.slice(0, next), [timed] = scene.split(/^shares of the time/m);
  const rows = timed.matchAll(/^([\w.+-]+\/[\w.+-]+) +(?:own +)?([\d.]+(?:e[+-]?\d+)?) +[\d.]/gm);
  const own = [...rows].map(([, name, us]) => ({name, us: Number(us)}));
  const refused = scene.matchAll(/^([\w.+-]+\/[\w.+-]+) +unsupported: |^ {2}unsupported: .*: (.+?) *$/gm);
  const unable = [...refused].flatMap(([, name, names]) => name ?? names.split(", "));
  if (!own.length) throw new Error("no contender was timed in this output of mbs bench");
  return {scene: head[1], n: Number(head[2]), fill: Number(head[3]), features: null, form: undefined,
          machine: (/^\w+ build by .{1,200}? on (.{1,200}), BLAS/m.exec(text) ?? [])[1] ?? "", own, unable, warnings: []};
}

// Only numbers and short texts go on, whatever was pasted or stands in the address. No character of a text steers a terminal, to
// which a command with it may be copied, or turns the words around it. Without the numbers by which mechanisms are near, features are of no use.
function checked(found) {
  const number = (value) => bounded(value) ? value : null;
  const text = (value) => typeof value === "string" ? value.slice(0, 300).replace(/[\p{Cc}\p{Cf}]/gu, " ") : "";
  const features = Object.fromEntries(Object.entries(found.features ?? {}).slice(0, MOST_FEATURES)
    .filter(([name, value]) => /^\w{1,20}$/.test(name) && bounded(value)));
  if (!number(found.n)) throw new Error("it does not say how many variables the scene has");
  return {scene: text(found.scene), n: found.n, fill: number(found.fill), features: NEAREST.every((name) => features[name] > 0) ? features : null,
          form: found.form === "saddle-point" ? found.form : "penalty", machine: text(found.machine),
          warnings: list(found.warnings).slice(0, 10).map(text), unable: list(found.unable).slice(0, MOST_OWN).map(text),
          own: list(found.own).slice(0, MOST_OWN).filter((one) => number(one?.us)).map((one) => ({name: text(one.name), us: one.us}))};
}

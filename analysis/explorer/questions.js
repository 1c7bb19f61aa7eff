// A question and its answer: which contests are nearest to the case, who of those that are left is fastest there, and what the
// rule predicts for the case itself. Nothing here touches the page.
"use strict";

const DATA = JSON.parse(document.getElementById("data").textContent);
const FORMS = ["penalty", "saddle-point"], KINDS = ["own", "gpl", "dense"], NEAREST = ["n", "per_column", "flops", "tangent"];
const SAME = 0.01;  // of the logarithms: a case is that of a mechanism
const MOST = 1e18;  // a number that is asked for is 0 or from 1 / MOST to MOST, so that products and axes of such ones are finite
const bounded = (value) => typeof value === "number" && (value === 0 || value >= 1 / MOST && value <= MOST);

// Numbers of names become names; rows of raw times become objects.
const ABOUT = new Map(DATA.names.map((one) => [one.name, one]));
for (const set of DATA.sets) {
  const name = (place) => DATA.names[place].name;
  for (const one of set.contests) {
    one.features = set.mechanisms[one.scene] ?? {};
    one.able = one.able.map(name);
    one.failed = one.failed.map(name);
    one.lost = one.lost.flatMap(([status, reason, places]) => places.map((place) => ({name: name(place), status, reason})));
    one.look = new Map(one.look.map(([place, us]) => [name(place), us]));
    one.processes = one.processes.map(([environment, number, again, record, layout]) => ({environment, number, again, record, layout}));
    one.rows = one.rows.map(([place, process, samples]) => [name(place), one.processes[process], samples]);
  }
  for (const one of set.curves) {
    one.points = one.points.map(([place, setting, step, error, time, low, high, from, record]) =>
      ({name: name(place), setting, step, error, time, low, high, from, record}));
    one.rounds = one.rounds.map(([place, process, status, seconds]) => ({point: one.points[place], process, status, seconds}));
    one.cut = one.cut.map(([place, setting, error, time]) => ({name: name(place), setting, error: error ?? Infinity, time}));
  }
}

// What nobody asked for: the set's own machine, the four-bar of 100 variables.
const START = {machine: "", scene: "", family: "four-bar", n: 100, fill: null, error: null, deadline: null, no: [], without: [], mine: null};

const setOf = (state) => DATA.sets.find((one) => one.name === state.machine) ?? DATA.sets[0];
const familiesOf = (set) => [...new Set(set.contests.map((one) => one.family))];
const logarithm = (a, b) => Math.log(a / b);

// Names that are left by the boxes and take the scene.
function chosen(state) {
  const out = (one) => KINDS.some((word) => one[word] && state.no.includes(word)) || [...state.without, ...(state.mine?.unable ?? [])].includes(one.name);
  return new Set(DATA.names.filter((one) => !out(one)).map((one) => one.name));
}

// Forms of the step that are left, the first one in which somebody who is left was measured on the case before the other.
const forms = (state) => {
  const names = chosen(state), order = state.mine?.form === "saddle-point" ? [...FORMS].reverse() : FORMS;
  const measured = (form) => setOf(state).contests.some((one) => one.scene === state.scene && one.form === form && one.able.some((name) => names.has(name)));
  return order.filter((form) => !state.no.includes(form === "penalty" ? "penalty" : "saddle")).sort((a, b) => measured(b) - measured(a));
};

// The case in numbers: n, fill and, of one's own scene or a measured one, its features.
function caseOf(state) {
  const set = setOf(state);
  const measured = state.scene ? set.contests.find((one) => one.scene === state.scene && Object.keys(one.features).length)
    ?? set.contests.find((one) => one.scene === state.scene) : null;
  if (state.mine) return {...state.mine, family: "", scene: state.mine.scene, features: state.mine.features ?? null};
  if (measured) return {n: measured.n, fill: measured.fill, family: measured.family, scene: measured.scene, features: measured.features};
  return {n: state.n, fill: state.fill, family: state.family, scene: "", features: null};
}

function distance(one, asked) {
  if (asked.features?.n > 0)  // which those of the map alone lack
    return one.features.n > 0 ? Math.hypot(...NEAREST.map((name) => logarithm(one.features[name], asked.features[name]))) : Infinity;
  return Math.hypot(logarithm(one.n, asked.n), asked.fill ? logarithm(one.fill, asked.fill) : 0);
}

// The answer: {asked, form, names, near: [{contest, ranking, exact}], predicted, features, error, warnings}. `near` is the contest
// of the case itself, or those on both sides of it in its family, or the two nearest.
function answer(state) {
  const set = setOf(state), names = chosen(state), asked = caseOf(state);
  const found = {set, asked, names, form: forms(state)[0] ?? null, near: [], predicted: [], features: null, error: null,
                 warnings: [...(state.mine?.warnings ?? [])]};
  const told = asked.features?.n > 0 || asked.fill || asked.family && !asked.family.includes("filled");  // by n alone none is the case
  for (const form of forms(state)) {
    const ranked = set.contests.filter((one) => one.form === form && (!asked.family || one.family === asked.family))
      .map((contest) => ({contest, far: contest.scene === asked.scene ? 0 : distance(contest, asked), samples: contest.rows.length}))
      .filter((one) => one.contest.able.some((name) => names.has(name)))
      .sort((a, b) => a.far === b.far ? b.samples - a.samples : a.far - b.far);
    if (!ranked.length) continue;
    const first = ranked[0], exact = first.contest.scene === asked.scene || Boolean(told) && first.far < SAME;
    const other = exact ? null : ranked.find((one) => asked.family ? (one.contest.n - asked.n) * (first.contest.n - asked.n) < 0
                                                                    : one.contest.scene !== first.contest.scene);
    found.form = form;
    found.near = [first, ...(other ? [other] : [])].map((one) => ({contest: one.contest, exact, ranking: rankContest(one.contest, names)}));
    found.features = featuresOf(asked, set);
    found.predicted = predicted(set, found.features, form, taking(found, () => false));
    found.warnings = warnings(state, asked, found.features, set.contests.filter((one) => one.form === form));
    break;
  }
  const inOther = (name, {scene}) => set.contests.some((one) => one.scene === scene && one.able.includes(name));
  if (state.error) found.error = answerError(state, set, asked, taking(found, inOther));  // whose points are of either form
  return found;
}

// Names without those that do not take what is near in this form of the step, unless they are `excused(name, contest)`.
function taking({near, names}, excused) {
  const refused = new Set(near.flatMap(({contest}) => contest.lost.filter(({name, status}) => status === "unsupported" && !excused(name, contest)))
    .map((one) => one.name));
  return new Set([...names].filter((name) => !refused.has(name)));
}

const WITH_SIZE = ["m", "jacobian", "mass", "tangent", "factor", "height", "supernodes", "springs"];  // grow with n, at one density

// Features of the case: its own; else between the two sizes of its family that enclose it, on logarithms; else those of the
// nearest mechanism, scaled.
function featuresOf(asked, set) {
  if (asked.features?.n > 0) return {...asked.features};
  const known = Object.values(set.mechanisms).filter((one) => !asked.family || one.family === asked.family)
    .sort((a, b) => distance(a, {...asked, features: null}) - distance(b, {...asked, features: null}));
  if (!known.length) return null;
  const first = known[0], below = (one) => one.n <= asked.n;
  const second = asked.family && !asked.fill && first.n !== asked.n ? known.find((one) => below(one) !== below(first)) : null;
  const found = {}, names = Object.keys(first).filter((name) => name !== "family");
  if (second) {
    const share = logarithm(asked.n, first.n) / logarithm(second.n, first.n);
    for (const name of names)
      found[name] = first[name] > 0 && second[name] > 0 ? first[name] * (second[name] / first[name]) ** share : first[name];
  } else {
    const larger = asked.n / first.n;
    for (const name of names) found[name] = first[name] * (WITH_SIZE.includes(name) ? larger : 1);
    const filled = asked.fill ? asked.fill / (100 * found.tangent / asked.n ** 2) : 1, most = asked.n * (asked.n + 1) / 2;
    Object.assign(found, {tangent: found.tangent * filled, factor: Math.min(found.factor * filled, most)});
    found.per_column = found.factor / asked.n;
    const denser = found.per_column / first.per_column;
    found.flops = first.flops * larger * denser ** 2;
    if (first.saddle_flops)
      Object.assign(found, {saddle_factor: first.saddle_factor * larger * denser, saddle_flops: first.saddle_flops * larger * denser ** 2});
    if (first.dense) found.dense = Math.min(first.dense * denser ** 2 / larger ** 2, 100);
  }
  return {...found, one: 1, n: asked.n, n2: asked.n ** 2, n3: asked.n ** 3, fill: 100 * found.tangent / asked.n ** 2};
}

// [{name, value, low, high, terms}] in µs a step, the fastest first: the rule's sums of features.
function predicted(set, features, form, names) {
  if (!features) return [];
  const found = [];
  for (const [name, times] of Object.entries(set.times)) {
    const model = times[form];
    if (!names.has(name) || !model?.coefficients) continue;
    const terms = Object.entries(model.coefficients).map(([feature, us]) => ({feature, us, amount: amountOf(feature, features)}))
      .map((one) => ({...one, product: one.us * one.amount}));
    const value = terms.reduce((sum, one) => sum + one.product, 0);
    if (value > 0) found.push({name, value, low: value * model.low, high: value * model.high, terms});
  }
  return found.sort((a, b) => a.value - b.value);
}

// Of a product of features, such as "n*n", "passes*flops" or "1".
const amountOf = (product, features) => product.split("*").reduce((amount, one) => amount * (features[one] ?? Number(one)), 1);

const PLAIN = {__proto__: null, n: "n", fill: "fill of the tangent", per_column: "non-zeros a column of the factor",
               flops: "operations of a factorization", tangent: "non-zeros of the tangent"};

function warnings(state, asked, features, contests) {
  const found = [...(state.mine?.warnings ?? [])];
  for (const name of features && contests.some((one) => one.features.n > 0) ? Object.keys(PLAIN) : ["n", "fill"]) {
    const value = features?.[name] ?? asked[name];
    const known = contests.map((one) => one.features[name] ?? one[name]).filter((one) => one > 0);
    const [low, high] = [Math.min(...known), Math.max(...known)];
    if (value > 0 && (value < low * (1 - SAME) || value > high * (1 + SAME)))
      found.push(`${PLAIN[name]}: ${short(value)} lies outside of what was measured (${short(low)} to ${short(high)})`);
  }
  if (asked.family && asked.n && !asked.scene) {
    const known = contests.filter((one) => one.family === asked.family).map((one) => one.n);
    if (known.length && (asked.n < Math.min(...known) || asked.n > Math.max(...known)))
      found.push(`${asked.family}: measured from n = ${Math.min(...known)} to ${Math.max(...known)} alone`);
  }
  return found;
}

// Which point reaches an error in the least time, on the judged four-bar nearest to the case.
function answerError(state, set, asked, names) {
  const far = (one) => distance(one, {...asked, features: null});
  const [curve] = set.curves.filter((one) => one.unit === "m").sort((a, b) => far(a) - far(b));
  const left = ({setting}) => !state.no.includes(setting.startsWith("saddle") ? "saddle" : /^(rattle|multistep)/.test(setting) ? "" : "penalty");
  const layers = new Set([...names].map((name) => ABOUT.get(name).own));  // a curve is the setting's: whoever of its layer made it
  if (!curve) return null;
  const points = curve.points.filter((one) => names.has(one.name) && one.error <= state.error && left(one));
  const cut = curve.cut.filter((one) => layers.has(ABOUT.get(one.name).own) && one.error > state.error && left(one));
  return {curve, ranking: rankPoints(curve, points, cut)};
}

// µs a step of a contender in a contest: the median over processes of the medians over samples.
const stepOf = (contest, name) => median(contest.rows.filter((one) => one[0] === name).map(([, , samples]) => median(samples)));

// "1.23", "6800", "1.2e-5".
function short(value, digits = 3) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return "∞";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) return value.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e");
  return size >= 10 ** digits ? value.toFixed(0) : String(Number(value.toPrecision(digits)));
}

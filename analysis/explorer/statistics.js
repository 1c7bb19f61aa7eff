// Statistics of timed contests: what analysis/core/timing.py does, line by line, so that a page can rank anew whoever is left.
// A ratio is {value, low, high}; a ranking has the winner and the ratios to it, the fastest first.
"use strict";

function median(values) {
  const sorted = [...values].sort((a, b) => a - b), middle = sorted.length >> 1;
  return sorted.length % 2 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
}

const mean = (values) => values.reduce((sum, one) => sum + one, 0) / values.length;

// Samples of one contest by contender and process. `rows`: [name, process, samples], a process being {environment, number, layout}.
// `beyond`: a variance of a ratio's logarithm that more processes do not lessen, and its degrees of freedom.
class Paired {
  constructor(rows, beyond = [0, 1]) {
    this.beyond = beyond;
    this.logs = new Map();
    this.layouts = new Map(rows.filter(([, process]) => process.layout).map(([, process]) => [process.number, process.layout]));
    this.known = new Map();
    for (const [name, process, samples] of rows) {
      if (!this.logs.has(name)) this.logs.set(name, new Map());
      this.logs.get(name).set(`${process.environment}\n${process.number}`, {...process, logs: samples.map(Math.log)});
    }
  }

  // Time of `first` over that of `second`; NaN where they share no process. Of one layout, or process, there is no interval.
  ratio(first, second) {
    const key = `${first}\n${second}`;
    if (!this.known.has(key)) this.known.set(key, interval(this.byLayout(this.logRatios(first, second)), ...this.beyond));
    return this.known.get(key);
  }

  // Means over the processes of each layout; without layouts each process stands for itself.
  byLayout(logs) {
    const found = new Map();
    for (const [number, value] of logs) {
      const key = this.layouts.get(number) ?? number;
      found.set(key, [...(found.get(key) ?? []), value]);
    }
    return [...found.values()].map(mean);
  }

  // By number of the process.
  logRatios(first, second) {
    const mine = this.logs.get(first) ?? new Map(), other = this.logs.get(second) ?? new Map();
    const direct = new Map([...mine.keys()].filter((key) => other.has(key)).sort()
      .map((key) => [mine.get(key).number, difference(mine.get(key), other.get(key))]));
    if (direct.size || !mine.size || !other.size) return direct;
    const environments = [mine, other].map((one) => one.values().next().value.environment);
    const anchors = this.common(environments, [first, second]);
    const found = new Map();
    if (!anchors) return found;
    for (const one of mine.values()) {
      const keys = environments.map((environment) => `${environment}\n${one.number}`);
      if (keys.every((key, i) => anchors[i].has(key)) && mine.has(keys[0]) && other.has(keys[1]))
        found.set(one.number, difference(mine.get(keys[0]), anchors[0].get(keys[0])) - difference(other.get(keys[1]), anchors[1].get(keys[1])));
    }
    return found;
  }

  // Logs, one in each environment, of a variant that both have: through it the contenders of `pair`, of different environments, are compared.
  // A second instance, which is a control, stands for nobody.
  common(environments, pair) {
    const base = (name) => name.split("+")[0];
    const names = environments.map((environment) => new Map([...this.logs]
      .filter(([name, found]) => !name.endsWith("+twin") && [...found.values()].some((one) => one.environment === environment))
      .map(([name, found]) => [base(name), found])));
    const shared = [...names[0].keys()].filter((name) => names[1].has(name)).sort(), others = shared.filter((name) => !pair.map(base).includes(name));
    const anchor = shared.includes(DATA.anchor) ? DATA.anchor : others[0];
    return anchor ? names.map((one) => one.get(anchor)) : null;
  }

  // Who is fastest among `names`; null if none of them was timed.
  rank(names) {
    const chosen = [...this.logs.keys()].filter((name) => names.has(name));
    if (!chosen.length) return null;
    const toFirst = new Map(chosen.map((name) => [name, this.ratio(name, chosen[0]).value]));
    const order = chosen.filter((name) => !isNaN(toFirst.get(name))).sort((a, b) => toFirst.get(a) - toFirst.get(b));
    const tried = new Set();
    for (let winner = order[0]; ;) {  // they may share other processes with the winner than with the first
      const ratios = order.map((name) => [name, name === winner ? ONE : this.ratio(name, winner)]).map(([name, one]) => [
        name, isNaN(one.value) ? {value: toFirst.get(name) / toFirst.get(winner), low: 0, high: Infinity} : one]);
      tried.add(winner);
      const faster = ratios.filter(([name, one]) => !tried.has(name) && one.value < 1).sort((a, b) => a[1].value - b[1].value)[0];
      if (!faster)
        return ranking(winner, ratios);
      winner = faster[0];
    }
  }
}

const ONE = {value: 1, low: 1, high: 1};

function difference(first, second) {
  const count = Math.min(first.logs.length, second.logs.length);
  return median(Array.from({length: count}, (_, i) => first.logs[i] - second.logs[i]));
}

function interval(logs, more, of) {
  if (!logs.length) return {value: NaN, low: NaN, high: NaN};
  const middle = mean(logs);
  if (logs.length === 1) return {value: Math.exp(middle), low: 0, high: Infinity};
  const spread = Math.sqrt(logs.reduce((sum, one) => sum + (one - middle) ** 2, 0) / (logs.length - 1));
  const own = spread / Math.sqrt(logs.length), error = Math.hypot(own, Math.sqrt(more));
  const freedom = more ? Math.floor(error ** 4 / (own ** 4 / (logs.length - 1) + more ** 2 / of) + 1e-9) : logs.length - 1;
  const half = DATA.quantiles[freedom - 1] * error;
  return {value: Math.exp(middle), low: Math.exp(middle - half), high: Math.exp(middle + half)};
}

function ranking(winner, ratios) {
  const place = ([name, one]) => name === winner ? 0 : one.value > 0 ? one.value : Infinity;
  ratios = [...ratios].sort((a, b) => (a[0] !== winner) - (b[0] !== winner) || place(a) - place(b));
  const others = ratios.filter(([name]) => name !== winner), names = (rows) => rows.map(([name]) => name);
  const open = names(others.filter(([, one]) => one.low <= 1 && one.high > DATA.equivalent));
  return {winner, ratios, second: others.length ? others[0][0] : null, margin: others.length ? others[0][1] : null,
          decided: others.every(([, one]) => one.low > 1), settled: !open.length, open,
          equivalent: [winner, ...names(others.filter(([, one]) => one.high <= DATA.equivalent))]};
}

// Of a contest. On the map leaders have further processes and are compared by these alone (analysis/map/timed.py), and one who
// is alone wins only if nobody failed (analysis/map/cells.py).
function rankContest(contest, names) {
  const able = new Set(contest.able.filter((name) => names.has(name)));
  contest.paired ??= new Paired(contest.rows, contest.beyond);
  contest.again ??= new Paired(contest.rows.filter(([, process]) => process.again), contest.beyond);
  let found = contest.paired.rank(able);
  if (!found) return null;
  const lead = found.ratios.filter(([name]) => contest.again.logs.has(name));
  if (lead.length > 1 && lead[0][0] === found.winner) {
    const first = contest.again.rank(new Set(found.ratios.map(([name]) => name)));
    const known = new Set(first.ratios.map(([name]) => name));
    const others = found.ratios.filter(([name]) => !known.has(name)).map(([name]) => [name, contest.paired.ratio(name, first.winner)]);
    found = ranking(first.winner, [...first.ratios, ...others]);
  }
  const trusted = found.second !== null || !contest.failed.some((name) => names.has(name));
  return {...found, decided: found.decided && trusted, settled: found.settled && trusted};
}

// Of points of error and time (analysis/accuracy/winners.py): each contender counts with its fastest point, one of the rounds
// where it has one there; null if nobody meets the error. `cut`: curves that the budget ended before they met it.
function rankPoints(curve, points, cut = []) {
  const first = new Map(), label = (point) => `${point.name}|${point.setting}|${point.step}`;
  const sorted = [...points].sort((a, b) => a.time - b.time);
  for (const point of sorted) if (point.from === "rounds" && !first.has(point.name)) first.set(point.name, point);
  if (!sorted.length) return null;
  curve.paired ??= new Paired(curve.rounds.filter((one) => one.seconds !== null).map((one) =>
    [label(one.point), {environment: "", number: one.process}, [one.seconds]]));
  const lost = new Set(curve.rounds.filter((one) => !["ok", "dropped"].includes(one.status)).map((one) => label(one.point)));
  const byLabel = new Map(sorted.map((point) => [label(point), point]));
  const found = curve.paired.rank(new Set([...first.values()].map(label).filter((one) => !lost.has(one))));
  const winner = found ? byLabel.get(found.winner) : sorted[0];
  const waiting = cut.some((one) => one.time < winner.time)
    || sorted.some((point) => point.time <= DATA.near * winner.time && !first.has(point.name));
  const ratios = found ? found.ratios.map(([one, ratio]) => [byLabel.get(one), ratio]) : [];
  const pointsOf = (labels) => labels.filter((one) => one !== found.winner).map((one) => byLabel.get(one));
  return {winner, ratios, decided: !!found && found.decided && !waiting, settled: !!found && found.settled && !waiting,
          equivalent: pointsOf(found?.equivalent ?? []), open: pointsOf(found?.open ?? []), candidates: sorted.length};
}

"use strict";
// The kernels of rocking-cli in a browser: structures and motions as they need them, and the answers of `rocking respond`
// and `rocking margin` in their words. What takes long is done by a worker, which runs this same text.

// Numbers as Python prints them: a share in per cent as `names.percent`, and so many digits as in a format "g".
function percent(share) {
  const size = 100 * Math.abs(share);
  if (size < 5e-3) return "0 %";
  if (size >= 99.5 && size < 100) return `${general(Math.min(size, 99.9), 3)} %`;
  return `${size >= 9.95 ? (size + 1e-9).toFixed(0) : general(size, 2)} %`;
}
function general(value, digits) {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "nan" : value > 0 ? "inf" : "-inf";
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e"), power = Number(exponent);
  if (power < -4 || power >= digits) {
    const short = mantissa.includes(".") ? mantissa.replace(/\.?0+$/, "") : mantissa;
    return `${short}e${power < 0 ? "-" : "+"}${String(Math.abs(power)).padStart(2, "0")}`;
  }
  const fixedText = value.toFixed(Math.max(0, digits - 1 - power));
  return fixedText.includes(".") ? fixedText.replace(/\.?0+$/, "") : fixedText;
}

async function inflated(text) {
  const bytes = Uint8Array.from(atob(text), each => each.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
// An array that `packing.py` has packed: its shape, and its numbers.
async function unpacked({shape, cells, kind, how, steps, data}) {
  const planes = await inflated(data), n = planes.length / 8, bytes = new Uint8Array(planes.length);
  for (let plane = 0; plane < 8; plane++) for (let k = 0; k < n; k++) bytes[8 * k + plane] = planes[plane * n + k];
  const columns = new BigInt64Array(bytes.buffer);
  if (how === "plain") return {shape, values: kind === "whole" ? columns : new Float64Array(bytes.buffer)};
  const wide = n / cells, powers = how === "smooth" ? 1 : 4;
  for (let column = 0; column < wide; column++) if (how !== "cubics" || column % 4 < 2)
    for (let order = 0; order < 3; order++)
      for (let k = 1, at = column * cells + 1; k < cells; k++, at++) columns[at] += columns[at - 1];
  if (how === "grid") {
    const values = new Float64Array(n);
    for (let column = 0; column < wide; column++) {
      const step = steps[(column % (wide / 2)) / powers | 0];
      for (let k = 0; k < cells; k++) values[k * wide + column] = Number(columns[column * cells + k]) * step;
    }
    return {shape, values};
  }
  for (let at = (wide / 2) * cells; at < n; at++) columns[at] += columns[at - (wide / 2) * cells];
  const real = new Float64Array(columns.buffer), one = new Float64Array(1), bits = new BigInt64Array(one.buffer);
  if (how === "cubics") for (let column = 0; column < wide; column += 4)
    for (let k = 0; k < cells; k++) {
      const at = power => (column + power) * cells + k, last = k === cells - 1;
      const v0 = real[at(0)], d0 = real[at(1)], v1 = last ? 0 : real[at(0) + 1], d1 = last ? 0 : real[at(1) + 1];
      one[0] = 3 * (v1 - v0) - 2 * d0 - d1;
      columns[at(2)] += bits[0];
      one[0] = 2 * (v0 - v1) + d0 + d1;
      columns[at(3)] += bits[0];
    }
  const values = new Float64Array(n);
  for (let column = 0; column < wide; column++)
    for (let k = 0; k < cells; k++) values[k * wide + column] = real[column * cells + k];
  return {shape, values};
}
// The same for all that is packed in plain data.
async function whole(data) {
  if (data === null || typeof data !== "object") return data;
  if (typeof data.data === "string") return unpacked(data);
  const values = await Promise.all(Object.values(data).map(whole));
  return Array.isArray(data) ? values : Object.fromEntries(Object.keys(data).map((key, k) => [key, values[k]]));
}

// Columns of `marks` and of `runs`, as in kernels.py, stepping.py and openings.py.
const MARKS = 26, RUN_COLUMNS = 10, BLOCK = 32, COLUMNS = 19, KEPT = 20, NOTES = 6;
const PEAK = 0, CROSSED = 2, FIRST_UPLIFT = 3, IMPACTS = 4, ENDED = 5, SIDE = 6, STATUS = 7, PASSED = 8, REASON = 9;
const WHERE = 10, PASSED_PEAK = 11, PASSED_IMPACTS = 13, WARNED = 14, WARNED_PEAK = 16;
const OVERTURNED = 1, STILL_ROCKING = 2, STALLED = 3, BOUND_REASON = 5;

// The memory of the compiled kernels, and calls of them.
class Compiled {
  constructor(module) {
    const env = {};
    for (const {name} of WebAssembly.Module.imports(module)) env[name] = Math[name.replace("call_", "")];
    this.exports = new WebAssembly.Instance(module, {env}).exports;
    this.end = this.exports.memory.buffer.byteLength;
  }
  room(bytes) {
    const at = this.end;
    this.end += Math.ceil(bytes / 16) * 16;
    const missing = this.end - this.exports.memory.buffer.byteLength;
    if (missing > 0) this.exports.memory.grow(Math.ceil(missing / 65536));
    return at;
  }
  // An array in the memory, with what it holds; its place does not change.
  array(values, shape) {
    const at = this.room(8 * values.length);
    new values.constructor(this.exports.memory.buffer, at, values.length).set(values);
    return {at, shape};
  }
  reals(shape) { return {at: this.room(8 * shape.reduce((a, b) => a * b, 1)), shape}; }
  view({at, shape}) { return new Float64Array(this.exports.memory.buffer, at, shape.reduce((a, b) => a * b, 1)); }
  call(entry, values) {
    const wholes = [], reals = [], places = [];
    for (const each of values) {
      if (each.shape) { places.push(each.at); wholes.push(...each.shape); }
      else if ("real" in each) reals.push(each.real);
      else wholes.push(each.whole);
    }
    const big = list => this.array(BigInt64Array.from(list, BigInt), [list.length]).at, before = this.end;
    const status = this.exports[entry](big(wholes), this.array(Float64Array.from(reals), [reals.length]).at, big(places));
    this.end = before;
    if (status) throw new Error(`the kernel ended with status ${status}`);
  }
}

// One structure in the memory: answers about any number of runs under one motion.
class Kernel {
  constructor(module, model, options) {
    this.compiled = new Compiled(module);
    this.model = model;
    this.options = options;
    const put = ({values, shape}) => this.compiled.array(values, shape), {deck, joints} = model;
    this.tables = ["structures", "numbers", "forces", "smooth", "angles", "certain", "held", "corners"]
      .map(key => put(deck[key]));
    this.joints = ["sizes", "contacts", "bearing", "rows", "struck", "stopped", "within", "rest", "numbers"]
      .map(key => put(joints[key]));
    const count = Number(joints.sizes.values[1]);
    this.memory = [[2, COLUMNS], [count, KEPT], [NOTES]].map(shape => this.compiled.reals(shape));
    this.memory.push(this.compiled.array(new BigInt64Array(4 * count), [4 * count]));
    this.aside = this.compiled.reals([MARKS]);
    this.start = this.compiled.end;
  }
  // The marks of runs [{factor, size, slender, restitution}] under a motion {u, dt}; with `samples`, those of the last.
  run(motion, runs, mostImpacts, samples = null) {
    const {compiled} = this, u = motion.u;
    compiled.end = this.start;
    const ahead = new Float64Array(u.length);
    for (let k = u.length - 2, most = Math.abs(u[u.length - 1]); k >= 0; k--) ahead[k] = most = Math.max(most, Math.abs(u[k]));
    const blocks = new Float64Array(Math.ceil(u.length / BLOCK));
    for (let k = 0; k < u.length; k++) {
      const block = k / BLOCK | 0, size = Math.abs(u[k]);
      blocks[block] = Math.max(blocks[block], size);
      if (k % BLOCK === 0 && block) blocks[block - 1] = Math.max(blocks[block - 1], size);
    }
    const row = values => compiled.array(values, [values.length]), none = {at: 0, shape: [0]};
    const record = [0, u.length, 0, 0, 0, u.length, 0, blocks.length, motion.dt, 1];
    const rows = new Float64Array(runs.length * RUN_COLUMNS);
    runs.forEach(({factor, size = 1, slender = 1, restitution = [NaN, NaN]}, k) =>
      rows.set([0, 0, factor, Math.abs(factor), size, ...restitution, 0, slender, 0], k * RUN_COLUMNS));
    const marks = compiled.reals([runs.length, MARKS]);
    compiled.view(marks).fill(NaN);
    const kept = samples ? [samples.count, samples.count, 3 * samples.impacts].map(n => compiled.reals([n])) : null;
    if (kept) kept[2].shape = [samples.impacts, 3];
    const places = [
      {whole: 0}, {whole: runs.length}, compiled.array(rows, [runs.length, RUN_COLUMNS]), ...this.tables,
      compiled.array(Float64Array.from(record), [1, record.length]), row(u), none, row(ahead), row(blocks), none, none,
      ...this.joints, {real: this.options.rtol}, {whole: mostImpacts}, {whole: samples ? 0 : 1},
      {whole: samples ? samples.every : 1}, ...(kept ?? [none, none, {at: 0, shape: [0, 3]}]), this.aside, marks, ...this.memory,
    ];
    compiled.call("rocking_histories", places);
    const found = compiled.view(marks), each = runs.map((_, k) => this.outcome(found.slice(k * MARKS, (k + 1) * MARKS)));
    return samples ? {...each[0], phi: compiled.view(kept[0]).slice(), impacts: compiled.view(kept[2]).slice()} : each;
  }
  // The outcome of a run from its marks, as `read_marks` has it.
  outcome(marks) {
    const {phiCr} = this.model, status = marks[STATUS], passed = marks[PASSED], crossed = marks[CROSSED];
    const overturned = status === OVERTURNED && !(passed < (Number.isNaN(crossed) ? Infinity : crossed));
    const failed = status === STALLED || Number.isNaN(status), unknown = Number.isFinite(passed) && !overturned && !failed;
    const peaks = [0, 1].map(d => marks[(unknown ? PASSED_PEAK : PEAK) + d]), ratio = Math.max(peaks[0] / phiCr[0], peaks[1] / phiCr[1]);
    const until = unknown ? passed : overturned && !Number.isNaN(crossed) ? crossed : Infinity, uplift = marks[FIRST_UPLIFT];
    const warned = marks[WARNED] <= until ? marks[WARNED] : NaN;
    const bound = Math.max(marks[WARNED_PEAK] / phiCr[0], marks[WARNED_PEAK + 1] / phiCr[1]);
    return {
      unknown, failed, overturned, status, peak_ratio: overturned ? NaN : ratio, fell_to: overturned ? 1 - 2 * marks[SIDE] : 0,
      overturning_time: overturned ? crossed : NaN, uplift_time: unknown && uplift > passed ? NaN : uplift, warned,
      impact_count: (unknown ? marks[PASSED_IMPACTS] : marks[IMPACTS]) || 0, known_to: unknown ? passed : NaN,
      lower_bound: Number.isNaN(warned) ? (unknown ? ratio : NaN) : bound, ended: marks[ENDED], side: marks[SIDE],
      reason: marks[REASON], where: marks[WHERE],
    };
  }
}

// A normal quantile [Wichura, Algorithm AS 241, Appl. Stat. 37, 1988], as Python has it.
function quantile(p) {
  const over = (r, above, below) => above.reduce((sum, c) => sum * r + c) / below.reduce((sum, c) => sum * r + c);
  const q = p - 0.5;
  if (Math.abs(q) <= 0.425) return q * over(0.180625 - q * q,
    [2.5090809287301226727e3, 3.3430575583588128105e4, 6.7265770927008700853e4, 4.5921953931549871457e4,
      1.3731693765509461125e4, 1.9715909503065514427e3, 1.3314166789178437745e2, 3.3871328727963666080e0],
    [5.2264952788528545610e3, 2.8729085735721942674e4, 3.9307895800092710610e4, 2.1213794301586595867e4,
      5.3941960214247511077e3, 6.8718700749205790830e2, 4.2313330701600911252e1, 1.0]);
  const r = Math.sqrt(-Math.log(q <= 0 ? p : 1 - p));
  const x = r <= 5 ? over(r - 1.6,
    [7.74545014278341407640e-4, 2.27238449892691845833e-2, 2.41780725177450611770e-1, 1.27045825245236838258e0,
      3.64784832476320460504e0, 5.76949722146069140550e0, 4.63033784615654529590e0, 1.42343711074968357734e0],
    [1.05075007164441684324e-9, 5.47593808499534494600e-4, 1.51986665636164571966e-2, 1.48103976427480074590e-1,
      6.89767334985100004550e-1, 1.67638483018380384940e0, 2.05319162663775882187e0, 1.0])
    : over(r - 5,
    [2.01033439929228813265e-7, 2.71155556874348757815e-5, 1.24266094738807843860e-3, 2.65321895265761230930e-2,
      2.96560571828504891230e-1, 1.78482653991729133580e0, 5.46378491116411436990e0, 6.65790464350110377720e0],
    [2.04426310338993978564e-15, 1.42151175831644588870e-7, 1.84631831751005468180e-5, 7.86869131145613259100e-4,
      1.48753612908506148525e-2, 1.36929880922735805310e-1, 5.99832206555887937690e-1, 1.0]);
  return q < 0 ? -x : x;
}

// The probability of normal numbers below one: where the quantile is that number.
function below(number) {
  let low = 0, high = 1;
  for (let round = 0; round < 60; round++) {
    const middle = (low + high) / 2;
    if (quantile(middle) < number) low = middle; else high = middle;
  }
  return high;
}

// Answers about all structures of a page, in the page or in its worker.
class Answers {
  constructor(module, data) {
    this.module = module;
    this.data = data;
    this.kernels = new Map();
  }
  // A structure with the value of its field that settings choose, and its kernel.
  variant({structure, value}) { return variantOf(this.data, structure, value); }
  kernel(settings, model = this.variant(settings).model) {
    if (!this.kernels.has(model)) this.kernels.set(model, new Kernel(this.module, model, this.data));
    return this.kernels.get(model);
  }
  // The motion of settings, scaled: acceleration [m/s2], interval [s], and of how many samples one is kept.
  motion({motion, scale, polarity, time, amplitude, period}) {
    if (motion === "record") {
      const {u, dt, every, factor: given} = this.data.motion, factor = polarity * (scale * given);
      return {u: u.values.map(each => each * factor), dt: dt * time, every};
    }
    const {u, dt, every} = this.data.pulses[motion], factor = polarity * (amplitude * this.data.g);
    return {u: u.values.map(each => each * factor), dt: dt * period, every};
  }
  conditions({restitution, size, slender}) {
    return {factor: 1 / slender, size, slender, restitution: restitution === null ? [NaN, NaN] : [restitution, restitution]};
  }
  // Whether a body is so stocky that it does not rock, and whether it slides under accelerations up to the strongest.
  stays({model: {slidesFrom}}, slender) { return slidesFrom !== null && slender > slidesFrom; }
  slides({model: {slidesAt}}, strongest) { return strongest > slidesAt; }
  history(settings) {
    const {data} = this, structure = this.variant(settings), motion = this.motion(settings), {every} = motion;
    const dt = every * motion.dt, npts = Math.floor((motion.u.length - 1) / every) + 1;
    const count = Math.max(npts, 1) + roundHalfEven(data.tail / dt), stays = this.stays(structure, settings.slender);
    const kernel = this.kernel(settings), impacts = data.mostImpacts, {phiCr} = structure.model;
    const run = kernel.run(motion, [this.conditions(settings)], data.mostImpacts, {every, count, impacts});
    const end = run.unknown ? Math.min(run.ended, run.known_to) : run.ended;
    const kept = Math.min(count, Math.max(npts, Math.trunc(end / dt) + (run.status === STILL_ROCKING ? 1 : 3)));
    const phi = run.phi.slice(0, kept);
    for (let k = 0; k < kept; k++) if (stays) phi[k] = 0; else if (run.unknown && k * dt > run.known_to) phi[k] = NaN;
    const ratio = phi.map(each => each / (each < 0 ? phiCr[1] : phiCr[0]));
    for (let k = 0; k < kept; k++) phi[k] *= settings.slender;
    const kind = stays ? (this.slides(structure, strongestOf(motion.u)) ? "slides" : "rests") : run.failed ? "failed" : run.unknown ? "unknown" : run.overturned ? "overturns"
      : run.peak_ratio > 0 ? "rocks" : "rests";
    const still = {peak_ratio: 0, impact_count: 0, uplift_time: NaN, known_to: NaN, overturning_time: NaN, unknown: false};
    const outcome = {...run, kind, felt: feltOf(run), ...(stays ? still : {})}, beside = {};
    delete outcome.phi;
    for (const [name, model] of Object.entries(stays || run.unknown ? {} : structure.linear)) {
      const other = this.kernel(settings, model).run(motion, [this.conditions(settings)], data.mostImpacts, {every, count, impacts: 0});
      beside[name] = other.phi.slice(0, kept).map(each => each / (each < 0 ? model.phiCr[1] : model.phiCr[0]));
    }
    const stage = settings.value !== null && settings.size === 1 && settings.slender === 1 ? structure.stage : undefined;
    return {stage, dt, phi, ratio, beside, ground: motion.u.map(each => each / data.g), groundDt: motion.dt, end: (kept - 1) * dt, outcome,
      headline: headline(outcome, structure), sentences: sentences(outcome, structure)};
  }
  // The neighbours of a structure in settings: factors on amplitude and slenderness, and restitutions.
  drawn(settings) {
    const {neighbours, model: {mostRestitution}} = this.variant(settings), {restitution} = settings;
    const {slender, restitution: usual, spread} = neighbours, {amplitude, uniform, leastRestitution} = this.data;
    const shares = mostRestitution.map(most => spread && restitution !== null ? below((most - restitution) / spread) : 1);
    return Array.from(amplitude.values, (factor, k) => ({
      factor, slender: slender.values[k],
      restitution: [0, 1].map(d => restitution === null ? usual.values[2 * k + d] : spread === 0 ? restitution
        : clampTo(restitution + spread * quantile(Math.max(uniform.values[k] * shares[d], 1e-300)), leastRestitution, mostRestitution[d])),
    }));
  }
  // Outcomes of runs near a motion, in parts, between which others get their turn; null once they are superseded.
  async near(settings, motion, runs, progress, current) {
    const structure = this.variant(settings), kernel = this.kernel(settings), found = [], strongest = strongestOf(motion.u);
    for (let first = 0; first < runs.length;) {
      const part = runs.slice(first, first + 25).map(each => ({...each, stands: each.slender > 0}));
      const rows = part.map(({factor, slender, stands, restitution, size}) =>
        ({factor: factor / (stands ? slender : 1), slender: stands ? slender : 1, restitution, size}));
      const outcomes = kernel.run(motion, rows, this.data.decisiveImpacts);
      outcomes.forEach((each, k) => {
        const stays = this.stays(structure, rows[k].slender), slides = stays && this.slides(structure, strongest * part[k].factor);
        found.push(!part[k].stands ? {overturned: true, unknown: false, peak_ratio: NaN, impact_count: 0}
          : stays ? {overturned: false, unknown: false, slides, peak_ratio: 0, impact_count: 0} : each);
      });
      first += part.length;
      progress(first / runs.length, found);
      await new Promise(resolve => setTimeout(resolve));
      if (!current()) return null;
    }
    return found;
  }
  async neighbours(settings, progress, current) {
    const structure = this.variant(settings), motion = this.motion(settings), {slender, size} = settings;
    const drawn = this.drawn(settings), itself = {factor: 1, slender, size, restitution: this.conditions(settings).restitution};
    const runs = [itself, ...drawn.map(each => ({...each, slender: each.slender * slender, size}))];
    const summary = found => {
      const others = found.slice(1), share = test => others.length ? others.filter(test).length / others.length : 0;
      const kind = each => each.unknown ? 2 : each.overturned ? 1 : 0;
      return {count: drawn.length, overturned: share(each => each.overturned), unknown: share(each => each.unknown),
        as_itself: share(each => kind(each) === kind(found[0])), sentence: ""};
    };
    const found = await this.near(settings, motion, runs, (done, so) => progress(done, summary(so)), current);
    return found && {...summary(found), sentence: neighboursInWords(found.slice(1), structure, settings)};
  }
  async margin(settings, progress, current) {
    const {leastShare} = this.data, factors = [...this.data.factors.filter(each => Math.abs(each - 1) > 1e-9), 1].sort((a, b) => a - b);
    const motion = this.motion({...settings, scale: 1}), {slender, size} = settings, drawn = this.drawn(settings);
    const runs = factors.flatMap(scale => drawn.map(each => ({...each, factor: scale * each.factor, slender: each.slender * slender, size})));
    const summary = found => {
      const share = test => factors.map((_, k) => {
        const mine = found.slice(k * drawn.length, (k + 1) * drawn.length);
        return mine.length < drawn.length ? null : mine.filter(test).length / drawn.length;
      });
      return {factors, overturned: share(each => each.overturned), unknown: share(each => each.unknown), sentence: ""};
    };
    const found = await this.near(settings, motion, runs, (done, so) => progress(done, summary(so)), current);
    if (!found) return null;
    const result = summary(found), first = factors.find((_, k) => result.overturned[k] + result.unknown[k] >= leastShare);
    const some = `${percent(leastShare)} or more`;
    result.sentence = first === undefined ? `At no factor tried may ${some} overturn.`
      : `Of ${factors.length} factors tried, the smallest at which ${some} may overturn is ${general(first, 3)}.`;
    return result;
  }
  async map(settings, progress, current) {
    const shape = settings.motion === "record" ? "sine" : settings.motion, N = 20;
    const axes = this.data.structures[settings.structure].axes[shape];
    if (!axes) throw new Error("No map: no single block is equivalent to this structure.");
    const {periods: [fast, slow], amplitudes: [low, high]} = axes;
    const at = (from, to, k) => Number((from * (to / from) ** (k / (N - 1))).toPrecision(4)), stretch = Math.sqrt(settings.size);
    const periods = Array.from({length: N}, (_, k) => at(fast * stretch, slow * stretch, k));
    const amplitudes = Array.from({length: N}, (_, k) => at(low, high, k)), classes = new Uint8Array(N * N).fill(255);
    const result = {shape, periods, amplitudes, classes};
    for (let column = 0; column < N; column++) {
      const motion = this.motion({...settings, motion: shape, amplitude: 1 / this.data.g, period: periods[column]});
      const runs = amplitudes.map(each => ({...this.conditions(settings), factor: each * this.data.g}));
      const found = await this.near(settings, motion, runs, () => {}, current);
      if (!found) return null;
      found.forEach((each, k) => classes[k * N + column] = each.overturned ? (each.impact_count ? 2 : 3)
        : each.unknown ? 4 : each.peak_ratio > 0 ? 1 : 0);
      progress((column + 1) / N, {...result, classes: classes.slice()});
    }
    return result;
  }
}
const strongestOf = u => u.reduce((most, each) => Math.max(most, Math.abs(each)), 0);
// How many impacts are not the chatter before rest, as `History.felt` counts them.
function feltOf({impacts, impact_count}) {
  const rates = Array.from({length: Math.min(impact_count, impacts.length / 3)}, (_, k) => impacts[3 * k + 2]);
  const most = Math.max(0, ...rates);
  return rates.filter(rate => rate >= 0.02 * most).length;
}
function variantOf(data, structure, value) {
  const {vary, variants} = data.structures[structure];
  return variants[value ?? vary?.usual ?? 0];
}
const clampTo = (value, low, high) => Math.min(Math.max(value, low), high);
function roundHalfEven(value) {
  const low = Math.floor(value), part = value - low;
  return part === 0.5 ? low + (low % 2) : Math.round(value);
}

// The words of an outcome, as views/conclusion.py, views/verdict.py and views/neighbours.py have them.
function headline(outcome, {over}) {
  return {
    unknown: `unknown after ${general(outcome.known_to, 4)} s`, overturns: "overturns", slides: "slides and does not rock",
    failed: "could not be simulated", rests: "does not uplift",
  }[outcome.kind] ?? `rocks to ${general(outcome.peak_ratio, 3)} ${over}`;
}
function sentences(outcome, {model}) {
  const at = model.atLimit.some(Boolean) ? "its kinematic limit" : "its critical rotation", told = [];
  const small = (value, unit) => value >= 0.5 ? `${general(value, 3)} ${unit}` : `${general(1000 * value, 3)} m${unit}`;
  if (outcome.kind === "slides") told.push("How far it slides, and whether it reaches an edge, `rocking respond` computes.");
  const impacts = `${outcome.felt} impact${outcome.felt === 1 ? "" : "s"}`, way = outcome.fell_to > 0 ? "clockwise" : "anticlockwise";
  if (outcome.kind === "overturns")
    told.push(`It passes ${at} for good, ${way}, at ${general(outcome.overturning_time, 4)} s, after ${impacts}.`);
  if (outcome.kind === "rocks" && outcome.uplift_time >= 0)
    told.push(`First uplift at ${general(outcome.uplift_time, 4)} s; ${impacts} without the chatter before rest.`);
  if (outcome.kind === "rocks" && outcome.peak_ratio > 1) told.push(`It exceeds ${at} and is brought back.`);
  if (outcome.kind === "unknown") {
    let why = "nothing holds the structure down, as v_g'' comes down to -g";
    const label = model.labels[outcome.where], does = model.sliding.includes(outcome.where) ? "has slid by" : "has opened by";
    if (outcome.reason === BOUND_REASON) why = model.bounds[outcome.side];
    else if (outcome.reason === 2) why = `the joint between ${label} crushes: its normal force exceeds its strength`;
    else if (outcome.reason < 2) why = `the joint between ${label} ${outcome.reason === 1 ? "has slid by" : does} `
      + `${small(model.limit * model.reach, "m")} (${percent(model.limit)} of D_cr = ${general(model.reach, 3)} m, by which the farthest `
      + "block moves up to phi_cr)";
    told.push(`The outcome is unknown after ${general(outcome.known_to, 4)} s: then ${why}. The structure may overturn.`);
    told.push(outcome.peak_ratio > 0 ? `A lower bound of the peak is ${general(outcome.lower_bound, 4)} of ${at}.`
      : "Until then it does not uplift.");
  }
  return told;
}
function neighboursInWords(found, {over, neighbours}, {restitution}) {
  const count = found.length, how = restitution === null ? neighbours.deviations : neighbours.deviationsGiven;
  const number = test => found.filter(test).length, some = n => `${n} (${percent(n / count)})`;
  const fell = number(each => each.overturned), unknown = number(each => each.unknown), slides = number(each => each.slides);
  let shares = fell === 0 ? (unknown ? "none is known to overturn the structure" : "none overturns the structure")
    : fell === count ? "all overturn the structure" : `${some(fell)} ${fell === 1 ? "overturns" : "overturn"} the structure`;
  if (unknown) shares += `, and the outcome under ${unknown === count ? "all" : some(unknown)} is unknown`;
  if (found.every(each => !each.overturned && !each.unknown && !each.slides && each.peak_ratio === 0))
    return `None of ${count} neighbouring motions uplifts the structure (${how}).`;
  const told = [`Of ${count} neighbouring motions, ${shares}`];
  if (slides) told.push(`${some(slides)} only ${slides === 1 ? "slides" : "slide"}`);
  const peaks = found.map(each => each.overturned || each.unknown ? Infinity : each.peak_ratio).sort((a, b) => a - b);
  const [low, median, high] = [0.16, 0.5, 0.84].map(share => peaks[Math.max(0, Math.ceil(share * count - 1e-9) - 1)]);
  if (high === 0 && !slides) return `${told[0]}; at most one in six uplifts it (${how}).`;
  const enough = count >= 20;  // with fewer, one or two neighbours decide
  if (slides && slides + unknown === count) return `${told.join("; ")} (${how}).`;
  if (median === 0 || (low === 0 && enough)) told.push(`${median === 0 ? "half" : "16 %"} do not uplift it`);
  if (median > 0 && median < Infinity) told.push(`the median peak is ${general(median, 2)} ${over}`);
  const [part, others, most] = high < Infinity ? ["84 %", "16 %", high] : ["16 %", "84 %", median === Infinity ? low : 0];
  if (enough && most > 0 && most <= 1) told.push(`${part} stay below ${general(most, 2)} ${over}`);
  else if (enough && most > 1 && most < Infinity)
    told.push(`${others} pass the critical rotation (${general(most, 2)} ${over}) or ${unknown ? "overturn or are unknown" : "overturn"}`);
  return `${told.join("; ")} (${how}).`;
}

// The structure file of a size: what grows with it, and by which power, the files of two sizes tell.
function resized([one, two], size) {
  if (size === 1) return one;
  if (two === null) return null;
  const number = /(?<![\w.])-?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.])/g, other = two.match(number) ?? [];
  if (one.replace(number, "") !== two.replace(number, "")) return null;
  return one.replace(number, text => {
    const [a, b] = [Number(text), Number(other.shift())];
    return a === b || !a ? text : String(a * size ** Math.round(Math.log2(b / a)));
  });
}

// The engine of the page. Its worker gets the questions that take long; a newer one of a kind supersedes the one before.
async function startEngine(data) {
  if (typeof DecompressionStream === "undefined" || typeof WebAssembly === "undefined")
    throw new Error("This browser cannot run the page: Chrome 80, Edge 80, Firefox 113 and Safari 16.4, or newer, can.");
  const module = await WebAssembly.compile(await inflated(data.kernel)), packed = {...data, kernel: null};
  const text = document.getElementById("kernel").textContent;
  const worker = new Worker(URL.createObjectURL(new Blob([text, "\nserve();"], {type: "text/javascript"})));
  worker.postMessage({module, data: packed});
  // First what the page begins with; tables of other values of a field follow.
  const usualOf = ({vary}) => vary?.usual ?? 0;
  const begun = packed.structures.map(each => ({...each, variants: each.variants.map((one, k) => k === usualOf(each) ? one : null)}));
  const ready = await whole({...packed, structures: begun}), answers = new Answers(module, ready);
  const all = Promise.all(packed.structures.map(async ({variants}, k) => {
    const mine = ready.structures[k];
    for (let at = 0; at < variants.length; at++) mine.variants[at] ??= await whole(variants[at]);
  }));
  const asked = new Map();
  let last = 0;
  worker.onmessage = ({data: {id, share, partial, result, error}}) => {
    const {progress, resolve, reject} = asked.get(id);
    if (share !== undefined) return progress(share, partial);
    asked.delete(id);
    if (error) reject(new Error(error)); else resolve(result);
  };
  const ask = kind => (settings, progress = () => {}) => new Promise((resolve, reject) => {
    asked.set(++last, {progress, resolve, reject});
    worker.postMessage({id: last, kind, settings});
  });
  return {
    structures: ready.structures.map(({name, vary, notes}, k) => {
      const {stage, over, model} = variantOf(ready, k, null), [one, other] = model.restitution;
      return {name, stage, vary, notes, restitution: model.restitution, over: over === "phi_cr" ? "φ/φcr" : `φ ${over}`,
        eta: one === other ? one : null, etaMost: Math.min(model.oneSided ? 0.99 : 1, ...model.mostRestitution),
        reference: {positive: model.phiCr[0], negative: model.phiCr[1]}};
    }),
    motion: {name: ready.motion.name},
    shapes: Object.entries(ready.pulses).map(([key, {label}]) => ({key, label})),
    all,
    history: settings => answers.history(settings),
    neighbours: ask("neighbours"), margin: ask("margin"), map: ask("map"),
    yaml: settings => settings.slender !== 1 ? null : resized(variantOf(ready, settings.structure, settings.value).yaml, settings.size),
    command: settings => commandOf(settings, ready),
    csv: settings => csvOf(answers.history(settings)),
  };
}
// The name of a file that the page saves of a structure; one that is not as given has another.
function fileOf({name, vary}, {size, value}) {
  const changed = [...(size === 1 ? [] : [`size_${general(size, 4)}`]), ...(value === null ? [] : [general(vary.values[value], 4)])];
  return [name.replace(/[^\p{L}\p{N}_-]+/gu, "_").slice(0, 60) || "structure", ...changed].join("_");
}
function commandOf({structure, motion, scale, polarity, time, amplitude, period, restitution, size, slender, value}, data) {
  const texts = variantOf(data, structure, value).yaml;
  const why = resized(texts, size) === null ? "No file describes this structure in another size: reset it."
    : slender !== 1 ? "No command has this width over height: reset it."
    : motion === "record" && time !== 1 ? "No command has this time scale: reset it."
    : motion === "record" && !data.command ? "The motion has no file that a command could read." : "";
  const given = data.structures[structure], end = fileOf(given, {size, value});
  const file = given.file && size === 1 && value === null ? given.file : `${end}.yaml`;
  const safe = file.startsWith("-") ? `./${file}` : file;
  const quoted = /^[\w./-]+$/.test(safe) ? safe : `'${safe.replaceAll("'", "'\\''")}'`;
  const factor = polarity * scale * data.motion.factor, scaled = Math.abs(factor) === 1 ? [] : [`--scale ${Math.abs(factor)}`];
  const words = motion === "record" ? [data.command, ...scaled] : [`--pulse ${motion}:${amplitude}g:${period}s`];
  if ((motion === "record" ? factor : polarity) < 0) words.push("--polarity -1");
  const eta = restitution ?? given.options.restitution, {opening} = given.options;
  if (eta !== null) words.push(`--restitution ${eta}`);
  if (opening !== null) words.push(`--opening ${opening}`);
  return {command: why ? null : ["rocking respond", quoted, ...words, "--engine exact"].join(" "), why};
}
function csvOf({dt, phi, ratio}) {
  return ["t [s],phi [rad],phi over phi_cr", ...Array.from(phi, (each, k) => `${k * dt},${Number.isNaN(each) ? "" : each},${
    Number.isNaN(ratio[k]) ? "" : ratio[k]}`)].join("\n") + "\n";
}
// Times of a history, of the neighbours and of a map on this machine, warm [ms].
async function benchmark(engine) {
  const times = {}, settings = {structure: 0, motion: "record", scale: 1, polarity: 1, time: 1, amplitude: 1, period: 1,
    restitution: null, size: 1, slender: 1, value: null};
  for (const kind of ["history", "neighbours", "map"]) for (let round = 0; round < 3; round++) {
    const start = performance.now();
    await engine[kind](settings);
    times[kind] = Math.min(times[kind] ?? Infinity, performance.now() - start);
  }
  return times;
}
// What the worker does: one question at a time, the newest of each kind.
function serve() {
  let ready;
  const newest = {};
  onmessage = async ({data: {module, data, id, kind, settings}}) => {
    if (module) { ready = whole(data).then(unpackedData => new Answers(module, unpackedData)); return; }
    newest[kind] = id;
    const answers = await ready;
    try {
      const current = () => newest[kind] === id;
      const result = await answers[kind](settings, (share, partial) => postMessage({id, share, partial}), current);
      postMessage({id, result});
    } catch (error) {
      postMessage({id, error: error.message});
    }
  };
}
if (typeof module !== "undefined") module.exports = {Answers, whole, inflated, resized, percent, general, quantile};

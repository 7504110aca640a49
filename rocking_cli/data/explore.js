// The page of `rocking explore`: controls of a ground motion and of structures, and what the structures do under it.

const byId = id => document.getElementById(id);
const inShort = (value, digits = 4) => String(Number(value.toPrecision(digits)));
const LEAST_ENLARGED = 2 * Math.PI / 180, MOST_ENLARGED = 5 * Math.PI / 180;  // as in `rocking animate`
const REST = 300, LONG_REST = 600;  // [ms] without a change, until what takes some time and what takes longer start
const CLASSES = [["none", "no uplift"], ["rocks", "rocks"], ["after", "overturns after impacts"],
                 ["at-once", "overturns without an impact"], ["unknown", "unknown"]], UNKNOWN = CLASSES[4][0];

// How the steps of a slider give values: by equal factors, by equal differences, or one by one from a list.
const byFactors = (least, most, steps) => ({least, most, steps,
  at: k => Number((least * (most / least) ** (k / steps)).toPrecision(3)),
  place: value => steps * Math.log(value / least) / Math.log(most / least)});
const evenly = (least, most, steps) => ({least, most, steps,
  at: k => Number((least + (most - least) * k / steps).toPrecision(3)),
  place: value => steps * (value - least) / (most - least)});
const among = values => ({least: values[0], most: values.at(-1), steps: values.length - 1,
  at: k => values[k], place: value => nearest(values, value)});

// A row of the controls: a name, a note if it is changed, and a reset. `fill` adds the control, and returns what shows its value.
function settingRow(parent, given, fill) {
  const {id, label, reset, changed, note = () => "changed"} = given, row = element(parent, "div", {class: "row"});
  const name = element(row, "span", {class: "name"});
  element(name, "label", {for: id}, label);
  const mark = element(name, "span", {class: "changed"}), show = fill(row, given);
  if (reset) element(row, "button", {type: "button", "aria-label": `Reset ${label}`}, "Reset").addEventListener("click", reset);
  return {row, refresh() { show(); mark.textContent = changed() ? ` ${note()}` : ""; }};
}
// A slider with a number beside it. `shown` gives its value, or null where that of the structure is not a number.
function fillSlider(row, {id, label, range, shown, take, reset}) {
  const slider = element(row, "input", {type: "range", min: 0, max: range.steps, step: 1, "aria-label": `${label}, slider`});
  const number = element(row, "input", {type: "text", inputmode: "decimal", id, autocomplete: "off"});
  const valueOf = () => number.value.trim() === "" ? NaN : Number(number.value.replace(",", "."));
  const wrong = element(row, "span", {class: "wrong", role: "alert"});
  const text = () => shown() === null ? "" : inShort(shown());
  slider.addEventListener("input", () => take(range.at(slider.valueAsNumber)));
  number.addEventListener("input", () => {
    const value = valueOf(), valid = value >= range.least && value <= range.most;
    number.setAttribute("aria-invalid", number.value.trim() !== "" && !valid);
    wrong.textContent = number.value.trim() === "" || valid ? "" : `a number from ${inShort(range.least)} to ${inShort(range.most)}`;
    if (valid) take(value);
  });
  number.addEventListener("change", () => {
    if (number.value.trim() === "") reset();
    number.value = text();
    number.setAttribute("aria-invalid", false);
  });
  return () => {
    slider.value = range.place(shown() ?? range.middle);
    slider.setAttribute("aria-valuetext", text() || range.asGiven);
    number.placeholder = range.asGiven ? "as given" : "";
    if (document.activeElement !== number) { number.value = text(); wrong.textContent = ""; }  // what is typed is left as it is
  };
}
function fillList(row, {id, choices, shown, take}) {
  const select = element(row, "select", {id});
  for (const [value, text] of choices) element(select, "option", {value}, short(text));
  select.addEventListener("change", () => take(select.value));
  return () => { select.value = shown(); };
}
function fillRadios(row, {id, label, choices, shown, take}) {
  const group = element(row, "div", {class: "radios", role: "radiogroup", "aria-label": label});
  const inputs = choices.map(([value, text], k) => {
    const own = element(group, "label", {}), input = element(own, "input", {type: "radio", name: id, value, id: id + (k || "")});
    own.append(` ${text}`);
    input.addEventListener("change", () => take(value));
    return input;
  });
  return () => { for (const input of inputs) input.checked = Number(input.value) === shown(); };
}

// Samples of a curve until it is no longer known: the largest of each of many bins, as a chart shows no more.
function curveOf(values, dt) {
  const end = values.findIndex(value => !Number.isFinite(value)), count = end < 0 ? values.length : end;
  const x = [], y = [], bin = Math.max(1, Math.ceil(count / 6000));
  for (let start = 0; start < count; start += bin) {
    let most = start;
    for (let k = start + 1; k < Math.min(start + bin, count); k++) if (Math.abs(values[k]) > Math.abs(values[most])) most = k;
    x.push(most * dt);
    y.push(values[most]);
  }
  return count ? {x, y} : {x: [0], y: [0]};
}
// The value at a time between samples; the last known one after it.
function sampleAt(values, dt, time) {
  const k = clamp(time / dt, 0, Math.max(values.length - 1, 0)), low = Math.floor(k), high = Math.min(low + 1, values.length - 1);
  return values.length ? values[low] + (k - low) * (values[high] - values[low]) : 0;
}
const largestOf = values => values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);

// Structures that move, and charts over time, of histories that are exchanged at every change of a control.
function explorePlayer(structures) {
  const root = byId("player"), alone = structures.length === 1;
  byId("scenes").className = alone ? "stages" : "stages several";
  const actors = structures.map(({name, stage: {box: [low, high]}}, k) => {
    const figure = element(byId("scenes"), "div", {class: "actor", style: `flex-grow: ${high[0] - low[0]}`});
    const title = element(figure, "p", {class: "name"}), svg = shape(figure, "svg", {role: "img", class: "stage"});
    const read = element(figure, "output", {class: "now", "aria-live": "off"}), fate = element(figure, "p", {class: "fate"});
    title.hidden = fate.hidden = alone;
    element(title, "span", {}, `${name} `);
    if (!alone) swatch(title, `curve-${k}`);
    return {figure, svg, read, fate, chosen: element(title, "span", {})};
  });
  const play = element(byId("transport"), "button", {type: "button", class: "play"}, "Play");
  const slider = element(byId("transport"), "input", {type: "range", min: 0, step: "any", "aria-label": "time in seconds"});
  const rate = element(element(byId("transport"), "label", {}, "speed "), "select", {});
  for (const each of [0.1, 0.25, 0.5, 1, 2, 4]) rate.add(new Option(`${each} ×`, each, false, each === 1));
  // `wanted`: it plays by itself after a change. `held`: the reader chose the moment that is shown.
  let runs = [], drawn = [], width = 0, times = 1, now = 0, end = 0, last = 0, view = [0, 0];
  let wanted = !matchMedia("(prefers-reduced-motion: reduce)").matches, held = false, running = false, frame = 0, before = 0;

  function show() {
    runs.forEach((run, k) => {
      const until = Math.min(now, run.until), turn = sampleAt(run.known, run.dt, until), {over} = structures[k];
      actors[k].stage.show(turn, turn, 0);
      actors[k].figure.classList.toggle("stopped", !alone && now > run.until);
      actors[k].read.textContent = `φ = ${fixed(turn * 180 / Math.PI, times > 1 ? 3 : 2)}°, ` +
        `${over} = ${fixed(sampleAt(run.ratio.subarray(0, run.known.length), run.dt, until), times > 1 ? 4 : 2)}`;
    });
    byId("now").textContent = `t = ${now.toFixed(2)} s`;
    for (const chart of drawn) chart.show(now);
    slider.value = now;
    slider.setAttribute("aria-valuetext", `${now.toFixed(2)} seconds`);
  }
  function look(from, span) {
    const wide = clamp(span, Math.min(0.05, last), last), low = clamp(from, 0, last - wide);
    view = [low, low + wide];
    for (const chart of drawn) { chart.build(width, view); chart.show(now); }
  }
  const zoom = factor => look(now - (now - view[0]) * factor, (view[1] - view[0]) * factor);
  function set(on) {
    running = on;
    play.textContent = on ? "Pause" : "Play";
    cancelAnimationFrame(frame);
    if (!on) return;
    if (now >= end) now = 0;
    before = performance.now();
    frame = requestAnimationFrame(tick);
  }
  function tick(at) {
    now = Math.min(end, now + Math.max(0, at - before) / 1000 * Number(rate.value));
    before = at;
    show();
    if (now >= end) set(false); else frame = requestAnimationFrame(tick);
  }
  function go(time) { set(false); held = true; now = clamp(time, 0, end); show(); }
  function wire(chart) {
    chart.plot.addEventListener("pointerdown", event => go(chart.snap(chart.timeAt(event))));
    chart.plot.addEventListener("pointermove", event => {
      if (event.buttons) go(chart.snap(chart.timeAt(event)));
      else if (!running) { now = clamp(chart.snap(chart.timeAt(event)), 0, end); show(); }
    });
  }
  function drawCharts() {
    const overs = [...new Set(structures.map(each => each.over))], over = overs.length > 1 ? "φ over φcr or the limit" : overs[0];
    const text = overs.length > 1 ? "critical rotation or limit" : over.endsWith("cr") ? "critical rotation" : over.split("/").at(-1);
    const most = Math.min(1.4, Math.max(...runs.flatMap(run => [run.curve.y, ...(alone ? Object.values(run.beside) : [])]
      .map(values => largestOf(values.filter(Number.isFinite)))))), {shaken} = runs[0];
    byId("ratio").replaceChildren();
    byId("ground").replaceChildren();
    drawn = [timeChart(byId("ratio"), {  // the levels are in view, unless the rotations are far below them
      label: `rotation ${over}, clockwise up`, levels: [{at: 1, text}, {at: -1, text}],
      tall: most === 0 || most > 0.25 ? Math.max(1.25, 1.1 * most) : 1.2 * roundStep(Math.max(most, 0.002)),
      series: [
        ...runs.map(({curve}, k) => ({name: alone ? over : structures[k].name, look: `curve-${k}`, ...curve})),
        ...(alone ? Object.entries(runs[0].beside) : []).map(([look, values]) => ({
          name: look === "linear1" ? "linear, κ₁" : "linear, κ₂", look, ...curveOf(values, runs[0].dt)})),
      ],
    }), timeChart(byId("ground"), {
      label: "ground acceleration [g]", levels: [], tall: 1.1 * largestOf(shaken.y) || 1,
      series: [{name: "ground", look: "trace", ...shaken}],
    })];
    drawn.forEach(wire);
  }
  // How many times displacements are enlarged, if no rotation is large: a round number.
  function enlargement() {
    const most = Math.max(...runs.map(run => run.most)), limits = structures.flatMap(each => Object.values(each.reference));
    if (most === 0 || most >= LEAST_ENLARGED) return 1;
    const room = Math.min(MOST_ENLARGED, 0.5 * Math.min(...limits.filter(Number.isFinite))) / most;
    return [100, 50, 20, 10, 5, 2].find(each => each <= room) ?? 1;
  }
  // Draws histories anew: at their largest rotation while a control moves, and in motion once it rests.
  function update(histories, names, chosen) {
    const whole = view[0] <= 0 && view[1] >= last;
    runs = histories.map(run => {
      const cut = run.phi.findIndex(value => !Number.isFinite(value)), known = cut < 0 ? run.phi : run.phi.subarray(0, cut);
      return {...run, known, most: largestOf(known), until: Math.max(0, known.length - 1) * run.dt,
              curve: curveOf(run.ratio, run.dt), shaken: curveOf(run.ground, run.groundDt)};
    });
    end = Math.max(...runs.map(run => run.until));
    last = Math.max(end, runs[0].shaken.x.at(-1), 1e-3);
    slider.max = end;
    times = enlargement();
    const words = times === 1 ? "Displacements are to scale." : `Displacements are enlarged ${times} times.`;
    actors.forEach((own, k) => {
      own.svg.setAttribute("aria-label", `${structures[k].name}: ${names[k]}`);
      own.fate.textContent = names[k];
      own.chosen.textContent = k === chosen ? " (chosen)" : "";
      const stage = runs[k].stage ?? structures[k].stage;
      if (own.times === times && own.drawn === stage) return;
      Object.assign(own, {times, drawn: stage, stage: structureStage(own.svg, stage, times, alone ? words : "")});
      width = 0;
    });
    const peak = runs[chosen].known.findIndex(value => Math.abs(value) === runs[chosen].most);
    now = clamp(held ? now : peak * runs[chosen].dt, 0, end);
    drawCharts();
    if (whole) view = [0, last];
    build();
    return `${words} ${times > 1 ? "Numbers are not enlarged. " : ""}The ground is drawn still.`;
  }
  function build() {
    const wide = byId("ratio").clientWidth || 700;
    if (wide !== width) {
      width = wide;
      const tallest = clamp(0.5 * width, 240, 420), widths = actors.map(({figure}) => figure.clientWidth || width);
      const scale = Math.min(...actors.map(({stage}, k) => stage.fits(widths[k], tallest)));  // the same for all
      actors.forEach(({stage}, k) => stage.build(widths[k], scale));
    }
    look(view[0], view[1] - view[0]);
    show();
  }
  for (const [text, act] of [["Zoom in", () => zoom(0.5)], ["Zoom out", () => zoom(2)], ["Show all", () => look(0, last)]])
    element(byId("zooms"), "button", {type: "button"}, text).addEventListener("click", act);
  slider.addEventListener("input", () => go(Number(slider.value)));
  const toggle = () => { wanted = !running; held = running; set(!running); };
  play.addEventListener("click", toggle);
  root.addEventListener("keydown", event => {
    if (event.target === rate || event.ctrlKey || event.metaKey || event.altKey) return;
    const to = {ArrowLeft: now - 0.1, ArrowRight: now + 0.1, Home: 0, End: end}[event.key];
    if (to !== undefined) go(to);
    else if (event.key === " " && event.target.tagName !== "BUTTON") toggle();
    else if (event.key === "+" || event.key === "-") zoom(event.key === "+" ? 0.5 : 2);
    else if (event.key === "0") look(0, last);
    else return;
    event.preventDefault();
  });
  const uplift = () => Math.min(...runs.map(run => run.outcome.uplift_time).filter(Number.isFinite));
  return {
    update, resize() { if (byId("ratio").clientWidth !== width) build(); },
    moving() { if (!held) set(false); },
    rested() { if (wanted && !held) { now = clamp(uplift() - 0.5, 0, end) % end || 0; set(true); } },
  };
}

// Axes of a figure, logarithmic across, and logarithmic or of shares upwards. Returns places of values, and values of places.
const FRAME = {left: 62, right: 14, top: 12, bottom: 42, height: 300};
const widthOf = plot => Math.max(240, plot.clientWidth);  // a page that is not laid out has no width
const roundValues = (low, high) => [-3, -2, -1, 0, 1, 2].flatMap(k => [1, 2, 5].map(each => Number(`${each}e${k}`)))
  .filter(value => value >= low && value <= high);
// The limits of cells around values of a logarithmic scale.
function edgesOf(values) {
  const ends = [values[0] ** 2 / values[1], ...values, values.at(-1) ** 2 / values.at(-2)];
  return ends.slice(1).map((value, k) => Math.sqrt(value * ends[k]));
}
function figureAxes(svg, width, across, upwards, [xName, yName]) {
  const {left, right, top, bottom, height} = FRAME, wide = width - left - right, tall = height - top - bottom;
  svg.replaceChildren();
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  const part = (value, [low, high]) => Math.log(value / low) / Math.log(high / low);
  const X = value => left + wide * part(value, across);
  const Y = value => top + tall * (1 - (upwards ? part(value, upwards) : value));
  const pattern = shape(shape(svg, "defs", {}), "pattern", {id: `${svg.parentNode.id}-hatch`, width: 6, height: 6,
    patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)"});
  shape(pattern, "rect", {class: "hatched", width: 6, height: 6});
  shape(pattern, "line", {class: "hatch", x1: 1, x2: 1, y1: 0, y2: 6});
  const behind = shape(svg, "g", {}), cells = shape(svg, "g", {});
  shape(svg, "rect", {class: "frame", x: left, y: top, width: wide, height: tall});
  for (const value of roundValues(...across)) {
    shape(behind, "line", {class: "grid", x1: X(value), x2: X(value), y1: top, y2: height - bottom + 4});
    shape(behind, "text", {class: "small", x: X(value), y: height - bottom + 17, "text-anchor": "middle"}, inShort(value));
  }
  for (const value of upwards ? roundValues(...upwards) : [0, 0.25, 0.5, 0.75, 1]) {
    shape(behind, "line", {class: "grid", x1: left - 4, x2: width - right, y1: Y(value), y2: Y(value)});
    const text = upwards ? inShort(value) : percent(value);
    shape(behind, "text", {class: "small", x: left - 7, y: Y(value) + 4, "text-anchor": "end"}, text);
  }
  shape(behind, "text", {class: "small", x: left + wide / 2, y: height - 6, "text-anchor": "middle"}, xName);
  shape(behind, "text", {class: "small", x: -top - tall / 2, y: 14, "text-anchor": "middle", transform: "rotate(-90)"}, yName);
  return {X, Y, cells, valueAt: (x, y) => [across[0] * (across[1] / across[0]) ** ((x - left) / wide),
                                           upwards && upwards[0] * (upwards[1] / upwards[0]) ** (1 - (y - top) / tall)]};
}
// A cell in a look, which is hatched for what is unknown.
const cell = (plot, parent, look, place) =>
  shape(parent, "rect", {...place, class: `block ${look}`, ...(look === UNKNOWN && {fill: `url(#${plot}-hatch)`})});
function keyOf(plot, legend, look, text) {
  const entry = element(legend, "span", {}), drawn = shape(entry, "svg", {"aria-hidden": "true", viewBox: "0 0 22 14"});
  cell(plot, drawn, look, {x: .5, y: .5, width: 21, height: 13});
  entry.append(` ${text}`);
}

// Shares of neighbours that overturn, or are of unknown outcome, over the scale factor.
function marginFigure() {
  const svg = shape(byId("margin-plot"), "svg", {role: "img"});
  keyOf("margin-plot", byId("margin-legend"), "at-once", "overturn");
  keyOf("margin-plot", byId("margin-legend"), UNKNOWN, "unknown");
  return ({factors, overturned, unknown, sentence}, present, what) => {
    const edges = edgesOf(factors), width = widthOf(byId("margin-plot"));
    const {X, Y, cells} = figureAxes(svg, width, [edges[0], edges.at(-1)], null, [what, "share of neighbours"]);
    factors.forEach((_, k) => {
      if (overturned[k] === null) return;
      const at = {x: X(edges[k]), width: X(edges[k + 1]) - X(edges[k])}, both = Math.min(1, overturned[k] + (unknown[k] ?? 0));
      cell("margin-plot", cells, UNKNOWN, {...at, y: Y(both), height: Y(overturned[k]) - Y(both)});
      cell("margin-plot", cells, "at-once", {...at, y: Y(overturned[k]), height: Y(0) - Y(overturned[k])});
    });
    if (present >= edges[0] && present <= edges.at(-1)) {
      const x = X(present), aside = x > 0.7 * width;
      for (const look of ["halo", "here"]) shape(svg, "line", {class: look, x1: x, x2: x, y1: FRAME.top, y2: Y(0)});
      shape(svg, "text", {class: "here-text", x: x + (aside ? -6 : 6), y: FRAME.top + 15, "text-anchor": aside ? "end" : "start"},
        `present: ${inShort(present)}`);
    }
    byId("margin-said").textContent = sentence ?? "";
    svg.setAttribute("aria-label", `Share of neighbours that overturn, over the ${what}. ${sentence ?? ""}`);
  };
}

// Outcomes under pulses, by period and amplitude; `choose` receives the pulse of a cell.
function mapFigure(shapeOf, choose) {
  const plot = byId("map-plot"), svg = shape(plot, "svg", {role: "img"});
  for (const [look, text] of CLASSES) keyOf("map-plot", byId("map-legend"), look, text);
  let axes, map, here = null;
  const cellAt = event => {
    const {x, y} = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    const [period, amplitude] = axes.valueAt(x, y);
    return [placeOf(edgesOf(map.periods).slice(0, -1), period), placeOf(edgesOf(map.amplitudes).slice(0, -1), amplitude)];
  };
  const read = ([i, j]) => {
    const text = CLASSES[map.classes[j * map.periods.length + i]]?.[1] ?? "not yet computed";
    byId("map-read").textContent = `${inShort(map.periods[i], 3)} s, ${inShort(map.amplitudes[j], 3)} g: ${text}.`;
  };
  const take = ([i, j]) => { read([i, j]); choose({motion: map.shape, period: map.periods[i], amplitude: map.amplitudes[j]}); };
  plot.addEventListener("pointermove", event => { if (map) read(cellAt(event)); });
  plot.addEventListener("click", event => { if (map) take(cellAt(event)); });
  plot.addEventListener("keydown", event => {
    const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
    if (!step || !map) return;
    event.preventDefault();
    const [i, j] = here ? [nearest(map.periods, here.period), nearest(map.amplitudes, here.amplitude)]
      : [map.periods.length >> 1, map.amplitudes.length >> 1];
    take([clamp(i + step[0], 0, map.periods.length - 1), clamp(j + step[1], 0, map.amplitudes.length - 1)]);
  });
  return (given, pulse) => {
    map = given;
    here = pulse;
    const {periods, amplitudes, classes} = map, [x, y] = [edgesOf(periods), edgesOf(amplitudes)], n = periods.length;
    axes = figureAxes(svg, widthOf(plot), [x[0], x.at(-1)], [y[0], y.at(-1)], ["period [s]", "amplitude [g]"]);
    const {X, Y, cells} = axes;
    for (let j = 0; j < amplitudes.length; j++) for (let i = 0, next; i < n; i = next) {  // equal neighbours are one block
      const kind = classes[j * n + i], top = Y(y[j + 1]);
      for (next = i + 1; next < n && classes[j * n + next] === kind;) next++;
      if (!CLASSES[kind]) continue;
      cell("map-plot", cells, CLASSES[kind][0], {x: X(x[i]), width: X(x[next]) - X(x[i]), y: top, height: Y(y[j]) - top});
    }
    const inside = (value, edges) => value >= edges[0] && value <= edges.at(-1);
    if (here && inside(here.period, x) && inside(here.amplitude, y)) for (const look of ["halo", "here"])
      shape(svg, "path", {class: look, d: `M${X(here.period)},${Y(here.amplitude)}m-9,0h18m-9,-9v18`});
    byId("map-title").textContent = `Map of pulses (${shapeOf(map.shape)})`;
    const label = `Outcomes under pulses (${shapeOf(map.shape)}), by period and amplitude.`;
    svg.setAttribute("aria-label", label);
    plot.setAttribute("aria-label", `${label} Arrows or a click choose a pulse.`);
  };
}

// Parts of the page as one SVG file, with the styles that they have on white paper.
const LOOKS = ["fill", "stroke", "stroke-width", "stroke-dasharray", "stroke-linejoin", "opacity", "vector-effect", "paint-order",
               "font-family", "font-size", "font-weight", "text-anchor", "shape-rendering"];
function svgOf(blocks) {
  const page = document.documentElement.style, MARGIN = 12;
  for (const {selectorText, style} of document.styleSheets[0].cssRules)  // those of the dark page are in a media rule
    if (selectorText === ":root") for (const name of style) page.setProperty(name, style.getPropertyValue(name));
  page.colorScheme = "light";
  const root = document.implementation.createDocument("http://www.w3.org/2000/svg", "svg").documentElement;
  shape(root, "rect", {width: "100%", height: "100%", fill: "#ffffff"});
  const width = 2 * MARGIN + Math.max(...blocks.map(block => block.clientWidth));
  let down = MARGIN;
  for (const block of blocks) {
    const frame = block.getBoundingClientRect(), right = MARGIN - frame.left, lower = down - frame.top;
    for (const svg of block.querySelectorAll("svg")) {
      const box = svg.getBoundingClientRect(), copy = svg.cloneNode(true), copies = [copy, ...copy.querySelectorAll("*")];
      [svg, ...svg.querySelectorAll("*")].forEach((node, k) => {
        const style = getComputedStyle(node);
        copies[k].removeAttribute("class");
        copies[k].setAttribute("style", LOOKS.map(name => `${name}:${style.getPropertyValue(name)}`).join(";"));
        if (style.display === "none") copies[k].remove();
      });
      const place = {x: right + box.left, y: lower + box.top, width: box.width, height: box.height};
      shape(root, "rect", {...place, fill: getComputedStyle(svg).backgroundColor});
      for (const key in place) copy.setAttribute(key, place[key]);
      root.append(copy);
    }
    for (const walker = document.createTreeWalker(block, NodeFilter.SHOW_TEXT); walker.nextNode();) {
      const node = walker.currentNode, style = getComputedStyle(node.parentElement), range = document.createRange();
      let line = null, top;
      if (!node.parentElement.closest("svg")) for (const {index, 0: word} of node.data.matchAll(/\S+/g)) {
        range.setStart(node, index);
        range.setEnd(node, index + word.length);
        const box = range.getBoundingClientRect();
        if (line && Math.abs(top - box.top) < 3) line.textContent += ` ${word}`;  // by lines, as the page breaks them
        else if (box.width) line = shape(root, "text", {x: right + box.left, y: lower + box.bottom - 0.22 * box.height,
          style: `fill:${style.color};font:${style.fontWeight} ${style.fontSize} ${style.fontFamily}`}, word);
        top = box.top;
      }
    }
    down += frame.height + MARGIN;
  }
  document.documentElement.removeAttribute("style");
  root.setAttribute("viewBox", `0 0 ${width} ${down}`);
  root.setAttribute("width", width);
  root.setAttribute("height", down);
  return new XMLSerializer().serializeToString(root);
}
function saveFile(name, type, text) {
  const link = element(document.body, "a", {href: URL.createObjectURL(new Blob([text], {type})), download: name});
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  return `Saved ${name}.`;
}

// The whole page, for the engine of kernel.js.
function explorePage(engine) {
  const {structures, motion, shapes} = engine;
  const standard = {structure: 0, motion: "record", scale: 1, polarity: 1, time: 1, amplitude: 0.4, period: 1,
                    restitution: null, size: 1, slender: 1, value: null};
  const sliders = {
    scale: ["Scale factor", byFactors(0.1, 10, 200)], time: ["Time scale", byFactors(0.5, 2, 120)],
    amplitude: ["Amplitude [g]", byFactors(0.01, 10, 300)], period: ["Period [s]", byFactors(0.05, 50, 300)],
    restitution: ["Restitution", evenly(0.05, Math.min(...structures.map(each => each.etaMost)), 190)],
    size: ["Size", byFactors(0.25, 4, 200)], slender: ["Width over height (neighbours' rule)", byFactors(0.8, 1.25, 40)],
  };
  let settings = standard, runs = [], frame = 0, resting = 0, loaded = false;
  const given = () => structures[settings.structure], changed = key => key !== "structure" && settings[key] !== standard[key];
  const pulsed = () => settings.motion !== "record", ofMotion = () => pulsed() ? ["amplitude", "period"] : ["scale", "time"];
  const shapeOf = key => shapes.find(each => each.key === key)?.label ?? key;
  const varied = ({label, unit}) => unit ? `${label} [${unit}]` : label;

  // The settings in the address; what is not valid there is ignored.
  function fromAddress() {
    const asked = new URLSearchParams(location.hash.slice(1)), read = {...standard};
    const take = (key, valid) => {
      const text = asked.get(key) ?? "", value = key === "motion" ? text : Number(text);
      if (text && valid(value)) read[key] = value;
    };
    take("structure", value => value in structures);
    const {values = [], usual} = structures[read.structure].vary ?? {};
    take("value", value => loaded && value in values && value !== usual);
    take("motion", value => shapes.some(each => each.key === value));
    take("polarity", value => value === -1);
    for (const [key, [, {least, most}]] of Object.entries(sliders)) take(key, value => value >= least && value <= most);
    return read;
  }

  // The controls.
  const rows = {};
  function addRow(key, parent, fill, more) {
    const id = more.row ?? key, take = value => choose({[key]: value}), reset = () => choose({[key]: standard[key]});
    const usual = {id: `set-${id}`, shown: () => settings[key], changed: () => changed(key), take, reset};
    rows[id] = settingRow(byId(parent), {...usual, ...more}, fill);
  }
  function addSlider(key, parent, more = {}) {
    const [label, range] = sliders[key], usual = more.usual ?? (() => standard[key]);
    const note = () => `changed, given ${usual() === null ? restitutionGiven() : inShort(usual())}`;
    addRow(key, parent, fillSlider, {label, range, note, ...more});
  }
  addRow("motion", "of-motion", fillList, {label: "Ground motion",
    choices: [["record", `${motion.name} (given)`], ...shapes.map(({key, label}) => [key, `pulse: ${label}`])]});
  for (const key of ["scale", "time", "amplitude", "period"]) addSlider(key, "of-motion");
  addRow("polarity", "of-motion", fillRadios, {label: "Polarity", choices: [[1, "as given"], [-1, "reversed"]]});
  if (structures.length > 1) addRow("structure", "of-structure", fillList, {label: "Structure",
    choices: structures.map(({name}, k) => [k, name]), reset: null,
    take: k => choose({structure: Number(k), value: null})});
  addSlider("restitution", "of-structure", {shown: () => settings.restitution ?? given().eta, usual: () => given().eta});
  const restitutionGiven = () => given().restitution.map(each => inShort(each, 3)).join(" and ");
  addSlider("size", "of-structure");
  addSlider("slender", "of-structure");
  structures.forEach(({vary}, k) => {
    if (vary) addRow("value", "of-structure", fillSlider, {row: `value-${k}`, label: varied(vary), range: among(vary.values),
      note: () => `changed, given ${inShort(vary.values[vary.usual])}`, shown: () => vary.values[settings.value ?? vary.usual],
      take(value) { const at = nearest(vary.values, value); choose({value: at === vary.usual ? null : at}); }});
  });
  byId("reset").addEventListener("click", () => choose(standard));

  // Studies that take longer. A study goes on while the settings that it depends on are the same.
  function study(id, without, rest, ask, draw) {
    const line = byId(`${id}-work`), bar = element(line, "progress", {max: 1, value: 0, "aria-label": "share computed"});
    const text = element(line, "span", {}), section = line.parentElement;
    const keyNow = () => JSON.stringify(Object.entries(settings).filter(([name]) => !without.includes(name)));
    let key = "", found = null, share = null, trouble = "", timer = 0;
    function note() {
      const old = key !== keyNow(), busy = old || share !== null;
      line.hidden = !busy && !trouble;
      bar.hidden = !busy;
      bar.value = old ? 0 : share ?? 0;
      text.textContent = old && found ? "of the settings before; computing" : busy ? "computing" : trouble;
      for (const each of section.querySelectorAll("p:not(.work)")) each.classList.toggle("old", old);
      section.setAttribute("aria-busy", busy);
    }
    async function start() {
      const mine = keyNow();
      if (mine === key) return;
      [key, share, trouble] = [mine, 0, ""];
      const take = (result, done) => {  // results of settings before are left
        if (mine !== key) return;
        if (result) draw(found = result);
        share = done;
        note();
      };
      note();
      try {
        const result = await engine[ask]({...settings}, (done, partial) => take(partial, done));
        if (result) take(result, null);
      } catch (error) {
        if (mine === key) trouble = error.message;
        take(null, null);
      }
    }
    return {draw() { if (found) draw(found); }, wait() { note(); clearTimeout(timer); timer = setTimeout(start, rest); }};
  }
  const drawMargin = marginFigure(), drawMap = mapFigure(shapeOf, pulse => choose(pulse));
  const studies = [
    study("near", [], REST, "neighbours", ({overturned, unknown, as_itself, sentence}) => {
      const shares = [[overturned, "overturn"], [unknown || NaN, "unknown"], [as_itself, "end as the motion itself"]];
      const known = shares.filter(([share]) => Number.isFinite(share)).map(([share, text]) => `${percent(share)} ${text}`);
      byId("shares").textContent = `Neighbours: ${known.join(", ")}`;
      byId("near").textContent = letters(sentence ?? "");
      if (sentence) byId("said").textContent = letters(sentence);
    }),
    study("margin", ["scale"], LONG_REST, "margin", found =>
      drawMargin(found, pulsed() ? 1 : settings.scale, pulsed() ? "factor on the amplitude" : "scale factor")),
    study("map", ["scale", "time", "amplitude", "period"], LONG_REST, "map", found =>
      drawMap(found, pulsed() ? settings : null)),
  ];

  // What follows a change: at once the histories, and after a rest what is read, kept or takes longer.
  const player = explorePlayer(structures);
  function choose(some) {
    settings = {...settings, ...some};
    Object.assign(sliders.restitution[1], {asGiven: restitutionGiven(), middle: given().restitution.reduce((a, b) => a + b) / 2});
    for (const each of Object.values(rows)) each.refresh();
    for (const key of ["scale", "time", "amplitude", "period"]) rows[key].row.hidden = !ofMotion().includes(key);
    structures.forEach(({vary}, k) => { if (vary) rows[`value-${k}`].row.hidden = k !== settings.structure; });
    const count = Object.keys(standard).filter(changed).length;
    byId("changed").textContent = count ? `${count} changed` : "All are as given.";
    byId("taken").textContent = "";
    player.moving();
    frame ||= requestAnimationFrame(compute);
    clearTimeout(resting);
    resting = setTimeout(rested, REST);
    for (const each of studies) each.wait();
  }
  const letters = text => text.replaceAll("phi_cr", "φcr");
  const write = (id, texts) => byId(id).replaceChildren(...texts.map(text => element(byId(id), "p", {}, letters(text))));
  function compute() {
    frame = 0;
    const of = k => k === settings.structure ? settings : {...settings, structure: k, value: null};
    runs = structures.map((_, k) => engine.history(of(k)));
    const names = runs.map(run => run.headline.replaceAll("phi_cr", "φcr")), run = runs[settings.structure];
    byId("headline").textContent = `${short(given().name)}: ${names[settings.structure]}`;
    byId("headline").className = run.outcome.kind;
    const asGiven = !run.stage && ["size", "slender", "value"].some(changed) ? " The structure is drawn as given." : "";
    byId("drawn").textContent = player.update(runs, names, settings.structure) + asGiven;
    byId("state").textContent = inWords();
    write("sentences", run.sentences);
    for (const each of studies) each.draw();
  }
  function inWords() {
    const say = (key, label, value) => `${label.toLowerCase()} ${value}${changed(key) ? " (changed)" : ""}`;
    const numbers = keys => keys.map(key => say(key, sliders[key][0], inShort(settings[key])));
    const eta = settings.restitution ?? given().eta, {vary} = given();
    const under = pulsed() ? `a pulse (${shapeOf(settings.motion)})` : motion.name;
    return [`${given().name} under ${under}`, ...numbers(ofMotion()),
      say("polarity", "polarity", settings.polarity === 1 ? "as given" : "reversed"),
      say("restitution", "restitution", eta === null ? restitutionGiven() : inShort(eta)), ...numbers(["size", "slender"]),
      ...(vary ? [say("value", varied(vary), inShort(vary.values[settings.value ?? vary.usual]))] : [])].join(", ");
  }
  function rested() {
    if (frame) { cancelAnimationFrame(frame); compute(); }  // as in a tab behind others
    const {sentences} = runs[settings.structure], {command, why} = engine.command(settings);
    write("notes", given().notes);
    byId("said").textContent = [`${byId("headline").textContent}.`, ...sentences].join(" ");
    byId("command").textContent = command ?? "";
    byId("command").parentElement.hidden = copy.hidden = !command;
    byId("why").textContent = command ? "" : why;
    const kept = Object.entries(settings).filter(([key, value]) => value !== standard[key]);
    if (location.protocol !== "about:") history.replaceState(null, "", `#${new URLSearchParams(kept)}`);
    player.rested();
  }

  // What the reader takes along.
  function action(text, act) {
    const button = element(byId("files"), "button", {type: "button"}, text);
    button.addEventListener("click", () => { byId("taken").textContent = act(); });
    return button;
  }
  const name = end => fileOf(given(), settings) + end;
  const busy = id => byId(id).closest("section")?.getAttribute("aria-busy") === "true";
  const figure = (text, end, ids) => action(text, () => busy(ids[0]) ? "Still computing: save it when it is done."
    : saveFile(name(end), "image/svg+xml", svgOf(ids.map(byId))));
  const copy = action("Copy command", () => {
    getSelection().selectAllChildren(byId("command"));
    return document.execCommand("copy") ? "Copied." : "The command is selected.";
  });
  action("Structure (YAML)", () => engine.yaml(settings) === null ? "No file describes it in this size."
    : saveFile(name(".yaml"), "application/yaml", engine.yaml(settings)));
  action("History (CSV)", () => saveFile(name("_history.csv"), "text/csv", engine.csv(settings)));
  figure("Motion (SVG)", "_motion.svg", ["headline", "state", "scenes", "drawn", "ratio", "ground"]);
  figure("Margin (SVG)", "_margin.svg", ["margin-title", "state", "margin-plot", "margin-legend", "margin-said"]);
  figure("Map (SVG)", "_map.svg", ["map-title", "state", "map-plot", "map-legend"]);

  addEventListener("hashchange", () => choose(fromAddress()));
  addEventListener("resize", () => { player.resize(); for (const each of studies) each.draw(); });
  const asked = Number(new URLSearchParams(location.hash.slice(1)).get("value") ?? NaN);
  const ofValues = Object.keys(rows).filter(id => id.startsWith("value-")).map(id => rows[id].row);
  for (const each of ofValues) each.inert = true;
  choose(fromAddress());
  engine.all.then(() => {
    loaded = true;
    for (const each of ofValues) each.inert = false;
    const {vary} = given();
    if (vary && asked in vary.values && asked !== vary.usual) choose({value: asked});
  });
}

startEngine(JSON.parse(byId("data").textContent)).then(engine => {
  byId("still").hidden = true;
  byId("explore").hidden = false;
  explorePage(engine);
  if (window.frameElement)  // within a report, whose page scrolls
    new ResizeObserver(() => { frameElement.style.height = `${document.documentElement.scrollHeight}px`; }).observe(document.body);
  if (location.search === "?bench")
    benchmark(engine).then(times => element(document.body, "pre", {id: "bench"}, JSON.stringify(times)));
}, error => {
  byId("trouble").textContent = error.message;
  byId("trouble").hidden = false;
});

"use strict";
// Structures that move, with a slider and charts over time: shared by the page of `rocking animate` and the report.

function element(parent, tag, attributes, text) {
  const node = document.createElement(tag);
  for (const key in attributes) node.setAttribute(key, attributes[key]);
  if (text !== undefined) node.textContent = text;
  parent.appendChild(node);
  return node;
}
function shape(parent, tag, attributes, text) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const key in attributes) node.setAttribute(key, attributes[key]);
  if (text !== undefined) node.textContent = text;
  parent.appendChild(node);
  return node;
}
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
const short = text => text.length > 40 ? text.slice(0, 39) + "…" : text;
const fixed = (value, digits = 2) => (Math.round(value * 10 ** digits) / 10 ** digits + 0).toFixed(digits);
const outline = points => "M" + points.map(p => p.join(",")).join("L") + "Z";

// Index of the last of the ascending values that is not above a value; 0 if all are above.
function placeOf(values, value) {
  let low = 0, high = values.length;
  while (high - low > 1) { const mid = (low + high) >> 1; if (values[mid] <= value) low = mid; else high = mid; }
  return low;
}
function nearest(values, value) {
  const k = placeOf(values, value);
  return k + 1 < values.length && values[k + 1] - value < value - values[k] ? k + 1 : k;
}
// A step of 1, 2 or 5 times a power of ten, at least as large as the given value.
function roundStep(rough) {
  const unit = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map(k => k * unit).find(v => v >= rough * (1 - 1e-9));
}

// A structure on its ground. Returns a function for the largest scale [pixels per m] at which it fits, one that redraws it
// at a scale, and one that moves it to a signed rotation [rad], drawn larger than it is, on ground that has moved [m]; its
// place in the table of positions is the rotation, or a time.
function structureStage(svg, {picture, shades, middle, box: [low, high]}, enlargement, words) {
  const SIDE = picture.loads.some(load => load.force) ? 52 : 26, TOP = SIDE, BELOW = 18, LINE = 18;
  let moving = [], pins = [], world, moveHung, scale;
  const first = Object.keys(picture.reference)[0];  // of the directions that it can rock in
  const sideOf = r => r === 0 ? first : r < 0 ? "negative" : "positive";
  const ratioOf = r => r / picture.reference[sideOf(r)];

  // Place of a part, by linear interpolation between the positions of the table.
  function placed(part, rotation) {
    const table = picture.rotation, r = clamp(rotation, table[0], table[table.length - 1]);
    const k = Math.min(placeOf(table, r), table.length - 2), w = (r - table[k]) / (table[k + 1] - table[k]);
    const at = values => values[k] + w * (values[k + 1] - values[k]);
    return {x: at(part.x), y: at(part.y), psi: at(part.psi)};
  }
  function hatch(parent, start, end) {
    const [dx, dy] = [end[0] - start[0], end[1] - start[1]], size = Math.hypot(dx, dy), count = Math.floor(size / 9);
    const along = [dx / size, dy / size], c = Math.cos(2.4), s = Math.sin(2.4);
    const tick = [9 * (along[0] * c - along[1] * s), 9 * (along[0] * s + along[1] * c)];
    for (let k = 0; k < count; k++) {
      const w = (k + .5) / count, x = start[0] + w * dx, y = start[1] + w * dy;
      shape(parent, "line", {class: "earth", style: "stroke-width:1px", x1: x, y1: y, x2: x + tick[0], y2: y + tick[1]});
    }
  }
  // Loads and ties, drawn into one group behind the bodies and one before them; returns what moves them.
  function hang(behind, before, X, Y, width) {
    const SYMBOL = 11, COIL = 40, WIDE = 5, TEETH = 8, ARROW = 42, WEIGHT = 8;
    const steps = [];
    const at = (end, places) => {
      if (end.part === null) return [X(end.point[0]) + SYMBOL * end.lead[0], Y(end.point[1]) - SYMBOL * end.lead[1]];
      const {x, y, psi} = places[end.part], c = Math.cos(psi), s = Math.sin(psi), [[p, q], [u, v]] = [end.point, end.lead];
      return [X(x + c * p - s * q) + SYMBOL * (c * u - s * v), Y(y + s * p + c * q) - SYMBOL * (s * u + c * v)];
    };
    const write = (text, [x, y]) => {  // beside a point, on the side where there is more room
      const right = x > 0.6 * width;
      for (const [key, value] of Object.entries({x: x + (right ? -11 : 11), y: y - 6, "text-anchor": right ? "end" : "start"}))
        text.setAttribute(key, value);
    };
    for (const tie of picture.ties) {
      const layer = tie.bed ? behind : before;  // a structure may move over the springs along its face
      const drawn = tie.pieces.map(piece => ({piece, line: shape(layer, "path", {class: "tie"})}));
      for (const {ends} of tie.pieces)
        for (const end of ends) if (end.part === null) {
          const [x, y] = at(end, []);
          shape(layer, "rect", {class: "anchor", x: x - 4, y: y - 4, width: 8, height: 8});
        }
      const name = shape(before, "text", {class: "hung tied"}, short(tie.name));
      steps.push((places, k) => {
        let longest = [0, [0, 0]];
        for (const {piece, line} of drawn) {
          const [[x0, y0], [x1, y1]] = piece.ends.map(end => at(end, places)), long = Math.hypot(x1 - x0, y1 - y0);
          const [u, v] = long ? [(x1 - x0) / long, (y1 - y0) / long] : [1, 0];
          const coil = piece.kind === "line" ? 0 : piece.kind === "symbol" ? long : Math.min(COIL, .6 * long);
          const points = [[x0, y0]], from = (long - coil) / 2;
          if (coil > 0) for (let j = 0; j <= TEETH; j++) {
            const along = from + coil * j / TEETH, aside = j % 2 ? (j % 4 === 1 ? WIDE : -WIDE) : 0;
            points.push([x0 + u * along - v * aside, y0 + v * along + u * aside]);
          }
          points.push([x1, y1]);
          line.setAttribute("d", "M" + points.map(p => p.map(z => z.toFixed(2)).join(",")).join("L"));
          line.setAttribute("class", tie.slack[k] ? "tie slack" : "tie");
          if (long > longest[0]) longest = [long, [(x0 + x1) / 2, (y0 + y1) / 2]];
        }
        write(name, longest[1]);
      });
    }
    for (const load of picture.loads) {
      const [fx, fy] = load.force ?? [0, 0], size = Math.hypot(fx, fy) || 1, [u, v] = [fx / size, -fy / size];
      const mark = load.force === null
        ? shape(before, "path", {class: "weight", d: "M-8,8L8,8L5.6,-5L2.4,-5L2.4,-9L-2.4,-9L-2.4,-5L-5.6,-5Z"})
        : shape(before, "path", {class: "force",
            d: `M${-ARROW * u},${-ARROW * v}L${-9 * u},${-9 * v}M0,0L${-11 * u - 5 * v},${-11 * v + 5 * u}L${-11 * u + 5 * v},${-11 * v - 5 * u}Z`});
      const name = shape(before, "text", {class: "hung"}, load.name && `${short(load.name)}, ${load.text}`);
      steps.push((places, k, side) => {
        const [x, y] = at(load, places), turn = load.friction && side !== first ? -1 : 1;  // friction is against the motion
        mark.setAttribute("transform", `translate(${x},${y}) scale(${turn},1)`);
        write(name, load.force === null ? [x, y] : [x - turn * ARROW * u, y - ARROW * v]);
      });
    }
    return (places, k, side) => { for (const step of steps) step(places, k, side); };
  }
  const fits = (width, tallest) => Math.min((width - 2 * SIDE) / (high[0] - low[0]), tallest / (high[1] - low[1]));
  function build(width, newScale) {
    svg.replaceChildren();
    scale = newScale;
    const foot = TOP + (high[1] - low[1]) * scale + BELOW, left = (width - (high[0] - low[0]) * scale) / 2;
    const X = x => left + (x - low[0]) * scale, Y = y => TOP + (high[1] - y) * scale;
    // The lines of the foot: the bar of the scale, and beside it or below it how much displacements are enlarged.
    const bar = roundStep(0.12 * width / scale), lines = [];
    for (const word of words.split(" ").filter(Boolean)) {
      const longer = lines.length ? `${lines.at(-1)} ${word}` : word;
      if (lines.length && longer.length * 7 > width - 24) lines.push(word); else lines.splice(-1, 1, longer);
    }
    const beside = bar * scale + 70 + words.length * 7 < width;
    const height = foot + LINE * (1 + (beside ? 0 : lines.length)) + 6;
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    shape(svg, "line", {class: "plumb", x1: X(middle), x2: X(middle), y1: 6, y2: foot});  // it stands still
    world = shape(svg, "g", {class: "world"});
    for (const line of [...picture.ground, ...picture.walls]) {
      const points = line.map(p => [X(p[0]), Y(p[1])]);
      shape(world, "path", {class: "earth", d: "M" + points.map(p => p.join(",")).join("L")});
      for (let k = 1; k < points.length; k++) hatch(world, points[k - 1], points[k]);
    }
    const behind = shape(world, "g", {});
    const plane = shape(world, "g", {class: "plane", transform: `translate(${X(0)},${Y(0)}) scale(${scale},${-scale})`});
    for (const part of picture.parts) {
      const at = placed(part, 0);
      for (const each of part.outlines)
        shape(plane, "path", {class: "rest", d: outline(each), transform: `translate(${at.x},${at.y})`});
    }
    moving = picture.parts.map(part => {
      const group = shape(plane, "g", {});
      for (const each of part.outlines)
        shape(group, "path", {class: part.assumed ? "body assumed" : "body", d: outline(each)});
      shape(group, "circle", {class: "centroid", r: 3 / scale});
      return group;
    });
    moveHung = hang(behind, shape(world, "g", {}), X, Y, width);
    pins = picture.pins.map(pin => ({
      pin, X, Y, mark: shape(world, "circle", {class: "pin", r: 4}), letter: shape(world, "text", {class: "letter"}, pin.letter),
    }));
    const level = foot + LINE;
    shape(svg, "line", {x1: 12, x2: 12 + bar * scale, y1: level - 4, y2: level - 4, stroke: "currentColor", "stroke-width": 3});
    shape(svg, "text", {x: 18 + bar * scale, y: level}, `${Number(bar.toPrecision(3))} m`);
    if (beside) shape(svg, "text", {x: width - 12, y: level, "text-anchor": "end"}, words);
    else lines.forEach((line, k) => shape(svg, "text", {x: 12, y: level + LINE * (k + 1)}, line));
  }
  function show(rotation, place, shift) {
    const side = sideOf(rotation), places = picture.parts.map(part => placed(part, enlargement * place));
    world.setAttribute("transform", `translate(${shift * scale},0)`);
    // Ties are slack as at the place itself; the nodes of the table are far apart, and rest is none of them.
    const at = nearest(picture.rotation, place), still = picture.rotation.indexOf(0);
    moveHung(places, at === still ? clamp(at + Math.sign(rotation), 0, picture.rotation.length - 1) : at, side);
    moving.forEach((group, k) => {
      group.setAttribute("transform", `translate(${places[k].x},${places[k].y}) rotate(${places[k].psi * 180 / Math.PI})`);
      group.setAttribute("class", `part shade-${shades[side][k] ?? "rest"}`); // of its link in this direction
    });
    for (const {pin, X, Y, mark, letter} of pins) {
      const seen = rotation !== 0 && pin.direction === side;
      mark.style.display = letter.style.display = seen ? "" : "none";
      if (!seen) continue;
      const at = places[pin.part], c = Math.cos(at.psi), s = Math.sin(at.psi);
      const x = X(at.x + c * pin.point[0] - s * pin.point[1]), y = Y(at.y + s * pin.point[0] + c * pin.point[1]);
      mark.setAttribute("cx", x); mark.setAttribute("cy", y);
      letter.setAttribute("x", x + 7); letter.setAttribute("y", y - 7);
    }
  }
  return {fits, build, show, ratioOf};
}

// The look of a curve beside its name.
function swatch(parent, look) {
  const drawn = shape(parent, "svg", {"aria-hidden": "true", class: "swatch", viewBox: "0 0 34 10"});
  shape(drawn, "line", {class: `trace ${look}`, x1: 1, x2: 33, y1: 5, y2: 5});
}

// One chart over time: curves, a cursor, and a legend that reads the values under it.
let charts = 0;
function timeChart(root, {label, tall, levels, series}) {
  const legend = element(root, "div", {class: "legend"});
  element(legend, "span", {class: "heading"}, label);
  const values = series.map(({name, look}) => {
    const entry = element(legend, "span", {});
    swatch(entry, look);
    element(entry, "span", {}, ` ${name} `);
    return element(entry, "span", {class: "value"});
  });
  const plot = element(root, "div", {class: "plot", role: "group", tabindex: "0", "aria-label":
    `${label}, over time in seconds. Left and right arrow move the cursor, plus and minus zoom, zero shows all.`});
  const svg = shape(plot, "svg", {"aria-hidden": "true"}), clip = `clip-${++charts}`;
  const left = 52, right = 12, top = 8, bottom = 24, height = levels.length ? 210 : 150;
  const fine = Math.max(3, 2 - Math.floor(Math.log10(tall)));  // digits of a value
  let cursor, width, view;
  const X = t => left + (t - view[0]) / (view[1] - view[0]) * (width - left - right);
  const Y = v => top + (1 - v / tall) / 2 * (height - top - bottom);
  const timeAt = x => view[0] + (x / svg.clientWidth * width - left) / (width - left - right) * (view[1] - view[0]);

  function build(wide, span) {
    width = wide; view = span;
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const step = roundStep((view[1] - view[0]) * 70 / (width - left - right));
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const first = Math.ceil(view[0] / step - 1e-9);
    for (let k = first; k * step <= view[1] * (1 + 1e-9); k++) {
      shape(svg, "line", {class: "axis", x1: X(k * step), x2: X(k * step), y1: top, y2: height - bottom});
      shape(svg, "text", {class: "small tick", x: X(k * step), y: height - 8, "text-anchor": "middle"},
        (k * step).toFixed(digits) + (k === first ? " s" : ""));
    }
      const up = roundStep(tall / 2.5), fine = Math.max(0, -Math.floor(Math.log10(up) + 1e-9));
    for (let k = -Math.floor(tall / up); k * up <= tall; k++) {
      shape(svg, "line", {class: "axis", x1: left, x2: width - right, y1: Y(k * up), y2: Y(k * up)});
      shape(svg, "text", {class: "small", x: left - 6, y: Y(k * up) + 4, "text-anchor": "end"}, fixed(k * up, fine));
    }
    for (const {at, text} of levels) if (Math.abs(at) < tall) {
      shape(svg, "line", {class: "level", x1: left, x2: width - right, y1: Y(at), y2: Y(at)});
      shape(svg, "text", {class: "small", x: left + 5, y: Y(at) + (at > 0 ? 14 : -5)}, text);
    }
    const inside = shape(shape(svg, "clipPath", {id: clip}), "rect", {});
    for (const [key, value] of Object.entries({x: left, y: top, width: width - left - right, height: height - top - bottom}))
      inside.setAttribute(key, value);
    for (const {look, x, y} of series) {
      const points = [];
      for (let k = placeOf(x, view[0]); k < x.length; k++) {
        points.push(`${X(x[k]).toFixed(1)},${Y(clamp(y[k], -9 * tall, 9 * tall)).toFixed(1)}`);
        if (x[k] > view[1]) break;
      }
      shape(svg, "path", {class: `trace ${look}`, "clip-path": `url(#${clip})`, d: "M" + points.join("L")});
    }
    cursor = shape(svg, "line", {class: "cursor", y1: top, y2: height - bottom});
  }
  function show(time) {
    cursor.setAttribute("x1", X(time)); cursor.setAttribute("x2", X(time));
    series.forEach(({x, y}, k) => {
      const known = time >= x[0] - 1e-9 && time <= x[x.length - 1] + 1e-9;
      values[k].textContent = known ? fixed(y[nearest(x, time)], fine) : "–";
    });
  }
  function select(from, to) {
    svg.querySelector(".selection")?.remove();
    if (from === undefined) return;
    const [a, b] = [X(from), X(to)].map(x => clamp(x, left, width - right)).sort((p, q) => p - q);
    shape(svg, "rect", {class: "selection", x: a, y: top, width: b - a, height: height - top - bottom});
  }
  const snap = time => series[0].x[nearest(series[0].x, time)];
  return {plot, build, show, select, timeAt: event => timeAt(event.clientX - svg.getBoundingClientRect().left), snap};
}

// The whole view in `root`. `moment` is the time shown first [s]; `listener` receives the keys.
function motionView(root, {start, end, step, enlargement, ground, scale, drawn: words, stages, charts, speed, moment}, listener) {
  const alone = stages.length === 1;
  const scenes = element(root, "div", {class: alone ? "stages" : "stages several"});
  const actors = stages.map((given, k) => {
    const figure = element(scenes, "div", {class: "actor", style: `flex-grow: ${given.box[1][0] - given.box[0][0]}`});
    if (!alone) swatch(element(figure, "p", {class: "name"}, `${given.name} `), `curve-${k}`);
    const svg = shape(figure, "svg", {role: "img", "aria-label": `${given.label}. ${scale}`, class: "stage"});
    const stage = structureStage(svg, given, enlargement, alone ? scale : enlargement === 1 ? "" : `enlarged ${enlargement} times`);
    const read = alone ? null : element(figure, "output", {class: "now", "aria-live": "off"});
    if (!alone) element(figure, "p", {class: "fate"}, given.fate);
    // Small rotations, as all are over a limit, need more digits.
    const small = enlargement > 1 || Object.values(given.picture.phi_cr).includes(null);
    return {...given, figure, stage, read, digits: small ? 5 : 2};
  });
  element(root, "p", {class: "drawn"}, alone ? words : `${scale} ${words}`);
  const controls = element(root, "div", {class: "controls"});
  const play = element(controls, "button", {type: "button", class: "play"}, "Play");
  const slider = element(controls, "input", {type: "range", min: start, max: end, step: "any", "aria-label": "time in seconds"});
  const rate = element(element(controls, "label", {}, "speed "), "select", {});
  for (const each of [...new Set([0.1, 0.25, 0.5, 1, 2, 4, speed])].sort((a, b) => a - b))
    rate.add(new Option(`${Number(each.toPrecision(3))} ×`, each, false, each === speed));
  const read = element(root, "output", {class: "now", "aria-live": "off"});
  if (alone && stages[0].ending) element(root, "p", {class: "ending"}, stages[0].ending);
  const drawn = charts.map(each => timeChart(root, each));
  const zooms = element(root, "div", {class: "controls"});
  const button = (text, act) => element(zooms, "button", {type: "button"}, text).addEventListener("click", act);
  element(root, "p", {class: "hint"}, "Point at a chart to see the values and the structure at that moment. Drag across it, " +
    "pinch it, or click it and turn the wheel, to zoom. Keys: space plays, arrows move, + and − zoom, 0 shows all.");
  const last = Math.max(end, start + 1e-3), FINEST = 0.05;
  let now = clamp(moment, start, end), view = [start, last], running = false, before = 0, frame = 0, width = 0;

  function valueAt(values, time) {
    const k = clamp((time - start) / step, 0, values.length - 1), low = Math.floor(k), high = Math.min(low + 1, values.length - 1);
    return values[low] + (k - low) * (values[high] - values[low]);
  }
  function show() {
    const said = `t = ${now.toFixed(2)} s`;
    for (const {stage, rotation, place = rotation, stops, ratio, digits, figure, read: own} of actors) {
      const until = Math.min(now, stops ?? now), turn = valueAt(rotation, until);  // after that, all of it stands still
      stage.show(turn, valueAt(place, until), valueAt(ground, until));
      figure.classList.toggle("stopped", !alone && stops !== null && now > stops);
      const values = `φ = ${fixed(turn * 180 / Math.PI, digits > 2 ? 3 : 2)}°, ${ratio} = ${fixed(stage.ratioOf(turn), digits)}`;
      (own ?? read).textContent = alone ? `${said}, ${values}` : values;
    }
    if (!alone) read.textContent = said;
    if (now < view[0] || now > view[1]) look(now - (view[1] - view[0]) / 2, view[1] - view[0]);
    for (const chart of drawn) chart.show(now);
    slider.value = now;
    slider.setAttribute("aria-valuetext", `${now.toFixed(2)} seconds`);
  }
  function look(from, span) {
    const wide = clamp(span, Math.min(FINEST, last - start), last - start), low = clamp(from, start, last - wide);
    view = [low, low + wide];
    for (const chart of drawn) { chart.build(width, view); chart.show(now); }
  }
  const zoom = (factor, at) => look(at - (at - view[0]) * factor, (view[1] - view[0]) * factor);
  const whole = () => look(start, last - start);
  function build() {
    width = Math.max(280, root.clientWidth || 700);
    const tallest = Math.max(240, Math.min(0.5 * width, 420)), wide = actors.map(({figure}) => figure.getBoundingClientRect().width || width);
    const scale = Math.min(...actors.map(({stage}, k) => stage.fits(wide[k], tallest)));  // the same for all
    actors.forEach(({stage}, k) => stage.build(wide[k], scale));
    look(view[0], view[1] - view[0]);
    show();
  }
  function tick(at) {
    now = Math.min(end, now + (at - before) / 1000 * Number(rate.value));
    before = at;
    show();
    if (now >= end) set(false);
    if (running) frame = requestAnimationFrame(tick);
  }
  function set(on) {
    running = on;
    play.textContent = on ? "Pause" : "Play";
    cancelAnimationFrame(frame);
    if (!on) return;
    if (now >= end) now = start;
    before = performance.now();
    frame = requestAnimationFrame(tick);
  }
  function go(time) { set(false); now = clamp(time, start, end); show(); }

  for (const chart of drawn) {
    const fingers = new Map();
    let from, spread;
    const inView = event => clamp(chart.timeAt(event), ...view);
    chart.plot.addEventListener("pointerdown", event => {
      fingers.set(event.pointerId, event.clientX);
      if (event.isPrimary) { from = inView(event); go(chart.snap(from)); }
      if (event.pointerType === "mouse") chart.plot.setPointerCapture(event.pointerId);
      spread = undefined;
    });
    chart.plot.addEventListener("pointermove", event => {
      if (fingers.has(event.pointerId)) fingers.set(event.pointerId, event.clientX);
      if (fingers.size === 2) {
        const [a, b] = [...fingers.values()], wide = Math.max(20, Math.abs(a - b));
        if (spread) zoom(spread / wide, chart.timeAt({clientX: (a + b) / 2}));
        spread = wide;
      } else if (event.pointerType === "mouse" && fingers.size) chart.select(from, inView(event));
      else if (!running) go(chart.snap(inView(event)));
    });
    const lift = event => {
      const to = inView(event), dragged = event.type === "pointerup" && event.pointerType === "mouse" && fingers.has(event.pointerId);
      fingers.delete(event.pointerId);
      chart.select();
      if (dragged && Math.abs(to - from) > 0.01 * (view[1] - view[0])) look(Math.min(from, to), Math.abs(to - from));
    };
    chart.plot.addEventListener("pointerup", lift);
    chart.plot.addEventListener("pointercancel", lift);
    chart.plot.addEventListener("wheel", event => {
      if (document.activeElement !== chart.plot && !event.ctrlKey) return;  // the wheel belongs to the page
      event.preventDefault();
      zoom(Math.exp(clamp(event.deltaY, -200, 200) / 400), inView(event));
    }, {passive: false});
  }
  button("Zoom in", () => zoom(0.5, now));
  button("Zoom out", () => zoom(2, now));
  button("Show all", whole);
  slider.addEventListener("input", () => go(Number(slider.value)));
  play.addEventListener("click", () => set(!running));
  listener.addEventListener("keydown", event => {
    if (event.target === rate || event.ctrlKey || event.metaKey || event.altKey) return;
    const to = {ArrowLeft: now - 0.1, ArrowRight: now + 0.1, Home: start, End: end}[event.key];
    if (to !== undefined) go(to);
    else if (event.key === " " && event.target.tagName !== "BUTTON") set(!running);
    else if (event.key === "+" || event.key === "-") zoom(event.key === "+" ? 0.5 : 2, now);
    else if (event.key === "0") whole();
    else return;
    event.preventDefault();
  });
  addEventListener("resize", () => { if ((root.clientWidth || width) !== width) build(); });
  build();
  return {play: () => set(true)};
}

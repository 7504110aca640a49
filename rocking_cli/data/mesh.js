// A body of triangles that a reader turns: its faces from far to near, its foot on the ground, its weakest edge.
function bodyView(page, data) {
  const canvas = page.getElementById("body"), pen = canvas.getContext("2d");
  const around = page.getElementById("around"), above = page.getElementById("above"), only = page.getElementById("below");
  const count = data.points.length / 3, faces = data.triangles.length / 3;
  const x = new Float32Array(count), y = new Float32Array(count), depth = new Float32Array(count);
  const order = Array.from({ length: faces }, (_, k) => k), far = new Float32Array(faces);
  let reach = 0, top = 0;
  for (let k = 0; k < count; k++) {
    reach = Math.max(reach, Math.hypot(data.points[3 * k], data.points[3 * k + 1]));
    top = Math.max(top, data.points[3 * k + 2]);
  }
  let asked = false;

  // Views from an azimuth (0: along x from its positive end) and a height, both in degrees.
  function views() {
    const a = around.valueAsNumber * Math.PI / 180, h = above.valueAsNumber * Math.PI / 180;
    const [ca, sa, ch, sh] = [Math.cos(a), Math.sin(a), Math.cos(h), Math.sin(h)];
    return (px, py, pz) => [-sa * px + ca * py, sh * (ca * px + sa * py) - ch * (pz - top / 2),
                            ch * (ca * px + sa * py) + sh * (pz - top / 2)];
  }

  function draw() {
    asked = false;
    const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const style = getComputedStyle(page.documentElement), colour = name => style.getPropertyValue(name).trim();
    const scale = ratio * Math.min(width / (2.3 * reach), height / (1.12 * Math.hypot(top, 2 * reach)));
    const view = views(), at = (px, py, pz) => {
      const [u, v] = view(px, py, pz);
      return [canvas.width / 2 + scale * u, canvas.height / 2 + scale * v];
    };
    const line = (points, stroke, weight, dash = []) => {
      pen.beginPath();
      points.forEach((point, k) => k ? pen.lineTo(...at(...point)) : pen.moveTo(...at(...point)));
      pen.strokeStyle = stroke;
      pen.lineWidth = weight * ratio;
      pen.setLineDash(dash.map(each => each * ratio));
      pen.stroke();
      pen.setLineDash([]);
    };
    const below = above.valueAsNumber < 0, hidden = only.getAttribute("aria-pressed") === "true";
    const ground = () => {
      const ring = Array.from({ length: 73 }, (_, k) => [1.05 * reach * Math.cos(k * Math.PI / 36),
                                                         1.05 * reach * Math.sin(k * Math.PI / 36), 0]);
      line(ring, colour("--line"), 1);
      line([[0, 0, 0], [1.05 * reach, 0, 0]], colour("--faint"), 1);
      pen.fillStyle = colour("--ink");
      pen.font = `${13 * ratio}px system-ui, sans-serif`;
      pen.fillText("x", ...at(1.09 * reach, 0, 0));
    };
    const foot = () => {
      pen.beginPath();
      data.foot.forEach((point, k) => k ? pen.lineTo(...at(...point, 0)) : pen.moveTo(...at(...point, 0)));
      pen.closePath();
      pen.globalAlpha = 0.55;
      pen.fillStyle = colour("--shade-1");
      pen.fill();
      pen.globalAlpha = 1;
      line([...data.foot, data.foot[0]].map(point => [...point, 0]), colour("--ink"), 1.5);
    };
    pen.clearRect(0, 0, canvas.width, canvas.height);
    ground();
    if (!below) foot();
    if (!hidden) body(view, scale, colour("--shade-0"));
    if (below) foot();
    line(data.weakest.map(point => [...point, 0]), colour("--cursor"), 4);
    line([[0, 0, data.height], [0, 0, 0]], colour("--ink"), 1.5, [5, 4]);
    for (const [z, size] of [[data.height, 5], [0, 3]]) {
      pen.beginPath();
      pen.arc(...at(0, 0, z), size * ratio, 0, 2 * Math.PI);
      pen.fillStyle = colour("--ink");
      pen.fill();
    }
  }

  function body(view, scale, shade) {
    const base = [1, 3, 5].map(k => parseInt(shade.slice(k, k + 2), 16));
    for (let k = 0; k < count; k++) {
      const [u, v, w] = view(data.points[3 * k], data.points[3 * k + 1], data.points[3 * k + 2]);
      x[k] = canvas.width / 2 + scale * u;
      y[k] = canvas.height / 2 + scale * v;
      depth[k] = scale * w;
    }
    for (let k = 0; k < faces; k++) {
      const t = 3 * k;
      far[k] = depth[data.triangles[t]] + depth[data.triangles[t + 1]] + depth[data.triangles[t + 2]];
    }
    order.sort((one, other) => far[one] - far[other]);
    pen.lineWidth = 1;
    for (const k of order) {
      const [a, b, c] = [data.triangles[3 * k], data.triangles[3 * k + 1], data.triangles[3 * k + 2]];
      const [ux, uy, uz] = [x[b] - x[a], y[b] - y[a], depth[b] - depth[a]];
      const [vx, vy, vz] = [x[c] - x[a], y[c] - y[a], depth[c] - depth[a]];
      const [nx, ny, nz] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
      if (nz >= 0) continue;  // y is downwards, so that faces towards the reader have a negative area
      const light = 0.5 + 0.55 * Math.max(0, (0.35 * nx + 0.5 * ny - 0.79 * nz) / Math.hypot(nx, ny, nz));
      pen.fillStyle = pen.strokeStyle = `rgb(${base.map(each => Math.min(255, Math.round(each * light))).join(" ")})`;
      pen.beginPath();
      pen.moveTo(x[a], y[a]);
      pen.lineTo(x[b], y[b]);
      pen.lineTo(x[c], y[c]);
      pen.closePath();
      pen.fill();
      pen.stroke();
    }
  }

  function again() {
    if (!asked) requestAnimationFrame(draw);
    asked = true;
  }
  function turn(sideways, upwards) {
    around.value = (around.valueAsNumber + sideways + 540) % 360 - 180;
    above.value = above.valueAsNumber + upwards;
    again();
  }
  let held = null;
  canvas.addEventListener("pointerdown", event => {
    held = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", event => {
    if (held === null) return;
    turn((held[0] - event.clientX) / 2, (event.clientY - held[1]) / 2);
    held = [event.clientX, event.clientY];
  });
  for (const ends of ["pointerup", "pointercancel"]) canvas.addEventListener(ends, () => { held = null; });
  canvas.addEventListener("keydown", event => {
    const way = { ArrowLeft: [5, 0], ArrowRight: [-5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5] }[event.key];
    if (way === undefined) return;
    event.preventDefault();
    turn(...way);
  });
  only.addEventListener("click", () => {
    only.setAttribute("aria-pressed", String(only.getAttribute("aria-pressed") !== "true"));
    again();
  });
  around.addEventListener("input", again);
  above.addEventListener("input", again);
  addEventListener("resize", again);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
  draw();
}

// Plays a skeleton on a canvas: {name, unit, low, high, t, loops, bodies: {name: [x, y, theta]}, inks: {name: [on light, on dark]}, times, strokes, names}.
// Where strokes are at a moment is in carriers.js, which stands before this text in a page. Plain JavaScript, no libraries.
(function (root, data) {
  "use strict";
  const LIGHT = { ink: "#20252b", quiet: "#5d6670", paper: "#ffffff", faint: "#e9ecef", driver: "#c2410c", load: "#4b5563", wrong: "#c81e1e" };
  const DARK = { ink: "#e6e9ee", quiet: "#98a3b1", paper: "#10141b", faint: "#222a35", driver: "#ff8a4c", load: "#a9b6c6", wrong: "#ff6b6b" };
  const canvas = root.querySelector("canvas"), g = canvas.getContext("2d"), button = root.querySelector("button");
  const bar = root.querySelector("input"), time = root.querySelector("output"), dark = matchMedia("(prefers-color-scheme: dark)");
  const start = data.t[0], end = data.t[data.t.length - 1], span = end - start || 1;
  const seconds = data.loops ? 4 : Math.min(Math.max(span, 2), 12), digits = Math.max(0, Math.min(6, 3 - Math.floor(Math.log10(span))));
  let t = start, playing = !matchMedia("(prefers-reduced-motion: reduce)").matches, last = 0, held = 0, scale = 1, middle = [0, 0];

  /** The motion at a moment, as carriers.js needs it. */
  function motionAt(t) {
    let low = 0, high = data.t.length - 2;
    while (low < high) { const half = (low + high + 1) >> 1; if (data.t[half] <= t) low = half; else high = half - 1; }
    const part = Math.min(Math.max((t - data.t[low]) / (data.t[low + 1] - data.t[low] || 1), 0), 1);
    const body = (name) => {
      if (!data.bodies[name]) return { x: 0, y: 0, theta: 0 };
      const [x, y, theta] = data.bodies[name].map((values) => values[low] + part * (values[low + 1] - values[low]));
      return { x, y, theta };
    };
    const place = (end) => {
      const { x, y, theta } = body(end.body), c = Math.cos(theta), s = Math.sin(theta);
      return [x + c * end.x - s * end.y, y + s * end.x + c * end.y];
    };
    return { t, body, place };
  }
  const first = motionAt(start);
  const pixel = (x, y) => [middle[0] + scale * (x - (data.low[0] + data.high[0]) / 2), middle[1] - scale * (y - (data.low[1] + data.high[1]) / 2)];
  function draw() {
    const colours = dark.matches ? DARK : LIGHT, motion = motionAt(t);
    const of = (role) => role.startsWith("body:") ? (data.inks[role.slice(5)] || [])[dark.matches ? 1 : 0] || colours.ink : colours[role] || colours.ink;
    const ratio = Math.min(devicePixelRatio || 1, 2), width = canvas.clientWidth, height = canvas.clientHeight, pad = 3 * data.unit;
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    scale = Math.min(width / (data.high[0] - data.low[0] + 2 * pad), height / (data.high[1] - data.low[1] + 2 * pad)) * 0.94;
    middle = [width / 2, height / 2];
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.fillStyle = colours.paper;
    g.fillRect(0, 0, width, height);
    g.lineJoin = g.lineCap = "round";
    for (const one of data.paths) {
      g.beginPath();
      for (let k = 0; k < one.length; k += 2) g.lineTo(...pixel(one[k], one[k + 1]));
      g.globalAlpha = 0.55;
      g.strokeStyle = colours.driver;
      g.lineWidth = 1.5;
      g.stroke();
    }
    for (const one of data.strokes) {
      const points = moved(one.points, one, motion, first, data.times), line = one.width * 1.15;
      g.beginPath();
      for (let k = 0; k < points.length; k += 2) g.lineTo(...pixel(points[k], points[k + 1]));
      if (one.closed) g.closePath();
      if (one.fill) { g.globalAlpha = one.alpha; g.fillStyle = of(one.fill); g.fill(); }
      g.globalAlpha = one.closed ? 1 : one.alpha;
      if (line) { g.lineWidth = line; g.setLineDash(one.dash.map((dash) => dash * line)); g.strokeStyle = of(one.ink); g.stroke(); g.setLineDash([]); }
    }
    g.globalAlpha = 1;
    g.font = "500 12px system-ui, sans-serif";
    g.textBaseline = "middle";
    const taken = [];
    for (const one of data.names) {
      const at = moved(one.points, one, motion, first, data.times), [x, y] = pixel(at[0], at[1]), off = one.off * scale * 0.75 + 3, w = g.measureText(one.text).width;
      const sides = [[x + off, y - off - 4], [x + off, y + off + 6], [x - off - w, y - off - 4], [x - off - w, y + off + 6], [x - w / 2, y - 2 * off - 6]];
      const free = sides.find(([a, b]) => !taken.some(([c, d, e]) => a < c + e + 4 && c < a + w + 4 && Math.abs(b - d) < 15)) || sides[0];
      taken.push([...free, w]);
      g.lineWidth = 4;
      g.strokeStyle = colours.paper;
      g.strokeText(one.text, ...free);
      g.fillStyle = of(one.ink);
      g.fillText(one.text, ...free);
    }
    bar.value = String((1000 * (t - start)) / span);
    time.textContent = `${t.toFixed(digits)} s`;
  }
  function step(now) {
    if (!playing) return;
    const passed = last ? Math.min((now - last) / 1000, 0.25) : 0;
    last = now;
    t += (passed * span) / seconds;
    if (t >= end) {
      held += data.loops ? 1 : passed;
      t = held >= 1 ? (data.loops ? start + ((t - start) % span) : start) : end;
      if (held >= 1) held = 0;
    }
    draw();
    requestAnimationFrame(step);
  }
  function play(on) {
    playing = on;
    last = 0;
    button.textContent = on ? "❚❚" : "▶";
    button.setAttribute("aria-label", on ? "Pause" : "Play");
    if (on) requestAnimationFrame(step);
  }
  button.addEventListener("click", () => play(!playing));
  bar.addEventListener("input", () => { play(false); t = start + (span * bar.valueAsNumber) / 1000; draw(); });
  dark.addEventListener("change", draw);
  new ResizeObserver(draw).observe(canvas);
  play(playing);
  draw();
})

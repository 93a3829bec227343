/** Arrows and arcs of the moment in the plane: lengths and sweeps of all views, and the drawing of the 2D one. */

/**
 * @param {import("../data/decode.js").Payload} payload
 * @param {import("../data/motion.js").Motion} motion
 * @param {Record<string, boolean>} shown
 * @returns {{index: number, quantity: string, tail: [number, number], tip: [number, number], z: number}[]} (m)
 */
export function arrowsAt({ arrows }, motion, shown) {
  const out = [];
  arrows.list.forEach((one, index) => {
    const scale = arrows.scales[one.unit];
    if (!shown[one.quantity] || !scale) return;
    const u = motion.linear(one.value, 2), v = motion.linear(one.value, 2, 1), size = Math.hypot(u, v);
    const length = arrows.full * Math.min(size / scale.largest, arrows.longest);
    if (!size || length < arrows.tiny * arrows.full) return;
    const x = motion.linear(one.place, 2), y = motion.linear(one.place, 2, 1);
    const tip = [x + u / size * length, y + v / size * length];
    out.push({ index, quantity: one.quantity, tail: [x, y], tip, z: one.z });
  });
  return out;
}

/** @returns {{index: number, quantity: string, centre: [number, number], sweep: number, radius: number, z: number}[]} */
export function arcsAt({ arcs, arrows }, motion, shown) {
  const out = [];
  arcs.list.forEach((one, index) => {
    if (!shown[one.quantity] || !arcs.scale) return;
    const value = motion.linear(one.value) / arcs.scale.largest;
    const sweep = arcs.full * Math.max(-arrows.longest, Math.min(arrows.longest, value));
    if (Math.abs(sweep) < arrows.tiny * arcs.full) return;
    const centre = [motion.linear(one.place, 2), motion.linear(one.place, 2, 1)];
    out.push({ index, quantity: one.quantity, centre, sweep, radius: one.radius, z: one.z });
  });
  return out;
}

/** @param {CanvasRenderingContext2D} g  @param {import("./paper.js").Paper} paper */
export function drawArrows(g, paper, arrows, arcs, colours) {
  g.lineCap = "butt";
  for (const { quantity, tail, tip } of arrows) {
    const a = paper.pixel(...tail), b = paper.pixel(...tip);
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    if (length < 2) continue;
    const u = (b[0] - a[0]) / length, v = (b[1] - a[1]) / length, head = Math.min(13, 0.6 * length);
    g.strokeStyle = g.fillStyle = colours[quantity];
    g.lineWidth = 2.6;
    line(g, a, [b[0] - u * head * 0.8, b[1] - v * head * 0.8]);
    triangle(g, b, u, v, head);
  }
  for (const { quantity, centre, sweep, radius } of arcs) {
    const [x, y] = paper.pixel(...centre), r = Math.max(radius * paper.scale, 14);
    g.strokeStyle = g.fillStyle = colours[quantity];
    g.lineWidth = 2.6;
    const head = Math.min(12, 0.6 * r * Math.abs(sweep)), end = -sweep + Math.sign(sweep) * 0.8 * head / r;
    g.beginPath();
    g.arc(x, y, r, 0, end, sweep > 0);
    g.stroke();
    const way = -Math.sign(sweep), at = [x + r * Math.cos(-sweep), y + r * Math.sin(-sweep)];
    triangle(g, at, way * -Math.sin(-sweep), way * Math.cos(-sweep), head);
  }
}

function line(g, a, b) {
  g.beginPath();
  g.moveTo(...a);
  g.lineTo(...b);
  g.stroke();
}

function triangle(g, tip, u, v, head) {
  const w = 0.38 * head;
  g.beginPath();
  g.moveTo(...tip);
  g.lineTo(tip[0] - u * head - v * w, tip[1] - v * head + u * w);
  g.lineTo(tip[0] - u * head + v * w, tip[1] - v * head - u * w);
  g.closePath();
  g.fill();
}

/** Arrows and arcs of the moment in the plane: lengths and sweeps of all views, and the drawing of the 2D one. */
import { HEADS } from "./inks.js";


/**
 * @param {import("../data/decode.js").Payload} payload
 * @param {import("../data/motion.js").Motion} motion
 * @param {Record<string, boolean>} shown
 * @returns {{index: number, row: string, tail: number[], tip: number[], z: number}[]} (m) in the plane, or in space
 */
export function arrowsAt({ arrows, space }, motion, shown) {
  const out = [], sides = space ? [0, 1, 2] : [0, 1], now = (series) => sides.map((k) => motion.linear(series, sides.length, k));
  arrows.list.forEach((one, index) => {
    const scale = arrows.scales[one.unit];
    if (!shown[one.quantity] || !scale) return;
    const value = now(one.value), size = Math.hypot(...value);
    const length = arrows.full * Math.min(size / scale.largest, arrows.longest);
    if (!size || length < arrows.tiny * arrows.full) return;
    const tail = now(one.place), tip = tail.map((x, k) => x + value[k] / size * length);
    out.push({ index, row: one.row, tail, tip, z: one.z });
  });
  return out;
}

/** @returns {{index: number, row: string, centre: number[], sweep: number, radius: number, z: number, about?: number[]}[]} */
export function arcsAt({ arcs, arrows, space }, motion, shown) {
  const out = [], sides = space ? [0, 1, 2] : [0, 1], now = (series) => sides.map((k) => motion.linear(series, sides.length, k));
  arcs.list.forEach((one, index) => {
    if (!shown[one.quantity] || !arcs.scale) return;
    const value = motion.linear(one.value) / arcs.scale.largest;
    const sweep = arcs.full * Math.max(-arrows.longest, Math.min(arrows.longest, value));
    if (Math.abs(sweep) < arrows.tiny * arcs.full) return;
    out.push({ index, row: one.row, centre: now(one.place), sweep, radius: one.radius, z: one.z, about: space && now(one.about) });
  });
  return out;
}

/** @param {CanvasRenderingContext2D} g  @param {import("./paper.js").Paper} paper  @param {string} halo round every arrow */
export function drawArrows(g, paper, payload, motion, shown, colours, halo) {
  const shapes = [];
  for (const { row, tail, tip } of arrowsAt(payload, motion, shown)) {
    const a = paper.pixel(...motion.flat(tail)), b = paper.pixel(...motion.flat(tip)), length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    if (length < 2) continue;
    const u = (b[0] - a[0]) / length, v = (b[1] - a[1]) / length;
    for (const corners of arrowOutlines(length, HEADS[row])) {
      shapes.push([colours[row], corners.map(([x, y]) => [a[0] + u * x - v * y, a[1] + v * x + u * y])]);
    }
  }
  for (const { row, centre, sweep, radius, about } of arcsAt(payload, motion, shown)) {
    const [x, y] = paper.pixel(...motion.flat(centre)), r = Math.max(radius * paper.scale, 14);
    for (const corners of arcOutlines(r, sweep * motion.facing(about))) shapes.push([colours[row], corners.map(([u, v]) => [x + u, y - v])]);
  }
  g.setLineDash([]);
  g.lineJoin = "round";
  g.strokeStyle = halo;
  g.lineWidth = 3;
  for (const [, corners] of shapes) { trace(g, corners); g.stroke(); }
  for (const [colour, corners] of shapes) { g.fillStyle = colour; trace(g, corners); g.fill(); }
}

/** Shaft and points of an arrow along x, each as corners, in pixels. */
export function arrowOutlines(length, head) {
  const double = head.endsWith("double"), solid = head.startsWith("solid"), half = 1.4;
  const point = Math.min(13, (double ? 0.42 : 0.6) * length), neck = length - (solid ? 0.9 * point : 1.4 * half);
  const out = [[[0, half], [neck, half], [neck, -half], [0, -half]]];
  for (const back of double ? [0, 0.72 * point] : [0]) {
    const tip = length - back, far = tip - point, w = 0.4 * point, barb = 2.2 * half;
    out.push(solid ? [[tip, 0], [far, w], [far, -w]]
      : [[tip, 0], [far, 1.25 * w], [far - barb, 1.25 * w], [tip - 1.5 * barb, 0], [far - barb, -1.25 * w], [far, -1.25 * w]]);
  }
  return out;
}

/** Tube and point of an arc about the origin from the x axis on, y up, in pixels. */
export function arcOutlines(r, sweep) {
  const half = Math.min(1.8, 0.2 * r), head = Math.min(14, 0.8 * r, 0.6 * r * Math.abs(sweep)), way = Math.sign(sweep), w = 0.42 * head;
  const end = sweep - (way * 0.8 * head) / r, turn = Array.from({ length: 33 }, (_, k) => (end * k) / 32);
  const at = (angle, radius) => [radius * Math.cos(angle), radius * Math.sin(angle)];
  const neck = sweep - (way * head) / r;
  return [[...turn.map((angle) => at(angle, r + half)), ...turn.reverse().map((angle) => at(angle, r - half))], [at(sweep, r), at(neck, r + w), at(neck, r - w)]];
}

function trace(g, corners) {
  g.beginPath();
  for (const corner of corners) g.lineTo(...corner);
  g.closePath();
}

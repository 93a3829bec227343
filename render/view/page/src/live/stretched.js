/**
 * Parts of the numbers before, where the machine has others by now: each body is mapped so that its pins and traced
 * points are where they are now. Three or more that are not in line decide an affine map; two, or some in line, stretch
 * along the line and not across; one moves it.
 *
 * @typedef {Record<string, Record<string, [number, number]>>} Anchors  by body, places in its frame (m)
 * @typedef {[number, number, number, number, number, number]} Map  x' = a x + b y + c, y' = d x + e y + f
 */
import { Motion } from "../data/motion.js";

const LOOKED_AT = 7;
/** Moments in which a place must be the same one of a body. */
const SAME = 1e-4, FLAT = 0.05, LARGEST = 8;
/** Parts of the machine's size: places that are one; and of the longer axis: points that are in line. Largest stretch. */

/** The places that each body has for good. @param {any} payload  @returns {Anchors} */
export function anchors(payload) {
  const motion = new Motion(payload), { skeleton } = payload, near = SAME * Math.hypot(skeleton.high[0] - skeleton.low[0], skeleton.high[1] - skeleton.low[1]);
  const moments = Array.from({ length: LOOKED_AT }, (_, k) => motion.start + ((motion.end - motion.start) * k) / LOOKED_AT);
  const things = [
    ...Object.entries(payload.joints).map(([name, { bodies }]) => [`joint ${name}`, bodies, () => motion.joint(name)]),
    ...Object.entries(payload.points).map(([name, { body }]) => [`point ${name}`, [body], () => motion.point(name)]),
  ];
  const out = {};
  for (const [key, bodies, place] of things) {
    for (const body of bodies) {
      const seen = moments.map((t) => { motion.to(t); return within(motion.body(body), place()); });
      if (seen.every(([x, y]) => Math.hypot(x - seen[0][0], y - seen[0][1]) < near)) (out[body] ??= {})[key] = seen[0];
    }
  }
  return out;
}

/** @param {Anchors} before  @param {Anchors} now  @returns {Record<string, Map>} of bodies that have changed */
export function stretches(before, now) {
  const out = {};
  for (const body in before) {
    const keys = Object.keys(before[body]).filter((key) => now[body]?.[key]);
    const from = keys.map((key) => before[body][key]), to = keys.map((key) => now[body][key]);
    if (from.some(([x, y], k) => Math.hypot(x - to[k][0], y - to[k][1]) > 1e-9)) out[body] = mapOf(from, to);
  }
  return out;
}

/** @param {[number, number][]} from  @param {[number, number][]} to  @returns {Map} */
export function mapOf(from, to) {
  const a = mean(from), b = mean(to), u = from.map((p) => [p[0] - a[0], p[1] - a[1]]), v = to.map((p) => [p[0] - b[0], p[1] - b[1]]);
  const xx = sum(u, ([x]) => x * x), xy = sum(u, ([x, y]) => x * y), yy = sum(u, ([, y]) => y * y);
  const half = (xx + yy) / 2, apart = Math.hypot((xx - yy) / 2, xy), most = half + apart, least = Math.max(half - apart, 0);
  let m = [1, 0, 0, 1];
  if (most > 0 && least > FLAT * FLAT * most) {
    const det = xx * yy - xy * xy, row = (axis) => {
      const p = sum(u, ([x], k) => x * v[k][axis]), q = sum(u, ([, y], k) => y * v[k][axis]);
      return [(p * yy - q * xy) / det, (q * xx - p * xy) / det];
    };
    m = [...row(0), ...row(1)];
  }
  const turn = m[0] * m[3] - m[1] * m[2];
  if (most > 0 && (least <= FLAT * FLAT * most || turn < 1 / LARGEST || turn > LARGEST)) {
    const angle = Math.atan2(xy, (xx - yy) / 2 + apart), c = Math.cos(angle), s = Math.sin(angle);
    const along = u.map(([x, y]) => c * x + s * y), p = sum(along, (t, k) => t * v[k][0]) / most, q = sum(along, (t, k) => t * v[k][1]) / most;
    const grown = Math.hypot(p, q) || 1, [d, e] = [p / grown, q / grown];
    m = [grown * d * c + e * s, grown * d * s - e * c, grown * e * c - d * s, grown * e * s + d * c];
  }
  return [m[0], m[1], b[0] - m[0] * a[0] - m[1] * a[1], m[2], m[3], b[1] - m[2] * a[0] - m[3] * a[1]];
}

/** Heights over the plane of arrows and trails, which a motion without parts does not know. */
export function raised(patch, payload) {
  for (const kind of ["arrows", "arcs"]) {
    const known = new Map((payload[kind]?.list ?? []).map((one) => [`${one.quantity} ${one.name}`, one.z]));
    for (const one of patch[kind]?.list ?? []) one.z = known.get(`${one.quantity} ${one.name}`) ?? one.z;
  }
  for (const one of patch.trails ?? []) {
    const old = payload.trails.find(({ point }) => point === one.point);
    if (old) Object.assign(one, { z: old.z, radius: old.radius });
  }
}

const within = ({ x, y, theta }, [a, b]) => {
  const c = Math.cos(theta), s = Math.sin(theta);
  return [c * (a - x) + s * (b - y), c * (b - y) - s * (a - x)];
};
const mean = (points) => [0, 1].map((axis) => sum(points, (p) => p[axis]) / points.length);
const sum = (list, f) => list.reduce((total, one, k) => total + f(one, k), 0);

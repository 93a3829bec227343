/** Where strokes and names are at a moment; carriers.py says what the kinds of carriers mean. Both players use this file:
 * player.js of mbsd, and the page of render, which bundles it. */

/**
 * @typedef {{body: string, x: number, y: number}} End
 * @typedef {{kind: "ground" | "body" | "place" | "line" | "shapes", ends: End[]}} Carrier
 * @typedef {{t: number, body: (name: string) => {x: number, y: number, theta: number}, place: (end: End) => number[]}} Motion
 * @param {ArrayLike<number>} points x and y in turn (m), at the start
 * @param {{carrier: Carrier, shapes?: ArrayLike<number> | null}} carried
 * @param {Motion} motion
 * @param {Motion} first the same at its start
 * @param {ArrayLike<number>} times of the shapes
 * @returns {ArrayLike<number>} at the moment
 */
export function moved(points, { carrier, shapes }, motion, first, times) {
  switch (carrier.kind) {
    case "body": {
      const a = first.body(carrier.ends[0].body), b = motion.body(carrier.ends[0].body);
      return turned(points, a.x, a.y, Math.cos(b.theta - a.theta), Math.sin(b.theta - a.theta), b.x, b.y);
    }
    case "place": {
      const a = first.place(carrier.ends[0]), b = motion.place(carrier.ends[0]);
      return turned(points, a[0], a[1], 1, 0, b[0], b[1]);
    }
    case "line": return stretched(points, carrier.ends, motion, first);
    case "shapes": return between(shapes, points.length, motion.t, times);
    default: return points;
  }
}

function turned(points, x0, y0, c, s, x, y) {
  const out = new Float64Array(points.length);
  for (let k = 0; k < points.length; k += 2) {
    const u = points[k] - x0, v = points[k + 1] - y0;
    out[k] = x + c * u - s * v;
    out[k + 1] = y + s * u + c * v;
  }
  return out;
}

/** Along the line between the ends, not across. */
function stretched(points, ends, motion, first) {
  const [a, b] = ends.map((end) => first.place(end)), [c, d] = ends.map((end) => motion.place(end));
  const before = Math.hypot(b[0] - a[0], b[1] - a[1]), after = Math.hypot(d[0] - c[0], d[1] - c[1]);
  if (!before || !after) return turned(points, a[0], a[1], 1, 0, c[0], c[1]);
  const p = (b[0] - a[0]) / before, q = (b[1] - a[1]) / before, r = (d[0] - c[0]) / after, s = (d[1] - c[1]) / after;
  const out = new Float64Array(points.length);
  for (let k = 0; k < points.length; k += 2) {
    const x = points[k] - a[0], y = points[k + 1] - a[1];
    const u = (x * p + y * q) * after / before, v = y * p - x * q;
    out[k] = c[0] + u * r - v * s;
    out[k + 1] = c[1] + u * s + v * r;
  }
  return out;
}

/** A mean of the shapes before and after the moment. */
function between(shapes, fallback, t, times) {
  const size = shapes.length / times.length || fallback;
  let k = 0;
  while (k + 2 < times.length && times[k + 1] <= t) k++;
  const part = Math.min(Math.max((t - times[k]) / (times[k + 1] - times[k] || 1), 0), 1);
  const out = new Float64Array(size);
  for (let n = 0; n < size; n++) out[n] = (1 - part) * shapes[k * size + n] + part * shapes[(k + 1) * size + n];
  return out;
}

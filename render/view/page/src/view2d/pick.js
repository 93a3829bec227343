/** What is under a pixel of the 2D view: a joint or traced point before a body. */
import { moved } from "carriers";

const NEAR = 16;
/** Pixels. */

/**
 * @param {import("./skeleton.js").Skeleton} view
 * @returns {import("../state.js").Thing | null}
 */
export function thingAt(view, px, py) {
  const { payload, motion } = view.app;
  let best = null, nearest = NEAR;
  const look = (kind, name, place) => {
    const [x, y] = view.paper.pixel(...place), away = Math.hypot(x - px, y - py);
    if (away < nearest) [best, nearest] = [{ kind, name }, away];
  };
  for (const name in payload.joints) look("joint", name, motion.joint(name));
  for (const name in payload.points) look("point", name, motion.point(name));
  if (best) return best;
  const place = view.paper.place(px, py);
  for (const one of [...payload.skeleton.strokes].reverse()) {
    if (!one.closed || !one.ink.startsWith("body:")) continue;
    const points = moved(one.points, one, motion, view.first, payload.skeleton.times);
    if (inside(points, ...place)) return { kind: "body", name: one.ink.slice(5) };
  }
  return null;
}

function inside(points, x, y) {
  let odd = false;
  for (let k = 0, j = points.length - 2; k < points.length; j = k, k += 2) {
    const [ax, ay, bx, by] = [points[k], points[k + 1], points[j], points[j + 1]];
    if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) odd = !odd;
  }
  return odd;
}

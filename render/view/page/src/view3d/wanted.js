/** Which words and signs the 3D view shows at the moment. */
import { figures, written } from "../data/numbers.js";

/** @param {import("../app.js").App} app */
export function wantedLabels(app) {
  const { payload, motion, store } = app, { shown, selected } = store.state, out = [];
  const add = (kind, name, at = motion.spot(kind, name)) => out.push({ key: `${kind} ${name}`, text: name.replaceAll("_", " "), at, kind });
  if (shown.names) {
    for (const name in payload.joints) add("joint", name);
    for (const name in payload.points) add("point", name);
    for (const name in payload.bodies) if (payload.bodies[name].mass > 0) add("body", name);
  } else if (selected) {
    const at = app.spotOf(selected);
    if (at) add(selected.kind, selected.name, at);
  }
  if (shown.clearance) {
    for (const { at, gap, time, bodies, layers } of gaps(payload, motion)) {
      const act = time === null ? undefined : () => store.set({ playing: false, time });
      const now = time === null || Math.abs(time - motion.t) < NOW * (motion.end - motion.start);
      const moment = now ? "" : `, at ${figures(time, 3)} s`;
      const between = layers < gap ? `, ${written(layers, "m")} between layers` : "";
      out.push({ key: `gap ${bodies}`, text: `${written(gap, "m")} ${bodies.join(" – ")}${moment}${between}`.replaceAll("_", " "), at, kind: "gap", act });
    }
  }
  return out;
}

/** @param {import("../app.js").App} app */
export function wantedMarks(app) {
  const { payload, motion, store } = app, { shown, selected } = store.state, out = [];
  if (shown.centres) {
    for (const name in payload.bodies) if (payload.bodies[name].mass > 0) out.push({ kind: "centre", at: motion.spot("body", name) });
  }
  if (shown.names) for (const name in payload.joints) out.push({ kind: "joint", at: motion.spot("joint", name) });
  if (shown.clearance) for (const { at } of gaps(payload, motion)) out.push({ kind: "gap", at });
  const at = selected && app.spotOf(selected);
  if (at) out.push({ kind: "selected", at });
  return out;
}

const MOST = 6;
/** Part of the motion: nearer to its moment than this a gap is where it is told. */
const NOW = 2e-3;

/** The least gap of each pair of bodies that has a place, where it is now; layers: a lesser one all over faces. */
function gaps(payload, motion) {
  const seen = new Map(), layers = new Map();
  for (const pair of payload.clearance?.pairs ?? []) {
    const key = [...pair.bodies].sort().join(" ");
    if (!pair.at) {
      if (!seen.has(key) && !layers.has(key)) layers.set(key, pair.gap);
    } else if (!seen.has(key)) {
      const [x, y, z] = pair.at;
      seen.set(key, { ...pair, at: pair.on ? motion.where({ body: pair.on, x, y, z }) : pair.at, layers: layers.get(key) ?? Infinity });
    }
  }
  return [...seen.values()].slice(0, MOST);
}

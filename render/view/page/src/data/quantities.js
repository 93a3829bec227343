/**
 * What there is to plot of a thing: charts with a unit, curves with values at the payload's times.
 *
 * @typedef {{name: string, values: Float32Array, body?: string}} Line  of a body, whose colour it has
 * @typedef {{title: string, unit: string, lines: Line[]}} Chart
 * @typedef {{title: string, unit: string, crank: string, orders: Float32Array, sizes: Float32Array, body?: string}} Spectrum
 */
import { KINDS } from "./kinds.js";

/** Parts of the largest below which a curve is rounding; and what is rounding by itself, in SI units. */
const NOTHING = 1e-9, TINY = 1e-12;
/** Curves in one chart. */
const MOST = 6;

/** @param {import("./decode.js").Payload} payload  @param {import("../state.js").Thing | null} thing  @returns {Chart[]} */
export function chartsOf(payload, thing) {
  const one = thing && payload[KINDS[thing.kind]]?.[thing.name];
  const charts = one ? OF[thing.kind](one) : overview(payload);
  return charts.map((chart) => ({ ...chart, lines: chart.lines.filter((line) => line.values) })).filter((chart) => chart.lines.length);
}

/**
 * Harmonics against the crank: of the frame and the drivers for the whole machine, else of a driver or a joint with ground.
 *
 * @param {import("./decode.js").Payload} payload  @param {import("../state.js").Thing | null} thing  @returns {Spectrum[]}
 */
export function spectraOf(payload, thing) {
  const { frame, drivers } = payload;
  if (!frame?.harmonics) return [];
  const wanted = thing ? [thing.name] : ["shaking force", "shaking moment", "shaking couple", ...Object.keys(drivers)];
  if (thing && !["driver", "joint"].includes(thing.kind)) return [];
  return wanted.filter((name) => frame.harmonics[name]).map((name) => {
    const { unit, size } = frame.harmonics[name], words = thing ? (thing.kind === "joint" ? "the reaction" : "the effort") : name.startsWith("shaking") ? `the ${name}` : name;
    return { title: `Orders of ${words}`, unit, crank: frame.crank, orders: frame.order, sizes: size, body: thing || !drivers[name] ? undefined : acted(drivers[name]) };
  });
}

/** All things that have curves, by kind. @returns {import("../state.js").Thing[]} */
export function thingsOf(payload) {
  return Object.entries(KINDS).flatMap(([kind, key]) => Object.keys(payload[key]).map((name) => ({ kind, name })));
}

const chart = (title, unit, ...lines) => ({ title, unit, lines: lines.map(([name, values, body]) => ({ name, values, body })) });
/** The body that something acts on. */
const acted = ({ bodies = [] }) => bodies.findLast((body) => body !== "ground");

const OF = {
  joint: (one) => [
    chart("Reaction", "N", ...xyz(one, "f"), ["size", size(one, "f")]),
    ...some([one.torque], one.fx, one.fy) ? [chart("Reaction torque", "N m", ["torque", one.torque])] : [],
    ...some([one.mx, one.my, one.mz], one.fx, one.fy, one.fz) ? [chart("Moment", "N m", ...xyz(one, "m"))] : [],
    chart("Turn", "rad", ["turn", one.turn]),
    chart("Slide", "m", ["slide", one.slide]),
    chart("Place", "m", ...xyz(one, "")),
  ],
  body: (one) => [
    chart("Angle", "rad", ["angle", one.theta]),
    chart("Angular velocity", "rad/s", ["ω", one.omega], ...xyz(one, "w"), ["size", size(one, "w")]),
    chart("Angular acceleration", "rad/s²", ["α", one.alpha], ...xyz(one, "alpha")),
    chart("Place of its frame", "m", ...xyz(one, "")),
    chart("Velocity of its frame", "m/s", ...xyz(one, "v"), ["speed", size(one, "v")]),
    chart("Acceleration of its frame", "m/s²", ...xyz(one, "a")),
  ],
  driver: (one) => [
    chart(one.unit === "rad" ? "Torque" : "Force", one.effort_unit, ["effort", one.effort]),
    chart("Power", "W", ["power", one.power]),
    chart(one.unit === "rad" ? "Angle" : "Length", one.unit, ["value", one.value]),
  ],
  point: (one) => [
    chart("Speed", "m/s", ["speed", size(one, "v")], ...xyz(one, "v")),
    chart("Place", "m", ...xyz(one, "")),
    chart("Acceleration", "m/s²", ["size", size(one, "a")], ...xyz(one, "a")),
  ],
  force: (one) => [
    chart(one.unit === "rad" ? "Torque" : "Force", one.effort_unit, ["effort", one.effort]),
    chart("Force", "N", ...xyz(one, "f")),
    chart("Moment", "N m", ...xyz(one, "m")),
    chart(one.unit === "rad" ? "Angle" : "Length", one.unit, ["value", one.value]),
    chart("Power", "W", ["power", one.power]),
    ...some([one.potential]) ? [chart("Potential energy", "J", ["energy", one.potential])] : [],
  ],
  contact: (one) => [
    chart(one.unit === "rad" ? "Torque" : "Normal force", one.effort_unit, ["normal", one.normal], ["friction", one.friction]),
    chart("Gap", one.unit, ["gap", one.gap]),
  ],
};

/** Of the whole machine. */
function overview(payload) {
  const { drivers, points, energy, bodies, couple, frame } = payload, charts = [];
  for (const unit of ["N m", "N"]) {
    const lines = Object.entries(drivers).filter(([, one]) => one.effort_unit === unit && some([one.effort]));
    if (lines.length) charts.push(chart(unit === "N m" ? "Driving torque" : "Driving force", unit, ...lines.map(([name, one]) => [name, one.effort, acted(one)])));
  }
  const speeds = Object.entries(points).map(([name, one]) => [name, size(one, "v"), one.body]);
  charts.push(...several("Speed of traced points", "m/s", speeds));
  const spins = Object.entries(bodies).map(([name, one]) => [name, one.omega ?? size(one, "w"), name]).filter(([, values]) => some([values]));
  charts.push(...several("Angular velocities", "rad/s", spins));
  if (couple && some([couple.mx, couple.my])) charts.push(chart("Couple on the frame", "N m", ["about x", couple.mx], ["about y", couple.my]));
  if (frame && some([frame.fx, frame.fy])) charts.push(chart("Force of inertia on the frame", "N", ["x", frame.fx], ["y", frame.fy]));
  if (frame && (varies(frame.x) || varies(frame.y))) charts.push(chart("Centre of mass", "m", ["x", frame.x], ["y", frame.y]));
  if (some([energy.kinetic], energy.potential)) charts.push(chart("Energy", "J", ["kinetic", energy.kinetic], ["potential", energy.potential]));
  if (varies(payload.margin)) charts.push(chart("Distance from singular poses", "1", ["margin", payload.margin]));
  return charts;
}

/** All curves, in charts of a few each. */
function several(title, unit, lines) {
  const count = Math.ceil(lines.length / MOST), each = Math.ceil(lines.length / count);
  return Array.from({ length: count }, (_, k) => chart(count > 1 ? `${title} ${k + 1}/${count}` : title, unit, ...lines.slice(k * each, (k + 1) * each)));
}

/** Components of a vector, by the name that they begin with. */
const xyz = (one, name) => ["x", "y", "z"].map((axis) => [axis, one[name + axis]]);

function size(one, name) {
  const parts = xyz(one, name).map(([, values]) => values).filter(Boolean);
  return parts[0]?.map((_, k) => Math.hypot(...parts.map((values) => values[k])));
}

/** Whether a curve says more than one number. */
function varies(values) {
  const low = values.reduce((a, b) => Math.min(a, b), Infinity), high = values.reduce((a, b) => Math.max(a, b), -Infinity);
  return high - low > 1e-6 * Math.max(Math.abs(low), Math.abs(high));
}

/** Whether any of these is more than rounding beside the others. */
function some(series, ...beside) {
  const largest = (list) => list.reduce((top, values) => values ? values.reduce((a, b) => Math.max(a, Math.abs(b)), top) : top, 0);
  return largest(series) > Math.max(NOTHING * largest(beside), TINY);
}

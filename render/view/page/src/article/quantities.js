/** Series of the payload by the addresses of a text, and their words; render/article/quantities.py has the same rules. */
import { KINDS } from "../data/kinds.js";
import { live, written } from "../data/numbers.js";

const UNITS = { theta: "rad", omega: "rad/s", x: "m", y: "m", vx: "m/s", vy: "m/s", speed: "m/s", size: "N", fx: "N", fy: "N", torque: "N m", power: "W" };
const OWN = { value: "unit", gap: "unit", effort: "effort_unit", normal: "effort_unit" };
const SIZES = { size: ["fx", "fy"], speed: ["vx", "vy"] };
const TITLES = { theta: "Angle", omega: "Angular velocity", x: "Place", y: "Place", speed: "Speed", size: "Reaction", torque: "Torque", power: "Power", effort: "Effort", value: "Value", gap: "Gap", normal: "Normal force" };
const DIGITS = { now: 3, range: 2, most: 2 }, TURN = 2 * Math.PI;

/** @param {any} payload  @param {[string, string, string]} at kind, name and series  @returns {{values: Float32Array, unit: string} | null} */
export function seriesOf(payload, [kind, name, series]) {
  const thing = payload[KINDS[kind]]?.[name], parts = (SIZES[series] ?? [series]).map((part) => thing?.[part]);
  if (!parts.every((part) => part?.length)) return null;
  const values = parts.length === 1 ? parts[0] : Float32Array.from(parts[0], (x, k) => Math.hypot(x, parts[1][k]));
  return { values, unit: UNITS[series] ?? thing[OWN[series]] };
}

/** A chart of one series, as plots/chart.js takes it. */
export function chartOf(payload, at) {
  const found = seriesOf(payload, at), [kind, name, series] = at;
  if (!found) return null;
  const body = kind === "body" ? name : kind === "point" ? payload.points[name].body : undefined;
  return { title: `${TITLES[series] ?? series} of ${kind === "joint" || kind === "point" ? `${kind} ` : ""}${name.replaceAll("_", " ")}`, unit: found.unit, lines: [{ name: "", values: found.values, body }] };
}

/** The words of a quantity: of the moment, or of all the motion. @param {"now" | "range" | "most"} measure */
export function wordsOf({ values, unit }, measure, motion) {
  let low = Infinity, high = -Infinity;
  for (const value of values) [low, high] = [Math.min(low, value), Math.max(high, value)];
  const value = measure === "range" ? high - low : measure === "most" ? Math.max(-low, high) : motion.linear(values);
  if (unit === "rad") return degrees(measure === "now" && high - low > TURN ? value - TURN * Math.floor(value / TURN) : value);
  return (measure === "now" ? live([values], unit, DIGITS.now)(value) : written(value, unit, DIGITS[measure]));
}

/** Whole degrees. @param {number} angle rad */
export function degrees(angle) { return `${Math.round((angle * 360) / TURN) || 0}°`.replace("-", "−"); }

/**
 * Numbers with units as people write them: engineering prefixes, few digits, a true minus sign, no exponents. The rules
 * are those of mbsd/base/quantity.py; the cases in tests/shared/quantities.json hold both to the same answers.
 */
const PREFIXES = { "-12": "p", "-9": "n", "-6": "µ", "-3": "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T" };
const DOWN = ["m", "m/s", "s"];
const PLAIN = ["m/s²", "rad", "rad/s", "rad/s²", "°", "%", "cm³", "km/h", "rpm", "bar", "l/min", "1", ""];
const STEPS = {
  kg: [[1e3, 1e-3, "t"], [1, 1, "kg"], [0, 1e3, "g"]],
  "kg m²": [[0.01, 1, "kg·m²"], [0, 1e4, "kg·cm²"]],
};
const RAISED = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
const ANGLES = [1, 2, 5, 10, 15, 30, 45, 90, 180, 360];
const DIGITS = 4, LIVE = 6;

/** `12.3 mN`, `0 N`, `250 g`. @param {number} value SI  @param {string} unit */
export function written(value, unit, digits = 3) {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? `no number of ${dotted(unit)}` : `${value < 0 ? "−" : ""}∞ ${dotted(unit)}`.trim();
  const [factor, named] = prefixed(Number(Math.abs(value).toPrecision(digits)), unit);
  const kept = Math.abs(value * factor) < 1000 ? digits : Math.max(digits, DIGITS);
  return `${figures(value * factor, kept)}${named === "°" || named === "%" ? "" : " "}${named}`.trim();
}

/** The factor from SI, and the unit with its prefix. @param {number} largest  @returns {[number, string]} */
export function prefixed(largest, unit) {
  if (PLAIN.includes(unit) || !largest || !Number.isFinite(largest)) return [1, dotted(unit)];
  if (unit in STEPS) return STEPS[unit].find(([least]) => Math.abs(largest) >= least).slice(1);
  let power = Math.min(Math.max(3 * Math.floor(Math.log10(Math.abs(largest)) / 3 + 1e-9), -12), 12);
  if (DOWN.includes(unit)) power = Math.min(power, 0);
  return [10 ** -power, PREFIXES[power] + dotted(unit)];
}

/** A product of units with a dot: `N·m`. */
export const dotted = (unit) => unit.replaceAll(" ", "·");

/** So many significant digits, no exponent. @param {number} value */
export function figures(value, digits = DIGITS) {
  const number = Number(value.toPrecision(digits));
  if (!number) return "0";
  const power = Math.floor(Math.log10(Math.abs(number)) + 1e-12);
  if (power < -7 || power >= 7) {
    const mantissa = Number((number / 10 ** power).toPrecision(digits));
    return `${minus(String(mantissa))} × 10${[...String(power)].map((digit) => RAISED[digit]).join("")}`;
  }
  const text = number.toFixed(Math.max(digits - 1 - power, 0));
  return minus(text.includes(".") ? text.replace(/\.?0+$/, "") : text);
}

/** One prefix and as many decimals as the largest needs, so that numbers stand still. @param {Iterable<number>[]} series */
export function live(series, unit, digits = DIGITS) {
  let top = 0;
  for (const values of series) for (const value of values) if (Math.abs(value) > top) top = Math.abs(value);
  top = Number(top.toPrecision(digits));
  const [factor, named] = prefixed(top, unit);
  if (!top || !Number.isFinite(top)) return () => `0 ${named}`.trim();
  const decimals = Math.min(Math.max(digits - 1 - Math.floor(Math.log10(top * factor) + 1e-12), 0), LIVE);
  return (value) => {
    if (top * factor >= 1e7) return `${figures(value * factor, digits)} ${named}`.trim();
    const text = (value * factor).toFixed(decimals);
    return `${minus(Number(text) ? text : text.replace("-", ""))} ${named}`.trim();
  };
}

/** What an axis says: `force / kN`, `velocity / (m/s)`. */
export function labelled(words, unit) {
  if (!unit || unit === "1") return words;
  return /[/ ·]/.test(unit) ? `${words} / (${dotted(unit)})` : `${words} / ${unit}`;
}

/** Step of ticks (degrees) over a span of angle. */
export function angleStep(span, most = 9) {
  const step = ANGLES.find((one) => span / one <= most && (span < 180 || one >= 45));
  return step ?? 360 * Math.ceil(span / 360 / most);
}

const minus = (text) => text.replace("-", "−");

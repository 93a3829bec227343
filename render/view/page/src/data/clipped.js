/**
 * Where a chart is clipped: curves go to infinity near a singular pose and would leave nothing of the rest. The rule is
 * that of the plots (render/plots/measures.py).
 */
const PEAK = 12, KEPT = 3, USUAL = 0.9, NEAR = 0.05;

/**
 * @param {Float32Array[]} curves  @param {Float32Array | null} margin  how far each pose is from a singular one
 * @returns {{low: number, high: number, top: number} | null}
 */
export function clipped(curves, margin) {
  if (!margin?.length || !curves.length) return null;
  const sizes = Float32Array.from(margin, (_, k) => curves.reduce((most, values) => Math.max(most, Math.abs(values[k])), 0));
  const usual = part(sizes, USUAL);
  let top = 0;
  for (let k = 1; k < sizes.length; k++) if (sizes[k] > sizes[top]) top = k;
  if (!(usual > 0 && sizes[top] > PEAK * usual && margin[top] < NEAR * part(margin, 0.5))) return null;
  let low = 0, high = 0;
  for (const values of curves) for (const value of values) if (Math.abs(value) <= KEPT * usual) [low, high] = [Math.min(low, value), Math.max(high, value)];
  const room = 0.08 * (high - low);
  return { low: low - room, high: high + room, top: sizes[top] };
}

/** The value below which so large a part lies. */
function part(values, share) {
  const sorted = Float32Array.from(values).sort(), at = share * (sorted.length - 1), k = Math.floor(at);
  return sorted[k] + (at - k) * ((sorted[k + 1] ?? sorted[k]) - sorted[k]);
}

/** Numbers for people: as many decimals as the largest of a curve needs, so that they stand still. */

/** @param {Float32Array[]} series  @returns {(x: number) => string} */
export function writer(series) {
  let top = 0;
  for (const values of series) for (const value of values) if (Math.abs(value) > top) top = Math.abs(value);
  if (top < 1e-12) return () => "0"; // rounding
  if (top < 1e-3 || top >= 1e6) return (x) => (Math.abs(x) < 1e-6 * top ? "0" : sign(x.toExponential(2)));
  const digits = Math.min(Math.max(3 - Math.floor(Math.log10(top)), 0), 6);
  return (x) => sign((Math.abs(x) < 0.5 * 10 ** -digits ? 0 : x).toFixed(digits));
}

const sign = (text) => text.replace("-", "−");

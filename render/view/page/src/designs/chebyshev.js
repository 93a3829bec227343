/** Interpolation on a tensor grid of Chebyshev points, as studio/site/designs/table.py makes and checks it. */

/** What each node counts at x; the sum is 1. @param {number} x  @param {number[]} nodes  @returns {Float64Array} */
export function weights(x, nodes) {
  const out = new Float64Array(nodes.length), last = nodes.length - 1, near = 1e-14 * Math.abs(nodes[last] - nodes[0]);
  const hit = nodes.findIndex((node) => Math.abs(x - node) <= near);  // nearer, the quotients overflow
  if (hit >= 0) {
    out[hit] = 1;
    return out;
  }
  let sum = 0;
  for (let k = 0; k <= last; k++) sum += out[k] = ((k % 2 ? -1 : 1) * (k === 0 || k === last ? 0.5 : 1)) / (x - nodes[k]);
  return out.map((raw) => raw / sum);
}

/** What each design of the grid counts, the last axis running fastest. @param {number[]} place  @param {number[][]} axes */
export function tensorWeights(place, axes) {
  let out = Float64Array.of(1);
  place.forEach((x, axis) => {
    const along = weights(x, axes[axis]), wider = new Float64Array(out.length * along.length);
    for (let j = 0; j < out.length; j++) for (let k = 0; k < along.length; k++) wider[j * along.length + k] = out[j] * along[k];
    out = wider;
  });
  return out;
}

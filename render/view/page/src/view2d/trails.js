/** Paths of traced points: faint over the whole motion, bright behind the point as far as its tail. */

const PIECES = 90;

/**
 * @param {CanvasRenderingContext2D} g  @param {import("./paper.js").Paper} paper
 * @param {import("../data/decode.js").Payload} payload  @param {import("../data/motion.js").Motion} motion
 */
export function drawTrails(g, paper, payload, motion, colour) {
  g.lineJoin = g.lineCap = "round";
  for (const { point, tail } of payload.trails) {
    const { x, y, z } = payload.points[point];
    g.beginPath();
    for (let k = 0; k < x.length; k++) g.lineTo(...paper.pixel(...motion.flat([x[k], y[k], z?.[k]])));
    g.strokeStyle = colour;
    g.globalAlpha = 0.28;
    g.lineWidth = 1.4;
    g.stroke();
    const places = tailOf(payload, motion, tail, PIECES, () => motion.point(point)).map((place) => paper.pixel(...place));
    g.lineWidth = 2.6;
    for (let k = 1; k < places.length; k++) {
      g.globalAlpha = 0.95 * (1 - k / places.length) ** 1.3;
      g.beginPath();
      g.moveTo(...places[k - 1]);
      g.lineTo(...places[k]);
      g.stroke();
    }
    g.globalAlpha = 1;
  }
}

/** Places (m) from now back to the end of the tail; of a motion that does not repeat it grows from the start. @param {() => number[]} at */
export function tailOf(payload, motion, tail, count, at) {
  const now = motion.t, { start, end, turns } = payload.clock, span = end - start;
  const repeats = payload.period !== null;
  const length = repeats ? (tail * span) / turns : Math.min(tail * span, now - start);
  const out = [];
  for (let k = 0; k < count; k++) {
    const back = now - (length * k) / (count - 1) - start;
    motion.to(start + (repeats ? ((back % span) + span) % span : Math.max(back, 0)));
    out.push(at());
  }
  motion.to(now);
  return out;
}

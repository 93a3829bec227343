/** Names beside their places: each on the side with the most room, none over another. */

const WAYS = [[1, -1], [1, 1], [-1, -1], [-1, 1], [0, -1], [0, 1], [1, 0], [-1, 0]];

/**
 * @param {CanvasRenderingContext2D} g
 * @param {{text: string, x: number, y: number, off: number, colour: string}[]} names in pixels
 * @param {string} paper colour behind the letters
 */
export function writeNames(g, names, paper) {
  g.font = "500 13px system-ui, sans-serif";
  g.textBaseline = "middle";
  const taken = [];
  for (const { text, x, y, off, colour } of names) {
    const w = g.measureText(text).width, h = 16;
    let best = null;
    for (const [a, b] of WAYS) {
      const reach = off + 4;
      const left = a > 0 ? x + reach * (b ? 0.75 : 1) : a < 0 ? x - w - reach * (b ? 0.75 : 1) : x - w / 2;
      const top = b > 0 ? y + reach * (a ? 0.75 : 1) : b < 0 ? y - h - reach * (a ? 0.75 : 1) : y - h / 2;
      const cost = taken.reduce((sum, o) => sum + overlap(left, top, w, h, o), 0)
        + names.filter((o) => o.x > left - 6 && o.x < left + w + 6 && o.y > top - 6 && o.y < top + h + 6).length * 60;
      if (!best || cost < best.cost - 1e-9) best = { cost, left, top };
    }
    taken.push([best.left, best.top, w, h]);
    g.lineWidth = 4;
    g.lineJoin = "round";
    g.strokeStyle = paper;
    g.strokeText(text, best.left, best.top + h / 2);
    g.fillStyle = colour;
    g.fillText(text, best.left, best.top + h / 2);
  }
}

function overlap(x, y, w, h, [a, b, c, d]) {
  return Math.max(0, Math.min(x + w, a + c) - Math.max(x, a)) * Math.max(0, Math.min(y + h, b + d) - Math.max(y, b));
}

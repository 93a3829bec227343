/** A quiet grid with a scale, so that the plane has a size. */
import { written } from "../data/numbers.js";

const APART = 76;
/** Pixels between two lines, at least. */
const NARROW = 480;
/** Pixels of a plane whose scale stands above, where the legend of arrows is not. */

/** @param {CanvasRenderingContext2D} g  @param {import("./paper.js").Paper} paper */
export function drawGrid(g, paper, colours) {
  const step = roundAbove(APART / paper.scale);
  const [left, top] = paper.place(0, 0), [right, bottom] = paper.place(paper.width, paper.height);
  g.strokeStyle = colours.grid;
  g.lineWidth = 1;
  g.beginPath();
  for (let k = Math.ceil(left / step); k * step <= right; k++) {
    const x = Math.round(paper.pixel(k * step, 0)[0]) + 0.5;
    g.moveTo(x, 0);
    g.lineTo(x, paper.height);
  }
  for (let k = Math.ceil(bottom / step); k * step <= top; k++) {
    const y = Math.round(paper.pixel(0, k * step)[1]) + 0.5;
    g.moveTo(0, y);
    g.lineTo(paper.width, y);
  }
  g.stroke();
  const x = paper.width - paper.free[1] - 18, y = paper.width < NARROW ? paper.free[0] + 30 : paper.height - paper.free[2] - 18, length = step * paper.scale;
  g.strokeStyle = g.fillStyle = colours.quiet;
  g.lineWidth = 1.5;
  g.beginPath();
  g.moveTo(x - length, y - 4);
  g.lineTo(x - length, y);
  g.lineTo(x, y);
  g.lineTo(x, y - 4);
  g.stroke();
  g.font = "12px system-ui, sans-serif";
  g.textAlign = "center";
  g.textBaseline = "bottom";
  g.fillText(written(step, "m"), x - length / 2, y - 4);
  g.textAlign = "left";
}

function roundAbove(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].find((step) => step * power >= value * (1 - 1e-9)) * power;
}

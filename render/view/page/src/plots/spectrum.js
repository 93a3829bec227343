/** Harmonics against the crank as bars: how large each order is, with the largest in words. */
import uPlot from "uplot";
import { figures, prefixed, written } from "../data/numbers.js";
import { charted } from "../ui/canvases.js";
import { el } from "../ui/dom.js";
import { AXIS, HEIGHT } from "./chart.js";

/** Orders below this part of the largest are left out at the end; so many are shown at most, and so many named. */
const LEAST = 2e-3, MOST = 24, NAMED = 3;
const BAR = uPlot.paths.bars({ size: [0.6, 26] });

export class Spectrum {
  /**
   * @param {HTMLElement} parent  @param {import("../data/quantities.js").Spectrum} spectrum
   * @param {{ink: string, quiet: string, grid: string, line: (line: object, k: number) => string}} colours
   */
  constructor(parent, spectrum, colours) {
    const ink = colours.line(spectrum, 0);
    this.unit = el("small");
    this.named = el("div", { class: "values" });
    this.box = el("figure", { class: "chart spectrum" }, el("figcaption", {}, el("h3", {}, spectrum.title, " ", this.unit), this.named));
    parent.append(this.box);
    this.of(spectrum);
    this.plot = charted(() => new uPlot({
      width: Math.max(parent.clientWidth - 28, 200), height: HEIGHT, legend: { show: false }, cursor: { show: false },
      padding: [6, 12, 0, 0],
      scales: { x: { time: false, range: () => [0, this.last + this.step] }, y: { range: (_, low, high) => [0, high > 0 ? 1.08 * high : 1] } },
      axes: [
        { font: AXIS, stroke: colours.quiet, grid: { show: false }, ticks: { show: false }, size: 24, gap: 4, space: 24, values: (_, ticks) => ticks.map((tick) => (tick > 0 ? figures(tick) : "")) },
        { font: AXIS, stroke: colours.quiet, grid: { stroke: colours.grid, width: 1 }, ticks: { show: false }, size: 54, gap: 4, space: 30, values: (_, ticks) => ticks.map((tick) => figures(tick * this.factor)) },
      ],
      series: [{}, { label: spectrum.title, stroke: ink, fill: ink, width: 0, paths: BAR, points: { show: false } }],
    }, this.data, this.box));
  }

  /** @param {import("../data/quantities.js").Spectrum} spectrum */
  of(spectrum) {
    const { orders, sizes, unit, crank } = spectrum, top = sizes.reduce((a, b) => Math.max(a, b), 0);
    let count = sizes.length;
    while (count > 1 && !(sizes[count - 1] > LEAST * top)) count--;
    count = Math.min(count, MOST);
    this.data = [Array.from(orders.slice(0, count)), Array.from(sizes.slice(0, count))];
    this.last = orders[count - 1];
    this.step = orders.length > 1 ? orders[1] - orders[0] : 1;
    const [factor, name] = prefixed(top, unit);
    this.factor = factor;
    this.unit.textContent = `/ ${name} against the order of ${crank.replaceAll("_", " ")}`;
    const largest = Array.from(sizes.keys()).filter((k) => sizes[k] > LEAST * top).sort((a, b) => sizes[b] - sizes[a]).slice(0, NAMED);
    this.named.replaceChildren(...largest.map((k) => el("span", {}, `order ${figures(orders[k])} `, el("b", {}, written(sizes[k], unit)))));
  }

  /** The same quantity of another motion. @param {import("../data/quantities.js").Spectrum} spectrum */
  take(spectrum) {
    this.of(spectrum);
    this.plot.setData(this.data);
  }

  resize(width) { this.plot.setSize({ width, height: HEIGHT }); }

  remove() { this.plot.destroy(); this.box.remove(); }
}

/** One chart: curves over time, the moment as a line that can be dragged, values of the moment beside the names. */
import "./language.js";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { clipped } from "../data/clipped.js";
import { angleStep, figures, live, prefixed, written } from "../data/numbers.js";
import { charted } from "../ui/canvases.js";
import { el } from "../ui/dom.js";

export const HEIGHT = 148;
/** SI: less is rounding. */
const NOTHING = 1e-12;
export const AXIS = "12px system-ui, sans-serif";

export class Chart {
  /**
   * @param {HTMLElement} parent  @param {import("../app.js").App} app  @param {import("../data/quantities.js").Chart} chart
   * @param {{ink: string, quiet: string, grid: string, driver: string, line: (line: object, k: number) => string}} colours
   * @param {number} height in pixels
   */
  constructor(parent, app, chart, colours, height = HEIGHT) {
    this.app = app;
    this.height = height;
    this.unit = el("small");
    this.clipping = el("small", { class: "cut" });
    this.of(chart);
    const own = chart.lines.map((line, k) => colours.line(line, k));
    this.values = own.map((ink) => el("b", { style: `color:${ink}` }));
    const names = chart.lines.length > 1 ? chart.lines.map((line) => line.name.replaceAll("_", " ")) : [""];
    const legend = el("div", { class: "values" }, ...names.map((name, k) => el("span", {}, el("i", { style: `background:${own[k]}` }), name ? `${name} ` : "", this.values[k])));
    this.line = el("div", { class: "moment" });
    const head = el("h3", {}, chart.title, " ", this.unit, this.clipping);
    this.box = el("figure", { class: "chart" }, el("figcaption", {}, head, legend));
    parent.append(this.box);
    this.plot = charted(() => new uPlot({
      width: Math.max(parent.clientWidth - 28, 200), height, legend: { show: false }, cursor: { show: false },
      padding: [6, 12, 0, 0],
      scales: { x: { time: false, range: () => [app.clock.start, app.clock.end] }, y: { range: (u, low, high) => this.cut ? [this.cut.low, this.cut.high] : room(u, low, high) } },
      axes: [
        { font: AXIS, stroke: colours.quiet, grid: { stroke: colours.grid, width: 1 }, ticks: { show: false }, size: 24, gap: 4, space: 60, values: (_, ticks) => ticks.map((tick) => figures(tick)) },
        { font: AXIS, stroke: colours.quiet, grid: { stroke: colours.grid, width: 1 }, ticks: { show: false }, size: 54, gap: 4, space: 30, ...this.shown.axis, values: (u, ticks) => this.shown.axis.values(u, ticks) },
      ],
      series: [{}, ...chart.lines.map((line, k) => ({ label: line.name, stroke: own[k], width: 2, dash: dashOf(own, k), points: { show: false } }))],
      hooks: { draw: [(u) => marks(u, app.payload.marks, colours)] },
    }, [app.payload.time, ...chart.lines.map((line) => line.values)], this.box));
    this.plot.over.append(this.line);
    this.plot.over.style.cursor = "ew-resize";
    this.drag();
    this.cursor();
  }

  of(chart) {
    const curves = chart.lines.map((line) => line.values);
    this.chart = chart;
    this.shown = measure(chart.unit, curves);
    this.cut = chart.unit === "rad" ? null : clipped(curves, this.app.payload.margin);
    this.write = this.shown.write;
    this.unit.textContent = this.shown.unit ? `/ ${this.shown.unit}` : "";
    this.clipping.textContent = this.cut ? ` clipped: up to ${written(this.cut.top, chart.unit)} near a singular pose` : "";
  }

  /** The same curves of another motion. @param {import("../data/quantities.js").Chart} chart */
  take(chart) {
    this.of(chart);
    this.plot.setData([this.app.payload.time, ...chart.lines.map((line) => line.values)]);
  }

  /** A drag moves the machine. */
  drag() {
    const { over } = this.plot, go = (event) => {
      const time = this.plot.posToVal(event.clientX - over.getBoundingClientRect().left, "x");
      this.app.store.set({ playing: false, time: Math.min(Math.max(time, this.app.clock.start), this.app.clock.end) });
    };
    over.addEventListener("pointerdown", (event) => {
      if (event.button) return;
      over.setPointerCapture(event.pointerId);
      go(event);
    });
    over.addEventListener("pointermove", (event) => over.hasPointerCapture(event.pointerId) && go(event));
  }

  resize(width) { this.plot.setSize({ width, height: this.height }); this.cursor(); }

  cursor() {
    const { motion } = this.app;
    this.line.style.transform = `translateX(${this.plot.valToPos(motion.t, "x").toFixed(1)}px)`;
    this.chart.lines.forEach((line, k) => { this.values[k].textContent = this.write(motion.linear(line.values)); });
  }

  remove() { this.plot.destroy(); this.box.remove(); }
}

/** Lines of one body differ by their dashes. */
const DASHES = [undefined, [7, 4], [2, 3], [9, 3, 2, 3]];
const dashOf = (own, k) => DASHES[own.slice(0, k).filter((ink) => ink === own[k]).length % DASHES.length];

/** Room above and below; a curve that is constant but for rounding is a straight line. */
function room(_, low, high) {
  if (low === null || high === null) return [-1, 1];
  const middle = (low + high) / 2, least = Math.max(Math.abs(middle) * 2e-4, 1e-9), half = Math.max((high - low) / 2, least);
  return half === least ? [middle - Math.max(Math.abs(middle), 1e-6), middle + Math.max(Math.abs(middle), 1e-6)] : [middle - 1.1 * half, middle + 1.1 * half];
}

/** How a chart's numbers are written: with one prefix, angles in degrees with ticks by parts of a right angle. */
function measure(unit, curves) {
  if (unit === "rad") {
    const turn = 180 / Math.PI, write = live(curves.map((values) => values.map((value) => value * turn)), "°");
    const splits = (u, axis, low, high) => {
      const step = angleStep((high - low) * turn, 5), out = [];
      for (let k = Math.ceil((low * turn) / step); k * step <= high * turn + 1e-9; k++) out.push((k * step) / turn);
      return out;
    };
    return { unit: "°", write: (value) => write(value * turn), axis: { splits, values: (_, ticks) => ticks.map((tick) => figures(tick * turn)) } };
  }
  const top = curves.reduce((most, values) => values.reduce((a, b) => Math.max(a, Math.abs(b)), most), 0), plain = unit === "1" ? "" : unit;
  const [factor, named] = top < NOTHING ? [1, plain] : prefixed(top, plain);
  return { unit: named, write: top < NOTHING ? () => `0 ${plain}`.trim() : live(curves, plain), axis: { values: (_, ticks) => ticks.map((tick) => figures(tick * factor)) } };
}

/** Events and dead points. */
function marks(u, list, colours) {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([2 * devicePixelRatio, 3 * devicePixelRatio]);
  for (const { time, kind } of list) {
    const x = Math.round(u.valToPos(time, "x", true)) + 0.5;
    ctx.strokeStyle = kind === "dead point" ? colours.driver : colours.quiet;
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
  }
  ctx.restore();
}

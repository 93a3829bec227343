/** One chart: curves over time, the moment as a line that can be dragged, values of the moment beside the names. */
import "./language.js";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { writer } from "../data/numbers.js";
import { el } from "../ui/dom.js";

export const HEIGHT = 148;
const AXIS = "12px system-ui, sans-serif";

export class Chart {
  /**
   * @param {HTMLElement} parent  @param {import("../app.js").App} app  @param {import("../data/quantities.js").Chart} chart
   * @param {{ink: string, quiet: string, grid: string, driver: string, body: (k: number) => string}} colours
   */
  constructor(parent, app, chart, colours) {
    this.app = app;
    this.chart = chart;
    this.write = writer(chart.lines.map((line) => line.values));
    this.values = chart.lines.map((_, k) => el("b", { style: `color:${colours.body(k)}` }));
    const names = chart.lines.length > 1 ? chart.lines.map((line) => line.name.replaceAll("_", " ")) : [""];
    const legend = el("div", { class: "values" }, ...names.map((name, k) => el("span", {}, el("i", { style: `background:${colours.body(k)}` }), name ? `${name} ` : "", this.values[k])));
    this.line = el("div", { class: "moment" });
    const head = el("h3", {}, chart.title, " ", el("small", {}, chart.unit === "1" ? "" : chart.unit));
    this.box = el("figure", { class: "chart" }, el("figcaption", {}, head, legend));
    parent.append(this.box);
    const { payload } = app;
    this.plot = new uPlot({
      width: Math.max(parent.clientWidth - 28, 200), height: HEIGHT, legend: { show: false }, cursor: { show: false },
      padding: [6, 12, 0, 0],
      scales: { x: { time: false, range: [app.clock.start, app.clock.end] }, y: { range: room } },
      axes: [
        { font: AXIS, stroke: colours.quiet, grid: { stroke: colours.grid, width: 1 }, ticks: { show: false }, size: 24, gap: 4, space: 60, values: (_, ticks) => shortest(ticks) },
        { font: AXIS, stroke: colours.quiet, grid: { stroke: colours.grid, width: 1 }, ticks: { show: false }, size: 54, gap: 4, space: 30, values: (_, ticks) => shortest(ticks) },
      ],
      series: [{}, ...chart.lines.map((line, k) => ({ label: line.name, stroke: colours.body(k), width: 2, points: { show: false } }))],
      hooks: { draw: [(u) => marks(u, payload.marks, colours)] },
    }, [payload.time, ...chart.lines.map((line) => line.values)], this.box);
    this.plot.over.append(this.line);
    this.plot.over.style.cursor = "ew-resize";
    this.drag();
    this.cursor();
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

  resize(width) { this.plot.setSize({ width, height: HEIGHT }); this.cursor(); }

  cursor() {
    const { motion } = this.app;
    this.line.style.transform = `translateX(${this.plot.valToPos(motion.t, "x").toFixed(1)}px)`;
    this.chart.lines.forEach((line, k) => { this.values[k].textContent = `${this.write(motion.linear(line.values))}${this.chart.unit === "1" ? "" : ` ${this.chart.unit}`}`; });
  }

  remove() { this.plot.destroy(); this.box.remove(); }
}

/** Room above and below; a curve that is constant but for rounding is a straight line. */
function room(_, low, high) {
  if (low === null || high === null) return [-1, 1];
  const middle = (low + high) / 2, least = Math.max(Math.abs(middle) * 2e-4, 1e-9), half = Math.max((high - low) / 2, least);
  return half === least ? [middle - Math.max(Math.abs(middle), 1e-6), middle + Math.max(Math.abs(middle), 1e-6)] : [middle - 1.1 * half, middle + 1.1 * half];
}

function shortest(ticks) {
  const top = Math.max(...ticks.map(Math.abs));
  if (top && (top < 1e-3 || top >= 1e5)) return ticks.map((tick) => (tick ? Number(tick.toPrecision(3)).toExponential().replace("e+", "e") : "0").replaceAll("-", "−"));
  return ticks.map((tick) => String(Number(tick.toPrecision(6))).replace("-", "−"));
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

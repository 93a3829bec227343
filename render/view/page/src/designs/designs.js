/**
 * Sliders without a server: motions of designs on a grid are in the page, and what is between them is their polynomial.
 * What the table holds is told in studio/site/designs/table.py.
 */
import { written } from "../data/numbers.js";
import { anchors, raised, stretches } from "../live/stretched.js";
import { Sliders } from "../live/sliders.js";
import { el } from "../ui/dom.js";
import { tensorWeights } from "./chebyshev.js";

const STEPS = 65535;

export class Designs {
  /** @param {import("../data/decode.js").Payload} table */
  constructor(table) {
    this.table = table;
    this.values = {};
  }

  /** Take the page whose numbers are moved. @param {import("../app.js").App} app */
  attach(app) {
    this.app = app;
    this.own = app.payload;
    this.design = anchors(app.payload);
  }

  /** @param {import("../app.js").App} app */
  mounted(app) {
    this.attach(app);
    this.sliders = new Sliders((values) => this.move(values), (held) => app.hold(held));
    const exact = el("p", { class: "exact" }, `Between stored motions: places within ${written(this.table.places, "m")} of a solution, efforts within ${Math.max(0.01, 100 * this.table.efforts).toPrecision(2)} % of the largest.`);
    app.slot.replaceChildren(el("section", { class: "live", "aria-label": "Numbers of the machine" },
      el("div", { class: "line" }, el("h2", {}, "Move a number"), el("span", { class: "state" })), this.sliders.element, exact));
    this.sliders.take(this.table.numbers, {});
  }

  /** @param {Record<string, number>} values */
  move(values) {
    for (const { name, value, low, high } of this.table.numbers) {
      if (!(name in values)) continue;
      const now = Math.min(Math.max(values[name], low), high);
      if (now === value) delete this.values[name];
      else this.values[name] = now;
    }
    this.sliders?.show(this.values);
    const { app } = this;
    if (!Object.keys(this.values).length) return void app.update({ ...this.own, other: null });
    const patch = this.between();
    patch.marks = patch.insights = [];
    patch.trails = this.own.trails;
    patch.clearance = patch.frame = patch.couple = null;
    patch.other = null;
    if (this.own.solid) {
      raised(patch, this.own);
      patch.other = stretches(this.design, anchors({ ...this.own, ...patch }));
    }
    app.update(patch);
  }

  /** The payload of the numbers as they are now. */
  between() {
    const { numbers, nodes, form, low, span, used, codes } = this.table, count = used.length, all = Float64Array.from(low);
    const counts = tensorWeights(numbers.map(({ name, value }) => this.values[name] ?? value), nodes), sums = new Float64Array(count);
    counts.forEach((weight, design) => {
      if (!weight) return;
      const from = design * count;
      for (let k = 0; k < count; k++) sums[k] += weight * codes[from + k];
    });
    for (let k = 0; k < count; k++) all[used[k]] += (span[k] / STEPS) * sums[k];
    let at = 0;
    const filled = (value) => {
      if (Array.isArray(value)) return value.map(filled);
      if (!value || typeof value !== "object") return value;
      if (!("#" in value)) return Object.fromEntries(Object.keys(value).map((key) => [key, filled(value[key])]));
      const { "#": length } = value, from = at;
      if (length === null) return all[at++];
      at += length;
      return (value.double ? Float64Array : Float32Array).from(all.subarray(from, at));
    };
    return filled(form);
  }
}

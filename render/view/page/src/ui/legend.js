/** The scale of arrows and arcs, as long as those in the picture; one for the whole motion. */
import { QUANTITIES } from "../view2d/inks.js";
import { el } from "./dom.js";

export class Legend {
  /** @param {import("../app.js").App} app */
  constructor(app) {
    this.app = app;
    this.key = "";
  }

  draw() {
    const { payload, store, stage } = this.app, { shown } = store.state, { arrows, arcs } = payload;
    const scale = stage.shown.pixelsPerMetre?.() ?? this.app.stage.plane.paper.scale;
    const colours = QUANTITIES[this.app.dark ? "dark" : "light"], rows = [];
    const quantities = [...new Set([...arrows.list, ...arcs.list].map((one) => one.quantity))].filter((one) => shown[one]);
    for (const quantity of quantities) {
      const units = new Set(arrows.list.filter((one) => one.quantity === quantity).map((one) => one.unit));
      for (const unit of units) {
        const one = arrows.scales[unit];
        if (one) rows.push({ quantity, words: one.words, length: (arrows.full * one.reference / one.largest) * scale, cut: one.cut });
      }
      if (arcs.scale && arcs.list.some((one) => one.quantity === quantity)) {
        rows.push({ quantity, words: arcs.scale.words, sweep: arcs.full * arcs.scale.reference / arcs.scale.largest, cut: arcs.scale.cut });
      }
    }
    const key = JSON.stringify([rows.map((row) => [row, Math.round(row.length ?? 0)]), this.app.dark]);
    if (key === this.key) return;
    this.key = key;
    this.app.parts.legend.replaceChildren(...rows.map((row) => {
      const name = row.sweep ? (row.quantity === "forces" ? "torques" : "torques of joints") : row.quantity;
      return el("div", { class: "row", style: `color:${colours[row.quantity]}` },
        row.sweep ? arc(row.sweep) : arrow(Math.min(Math.max(row.length, 12), 150)),
        el("b", {}, row.words), el("span", {}, row.cut ? `${name}, peaks cut` : name));
    }));
  }
}

function arrow(length) {
  return el("svg:svg", { width: length, height: 12, viewBox: `0 0 ${length} 12` },
    el("svg:path", { d: `M0 6H${length - 9}`, stroke: "currentColor", "stroke-width": 2.6 }),
    el("svg:path", { d: `M${length} 6l-11-4.4v8.8z`, fill: "currentColor" }));
}

function arc(sweep) {
  const r = 8, x = 11 + r * Math.cos(sweep), y = 11 - r * Math.sin(sweep);
  return el("svg:svg", { width: 22, height: 22, viewBox: "0 0 22 22" },
    el("svg:path", { d: `M${11 + r} 11A${r} ${r} 0 ${sweep > Math.PI ? 1 : 0} 0 ${x} ${y}`, stroke: "currentColor", "stroke-width": 2.6, fill: "none" }),
    el("svg:circle", { cx: x, cy: y, r: 3.2, fill: "currentColor" }));
}

/** The scale of arrows and arcs, as long as those in the picture; one for the whole motion. */
import { arcOutlines, arrowOutlines } from "../view2d/arrows.js";
import { HEADS, QUANTITIES } from "../view2d/inks.js";
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
    for (const { row, unit } of unique(arrows.list.filter((one) => shown[one.quantity]), (one) => `${one.row} ${one.unit}`)) {
      const one = arrows.scales[unit];
      if (one) rows.push({ row, name: row, words: one.words, length: (arrows.full * one.reference / one.largest) * scale, cut: one.cut });
    }
    for (const { row, quantity } of arcs.scale ? unique(arcs.list.filter((one) => shown[one.quantity]), (one) => one.quantity) : []) {
      const { words, cut } = arcs.scale, name = quantity === "forces" ? "torques" : "torques of joints";
      rows.push({ row, name, words, sweep: (arcs.full * arcs.scale.reference) / arcs.scale.largest, cut });
    }
    const key = JSON.stringify([rows.map((row) => [row, Math.round(row.length ?? 0)]), this.app.dark]);
    if (key === this.key) return;
    this.key = key;
    this.app.parts.legend.replaceChildren(...rows.map(({ row, name, words, length, sweep, cut }) => el("div", { class: "row", style: `color:${colours[row]}` },
      sweep ? arc(sweep) : arrow(Math.min(Math.max(length, 16), 150), HEADS[row]), el("b", {}, words), el("span", {}, cut ? `${name}, peaks cut` : name))));
  }
}

const unique = (list, key) => [...new Map(list.map((one) => [key(one), one])).values()];
const path = (corners, x, y) => `M${corners.map(([u, v]) => `${(x + u).toFixed(2)} ${(y - v).toFixed(2)}`).join("L")}z`;

function arrow(length, head) {
  const d = arrowOutlines(length, head).map((corners) => path(corners, 0, 7));
  return el("svg:svg", { width: length, height: 14, viewBox: `0 0 ${length} 14` }, ...d.map((one) => el("svg:path", { d: one, fill: "currentColor" })));
}

function arc(sweep) {
  const d = arcOutlines(11, sweep).map((corners) => path(corners, 15, 15));
  return el("svg:svg", { width: 30, height: 24, viewBox: "0 2 30 26" }, ...d.map((one) => el("svg:path", { d: one, fill: "currentColor" })));
}

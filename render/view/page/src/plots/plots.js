/** The side panel: which thing is chosen, and its curves under the same cursor. */
import { chartsOf, thingsOf } from "../data/quantities.js";
import { same } from "../state.js";
import { el } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { inks } from "../view2d/inks.js";
import { Chart } from "./chart.js";
import { csv, download } from "./csv.js";

const WORDS = { joint: "Joints", body: "Bodies", driver: "Drivers", point: "Points", force: "Forces", contact: "Contacts" };

export class Plots {
  /** @param {import("../app.js").App} app */
  constructor(app) {
    this.app = app;
    this.made = [];
    this.choice = el("select", { class: "choice", "aria-label": "Curves of", onchange: () => app.store.set({ selected: this.choice.value ? this.things[Number(this.choice.value)] : null }) });
    const save = el("button", { type: "button", class: "round", title: "Save these curves as CSV (s)", "aria-label": "Save these curves as CSV", onclick: () => this.save() }, icon("save"));
    this.marks = el("p", { class: "happens" });
    this.list = el("div", { class: "charts" });
    app.parts.side.append(el("div", { class: "choose" }, this.choice, save), this.marks, this.list);
    app.store.on(["selected", "theme"], () => this.update());
    app.themes.changed = () => this.update();
    new ResizeObserver(() => this.resize()).observe(this.list);
    this.update();
  }

  update() {
    const { payload, store } = this.app, { selected } = store.state, colours = inks(this.app.dark, payload.bodies);
    this.options();
    for (const chart of this.made) chart.remove();
    this.charts = chartsOf(payload, selected);
    this.made = this.charts.map((chart) => new Chart(this.list, this.app, chart, colours));
    this.marks.replaceChildren(...payload.marks.slice(0, 8).map(({ time, words, kind }) => el("button", {
      type: "button", class: "mark", "data-kind": kind, onclick: () => store.set({ playing: false, time }),
    }, `${words.replaceAll("_", " ")} `, el("b", {}, `${Number(time.toPrecision(4))} s`))));
    this.marks.hidden = !payload.marks.length;
  }

  options() {
    const { payload, store } = this.app;
    this.things = thingsOf(payload);
    const groups = Object.entries(WORDS).map(([kind, words]) => {
      const ours = this.things.map((thing, k) => [thing, k]).filter(([thing]) => thing.kind === kind);
      return ours.length ? el("optgroup", { label: words }, ...ours.map(([thing, k]) => el("option", { value: k }, thing.name.replaceAll("_", " ")))) : null;
    });
    this.choice.replaceChildren(el("option", { value: "" }, "The whole machine"), ...groups.filter(Boolean));
    const at = this.things.findIndex((thing) => same(thing, store.state.selected));
    this.choice.value = at < 0 ? "" : String(at);
  }

  resize() {
    const width = Math.max(this.list.clientWidth - 28, 200);
    if (width === this.width) return;
    this.width = width;
    for (const chart of this.made) chart.resize(width);
  }

  cursor() { for (const chart of this.made) chart.cursor(); }

  save() {
    const { payload, store } = this.app, { selected } = store.state;
    const name = [payload.mechanism, selected?.name].filter(Boolean).join("-").replaceAll("/", "_");
    download(csv(payload.time, this.charts, selected ? `${selected.kind} ${selected.name}` : ""), `${name}.csv`);
  }
}

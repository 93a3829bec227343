/** The side panel: which thing is chosen, and its curves under the same cursor. */
import { figures } from "../data/numbers.js";
import { chartsOf, spectraOf, thingsOf } from "../data/quantities.js";
import { same } from "../state.js";
import { el } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { inks } from "../view2d/inks.js";
import { Chart } from "./chart.js";
import { csv, download } from "./csv.js";
import { Spectrum } from "./spectrum.js";

const WORDS = { joint: "Joints", body: "Bodies", driver: "Drivers", point: "Points", force: "Forces", contact: "Contacts" };

const FEW = 8;
/** Marks that are shown without being asked for. */

export class Plots {
  /** @param {import("../app.js").App} app */
  constructor(app) {
    this.app = app;
    this.made = [];
    this.spectra = [];
    this.choice = el("select", { class: "choice", "aria-label": "Curves of", onchange: () => app.store.set({ selected: this.choice.value ? this.things[Number(this.choice.value)] : null }) });
    const save = el("button", { type: "button", class: "round", title: "Save these curves as CSV (s)", "aria-label": "Save these curves as CSV", onclick: () => this.save() }, icon("save"));
    this.insights = el("ul", { class: "insights", "aria-label": "What it shows" });
    this.marks = el("p", { class: "happens" });
    this.list = el("div", { class: "charts" });
    app.parts.side.append(el("div", { class: "choose" }, this.choice, save), this.insights, this.marks, this.list);
    app.store.on(["selected", "theme"], () => this.update());
    app.themes.changed = () => this.update();
    new ResizeObserver(() => this.resize()).observe(this.list);
    this.update();
  }

  update() {
    const { payload, store } = this.app, { selected } = store.state, colours = inks(this.app.dark, payload.bodies);
    this.options();
    this.charts = chartsOf(payload, selected);
    const spectra = spectraOf(payload, selected);
    const inked = Object.values(payload.bodies).map((body) => body.inks);
    const key = JSON.stringify([this.app.dark, selected, inked, this.charts.map(({ title, unit, lines }) => [title, unit, lines.map(({ name, body }) => [name, body])]), spectra.map(({ title, unit, body }) => [title, unit, body])]);
    if (key === this.key) {
      this.made.forEach((chart, k) => chart.take(this.charts[k]));
      this.spectra.forEach((spectrum, k) => spectrum.take(spectra[k]));
    } else {
      for (const chart of [...this.made, ...this.spectra]) chart.remove();
      this.made = this.charts.map((chart) => new Chart(this.list, this.app, chart, colours));
      this.spectra = spectra.map((spectrum) => new Spectrum(this.list, spectrum, colours));
    }
    this.key = key;
    this.happens(this.all);
    this.tells();
  }

  /** What the whole machine shows, as buttons that go to its time. */
  tells() {
    const { payload, store } = this.app, list = store.state.selected ? [] : payload.insights ?? [];
    this.insights.replaceChildren(...list.map(({ time, words }) => el("li", {}, el("button", {
      type: "button", onclick: () => store.set({ playing: false, time }),
    }, words))));
    this.insights.hidden = !list.length;
  }

  /** What happens when, as buttons that go there; of many the first ones, until all are asked for. */
  happens(all = false) {
    const { payload, store } = this.app, list = all ? payload.marks : payload.marks.slice(0, FEW), more = payload.marks.length - list.length;
    this.all = all;
    this.marks.replaceChildren(...list.map(({ time, words, kind }) => el("button", {
      type: "button", class: "mark", "data-kind": kind, onclick: () => store.set({ playing: false, time }),
    }, `${words.replaceAll("_", " ")} `, el("b", {}, `${figures(time)} s`))));
    if (more) this.marks.append(el("button", { type: "button", class: "mark", onclick: () => this.happens(true) }, `${more} more`));
    this.marks.hidden = !payload.marks.length;
  }

  options() {
    const { payload, store } = this.app;
    this.things = thingsOf(payload);
    const key = JSON.stringify([this.things, store.state.selected]);
    if (key === this.offered) return;
    this.offered = key;
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
    for (const chart of [...this.made, ...this.spectra]) chart.resize(width);
  }

  cursor() { for (const chart of this.made) chart.cursor(); }

  save() {
    const { payload, store } = this.app, { selected } = store.state;
    const name = [payload.mechanism, selected?.name].filter(Boolean).join("-").replaceAll("/", "_");
    download(csv(payload.time, this.charts, selected ? `${selected.kind} ${selected.name}` : ""), `${name}.csv`);
  }
}

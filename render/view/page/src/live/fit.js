/** The panel that fits the lengths to a drawn path: point, path, conditions, progress, cancel. */
import { el } from "../ui/dom.js";
import { Drawn } from "./drawn.js";

export class Fit {
  /** @param {import("../app.js").App} app  @param {(wish: Record<string, any>) => void} say */
  constructor(app, say) {
    this.app = app;
    this.say = say;
    this.drawn = new Drawn(app, () => this.ready());
    this.point = el("select", { "aria-label": "Point that follows the path" });
    this.draw = button("Draw path", () => (this.drawn.drawing ? this.drawn.clear() : this.drawn.begin(), this.ready()));
    this.closed = el("input", { type: "checkbox", onchange: () => { this.drawn.closed = this.closed.checked; } });
    this.ordered = el("input", { type: "checkbox" });
    this.grashof = el("input", { type: "checkbox" });
    this.angle = el("input", { type: "number", class: "number", min: 0, max: 89, step: 5, value: 0, "aria-label": "Least transmission angle in degrees" });
    this.start = button("Fit", () => this.begin());
    this.cancel = button("Cancel", () => this.say({ do: "cancel" }));
    this.bar = el("progress", { max: 1, value: 0, "aria-label": "Progress of the fit" });
    this.words = el("p", { class: "words", role: "status" });
    this.element = el("details", { class: "fit" }, el("summary", {}, "Fit lengths to a path"),
      el("div", { class: "line" }, el("label", {}, "Point ", this.point), this.draw, el("label", {}, this.closed, " closed"), el("label", { title: "The point goes along the path as it was drawn" }, this.ordered, " in this sense")),
      el("div", { class: "line" }, el("label", {}, this.grashof, " Grashof"), el("label", {}, "transmission angle at least ", this.angle, " °")),
      el("div", { class: "line" }, this.start, this.cancel, this.bar), this.words);
    this.running(false);
    this.update();
  }

  /** Take what the app's payload is now. */
  update() {
    const names = Object.keys(this.app.payload.points), was = this.point.value;
    if (names.join() !== [...this.point.options].map(({ value }) => value).join()) {
      this.point.replaceChildren(...names.map((name) => el("option", { value: name }, name)));
      if (names.includes(was)) this.point.value = was;
    }
    this.element.hidden = !names.length;
  }

  ready() {
    this.draw.textContent = this.drawn.drawing ? "Stop drawing" : this.drawn.path.length ? "Draw anew" : "Draw path";
    this.start.disabled = this.busy || this.drawn.path.length < 2;
    if (this.drawn.drawing) this.words.textContent = "Draw over the skeleton with mouse or finger.";
    else if (this.drawn.path.length > 1) this.words.textContent = `A path of ${this.drawn.path.length} places.`;
  }

  begin() {
    this.running(true);
    this.say({
      do: "fit", point: this.point.value, path: this.drawn.places(), closed: this.closed.checked, ordered: this.ordered.checked,
      grashof: this.grashof.checked, least_transmission: Math.min(Math.max(this.angle.valueAsNumber || 0, 0), 89) * Math.PI / 180,
    });
  }

  running(busy) {
    this.busy = busy;
    this.bar.hidden = this.cancel.hidden = !busy;
    this.ready();
  }

  /** @param {Record<string, any>} header of a message on the fit */
  take(header) {
    const millimetres = (x) => `${Number((1000 * x).toPrecision(3))} mm`;
    if (header.kind === "progress") {
      if (!this.busy) this.running(true);
      this.bar.value = header.done;
      this.words.textContent = header.error === null ? "Looking for a design that closes." : `${millimetres(header.error)} off so far.`;
      return;
    }
    this.running(false);
    if (header.cancelled) this.words.textContent = "Cancelled.";
    else if (header.error) this.words.textContent = header.error;
    else this.words.textContent = `Fitted: ${millimetres(header.mean)} off on the mean, ${millimetres(header.largest)} at most.`;
  }
}

export const button = (text, onclick, attributes = {}) => el("button", { type: "button", class: "push", onclick, ...attributes }, text);

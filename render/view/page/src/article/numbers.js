/** Numbers of a text: some are dragged and move time or the machine, the others follow. */
import { written, live } from "../data/numbers.js";
import { degrees, seriesOf, wordsOf } from "./quantities.js";

const WAY = 320;
/** Pixels of a drag over all of a range. */
const TURN = 2 * Math.PI, FINE = 0.01, COARSE = 0.1;

export class Numbers {
  /** @param {import("../app.js").App} app  @param {HTMLElement} text  @param {import("../designs/designs.js").Designs | null} designs */
  constructor(app, text, designs) {
    this.app = app;
    this.designs = designs;
    this.seen = [...text.querySelectorAll(".now")].map((element) => ({ element, measure: element.dataset.measure, of: element.dataset.of.split("/").map(decodeURIComponent) }));
    this.dragged = [...text.querySelectorAll(".drag")].map((element) => this.slider(element));
    for (const { element } of [...this.seen, ...this.dragged]) element.style.minWidth = `${element.textContent.length * 0.52}em`;
  }

  /** What a number moves: its value, its ends, its words. */
  slider(element) {
    const { turn, number } = element.dataset, { app } = this;
    const one = number === undefined ? this.time(turn === "" || turn === undefined ? null : decodeURIComponent(turn)) : this.design(decodeURIComponent(number));
    one.element = element;
    if (!one.there()) return one;
    element.setAttribute("role", "slider");
    element.tabIndex = 0;
    const move = (part) => { one.set(one.low() + Math.min(Math.max(part, 0), 1) * (one.high() - one.low())); };
    const part = () => (one.get() - one.low()) / (one.high() - one.low() || 1);
    let start = null;
    element.addEventListener("pointerdown", (event) => {
      if (event.button) return;
      element.setPointerCapture(event.pointerId);
      start = [event.clientX, part()];
      app.hold(number !== undefined);
    });
    element.addEventListener("pointermove", (event) => {
      if (!start || !element.hasPointerCapture(event.pointerId)) return;
      const to = start[1] + (event.clientX - start[0]) / WAY;
      move(one.turns ? to - Math.floor(to) : to);
    });
    for (const end of ["pointerup", "pointercancel", "blur"]) element.addEventListener(end, () => { start = null; app.hold(false); });
    const keys = { ArrowLeft: -FINE, ArrowDown: -FINE, ArrowRight: FINE, ArrowUp: FINE, PageDown: -COARSE, PageUp: COARSE };
    element.addEventListener("keydown", (event) => {
      const to = event.key === "Home" ? 0 : event.key === "End" ? 1 : event.key in keys ? part() + keys[event.key] : null;
      if (to === null || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      move(one.turns && to !== 1 ? to - Math.floor(to) : to);
    });
    return one;
  }

  /** Time, told by the angle or length of a driver where there is one. @param {string | null} name */
  time(name) {
    const { app } = this, driver = () => app.payload.drivers[name];
    const words = () => {
      if (!driver()) return live([app.payload.time], "s", 3)(app.motion.t);
      const { value, unit } = driver(), now = app.motion.linear(value);
      return unit === "rad" ? degrees(now - TURN * Math.floor(now / TURN + 1e-9)) : live([value], unit, 3)(now);
    };
    return {
      there: () => true, turns: app.clock.repeats, low: () => app.clock.start, high: () => app.clock.end,
      get: () => app.motion.t, set: (time) => app.store.set({ playing: false, time }), words,
    };
  }

  /** A number of Params. @param {string} name */
  design(name) {
    const number = this.designs?.table.numbers.find((each) => each.name === name);
    return {
      there: () => !!number, low: () => number.low, high: () => number.high, get: () => this.designs.values[name] ?? number.value,
      set: (value) => this.designs.move({ [name]: Number(value.toPrecision(3)) }),
      words: () => written(this.designs.values[name] ?? number.value, number.unit),
    };
  }

  /** The numbers are those of the file again. */
  back() {
    if (!this.designs || !Object.keys(this.designs.values).length) return;
    this.designs.move(Object.fromEntries(this.designs.table.numbers.map(({ name, value }) => [name, value])));
  }

  /** Write what is so at the moment. */
  show() {
    const { payload, motion } = this.app;
    for (const { element, measure, of } of this.seen) {
      const series = seriesOf(payload, of);
      if (series) put(element, wordsOf(series, measure, motion));
    }
    for (const one of this.dragged) {
      if (!one.there()) continue;
      const words = one.words(), { element } = one;
      if (!put(element, words) && element.hasAttribute("aria-valuenow")) continue;
      const rounded = (value) => String(Number(value.toPrecision(5)));
      for (const [key, value] of [["valuemin", rounded(one.low())], ["valuemax", rounded(one.high())], ["valuenow", rounded(one.get())], ["valuetext", words]]) element.setAttribute(`aria-${key}`, value);
    }
  }
}

/** Whether the words are others. */
function put(element, words) {
  if (element.textContent === words) return false;
  element.textContent = words;
  return true;
}

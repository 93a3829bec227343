/** Play, pause, frame by frame, the scrub bar with its marks, time and speed. */
import { el } from "./dom.js";
import { icon } from "./icons.js";

const STEPS = 10000;
/** Of the scrub bar. */

export class Transport {
  /** @param {import("../app.js").App} app */
  constructor(app) {
    this.app = app;
    const { store } = app;
    const button = (name, label, onclick) => el("button", { type: "button", class: "round", title: label, "aria-label": label, onclick }, icon(name));
    this.playButton = button("pause", "Pause (space)", () => app.play());
    this.playButton.classList.add("play");
    this.bar = el("input", {
      type: "range", min: 0, max: STEPS, step: 1, value: 0, class: "scrub", "aria-label": "Time",
      oninput: () => store.set({ playing: false, time: this.timeOf(this.bar.valueAsNumber) }),
    });
    this.marks = el("div", { class: "marks", "aria-hidden": "true" });
    this.time = el("output", { class: "time" });
    this.speed = el("select", { class: "speed", "aria-label": "Speed", title: "Speed ([ and ])", onchange: () => store.set({ speed: this.speeds[this.speed.selectedIndex] }) });
    app.parts.bar.replaceChildren(
      button("back", "One frame back (←)", () => app.step(-1)), this.playButton, button("forth", "One frame on (→)", () => app.step(1)),
      el("div", { class: "track" }, this.marks, this.bar), this.time, this.speed,
    );
    store.on(["playing"], ({ playing }) => {
      this.playButton.replaceChildren(icon(playing ? "pause" : "play"));
      this.playButton.title = playing ? "Pause (space)" : "Play (space)";
      this.playButton.setAttribute("aria-label", this.playButton.title);
    }, true);
    store.on(["speed"], () => this.chosen());
    this.update();
  }

  timeOf(step) {
    const { start, end } = this.app.clock;
    return start + ((end - start) * step) / STEPS;
  }

  update() {
    const { clock, payload } = this.app, span = clock.end - clock.start;
    this.offer();
    this.digits = Math.max(0, Math.min(6, 3 - Math.floor(Math.log10(span || 1))));
    this.marks.replaceChildren(...payload.marks.map(({ time, words, kind }) => el("i", {
      style: `left:${(100 * (time - clock.start)) / span}%`, title: words, "data-kind": kind,
    })));
    this.cursor();
  }

  /** The speeds that this clock offers. */
  offer() {
    const { clock } = this.app, words = clock.speeds().map((speed) => clock.said(speed));
    this.speeds = clock.speeds();
    if (words.join() !== this.words) this.speed.replaceChildren(...words.map((word) => el("option", {}, word)));
    this.words = words.join();
    this.chosen();
  }

  chosen() { this.speed.selectedIndex = this.speeds.indexOf(nearest(this.speeds, this.app.store.state.speed)); }

  cursor() {
    const { clock, motion } = this.app;
    if (motion.t === this.drawn && clock === this.clock) return;
    [this.drawn, this.clock] = [motion.t, clock];
    const step = Math.round((STEPS * (motion.t - clock.start)) / (clock.end - clock.start));
    this.bar.value = String(step);
    this.bar.style.setProperty("--part", `${step / STEPS}`);
    this.bar.setAttribute("aria-valuetext", `${motion.t.toFixed(this.digits)} seconds`);
    this.time.textContent = `${motion.t.toFixed(this.digits)} s`;
  }
}

/** @param {number[]} speeds  @param {number} speed */
export const nearest = (speeds, speed) => speeds.reduce((a, b) => (Math.abs(Math.log(b / speed)) < Math.abs(Math.log(a / speed)) ? b : a));

/** What the paragraph that is read brings with it: time, arrows, one curve, camera, a variant. */
import { Chart } from "../plots/chart.js";
import { csv, download } from "../plots/csv.js";
import { same } from "../state.js";
import { inks } from "../view2d/inks.js";
import { Camera } from "./camera.js";
import { Numbers } from "./numbers.js";
import { chartOf } from "./quantities.js";

const LINE = 0.42, HIGH = 132, LOW = 96, GLIDE = 0.9;
/** Where one reads, in parts of what is free of the screen; heights of the curve in pixels; seconds of a way to a moment. */
const still = () => matchMedia("(prefers-reduced-motion: reduce)").matches;
const narrow = () => matchMedia("(max-width: 820px)").matches;

export class Article {
  /** @param {import("../app.js").App} app */
  constructor(app) {
    this.app = app;
    this.text = app.parts.root.querySelector("main");
    this.paragraphs = [...this.text.querySelectorAll("[data-scene]")];
    this.scenes = new Map(this.paragraphs.map((one) => [one, JSON.parse(one.dataset.scene)]));
    this.camera = new Camera(app);
    this.plays = !still();
    this.own = app.payload;
    app.themes.changed = () => { this.key = ""; this.update(); };
  }

  /** @param {import("../designs/designs.js").Designs | null} designs */
  begin(designs) {
    const { app, text } = this;
    designs?.attach(app);
    this.numbers = new Numbers(app, text, designs);
    let asked = false;
    const look = () => { asked = false; this.read(this.reading()); };
    const scrolled = () => { if (!asked) { asked = true; requestAnimationFrame(look); } };
    addEventListener("scroll", scrolled, { passive: true });
    addEventListener("resize", scrolled);
    text.addEventListener("focusin", (event) => this.read(this.held = event.target.closest("[data-scene]")));
    text.addEventListener("pointerdown", (event) => this.read(event.target.closest("[data-scene]")));
    for (const kind of ["wheel", "touchmove"]) addEventListener(kind, () => { this.held = null; }, { passive: true });
    for (const one of text.querySelectorAll(".push")) Object.assign(one, { tabIndex: 0, role: "button" });
    text.addEventListener("click", (event) => this.click(event.target.closest(".push")));
    text.addEventListener("keydown", (event) => {
      const one = [" ", "Enter"].includes(event.key) ? event.target.closest(".push") : null;
      if (one) { event.preventDefault(); this.click(one); }
    });
    app.parts.beside.addEventListener("click", (event) => { if (event.target.closest(".play")) this.plays = app.store.state.playing; });
    for (const kind of ["pointerdown", "wheel"]) app.parts.stage.addEventListener(kind, () => this.camera.stop(), { passive: true });
    app.store.on(["selected"], ({ selected }) => this.pressed(selected), true);
    new ResizeObserver(() => this.resize()).observe(app.parts.side);
    look();
    this.numbers.show();
  }

  /** The paragraph whose numbers a keyboard is at, while it is seen; else the last one above the line at which one reads. */
  reading() {
    const box = this.held?.getBoundingClientRect();
    if (box && box.bottom > 0 && box.top < innerHeight) return this.held;
    const top = narrow() ? Math.max(this.app.parts.beside.getBoundingClientRect().bottom, 0) : 0, line = top + LINE * (innerHeight - top);
    return this.paragraphs.findLast((one) => one.getBoundingClientRect().top <= line) ?? this.paragraphs[0];
  }

  /** @param {HTMLElement | null | undefined} one */
  read(one) {
    if (!one || one === this.now) return;
    this.now?.removeAttribute("aria-current");
    this.now = one;
    one.setAttribute("aria-current", "true");
    const { app } = this, scene = this.scenes.get(one), shown = Object.fromEntries((scene.arrows ?? []).map((word) => [word, true]));
    this.numbers.back();
    this.vary(scene.variant);
    app.store.set({ shown: { trails: true, ...shown, names: !app.payload.solid }, speed: scene.speed ?? 1, selected: null });
    this.camera.look(scene.near ?? null, still());
    this.apart = { from: app.store.state.apart, to: scene.apart ?? 0 };
    this.goes(scene);
    this.update();
  }

  /** Another motion beside the text, or its own again. @param {string | undefined} name */
  vary(name) {
    if (name === this.variant) return;
    this.variant = name;
    const { app } = this, other = name && this.own.variants?.[name];
    app.update(other ? { ...other, solid: null, clearance: null, other: null } : { ...this.own, other: null });
  }

  /** To the moment of a paragraph, or on from its beginning. */
  goes({ at, to }) {
    const { app } = this, { clock } = app, { time } = app.store.state;
    const first = to === undefined || this.plays ? at : (at + Math.min(to, clock.end)) / 2, target = at === undefined ? null : Math.min(Math.max(first, clock.start), clock.end);
    this.way = { began: 0, from: time, to: target, then: to !== undefined || at === undefined };
    if (target === null) app.play(this.plays);
    else app.store.set({ playing: false });
    if (still()) this.step(Infinity);
    app.redraw();
  }

  /** On the way to a moment and to where parts are taken apart; in each frame. */
  step(now) {
    const { way, apart, app } = this;
    if (!way) return;
    way.began ||= now;
    const raw = Math.min((now - way.began) / (1000 * GLIDE), 1) || (now === Infinity ? 1 : 0), part = raw * raw * (3 - 2 * raw);
    const state = { apart: apart.from + part * (apart.to - apart.from) };
    if (way.to !== null) state.time = way.from + part * (way.to - way.from);
    if (raw >= 1) this.way = null;
    app.store.set(state);
    if (raw < 1) app.redraw();
    else if (way.to !== null && way.then && this.plays) app.play(true);
  }

  /** Go to a moment, or point at a thing. @param {HTMLElement | null} button */
  click(button) {
    if (!button) return;
    const { app } = this;
    this.way = null;
    if (button.dataset.at) app.store.set({ playing: false, time: Math.min(Math.max(Number(button.dataset.at), app.clock.start), app.clock.end) });
    const [kind, name] = (button.dataset.show ?? "").split("/").map(decodeURIComponent);
    if (name) app.select({ kind, name });
  }

  pressed(selected) {
    for (const one of this.text.querySelectorAll("[data-show]")) {
      const [kind, name] = one.dataset.show.split("/").map(decodeURIComponent);
      one.setAttribute("aria-pressed", String(same(selected, { kind, name })));
    }
  }

  /** The curve of the paragraph, under the cursor of time. */
  update() {
    const { app } = this, scene = this.scenes.get(this.now), chart = scene?.curve ? chartOf(app.payload, scene.curve) : null;
    const key = JSON.stringify([scene?.curve, scene?.at, scene?.to, app.dark, chart?.unit]);
    if (key === this.key && chart) this.chart?.take(chart);
    else {
      this.chart?.remove();
      this.chart = chart && new Chart(app.parts.side, app, chart, inks(app.dark, app.payload.bodies), narrow() ? LOW : HIGH);
      if (this.chart) this.band(scene);
    }
    this.key = key;
    this.charts = chart ? [chart] : [];
    this.numbers?.show();
  }

  /** The time that a paragraph is about, on its curve: one that goes on beyond the end begins anew. */
  band({ at, to }) {
    if (at === undefined) return;
    const { start, end } = this.app.clock, part = (time) => `${(100 * (time - start)) / (end - start)}%`;
    const rows = to === undefined ? [[at, at]] : to > end ? [[at, end], [start, to - (end - start)]] : [[at, to]];
    for (const [low, high] of rows) {
      const one = document.createElement("i");
      one.className = "about-it";
      Object.assign(one.style, { left: part(low), width: low === high ? "2px" : part(start + high - low) });
      this.chart.plot.over.append(one);
    }
  }

  cursor() {
    const now = performance.now();
    if (!this.solid && this.app.stage.solid) this.camera.look(this.scenes.get(this.now)?.near ?? null, true); // the parts have come
    this.solid = this.app.stage.solid;
    this.step(now);
    this.chart?.cursor();
    this.numbers?.show();
    this.camera.draw(now);
  }

  resize() {
    const width = Math.max(this.app.parts.side.clientWidth - 28, 200);
    if (width === this.width) return;
    this.width = width;
    this.chart?.resize(width);
  }

  save() { if (this.charts.length) download(csv(this.app.payload.time, this.charts, ""), `${this.app.payload.mechanism}.csv`); }
}

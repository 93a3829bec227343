/**
 * The page: mount(root, payload, {live}) puts it into an element and returns the app.
 *
 *   app.update(patch)   a whole payload, or some of its keys; camera, time, speed and selection stay
 *   app.notice(text)    a line over the machine, such as an error of the solver; null takes it away
 *   app.slot            an element in the side panel for who embeds the page (sliders)
 *   app.store           what is shown (state.js); app.store.set({time: 0.2}) moves the machine
 *   app.payload, app.motion, app.clock
 *   app.select(thing), app.placeOf(thing), app.redraw(), app.hold(on): the view stays while numbers are dragged
 *
 * options: frame, Curves and keyed are parts of the page that another page has otherwise (article/).
 * live: {drag(thing, [x, y], phase)} is called while a joint or traced point is dragged in the 2D view, in m; phase is
 * "start", "move" or "end". Without it the plane is panned.
 */
import { Clock } from "./data/clock.js";
import { KINDS } from "./data/kinds.js";
import { motionOf } from "./data/space.js";
import { Plots } from "./plots/plots.js";
import { Store, same } from "./state.js";
import { keys } from "./ui/keys.js";
import { layout } from "./ui/layout.js";
import { initiallyShown } from "./ui/shown.js";
import { themes } from "./ui/themes.js";
import { Transport } from "./ui/transport.js";
import { Stage } from "./ui/stage.js";

export class App {
  constructor(root, payload, { live = null, frame = layout, Curves = Plots, keyed = document } = {}) {
    this.live = live;
    this.frame = this.frame.bind(this);
    this.ready = this.asked = false;
    this.take(payload);
    this.store = new Store({
      time: payload.clock.start, playing: !still(), speed: 1, selected: null, view: "3d", theme: "auto", apart: 0, cut: payload.solid?.section ?? 0, cutSide: payload.solid?.sawn ? "film" : "front",
      shown: initiallyShown(payload),
    });
    this.parts = frame(root, this);
    this.slot = this.parts.slot;
    this.themes = themes(this);
    this.stage = new Stage(this);
    this.plots = new Curves(this);
    this.transport = new Transport(this);
    keys(this, keyed);
    this.store.on(["time"], ({ time }) => { this.motion.to(time); this.redraw(); });
    this.store.on(["selected", "shown", "view", "theme", "apart", "cut", "cutSide"], () => this.redraw());
    this.store.on(["playing"], () => { this.last = 0; this.redraw(); });
    this.ready = true;
    this.redraw();
  }

  get dark() { return this.themes.dark; }

  take(payload) {
    this.payload = payload;
    this.motion = motionOf(payload);
    this.clock = new Clock(payload);
  }

  /** @param {import("./data/decode.js").Payload} patch */
  update(patch) {
    const { time, selected } = this.store.state;
    this.take({ ...this.payload, ...patch });
    const kept = Math.min(Math.max(time, this.clock.start), this.clock.end);
    this.motion.to(kept);
    this.stage.update();
    this.plots.update();
    this.transport.update();
    this.parts.update();
    this.store.set({ time: kept, selected: selected && this.there(selected) ? selected : null });
    this.redraw();
  }

  /** While numbers are dragged the 2D view stays where it is. */
  hold(on) { this.held = this.stage.plane.held = on; this.redraw(); }

  there({ kind, name }) { return !!this.payload[KINDS[kind]]?.[name]; }

  select(thing) { this.store.set({ selected: same(thing, this.store.state.selected) ? null : thing }); }

  /** Where a thing is in the 2D view at the moment (m); null of what has no place. @returns {[number, number] | null} */
  placeOf(thing) {
    const { payload, motion } = this, at = this.anchorOf(thing);
    switch (at?.kind) {
      case "joint": return motion.joint(at.name);
      case "point": return motion.point(at.name);
      case "body": return motion.centre(at.name);
      case "contact": {
        const one = payload.contacts[at.name];
        return [motion.linear(one.x), motion.linear(one.y)];
      }
      default: return null;
    }
  }

  /** The same among the parts. @returns {[number, number, number] | null} */
  spotOf(thing) {
    const at = this.anchorOf(thing), tops = () => Object.values(this.payload.solid.heights.bodies);
    if (!at) return null;
    return at.kind === "contact" ? [...this.placeOf(thing), Math.max(0, ...tops())] : this.motion.spot(at.kind, at.name);
  }

  /** The thing itself where it has a place, else the joint between its bodies. @returns {import("./state.js").Thing | null} */
  anchorOf(thing) {
    if (!thing || !this.there(thing)) return null;
    if (["joint", "point", "body", "contact"].includes(thing.kind)) return thing;
    const { joints, space, [KINDS[thing.kind]]: { [thing.name]: { bodies: pair = [] } } } = this.payload;
    const name = Object.keys(joints).find((one) => (space || joints[one].pair === "pin") && pair.length > 1 && joints[one].bodies.every((body) => pair.includes(body)));
    return name ? { kind: "joint", name } : null;
  }

  play(on = !this.store.state.playing) {
    const { time } = this.store.state;
    if (on && !this.clock.repeats && time >= this.clock.end) this.store.set({ time: this.clock.start });
    this.store.set({ playing: on });
  }

  step(frames) {
    this.store.set({ playing: false });
    this.store.set({ time: this.clock.step(this.store.state.time, frames) });
  }

  notice(text, kind = "error") { this.parts.notice(text, kind); }

  /** Draw before the screen is shown next. */
  redraw() {
    if (this.asked || !this.ready) return;
    this.asked = true;
    requestAnimationFrame(this.frame);
  }

  frame(now) {
    this.asked = false;
    const { playing, speed, time } = this.store.state;
    if (playing) {
      const passed = this.last ? Math.min((now - this.last) / 1000, 0.25) : 0;
      this.last = now;
      this.store.set({ time: this.clock.after(time, passed, speed) });
    }
    this.stage.draw();
    this.plots.cursor();
    this.transport.cursor();
    if (playing) this.redraw();
  }
}

const still = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

/** @param {HTMLElement} root  @param {import("./data/decode.js").Payload} payload  @param {{live?: any, frame?: Function, Curves?: any, keyed?: EventTarget}} options */
export function mount(root, payload, options = {}) { return new App(root, payload, options); }

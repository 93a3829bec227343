/**
 * The live part of the page: it follows the server, and sends it what is moved.
 *
 *   connection.js   the socket          sliders.js   the numbers of Params
 *   fit.js          fit to a path       drawn.js     the path over the 2D view
 *   stretched.js    parts of the numbers before, as far as they can serve
 */
import { el } from "../ui/dom.js";
import { Connection, newest } from "./connection.js";
import { Fit, button } from "./fit.js";
import { Sliders } from "./sliders.js";
import { anchors, raised, stretches } from "./stretched.js";

const LINES = 40;
/** Of what was printed, that are shown. */

export class Live {
  /** @param {(bytes: Uint8Array) => Promise<any>} decode */
  constructor(decode) {
    this.decode = decode;
    this.options = { drag: (thing, place, phase) => this.drag(thing, place, phase) };
    this.move = newest((wish) => this.moving && this.say(wish));
    this.queue = Promise.resolve();
    this.values = {};
    this.frames = 0;
    /** Where the parts have their pins, and whether the file has other numbers by now. */
    this.design = null;
    this.outdated = false;
  }

  /** @param {import("../app.js").App} app */
  mounted(app) {
    this.app = app;
    this.sliders = new Sliders((values, final) => this.say({ do: "set", values, final, arrows: this.arrows }), (held) => app.hold(held));
    this.fit = new Fit(app, (wish) => this.say(wish));
    this.state = el("span", { class: "state", role: "status" });
    this.undo = button("Undo", () => this.say({ do: "undo" }), { title: "Undo (Ctrl Z)" });
    this.redo = button("Redo", () => this.say({ do: "redo" }), { title: "Redo (Ctrl Shift Z)" });
    this.write = button("Write into mechanism.py", () => this.say({ do: "write" }), { title: "Replace these numbers in the file; nothing else of it changes" });
    this.stop = el("p", { class: "stop", role: "status", hidden: true });
    this.lines = el("pre", { class: "printed", hidden: true });
    app.slot.replaceChildren(el("section", { class: "live", "aria-label": "Numbers of Params" },
      el("div", { class: "line" }, el("h2", {}, "Params"), this.state, this.undo, this.redo),
      this.stop, this.sliders.element, el("div", { class: "line" }, this.write), this.fit.element, this.lines));
    document.addEventListener("keydown", (event) => this.key(event));
    this.connection = new Connection(
      (header, payload) => { this.queue = this.queue.then(() => this.take(header, payload)).catch((error) => console.error(error)); },
      (there) => there || this.says("no server; waiting for it", "bad"),
    );
  }

  /** Whether arrows are shown, which cost the server a quarter more. */
  get arrows() {
    const { shown } = this.app.store.state;
    return ["reactions", "forces", "velocities", "accelerations"].some((word) => shown[word]);
  }

  say(wish) { this.connection.say(wish); }

  /** While a joint or point is dragged in the 2D view: phase is start, move or end. */
  drag(thing, to, phase) {
    const { store, payload, clock } = this.app;
    if (phase === "start") {
      store.set({ playing: false });
      this.late = payload.analysis !== "sweep" && store.state.time > clock.start;
      if (this.late) {
        store.set({ time: clock.start });
        this.refused(`Forces move this machine, so its numbers decide where ${thing.name} is at the start alone. This is the start: drag it here.`);
      }
    }
    if (this.late) return;
    this.app.hold(phase !== "end");
    this.moving = phase !== "end"; // a move that waits for its frame is not sent after the end
    const wish = { do: "drag", thing, time: store.state.time, to, final: phase === "end", arrows: this.arrows };
    if (phase === "end") this.say(wish);
    else if (phase === "move") this.move(wish);
  }

  key(event) {
    if (!(event.ctrlKey || event.metaKey) || event.altKey || event.target?.matches?.("input[type=number], textarea")) return;
    const key = event.key.toLowerCase();
    if (key !== "z" && key !== "y") return;
    event.preventDefault();
    this.say({ do: key === "y" || event.shiftKey ? "redo" : "undo" });
  }

  async take(header, payload) {
    const { app } = this;
    switch (header.kind) {
      case "state":
        this.printed(header.lines, true);
        this.numbers(header);
        await this.motion(header, payload);
        this.failed(header.error);
        this.making = header.making;
        this.says(header.solving ? "solving" : this.error === undefined ? this.idle : this.state.textContent, this.state.dataset.kind);
        break;
      case "solving": if (!header.again) this.printed([], true); this.says("solving"); break;
      case "numbers": this.numbers(header); break;
      case "solved": this.numbers(header); this.failed(null); break;
      case "motion": await this.motion(header, payload); break;
      case "solid": await this.solid(payload); break;
      case "values": this.history(header); break;
      case "error": this.failed(header.text); break;
      case "refused": this.refused(header.text); break;
      case "parts":
        this.making = header.state === "making";
        if (header.state === "failed" && this.outdated) this.without();
        if (this.error === undefined) this.says(header.state === "failed" ? "no parts" : this.idle);
        break;
      case "line": this.printed([header.text]); break;
      case "progress": case "fitted": this.fit.take(header);
    }
  }

  async motion({ stop, values }, payload) {
    this.stops(stop);
    if (values) { this.values = values; this.sliders.show(values); }
    if (!payload.length) return;
    const patch = await this.decode(payload);
    delete patch.solid; // the parts come by themselves; until then those that are there serve
    delete patch.clearance;
    patch.other = null;
    if (this.design && this.app.payload.solid) {
      raised(patch, this.app.payload);
      if (this.outdated || Object.keys(this.values).length) patch.other = stretches(this.design, anchors({ ...this.app.payload, ...patch }));
    }
    this.app.update(patch);
    if (patch.other && !this.serves) this.without();
    this.fit.update();
    this.frames++;
    if (this.error === undefined) this.says(this.idle);
  }

  /** The motion of the file with its parts; none where its numbers have others by now: those that are there serve meanwhile. */
  async solid(payload) {
    const { app } = this;
    this.outdated = !payload.length;
    if (payload.length) {
      const own = await this.decode(payload);
      if (same(payload, this.bytes) && app.payload.solid) own.solid = app.payload.solid;
      this.bytes = payload.slice();
      this.design = anchors(own);
      if (Object.keys(this.values).length) this.dimmed(own);
      else app.update({ ...own, other: null });
    } else if (app.payload.solid && this.design) app.update({ other: stretches(this.design, anchors(app.payload)) });
    if (this.error === undefined) this.says(this.idle);
  }

  /** Parts of the file's numbers beside a motion with others. */
  dimmed(own) {
    const { app } = this, { arrows, arcs, trails } = app.payload, patch = { arrows, arcs, trails };
    raised(patch, own);
    app.update({ ...patch, solid: own.solid, clearance: null, other: stretches(this.design, anchors(app.payload)) });
    if (!this.serves) this.without();
  }

  /** Whether the parts have the bodies of the motion. */
  get serves() {
    const { bodies, solid } = this.app.payload, there = new Set(solid.pieces.map(({ body }) => body));
    return Object.keys(this.design).every((body) => body === "ground" || body in bodies || !there.has(body));
  }

  without() {
    this.design = null;
    this.app.update({ solid: null, clearance: null, other: null });
  }

  /** What is said while nothing is solved. */
  get idle() { return this.making ? "making parts" : this.app.payload.other ? "parts stretched" : ""; }

  numbers(header) {
    this.file = header.numbers;
    this.sliders.take(header.numbers, header.values);
    this.history(header);
  }

  history({ values, can_undo, can_redo }) {
    this.values = values;
    this.undo.disabled = !can_undo;
    this.redo.disabled = !can_redo;
    this.write.disabled = !Object.keys(values).length;
    this.sliders.show(values);
  }

  failed(text) {
    this.error = text ?? undefined;
    this.app.notice(text, "error");
    this.says(text ? "error in the file; this is the last good motion" : this.idle, text ? "bad" : "");
  }

  refused(text) {
    this.stop.hidden = false;
    this.stop.textContent = text;
  }

  /** Where the links cannot be closed: how far the motion goes, and why no further. */
  stops(stop) {
    this.stop.hidden = !stop;
    if (!stop) return;
    const drivers = Object.entries(stop.drivers).map(([name, value]) => {
      const angle = this.app.payload.drivers[name]?.unit !== "m";
      return `${name} ${angle ? `${(value * 180 / Math.PI).toFixed(2)}°` : `${value.toPrecision(5)} m`}`;
    });
    this.stop.textContent = `It stops at ${drivers.join(", ")} (${stop.time.toPrecision(5)} s). ${stop.text}`;
  }

  says(text, kind = "") {
    this.state.textContent = text;
    this.state.dataset.kind = kind;
  }

  printed(lines, anew = false) {
    const kept = anew ? [] : this.lines.textContent.split("\n").filter(Boolean);
    this.lines.textContent = [...kept, ...lines].slice(-LINES).join("\n");
    this.lines.hidden = !this.lines.textContent;
    this.lines.scrollTop = this.lines.scrollHeight;
  }
}

const same = (a, b) => a.length === b?.length && a.every((byte, k) => byte === b[k]);

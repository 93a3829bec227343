/** The 2D view: the skeleton with the standard symbols, and over it what is shown: trails, arrows, names. */
import { motionOf } from "../data/space.js";
import { same } from "../state.js";
import { pen } from "../ui/canvases.js";
import { drawArrows } from "./arrows.js";
import { moved } from "carriers";
import { drawGrid } from "./grid.js";
import { inks, showsArrows } from "./inks.js";
import { writeNames } from "./names.js";
import { Paper } from "./paper.js";
import { thingAt } from "./pick.js";
import { listen } from "./pointer.js";
import { drawTrails } from "./trails.js";

/** Radius of the dot in what is selected, in pixels. */
const DOT = 5;
/** Pixels of a step by the keyboard. */
const PAN = 40;
/** Of what is seen: by so much a machine with other numbers may be larger, so large it is at least; and in each frame the
 * view glides on by a part of the way. */
const SPARE = 0.06, LEAST = 0.55, GLIDE = 0.2;

export class Skeleton {
  /**
   * @param {HTMLCanvasElement} canvas  @param {import("../app.js").App} app
   */
  constructor(canvas, app) {
    this.canvas = canvas;
    this.app = app;
    this.paper = new Paper(canvas);
    this.free = [0, 0, 0, 0];
    this.grabbed = null;
    this.hovered = null;
    this.update();
    const redraw = () => app.redraw();
    listen(canvas, {
      click: (x, y) => app.select(thingAt(this, x, y)),
      hover: (x, y) => this.hover(x < 0 ? null : thingAt(this, x, y)),
      grab: (x, y) => this.grab(x, y),
      drag: (x, y) => this.app.live.drag(this.grabbed, this.paper.place(x, y), "move"),
      drop: (x, y, wandered) => wandered && this.app.live.drag(this.grabbed, this.paper.place(x, y), "end"),
      pan: (dx, dy) => { this.paper.pan = [this.paper.pan[0] + dx, this.paper.pan[1] + dy]; redraw(); },
      zoom: (x, y, factor) => { this.paper.zoomAt(x, y, factor); redraw(); },
    });
  }

  /** Take what the app's payload is now. */
  update() { this.first = motionOf(this.app.payload); }

  /** A joint or point may be dragged where the app is live. */
  grab(x, y) {
    const thing = this.app.live?.drag ? thingAt(this, x, y) : null;
    this.grabbed = thing && (thing.kind === "joint" || thing.kind === "point") ? thing : null;
    if (this.grabbed) this.app.live.drag(this.grabbed, this.paper.place(x, y), "start");
    return !!this.grabbed;
  }

  hover(thing) {
    if (same(thing, this.hovered)) return;
    this.hovered = thing;
    this.canvas.style.cursor = thing ? "pointer" : "default";
    this.canvas.title = thing ? `${thing.kind} ${thing.name}` : "";
    this.app.redraw();
  }

  resize(width, height, ratio) {
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    this.ratio = ratio;
    this.size = [width, height];
  }

  zoom(factor) { this.paper.zoomAt(this.size[0] / 2, this.size[1] / 2, factor); }
  turn(right, up) { this.paper.pan = [this.paper.pan[0] - PAN * right, this.paper.pan[1] + PAN * up]; }
  home() { this.paper.reset(); this.corners = null; }

  draw() {
    const { payload, motion, store } = this.app, { shown, selected } = store.state;
    const { skeleton } = payload, g = pen(this.canvas), colours = inks(this.app.dark, payload.bodies, showsArrows(shown));
    this.paper.fit(...this.size, ...this.box(skeleton), this.free);
    g.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    g.fillStyle = colours.paper;
    g.fillRect(0, 0, ...this.size);
    drawGrid(g, this.paper, colours);
    if (shown.trails) drawTrails(g, this.paper, payload, motion, colours.trail);
    if (shown.ghosts) this.ghosts(g, colours);
    g.globalAlpha = 1;
    for (const one of skeleton.strokes) if (!one.sign || shown.centres) this.stroke(g, one, colours, 1);
    this.mark(g, this.hovered, colours, 0.5);
    this.mark(g, selected, colours, 1);
    drawArrows(g, this.paper, payload, motion, shown, colours.arrows, colours.paper);
    if (shown.names) this.names(g, colours);
  }

  /** The skeleton alone over another view, whose paper it is drawn on. */
  over(paper) {
    const { payload, motion, store } = this.app, { shown } = store.state, own = this.paper, g = pen(this.canvas);
    const colours = inks(this.app.dark, payload.bodies, showsArrows(shown));
    this.paper = paper;
    g.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    g.clearRect(0, 0, ...this.size);
    if (shown.trails) drawTrails(g, paper, payload, motion, colours.trail);
    for (const one of payload.skeleton.strokes) if (!one.sign || shown.centres) this.stroke(g, one, colours, 1);
    drawArrows(g, paper, payload, motion, shown, colours.arrows);
    this.paper = own;
  }

  /** Corners (m) of what is seen: the machine's, but they stay while numbers are dragged and where it still fits. */
  box({ low, high, unit }) {
    const pad = 2.4 * unit, wanted = [low[0] - pad, low[1] - pad, high[0] + pad, high[1] + pad], seen = this.corners ?? wanted;
    const [across, up] = [seen[2] - seen[0], seen[3] - seen[1]], room = SPARE * Math.max(across, up);
    const fits = wanted.every((at, k) => (k < 2 ? at >= seen[k] - room : at <= seen[k] + room));
    const fills = Math.max((wanted[2] - wanted[0]) / across, (wanted[3] - wanted[1]) / up) > LEAST;
    this.corners = seen;
    if (!this.held && !(fits && fills)) {
      const near = seen.map((at, k) => at + GLIDE * (wanted[k] - at)), done = near.every((at, k) => Math.abs(at - wanted[k]) < 0.002 * Math.max(across, up));
      this.corners = done ? wanted : near;
      if (!done) this.app.redraw();
    }
    return [this.corners.slice(0, 2), this.corners.slice(2)];
  }

  stroke(g, one, colours, strength) {
    const points = moved(one.points, one, this.app.motion, this.first, this.app.payload.skeleton.times);
    const width = one.width * 1.25 * Math.min(Math.max(this.paper.scale * this.app.payload.skeleton.unit / 13, 0.7), 1.6);
    g.beginPath();
    for (let k = 0; k < points.length; k += 2) g.lineTo(...this.paper.pixel(points[k], points[k + 1]));
    if (one.closed) g.closePath();
    if (one.fill) {
      g.globalAlpha = strength * (one.fill.startsWith("body:") ? Math.min(1, one.alpha * 1.35) : one.alpha);
      g.fillStyle = colours.of(one.fill);
      g.fill();
    }
    g.globalAlpha = strength * (one.closed ? 1 : one.alpha);
    if (width > 0) {
      g.lineWidth = width;
      g.lineJoin = g.lineCap = "round";
      g.setLineDash(one.dash.map((dash) => dash * width));
      g.strokeStyle = colours.of(one.ink);
      g.stroke();
      g.setLineDash([]);
    }
    g.globalAlpha = 1;
  }

  ghosts(g, colours) {
    const { motion, payload } = this.app, now = motion.t;
    const moving = payload.skeleton.strokes.filter((one) => one.carrier.kind === "body" && one.fill?.startsWith("body:"));
    for (let k = 0; k < 8; k++) {
      motion.to(motion.start + (motion.end - motion.start) * (k / 8));
      for (const one of moving) this.stroke(g, one, colours, 0.22);
    }
    motion.to(now);
  }

  mark(g, thing, colours, strength) {
    if (!thing) return;
    const { motion, payload } = this.app;
    g.globalAlpha = strength;
    g.strokeStyle = colours.driver;
    g.lineWidth = 2.5;
    if (thing.kind === "body") {
      for (const one of payload.skeleton.strokes) {
        if (one.ink !== `body:${thing.name}` || !one.closed) continue;
        const points = moved(one.points, one, motion, this.first, payload.skeleton.times);
        g.beginPath();
        for (let k = 0; k < points.length; k += 2) g.lineTo(...this.paper.pixel(points[k], points[k + 1]));
        g.closePath();
        g.stroke();
      }
    } else {
      const place = this.app.placeOf(thing);
      if (place) {
        g.beginPath();
        g.arc(...this.paper.pixel(...place), Math.max(0.62 * payload.skeleton.unit * this.paper.scale + 5, 11), 0, 7);
        g.stroke();
        g.fillStyle = colours.driver;
        g.beginPath();
        g.arc(...this.paper.pixel(...place), DOT, 0, 7);
        g.fill();
      }
    }
    g.globalAlpha = 1;
  }

  names(g, colours) {
    const { motion, payload } = this.app;
    const names = payload.skeleton.names.map((one) => {
      const at = moved(Float64Array.from(one.at), one, motion, this.first, payload.skeleton.times);
      const [x, y] = this.paper.pixel(at[0], at[1]);
      return { text: one.text.replaceAll("_", " "), x, y, off: one.clearance * this.paper.scale, colour: colours.of(one.ink) };
    });
    writeNames(g, names, colours.paper);
  }
}

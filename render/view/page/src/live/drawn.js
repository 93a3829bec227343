/** A path drawn over the 2D view, in metres, that stays where it is when the view moves. */
import { pen } from "../ui/canvases.js";
import { el } from "../ui/dom.js";

const APART = 4;
/** Pixels between two places that are kept while it is drawn. */

export class Drawn {
  /** @param {import("../app.js").App} app  @param {() => void} done when a path has been drawn */
  constructor(app, done) {
    this.app = app;
    this.done = done;
    this.path = [];
    this.canvas = el("canvas", { class: "drawn", hidden: true, "aria-label": "Draw the path here" });
    app.parts.stage.append(this.canvas);
    this.canvas.addEventListener("pointerdown", (event) => {
      if (!this.drawing || event.button) return;
      this.canvas.setPointerCapture(event.pointerId);
      this.path = [];
      this.add(event);
    });
    this.canvas.addEventListener("pointermove", (event) => this.canvas.hasPointerCapture?.(event.pointerId) && this.add(event));
    this.canvas.addEventListener("pointerup", (event) => {
      if (!this.drawing) return;
      this.add(event);
      this.stop();
      this.done();
    });
  }

  /** Follow the view as long as there is something to see. */
  follow() {
    if (this.following) return;
    const frame = () => {
      this.draw();
      this.following = !this.canvas.hidden;
      if (this.following) requestAnimationFrame(frame);
    };
    this.following = true;
    requestAnimationFrame(frame);
  }

  get paper() { return this.app.stage.plane.paper; }

  begin() {
    this.app.store.set({ view: "2d", playing: false });
    this.drawing = true;
    this.canvas.hidden = false;
    this.canvas.dataset.drawing = "";
    this.follow();
  }

  stop() {
    this.drawing = false;
    delete this.canvas.dataset.drawing;
    this.canvas.hidden = !this.path.length;
  }

  clear() {
    this.path = [];
    this.stop();
  }

  add({ clientX, clientY }) {
    const box = this.canvas.getBoundingClientRect(), place = this.paper.place(clientX - box.left, clientY - box.top);
    const last = this.path.at(-1);
    if (last) {
      const [a, b] = [this.paper.pixel(...last), this.paper.pixel(...place)];
      if (Math.hypot(a[0] - b[0], a[1] - b[1]) < APART) return;
    }
    this.path.push(place);
  }

  /** At most so many places, at equal distances along the path. */
  places(most = 24) {
    const { path } = this;
    if (path.length <= 2) return path;
    const lengths = [0];
    for (let k = 1; k < path.length; k++) lengths.push(lengths[k - 1] + Math.hypot(path[k][0] - path[k - 1][0], path[k][1] - path[k - 1][1]));
    const count = Math.min(most, path.length), out = [];
    for (let n = 0, k = 1; n < count; n++) {
      const at = lengths.at(-1) * n / (count - 1);
      while (k < path.length - 1 && lengths[k] < at) k++;
      const part = Math.min(Math.max((at - lengths[k - 1]) / (lengths[k] - lengths[k - 1] || 1), 0), 1);
      out.push([0, 1].map((axis) => path[k - 1][axis] + part * (path[k][axis] - path[k - 1][axis])));
    }
    return out;
  }

  draw() {
    const { canvas, path } = this, flat = this.app.stage.flat;
    canvas.style.visibility = flat ? "visible" : "hidden";
    if (canvas.hidden || !flat) return;
    const { width, height } = canvas.getBoundingClientRect(), ratio = Math.min(devicePixelRatio || 1, 2);
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const g = pen(canvas);
    g.scale(ratio, ratio);
    g.strokeStyle = getComputedStyle(canvas).color;
    Object.assign(g, { lineWidth: 2.5, lineJoin: "round", lineCap: "round" });
    g.setLineDash([7, 5]);
    g.beginPath();
    for (const place of path) g.lineTo(...this.paper.pixel(...place));
    if (this.closed) g.closePath();
    g.stroke();
  }
}

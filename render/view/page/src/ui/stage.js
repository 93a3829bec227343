/** The middle of the page: the 3D view or the 2D one, whichever is chosen and possible. */
import { Skeleton } from "../view2d/skeleton.js";
import { Legend } from "./legend.js";

export class Stage {
  /** @param {import("../app.js").App} app */
  constructor(app) {
    this.app = app;
    const { canvases, stage } = app.parts;
    this.plane = new Skeleton(canvases.plane, app);
    this.solid = null;
    this.legend = new Legend(app);
    new ResizeObserver(() => { this.resize(); app.redraw(); }).observe(stage);
    app.store.on(["view"], () => this.resize());
    this.resize();
    this.update({ solid: app.payload.solid });
  }

  get flat() { return !this.solid || this.app.store.state.view === "2d"; }
  get shown() { return this.flat ? this.plane : this.solid; }

  update() { this.plane.update(); }

  resize() {
    const { width, height } = this.app.parts.stage.getBoundingClientRect();
    if (!width || !height) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2), { chips } = this.app.parts;
    this.plane.free = [chips.offsetHeight + 18, 0, 0, 0];
    this.plane.resize(width, height, ratio);
    this.solid?.resize(width, height, ratio);
  }

  zoom(factor) { this.shown.zoom(factor); this.app.redraw(); }
  home() { this.shown.home(); this.app.redraw(); }

  draw() {
    this.app.parts.root.dataset.view = this.flat ? "2d" : "3d";
    this.shown.draw();
    this.legend.draw();
  }
}

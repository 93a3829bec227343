/** The middle of the page: the 3D view or the 2D one, whichever is chosen and possible. */
import { Skeleton } from "../view2d/skeleton.js";
import { Solid } from "../view3d/scene.js";
import { Legend } from "./legend.js";
import { afterPaint } from "./painted.js";

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
    this.update();
  }

  /** The 3D view stays where parts are taken away: its canvas serves one renderer alone. */
  get flat() { return !this.solid || !this.app.payload.solid || this.app.store.state.view === "2d"; }
  get shown() { return this.flat ? this.plane : this.solid; }

  /** Take what the app's payload is now. */
  update() {
    this.plane.update();
    const { app } = this, { solid } = app.payload;
    if (solid && this.solid) this.solid.update();
    else if (this.waits && !this.coming) {
      this.coming = true;
      app.notice("The parts are being drawn …", "coming");
      afterPaint(() => this.build());
    }
  }

  /** Whether the parts are still to come: meanwhile the skeleton is shown. */
  get waits() { return !!this.app.payload.solid && !this.solid && !this.missing; }

  /** The 3D view with a first picture, which takes its time where WebGL is in software. */
  build() {
    const { app } = this;
    this.coming = false;
    if (!this.waits) return;
    try {
      const made = new Solid(app.parts.canvases.solid, app);
      this.place(made);
      made.home();
      made.draw();
      this.solid = made;
      app.notice(null, "coming");
    } catch (error) {
      this.missing = true;
      app.parts.root.dataset.flat = "";
      app.store.set({ shown: { ...app.store.state.shown, names: true, centres: true } });
      app.notice("This browser has no WebGL: here are the skeleton and the curves, without the parts.", "plain");
      console.info(`no WebGL: ${error.message}`);
    }
    app.redraw();
  }

  resize() {
    this.place(this.plane);
    if (this.solid) this.place(this.solid);
  }

  place(view) {
    const { width, height } = this.app.parts.stage.getBoundingClientRect();
    if (width && height) view.resize(width, height, Math.min(window.devicePixelRatio || 1, 2));
  }

  zoom(factor) { this.shown.zoom(factor); this.app.redraw(); }
  turn(right, up) { this.shown.turn(right, up); this.app.redraw(); }
  home() { this.shown.home(); this.app.redraw(); }

  /** While numbers are dragged WebGL in software would come too late: its last picture stays as a ghost, under the skeleton. */
  get ghost() { return !this.flat && this.app.held && this.solid.soft; }

  draw() {
    this.app.parts.root.dataset.view = this.flat ? "2d" : this.ghost ? "ghost" : "3d";
    if (this.ghost) this.plane.over(this.solid.paper);
    else this.shown.draw();
    this.legend.draw();
  }
}

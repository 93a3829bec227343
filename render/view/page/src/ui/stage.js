/** The middle of the page: the 3D view or the 2D one, whichever is chosen and possible. */
import { Skeleton } from "../view2d/skeleton.js";
import { Solid } from "../view3d/scene.js";
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
    else if (solid && !this.missing) {
      try {
        this.solid = new Solid(app.parts.canvases.solid, app);
        this.resize();
        this.solid.home();
      } catch (error) {
        this.missing = true;
        app.parts.root.dataset.flat = "";
        app.store.set({ shown: { ...app.store.state.shown, names: true } });
        app.notice("This browser has no WebGL: here are the skeleton and the curves, without the parts.", "plain");
        console.info(`no WebGL: ${error.message}`);
      }
    }
  }

  resize() {
    const { width, height } = this.app.parts.stage.getBoundingClientRect();
    if (!width || !height) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.plane.resize(width, height, ratio);
    this.solid?.resize(width, height, ratio);
  }

  zoom(factor) { this.shown.zoom(factor); this.app.redraw(); }
  turn(right, up) { this.shown.turn(right, up); this.app.redraw(); }
  home() { this.shown.home(); this.app.redraw(); }

  draw() {
    this.app.parts.root.dataset.view = this.flat ? "2d" : "3d";
    this.shown.draw();
    this.legend.draw();
  }
}

/** Curves under the same cursor. */
export class Plots {
  /** @param {import("../app.js").App} app */
  constructor(app) { this.app = app; }
  update() {}
  cursor() {}
  save() {}
}

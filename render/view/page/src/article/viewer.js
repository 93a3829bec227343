/** The frame of the view beside a text: the machine, its transport, one curve. */
import { el } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { scene } from "../ui/layout.js";

/** @param {HTMLElement} root  @param {import("../app.js").App} app */
export function viewer(root, app) {
  const beside = root.querySelector(".viewer"), seen = scene();
  const themeButton = el("button", { type: "button", class: "round" });
  const home = el("button", { type: "button", class: "round", title: "Whole machine (0)", "aria-label": "Show the whole machine", onclick: () => { app.plots.camera.stop(); app.stage.home(); } }, icon("whole"));
  const bar = el("div", { class: "bar", role: "group", "aria-label": "Time" }), side = el("div", { class: "curve" });
  seen.stage.append(el("div", { class: "tools" }, home, themeButton));
  beside.append(seen.stage, bar, side);
  root.classList.add("runs");
  return {
    ...seen, root, side, bar, themeButton, beside, slot: el("div"),
    update() { root.dataset.view = app.payload.solid ? app.store.state.view : "2d"; },
  };
}

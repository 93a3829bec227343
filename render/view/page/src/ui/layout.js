/** The page's frame: header, stage, side panel, transport; and what stands in them for all to use. */
import { el } from "./dom.js";
import { showHelp } from "./help.js";
import { icon } from "./icons.js";
import { inside } from "./inside.js";
import { SHOWN } from "./shown.js";

/** The canvases, and what is written over them. */
export function scene() {
  const legend = el("div", { class: "legend", "aria-live": "off" });
  const line = el("div", { class: "notice", role: "status", hidden: true });
  const canvases = { solid: el("canvas", { class: "view", tabindex: "0", "aria-label": "The parts; drag to turn, wheel to zoom, right button to move" }), plane: el("canvas", { class: "view", tabindex: "0", "aria-label": "The skeleton; click a joint or body for its curves" }) };
  const labels = el("div", { class: "labels", "aria-hidden": "true" });
  const notice = (text, kind) => {
    if (!text && kind === "coming" && line.dataset.kind !== kind) return; // another word is being said
    line.hidden = !text;
    line.textContent = text ?? "";
    line.dataset.kind = kind;
  };
  return { stage: el("div", { class: "scene" }, canvases.plane, canvases.solid, labels, legend, line), canvases, legend, labels, notice };
}

/** @param {HTMLElement} root  @param {import("../app.js").App} app */
export function layout(root, app) {
  const { store } = app;
  const title = el("h1"), about = el("p", { class: "about" });
  const views = ["3d", "2d"].map((view) => el("button", {
    type: "button", "aria-pressed": "false", title: `${view === "3d" ? "Parts" : "Skeleton"} (${view[0]})`,
    onclick: () => store.set({ view }),
  }, view === "3d" ? "Parts" : "Skeleton"));
  const segmented = el("div", { class: "segmented", role: "group", "aria-label": "View" }, ...views);
  const themeButton = el("button", { type: "button", class: "round" });
  const helpButton = el("button", { type: "button", class: "round", title: "Keys and licences (?)", "aria-label": "Keys and licences", onclick: () => showHelp() }, icon("help"));
  const homeButton = el("button", { type: "button", class: "round", title: "Whole machine (0)", "aria-label": "Show the whole machine", onclick: () => app.stage.home() }, icon("whole"));
  const header = el("header", { class: "top" }, el("div", { class: "name" }, title, about),
    el("div", { class: "tools" }, segmented, homeButton, themeButton, helpButton));
  const chips = el("div", { class: "chips", role: "group", "aria-label": "What is shown" });
  const seen = scene();
  const slot = el("div", { class: "slot" });
  const side = el("aside", { class: "side", "aria-label": "Curves" }, slot);
  const bar = el("footer", { class: "bar" });
  root.classList.add("mbsd");
  const within = inside(app);
  root.replaceChildren(header, el("main", { class: "stage" }, el("div", { class: "shows" }, chips, within), seen.stage), side, bar);

  const words = {};
  let offered = null;
  const parts = {
    ...seen, root, header, side, bar, slot, chips, themeButton,
    update() {
      const { payload } = app;
      title.textContent = payload.title;
      about.textContent = said(payload);
      segmented.hidden = !payload.solid;
      within.update();
      const there = SHOWN.filter((one) => one.there(payload)), key = there.map(({ word }) => word).join();
      if (key === offered) return void pressed();
      offered = key;
      chips.replaceChildren(...there.map(({ word, label, key }) => (words[word] = el("button", {
        type: "button", class: "chip", "data-word": word, title: `${label} (${key})`, onclick: () => store.show(word),
      }, el("span", { class: "dot" }), label))));
      pressed();
    },
  };
  const pressed = () => {
    const { shown, view } = store.state;
    for (const [word, chip] of Object.entries(words)) chip.setAttribute("aria-pressed", String(!!shown[word]));
    views.forEach((button, k) => button.setAttribute("aria-pressed", String(view === ["3d", "2d"][k])));
    root.dataset.view = app.payload.solid ? view : "2d";
  };
  store.on(["shown", "view"], pressed);
  parts.update();
  return parts;
}

function said({ bodies, joints, period, clock, analysis, clearance }) {
  const count = (n, one, many) => `${n} ${n === 1 ? one : many}`;
  const seconds = (x) => `${Number(x.toPrecision(3))}\u00a0s`;
  const words = [count(Object.keys(bodies).length, "body", "bodies"), count(Object.keys(joints).length, "joint", "joints")];
  words.push(period === null ? `${analysis === "sweep" ? "driven" : "simulated"} ${seconds(clock.end - clock.start)}` : `repeats every ${seconds(period)}`);
  if (clearance) words.push("clearances proven");
  return words.map((word) => word.replace(" ", "\u00a0")).join(" · ");
}

/** Keys; help.js lists them. */
import { showHelp } from "./help.js";
import { SHOWN } from "./shown.js";
import { nearest } from "./transport.js";

/** @param {import("../app.js").App} app  @param {EventTarget} keyed what hears them */
export function keys(app, keyed) {
  const { store } = app;
  const speed = (way) => {
    const speeds = app.clock.speeds(), at = speeds.indexOf(nearest(speeds, store.state.speed));
    store.set({ speed: speeds[Math.min(Math.max(at + way, 0), speeds.length - 1)] });
  };
  const act = {
    " ": () => app.play(),
    ArrowLeft: (event) => app.step(event.shiftKey ? -10 : -1),
    ArrowRight: (event) => app.step(event.shiftKey ? 10 : 1),
    Home: () => store.set({ playing: false, time: app.clock.start }),
    End: () => store.set({ playing: false, time: app.clock.end }),
    "[": () => speed(-1),
    "]": () => speed(1),
    "+": () => app.stage.zoom(1.2),
    "=": () => app.stage.zoom(1.2),
    "-": () => app.stage.zoom(1 / 1.2),
    0: () => app.stage.home(),
    j: () => app.stage.turn(-1, 0),
    l: () => app.stage.turn(1, 0),
    i: () => app.stage.turn(0, 1),
    m: () => app.stage.turn(0, -1),
    3: () => store.set({ view: "3d" }),
    2: () => store.set({ view: "2d" }),
    d: () => app.themes.next(),
    s: () => app.plots.save(),
    "?": () => showHelp(),
    Escape: () => store.set({ selected: null }),
  };
  for (const { word, key, there } of SHOWN) act[key] = () => there(app.payload) && store.show(word);
  keyed.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
    const { target } = event, tag = target?.tagName;
    const typed = tag === "SELECT" || tag === "TEXTAREA" || (tag === "INPUT" && target.type !== "range" && target.type !== "checkbox");
    if (typed || target?.closest?.(".slot")) return;
    if (event.key === " " && (tag === "BUTTON" || target?.type === "checkbox")) return;
    const one = act[event.key] ?? act[event.key.toLowerCase()];
    if (!one) return;
    event.preventDefault();
    one(event);
  });
}

/** Icons of one stroke, 20 by 20. */
import { el } from "./dom.js";

const PATHS = {
  play: "M6.5 4.2v11.6l9-5.8z",
  pause: "M6.5 4.5v11M13.5 4.5v11",
  back: "M12.5 5l-6 5 6 5zM4.8 5v10",
  forth: "M7.5 5l6 5-6 5zM15.2 5v10",
  whole: "M2.6 3.6h14.8v12.8H2.6zM5.9 12.9l1.7-4.1 5.4-1.6 1.5 5.7M4.9 12.9h2M13.5 12.9h2",
  help: "M7.4 7.6a2.7 2.7 0 1 1 3.9 2.5c-.9.5-1.3 1-1.3 2M10 15.2v.1",
  sun: "M10 6.8a3.2 3.2 0 1 0 0 6.4 3.2 3.2 0 0 0 0-6.4M10 2.6v1.6M10 15.8v1.6M2.6 10h1.6M15.8 10h1.6M4.8 4.8l1.1 1.1M14.1 14.1l1.1 1.1M4.8 15.2l1.1-1.1M14.1 5.9l1.1-1.1",
  moon: "M16 11.6A6.6 6.6 0 0 1 8.4 4a6.6 6.6 0 1 0 7.6 7.6z",
  half: "M10 3.4a6.6 6.6 0 1 0 0 13.2 6.6 6.6 0 0 0 0-13.2M10 3.4v13.2",
  save: "M10 3.5v8.8M6.4 8.9L10 12.4l3.6-3.5M4 16h12",
  close: "M5.5 5.5l9 9M14.5 5.5l-9 9",
};

/** @param {keyof PATHS} name */
export function icon(name) {
  const solid = name === "play" || name === "back" || name === "forth";
  return el("svg:svg", { viewBox: "0 0 20 20", "aria-hidden": "true", class: `icon${solid ? " solid" : ""}` },
    el("svg:path", { d: PATHS[name] }));
}

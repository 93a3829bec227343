/**
 * The page as a file: its payload is inside. Who embeds it defines `window.mbsdLive` before this script ends and gets
 * the app once it is mounted; with {server: true} the page follows the server that it comes from.
 *
 *   app.js        mount(root, payload, {live}): everything; the one door for who embeds it
 *   state.js      what is shown: time, speed, selection, view, theme, words of ui/shown.js
 *   data/         payload from bytes, motion at any moment, clock, quantities with units
 *   view2d/       the skeleton on a canvas          view3d/   the parts, with three.js
 *   plots/        curves under the same cursor      ui/       transport, keys, panels, help
 *   live/         the socket of a live page, sliders, dragging, fits
 *   designs/      sliders whose motions are in the page itself, as #mbsd-designs
 *   style/        CSS: colours.css has the two themes, the others a part of the page each
 */
import { mount } from "./app.js";
import { decode, fromBase64 } from "./data/decode.js";
import { Designs } from "./designs/designs.js";
import { Live } from "./live/live.js";
import { cardIsPlayed } from "./ui/canvases.js";
import { afterPaint } from "./ui/painted.js";
import "./style/page.css";

async function start() {
  const root = document.getElementById("mbsd");
  try {
    if (root.querySelector("svg") && !document.hidden) await new Promise(afterPaint);
    cardIsPlayed(); // takes its time where it is so: better while the sketch is seen
    const payload = await decode(fromBase64(document.getElementById("mbsd-payload").textContent));
    const designs = document.getElementById("mbsd-designs")?.textContent;
    const live = designs ? new Designs(await decode(fromBase64(designs))) : window.mbsdLive?.server ? new Live(decode) : window.mbsdLive ?? null;
    const app = mount(root, payload, { live: live?.options ?? null });
    window.mbsd = { app, decode, live };
    live?.mounted?.(app, decode);
  } catch (error) {
    root.textContent = `This page cannot show its machine: ${error.message ?? error}`;
    throw error;
  }
}

start();

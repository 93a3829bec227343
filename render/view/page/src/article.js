/**
 * The article as a file: its text is in the HTML, beside it the page's view of the machine.
 *
 *   article/article.js     what a paragraph brings: time, arrows, curve, camera, variant
 *   article/numbers.js     numbers of the text: dragged ones, those of the moment, those of all the motion
 *   article/quantities.js  series by the addresses of the text
 *   article/camera.js      the way of the camera
 *   article/viewer.js      the frame of the view, in place of the page's (ui/layout.js)
 */
import { mount } from "./app.js";
import { Article } from "./article/article.js";
import { viewer } from "./article/viewer.js";
import { decode, fromBase64 } from "./data/decode.js";
import { Designs } from "./designs/designs.js";
import { cardIsPlayed } from "./ui/canvases.js";
import { afterPaint } from "./ui/painted.js";
import "./style/page.css";
import "./article/article.css";

async function start() {
  const root = document.querySelector(".mbsd.article"), beside = root.querySelector(".viewer");
  try {
    if (!document.hidden) await new Promise(afterPaint);
    cardIsPlayed();
    const payload = await decode(fromBase64(document.getElementById("mbsd-payload").textContent));
    const table = document.getElementById("mbsd-designs")?.textContent;
    const designs = table ? new Designs(await decode(fromBase64(table))) : null;
    const app = mount(root, payload, { frame: viewer, Curves: Article, keyed: beside });
    app.plots.begin(designs);
    window.mbsd = { app, article: app.plots, decode };
  } catch (error) {
    beside.append(`The machine cannot be shown: ${error.message ?? error}`);
    throw error;
  }
}

start();

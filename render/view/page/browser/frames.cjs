/**
 * How fast WebGL draws a page, in software, or with GPU=1 by the graphics card: node frames.cjs FILE [WIDTH HEIGHT SECONDS].
 * Prints what draws, draw calls and triangles of a frame, frames, frames a second, and the processor time of the browser
 * for a frame, which another load of the machine does not change much (Linux).
 */
const { launch, open } = require("./browser.cjs");
const { used } = require("./processor.cjs");

const [, , file, width = 1280, height = 720, seconds = 10] = process.argv;

(async () => {
  const browser = await launch();
  const { page } = await open(browser, file, { width: Number(width), height: Number(height) });
  await page.evaluate(() => new Promise((done) => { const { app } = window.mbsd, draw = app.stage.draw.bind(app.stage);
    let count = 0;
    app.stage.draw = () => { draw(); if (++count === 6) { app.stage.draw = draw; app.play(false); done(); } }; // shaders are compiled by then
    app.play(true);
  }));
  const before = used();
  const frames = await page.evaluate((time) => new Promise((done) => {
    const { app } = window.mbsd, { stage } = app, draw = stage.draw.bind(stage);
    let count = 0;
    stage.draw = () => { draw(); count++; };
    app.play(true);
    setTimeout(() => done(count), 1000 * time);
  }), Number(seconds));
  const busy = used() - before;
  const by = await page.evaluate(() => {
    const { solid } = window.mbsd.app.stage, gl = solid.renderer.getContext(), { calls, triangles } = solid.renderer.info.render;
    return { renderer: gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER), "draw calls": calls, triangles };
  });
  console.log(JSON.stringify({ ...by, frames, "frames a second": frames / seconds, "processor seconds a frame": Number((busy / frames).toFixed(4)) }));
  await browser.close();
})();

/**
 * From a slider to the picture: node slider.cjs ADDRESS SLIDER VIEW COUNT. Moves the slider step by step, each when the
 * picture of the one before is on the screen, and prints as JSON milliseconds from each event to the end of its frame, and
 * processor seconds of browser and server together.
 * With several finger moves a frame, as hands make them, the newest counts, so this is the time of each that is seen.
 */
const [, , address, name, view, count] = process.argv;
const { launch } = require(process.env.PAGE_BROWSER);
const { used } = require(process.env.PAGE_PROCESSOR);

(async () => {
  const browser = await launch(), context = await browser.newContext({ viewport: { width: 1280, height: 800 }, colorScheme: "dark", reducedMotion: "reduce" });
  const page = await context.newPage(), until = (f, argument) => page.waitForFunction(f, argument, { timeout: 240000 });
  await page.goto(address);
  await until((one) => window.mbsd?.live?.connection && document.querySelector(`input[type=range][aria-label="${one}"]`), name);
  if (view === "3d") await until(() => window.mbsd.app.payload.solid && window.mbsd.app.stage.solid && !window.mbsd.app.stage.waits);
  await page.evaluate((one) => window.mbsd.app.store.set({ view: one, playing: false }), view);
  const before = used(process.ppid), found = await page.evaluate(async ({ name: one, steps }) => {
    const { app } = window.mbsd, slider = document.querySelector(`input[type=range][aria-label="${one}"]`), { min, max } = slider, start = slider.valueAsNumber;
    const draw = app.stage.draw.bind(app.stage), key = () => app.payload.joints.B.x[0] + app.payload.joints.B.y[0];
    let waiting = null;
    app.stage.draw = () => {
      draw();
      if (!waiting || Math.abs(key() - waiting.before) < 1e-12) return;
      const { begun, done } = waiting;
      waiting = null;
      const { port1, port2 } = new MessageChannel(); // a task after the frame: it has been painted
      port1.onmessage = () => done(performance.now() - begun);
      requestAnimationFrame(() => port2.postMessage(0));
    };
    const out = [];
    slider.dispatchEvent(new PointerEvent("pointerdown"));
    for (let k = 0; k < steps; k++) {
      const part = 0.04 * (Number(max) - Number(min)) * Math.sin((k + 1) / 3);
      slider.value = String(start + part);
      out.push(await new Promise((done) => {
        waiting = { before: key(), begun: performance.now(), done };
        slider.dispatchEvent(new Event("input"));
      }));
      await new Promise((done) => setTimeout(done, 30));
    }
    return out;
  }, { name, steps: Number(count) });
  console.log(JSON.stringify({ milliseconds: found, processor: used(process.ppid) - before }));
  await browser.close();
})();

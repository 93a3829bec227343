/**
 * Pictures of pages: node picture.cjs FILE PNG [JSON: {width, height, theme, part, shown, selected, view, ...}] ...
 */
const { launch, open } = require("./browser.cjs");

(async () => {
  const browser = await launch();
  const jobs = process.argv.slice(2);
  for (let k = 0; k + 2 < jobs.length + 1; k += 3) {
    const options = JSON.parse(jobs[k + 2] ?? "{}");
    const { page, errors, context } = await open(browser, jobs[k], options);
    await page.evaluate(({ part = 0.3, shown, selected, view }) => {
      const { app } = window.mbsd, { start, end } = app.clock;
      app.store.set({ playing: false, time: start + part * (end - start) });
      if (shown) app.store.set({ shown });
      if (selected) app.select(selected);
      if (view) app.store.set({ view });
    }, options);
    if (options.key) await page.keyboard.press(options.key);
    // Springs and belts come a moment later; then one frame shows it all.
    await page.waitForFunction(() => window.mbsd.app.stage.solid?.parts?.waits !== true, null, { timeout: 60000 });
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    await page.waitForTimeout(options.wait ?? 0);
    await page.screenshot({ path: jobs[k + 1], fullPage: !!options.full, timeout: 180000 });
    if (errors.length) { console.error(`${jobs[k]}:`, errors.join("\n")); process.exitCode = 1; }
    await context.close();
  }
  await browser.close();
})();

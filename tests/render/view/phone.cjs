/** A page on a phone: node phone.cjs PAGE FOLDER; pictures go to FOLDER, what was seen to FOLDER/phone.json. */
const fs = require("node:fs");
const path = require("node:path");
const [, , file, folder] = process.argv;
const { launch, open } = require(process.env.PAGE_BROWSER);
const { small, overlaps, cut } = require("./measured.cjs");

const SIZES = { phone: [390, 844], narrow: [320, 640] };
const frame = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

(async () => {
  const seen = { phones: [] }, browser = await launch();
  for (const [name, [width, height]] of Object.entries(SIZES)) {
    const { page, errors, context } = await open(browser, file, { width, height, touch: true, theme: name === "phone" ? "dark" : "light" });
    await page.evaluate(() => window.mbsd.app.store.set({ view: "2d", shown: { reactions: true, velocities: true, trails: true, names: true, centres: true } }));
    await frame(page);
    const look = async (state) => {
      await page.screenshot({ path: path.join(folder, `${name}-${state}.png`) });
      seen.phones.push({
        name, state, small: await page.evaluate(small, 44), overlaps: await page.evaluate(overlaps), cut: await page.evaluate(cut, "h1, .about, .chip, .time, .mark, h3"),
        wide: await page.evaluate(() => document.documentElement.scrollWidth), room: width,
        scrub: await page.evaluate(() => document.querySelector(".bar .scrub").getBoundingClientRect().width),
        speed: await page.evaluate(() => document.querySelector(".speed").selectedOptions[0].textContent), errors: [...errors],
      });
    };
    await look("2d");
    await page.evaluate(() => window.mbsd.app.store.set({ view: "3d", cut: 0.2 }));
    await frame(page);
    seen.phones.at(-1).inside = await page.evaluate(() => { const box = document.querySelector(".inside").getBoundingClientRect(), rows = [...document.querySelectorAll(".inside :is(input, select)")].map((one) => one.getBoundingClientRect()); return { left: Math.min(...rows.map(({ left }) => left)), right: Math.max(...rows.map(({ right }) => right)), least: Math.min(...rows.map(({ width }) => width)), high: box.height, under: document.querySelector(".chips").getBoundingClientRect().bottom <= box.top + 1 }; });
    await page.screenshot({ path: path.join(folder, `${name}-inside.png`) });
    await page.evaluate(() => window.mbsd.app.store.set({ view: "2d", cut: 0 }));
    await frame(page);
    await page.evaluate(() => scrollTo(0, 600));
    await frame(page);
    await look("curves");
    await page.evaluate(() => scrollTo(0, 0));
    await page.evaluate(() => document.querySelector("[aria-label='Keys and licences']").click());
    await look("help");
    await context.close();
  }

  const context = await browser.newContext({ viewport: { width: 1000, height: 620 }, reducedMotion: "reduce" }), page = await context.newPage();
  await page.addInitScript(() => {
    const get = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
      if (kind === "webgl2" && !window.before) {
        const sketch = document.querySelector("#mbsd > svg")?.getBoundingClientRect();
        window.before = { painted: performance.getEntriesByName("first-contentful-paint").length, width: sketch?.width ?? 0, strokes: document.querySelectorAll("#mbsd > svg *").length };
      }
      return get.call(this, kind, ...more);
    };
  });
  await page.goto(`file://${file}`);
  await page.waitForFunction(() => window.mbsd?.app && !window.mbsd.app.stage.waits, null, { timeout: 120000 });
  seen.before = await page.evaluate(() => window.before);
  seen.after = await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done({ view: document.querySelector(".mbsd").dataset.view, notice: document.querySelector(".notice").hidden })))));
  /** Colours around the rocker's centre of mass in the plane. */
  const mark = (shown) => page.evaluate((centres) => new Promise((done) => {
    const { app } = window.mbsd;
    app.store.set({ view: "2d", shown: { centres } });
    requestAnimationFrame(() => requestAnimationFrame(() => {
      const { plane } = app.stage, [x, y] = plane.paper.pixel(...app.motion.centre("rocker")).map((one) => Math.round(one * plane.ratio));
      done([...new Uint32Array(plane.canvas.getContext("2d").getImageData(x - 4, y - 4, 9, 9).data.buffer)].join());
    }));
  }), shown);
  seen.marked = [await mark(true), await mark(false)];
  await context.close();
  const still = await browser.newContext({ viewport: { width: 1000, height: 620 }, javaScriptEnabled: false }), plain = await still.newPage();
  await plain.goto(`file://${file}`);
  const svg = plain.locator("svg.mbsd-sketch");
  seen.sketch = { box: await svg.boundingBox(), paths: await svg.locator("path").count() };
  await plain.screenshot({ path: path.join(folder, "sketch.png") });
  await browser.close();
  fs.writeFileSync(path.join(folder, "phone.json"), JSON.stringify(seen));
})();

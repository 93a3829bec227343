/** Uses a site as people do: node use_site.cjs FOLDER PLAN; prints as JSON what was seen. */
const [, , folder, planText] = process.argv;
const { launch } = require(process.env.PAGE_BROWSER);
const plan = JSON.parse(planText);

(async () => {
  const browser = await launch(), seen = { errors: [], pages: {} };
  const open = async (file, more = {}) => {
    const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, reducedMotion: "no-preference", ...more }), page = await context.newPage();
    page.on("console", (message) => ["error", "warning"].includes(message.type()) && !/GPU stall|GL Driver/.test(message.text()) && seen.errors.push(`${file}: ${message.text()}`));
    page.on("pageerror", (error) => seen.errors.push(`${file}: ${error}`));
    page.on("request", (request) => !/^(file|data|blob):/.test(request.url()) && seen.errors.push(`${file}: request of ${request.url()}`));
    await page.addInitScript(() => {
      window.largest = 0;
      new PerformanceObserver((list) => { for (const entry of list.getEntries()) window.largest = entry.startTime; }).observe({ type: "largest-contentful-paint", buffered: true });
    });
    await page.goto(`file://${folder}/${file}`);
    return page;
  };
  const looked = (page) => page.evaluate(() => ({
    largest: window.largest,
    unsized: [...document.images].filter((image) => !image.getAttribute("width") || !image.getAttribute("height")).length,
    nameless: [...document.querySelectorAll("a, button, input, iframe, video")].filter((thing) => !(thing.textContent.trim() || thing.ariaLabel || thing.getAttribute("aria-label") || thing.title)).length,
    wide: document.documentElement.scrollWidth, room: document.documentElement.clientWidth,
  }));

  const wall = await open("index.html");
  await wall.waitForFunction(() => window.largest > 0);
  seen.pages.wall = await looked(wall);
  const there = () => wall.evaluate(() => [...document.querySelectorAll(".wall > li:not([hidden]) b")].map((name) => name.textContent));
  seen.all = await there();
  await wall.keyboard.press("/");
  await wall.keyboard.type("rocker");
  seen.searched = await there();
  seen.address = await wall.evaluate(() => location.hash);
  await wall.keyboard.press("Escape");
  seen.cleared = await there();
  await wall.keyboard.type("zzz");
  seen.none = [await there(), await wall.textContent(".count")];
  await wall.keyboard.press("Escape");
  await wall.focus(".tile");
  await wall.waitForFunction(() => document.querySelector(".tile video")?.currentTime > 0, null, { timeout: 60000 });
  seen.plays = true;
  await wall.click(".theme");
  seen.theme = await wall.evaluate(() => [document.documentElement.dataset.theme, getComputedStyle(document.body).backgroundColor]);

  for (const [name, more] of [["phone", { viewport: { width: 390, height: 844 } }], ["machine", {}]]) {
    const page = await open(`${plan.name}/index.html`, more);
    await page.waitForTimeout(500);
    seen.pages[name] = await looked(page);
    await page.context().close();
  }

  const page = await open(`${plan.name}/machine.html`);
  await page.waitForFunction(() => window.mbsd?.app, null, { timeout: 120000 });
  seen.sliders = await page.evaluate(() => window.mbsd.live.table.numbers.map(({ name, low, high }) => [name, low, high]));
  seen.moved = await page.evaluate((values) => {
    const { app, live } = window.mbsd;
    live.move(values);
    const { time, joints, drivers } = app.payload;
    return { time: [...time], x: [...joints.C.x], y: [...joints.C.y], effort: [...drivers.motor.effort], shown: live.values };
  }, plan.values);
  seen.back = await page.evaluate((values) => {
    const { app, live } = window.mbsd;
    live.move(values);
    return app.payload.joints.C.x.length;
  }, plan.own);
  console.log(JSON.stringify(seen));
  await browser.close();
})();

/** Reads an article as people do: node use_article.cjs ARTICLE FOLDER; prints as JSON what was seen. */
const path = require("node:path");
const [, , file, folder] = process.argv;
const { launch, open } = require(process.env.PAGE_BROWSER);

const frame = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
const now = (page) => page.evaluate(() => {
  const { app } = window.mbsd, words = (all) => [...document.querySelectorAll(all)].map((one) => [one.dataset.measure ?? "", one.dataset.of ?? one.dataset.turn, one.textContent]);
  return { time: app.motion.t, playing: app.store.state.playing, shown: app.store.state.shown, apart: app.store.state.apart, selected: app.store.state.selected, current: document.querySelector("[aria-current]")?.closest("section").getAttribute("aria-labelledby"), now: words(".now"), drag: words(".drag"), title: document.querySelector(".curve h3")?.textContent };
});
const look = (page) => page.evaluate(() => ({
  headings: [...document.querySelectorAll("h1, h2")].map((one) => one.tagName),
  nameless: [...document.querySelectorAll("button, select, input, [role=slider], [role=button], aside, section")].filter((one) => !(one.getAttribute("aria-label") || one.textContent.trim())).map((one) => one.outerHTML.slice(0, 90)),
  unvalued: [...document.querySelectorAll("[role=slider]")].filter((one) => !["valuemin", "valuemax", "valuenow", "valuetext"].every((key) => one.getAttribute(`aria-${key}`))).length,
  unreachable: [...document.querySelectorAll("[role=slider], [role=button]")].filter((one) => one.tabIndex < 0).length,
  wide: document.documentElement.scrollWidth, room: document.documentElement.clientWidth, language: document.documentElement.lang,
  stage: document.querySelector(".scene").getBoundingClientRect().height,
}));

(async () => {
  const browser = await launch(), seen = {};
  for (const [name, width, height] of [["desk", 1280, 720], ["phone", 390, 844]]) {
    const { page, errors, context } = await open(browser, file, { width, height, touch: name === "phone" });
    seen[name] = await look(page);
    const to = async (key) => {
      await page.evaluate((id) => document.querySelector(`[aria-labelledby=${id}] [data-scene]`).scrollIntoView({ block: innerWidth > 820 ? "start" : "center" }), key);
      await frame(page);
      await frame(page);
      return now(page);
    };
    seen[name].forces = await to("forces");
    seen[name].print = await to("print");
    await page.screenshot({ path: path.join(folder, `${name}.png`) });
    if (name === "desk") {
      seen.turn = await to("turn");
      await page.focus("[aria-labelledby=turn] .drag");
      for (const key of ["Home", "PageUp", "ArrowRight"]) await page.keyboard.press(key);
      await frame(page);
      seen.dragged = await now(page);
      await page.focus("[aria-labelledby=parts] [data-show='joint/B']");
      await page.keyboard.press("Enter");
      await frame(page);
      seen.shows = await now(page);
      await page.emulateMedia({ media: "print" });
      seen.printed = await page.evaluate(() => ({ sketch: document.querySelector(".mbsd-sketch").checkVisibility(), stage: document.querySelector(".scene").checkVisibility() }));
    }
    seen[name].errors = errors;
    await context.close();
  }
  const still = await browser.newContext({ javaScriptEnabled: false }), plain = await still.newPage();
  await plain.goto(`file://${file}`);
  seen.plain = { text: (await plain.textContent("main")).length, sketch: await plain.locator("svg.mbsd-sketch path").count(), roles: await plain.locator("main [role]").count() };
  console.log(JSON.stringify(seen));
  await browser.close();
})();

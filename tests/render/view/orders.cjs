/** Bars of orders on a page: node orders.cjs FILE. Prints, as JSON, what is said of each for the whole machine and for a driver. */
const { launch, open } = require(process.env.PAGE_BROWSER);

(async () => {
  const browser = await launch(), { page, errors } = await open(browser, process.argv[2]);
  const said = () => page.evaluate(() => [...document.querySelectorAll(".spectrum")].map((one) => ({
    title: one.querySelector("h3").firstChild.textContent, named: [...one.querySelectorAll(".values span")].map((span) => span.textContent),
    inked: (() => { const { width, height } = one.querySelector("canvas"), ctx = one.querySelector("canvas").getContext("2d"); return ctx.getImageData(0, 0, width, height).data.some((value) => value); })(),
  })));
  const whole = await said();
  await page.evaluate(() => window.mbsd.app.store.set({ selected: { kind: "driver", name: "motor" } }));
  const driver = await said();
  await page.evaluate(() => window.mbsd.app.store.set({ selected: { kind: "body", name: "rod_1" } }));
  console.log(JSON.stringify({ whole, driver, body: await said(), errors }));
  await browser.close();
})();

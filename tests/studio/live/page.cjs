/**
 * A live page in a browser: node page.cjs ADDRESS FOLDER. It moves a slider, drags a joint, undoes, makes the motion stop,
 * draws a path, begins a fit and cancels it, and tells what it saw as JSON; the test writes files when asked for on standard output.
 */
const path = require("node:path");
const readline = require("node:readline");
const { launch } = require(path.resolve(__dirname, "../../../render/view/page/browser/browser.cjs"));

const [address, folder] = process.argv.slice(2);
const lines = readline.createInterface({ input: process.stdin })[Symbol.asyncIterator]();
const ask = async (word) => { console.log(`ask ${word}`); await lines.next(); };

async function main() {
  const browser = await launch(), saw = {}, errors = [];
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, colorScheme: "dark", reducedMotion: "reduce" });
  const page = await context.newPage();
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && !/GPU stall|GL Driver/.test(message.text()) && errors.push(message.text()));
  page.on("pageerror", (error) => errors.push(String(error.stack ?? error)));
  page.on("request", (request) => { if (!request.url().startsWith(address) && !/^(data|blob|ws):/.test(request.url())) errors.push(`request of ${request.url()}`); });
  const until = (f, argument) => page.waitForFunction(f, argument, { timeout: 200000 });
  const picture = (name) => page.screenshot({ path: `${folder}/${name}.png` });
  const crank = () => page.evaluate(() => Math.hypot(mbsd.app.payload.joints.B.x[0], mbsd.app.payload.joints.B.y[0]));
  await page.goto(address);
  await until(() => window.mbsd?.live?.connection && document.querySelectorAll(".slide").length);

  await until(() => document.querySelector(".slide .unit").textContent);
  saw.units = await page.locator(".slide .unit").allTextContents();
  saw.sliders = await page.locator(".slide label").allTextContents();
  const slider = page.locator('input[type=range][aria-label="crank"]');
  /** To a part of the slider as it lies now: curves that arrive late move it. */
  const moveTo = async (part) => {
    const box = await slider.boundingBox();
    await page.mouse.move(box.x + box.width * part, box.y + box.height / 2);
  };
  await moveTo(0.25);
  const paper = () => page.evaluate(() => { const { paper } = mbsd.app.stage.plane; return [paper.scale, ...paper.pixel(0, 0)]; });
  const lay = await paper();
  await page.mouse.down();
  for (let k = 0; k <= 20; k++) await moveTo(0.2 + k / 400);
  await until(() => mbsd.live.frames > 1);
  saw.still = [lay, await paper()];
  await moveTo(0.25);
  await page.mouse.up();
  await until(() => !document.querySelector(".live .push").disabled);
  await until(() => Math.abs(Math.hypot(mbsd.app.payload.joints.B.x[0], mbsd.app.payload.joints.B.y[0]) - mbsd.live.values.crank) < 1e-7);
  const hand = () => page.evaluate(() => Number(document.querySelector('input[type=range][aria-label="crank"]').value));
  const letGo = await hand();
  await until((value) => Math.abs(mbsd.live.values.crank - value) < 1e-4, letGo);  // not a value on the way
  await until(() => Math.abs(Math.hypot(mbsd.app.payload.joints.B.x[0], mbsd.app.payload.joints.B.y[0]) - mbsd.live.values.crank) < 1e-7);
  saw.slid = await crank();
  await picture("slider");

  await page.keyboard.press("Control+z");
  await until(() => !("crank" in mbsd.live.values) && Math.abs(Math.hypot(mbsd.app.payload.joints.B.x[0], mbsd.app.payload.joints.B.y[0]) - 0.04) < 1e-7);
  saw.undone = await crank();

  const at = await page.evaluate(() => {
    mbsd.app.store.set({ view: "2d", playing: false, time: 0.25 });
    const box = document.querySelector("canvas.view").getBoundingClientRect();
    const pixel = mbsd.app.stage.plane.paper.pixel(...mbsd.app.placeOf({ kind: "joint", name: "C" }));
    return [box.left + pixel[0], box.top + pixel[1]];
  });
  const wanted = await page.evaluate(([x, y]) => {
    const box = document.querySelector("canvas.view").getBoundingClientRect();
    return mbsd.app.stage.plane.paper.place(x - box.left, y - box.top);
  }, [at[0] + 30, at[1] - 20]);
  await page.mouse.move(...at);
  await page.mouse.down();
  for (let k = 1; k <= 10; k++) await page.mouse.move(at[0] + 3 * k, at[1] - 2 * k);
  await page.mouse.up();
  await until(() => !mbsd.live.undo.disabled);
  const away = (place) => { const c = mbsd.app.placeOf({ kind: "joint", name: "C" }); return Math.hypot(c[0] - place[0], c[1] - place[1]) < 5e-4; };
  await until(away, wanted);
  saw.dragged = await page.evaluate(() => Object.keys(mbsd.live.values));
  await picture("dragged");
  await page.getByRole("button", { name: "Undo" }).click();
  await until(() => !Object.keys(mbsd.live.values).length);

  const field = page.locator('input[type=number][aria-label^="crank,"]');
  const ground = page.locator('input[type=number][aria-label^="ground,"]');
  await ground.fill("0.18");
  await ground.press("Enter");
  await until(() => !document.querySelector(".live .stop").hidden && mbsd.app.payload.period === null);
  saw.stop = await page.locator(".live .stop").textContent();
  await picture("stop");
  await page.getByRole("button", { name: "Undo" }).click();
  await until(() => document.querySelector(".live .stop").hidden);

  await page.locator("details.fit summary").click();
  await page.getByRole("button", { name: "Draw path" }).click();
  const places = await page.evaluate(() => {
    const box = document.querySelector("canvas.view").getBoundingClientRect(), { paper } = mbsd.app.stage.plane;
    return [[0.02, 0.075], [0.05, 0.085], [0.075, 0.07]].map((place) => paper.pixel(...place)).map(([x, y]) => [box.left + x, box.top + y]);
  });
  await page.mouse.move(...places[0]);
  await page.mouse.down();
  for (const place of places.slice(1)) await page.mouse.move(...place, { steps: 12 });
  await page.mouse.up();
  await page.getByRole("button", { name: "Fit", exact: true }).click();
  await until(() => /off so far/.test(document.querySelector(".fit .words").textContent));
  saw.progress = await page.locator(".fit .words").textContent();
  await picture("fitting");
  await page.getByRole("button", { name: "Cancel" }).click();
  await until(() => document.querySelector(".fit .words").textContent === "Cancelled.");
  await until(() => Math.abs(Math.hypot(mbsd.app.payload.joints.B.x[0], mbsd.app.payload.joints.B.y[0]) - 0.04) < 1e-7); // as before the fit

  await ask("break");
  await until(() => /error in the file/.test(document.querySelector(".live .state").textContent));
  saw.notice = await page.locator(".notice").textContent();
  saw.kept = await crank();
  await picture("error");
  await ask("cure");
  await until(() => Math.abs(Math.hypot(mbsd.app.payload.joints.B.x[0], mbsd.app.payload.joints.B.y[0]) - 0.045) < 1e-7);
  saw.cured = await page.locator(".notice").isHidden();

  await field.fill("0.0375");
  await field.press("Enter");
  await until(() => mbsd.live.values.crank === 0.0375);
  await page.getByRole("button", { name: /Write/ }).click();
  await until(() => !Object.keys(mbsd.live.values).length && mbsd.live.file.find(({ name }) => name === "crank").value === 0.0375);
  await page.getByRole("button", { name: "Undo" }).click();
  await until(() => Object.keys(mbsd.live.values).length);
  saw.after = await page.evaluate(() => mbsd.live.values);
  saw.errors = errors;
  await browser.close();
  process.stdout.write(`saw ${JSON.stringify(saw)}\n`, () => process.exit(0)); // what is asked holds standard input open
}

main().catch((error) => { console.log(`failed ${error.stack}`); process.exit(1); });

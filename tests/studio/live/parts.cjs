/** Parts in a live page: node parts.cjs ADDRESS FOLDER. What to write into the files is asked for on standard output. */
const path = require("node:path");
const readline = require("node:readline");
const { launch } = require(path.resolve(__dirname, "../../../render/view/page/browser/browser.cjs"));

const [address, folder] = process.argv.slice(2);
const lines = readline.createInterface({ input: process.stdin })[Symbol.asyncIterator]();
const ask = async (word, what = "ask") => { console.log(`${what} ${word}`); await lines.next(); };

async function main() {
  const browser = await launch(), saw = {}, errors = [];
  const context = await browser.newContext({ viewport: { width: 900, height: 640 }, colorScheme: "dark", reducedMotion: "reduce" });
  const page = await context.newPage();
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && !/GPU stall|GL Driver/.test(message.text()) && errors.push(message.text()));
  page.on("pageerror", (error) => errors.push(String(error.stack ?? error)));
  const until = (f, argument) => page.waitForFunction(f, argument, { timeout: 120000 }).catch(async (error) => { throw new Error(`${error.stack} ${await page.evaluate(() => document.querySelector(".live")?.innerText)}`); });
  const picture = (name) => page.screenshot({ path: `${folder}/parts-${name}.png`, timeout: 180000 });
  const state = () => page.evaluate(() => ({ solid: !!mbsd.app.payload.solid, state: document.querySelector(".live .state").textContent }));
  /** Length of the crank's piece (m), once parts of about that length are shown and nothing more is awaited. */
  const shown = async (length) => {
    await until((wanted) => {
      const { solid } = mbsd.app.payload, parts = mbsd.app.stage.solid?.parts;
      if (!solid || !parts || document.querySelector(".live .state").textContent) return false;
      const { boundingBox } = (parts.meshes[0].geometry.computeBoundingBox(), parts.meshes[0].geometry);
      window.found = boundingBox.max.x - boundingBox.min.x;
      return Math.abs(window.found - wanted) < 0.01;
    }, length);
    return page.evaluate(() => window.found);
  };
  /** Length of the crank's piece as it is placed (m), and whether the parts are those of other numbers. */
  const placed = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => {
    const { solid } = mbsd.app.stage, [mesh] = solid.parts.meshes, { min, max } = (mesh.geometry.computeBoundingBox(), mesh.geometry.boundingBox), other = min.clone();
    other.x = max.x;
    const [a, b] = [min.clone(), other].map((place) => solid.machine.worldToLocal(mesh.localToWorld(place)));
    done({ solid: !!mbsd.app.payload.solid, length: a.distanceTo(b), other: !!mbsd.app.payload.other, clear: mesh.material.opacity });
  }))));
  const tip = (length) => until((wanted) => Math.abs(mbsd.app.payload.points.P.x[0] - wanted) < 1e-6, length);
  await page.goto(address);
  await until(() => document.querySelector(".live .state")?.textContent === "making parts");
  saw.first = await state();
  const field = page.locator('input[type=number][aria-label="length, as a number"]'), type = async (length) => {
    await field.fill(String(length));
    await field.press("Enter");
    await tip(length);
  };
  const come = () => until(() => mbsd.app.payload.solid && mbsd.app.stage.solid?.parts && document.querySelector(".live .state").textContent === "parts stretched");
  await type(0.25); // they come while the number is another
  await come();
  saw.slid = await placed();
  await picture("slid");
  await page.reload();
  await come();
  saw.again = await placed();
  await type(0.2); // the number of the file, typed
  await until(() => !mbsd.app.payload.other);
  saw.back = await placed();
  saw.unchanged = await page.evaluate(() => [document.querySelector(".slide .back").hidden, [...document.querySelectorAll(".push")].find((one) => /Write/.test(one.textContent)).disabled]);
  saw.parts = await shown(0.2);
  await picture("first");

  await ask("longer");
  await tip(0.3);
  await until(() => document.querySelector(".live .state").textContent === "making parts");
  saw.longer = { ...(await placed()), ...(await state()) };
  await ask("longer", "count");
  await ask("break");
  await until(() => /error in the file/.test(document.querySelector(".live .state").textContent));
  saw.notice = await page.locator(".notice").textContent();
  await ask("broken", "count");
  await ask("cure");
  await tip(0.2);
  saw.cured = await shown(0.2);

  await page.evaluate(() => {
    window.seen = { gone: 0, uneven: 0 };
    const { app } = mbsd, update = app.update.bind(app);
    app.update = (patch) => {
      update(patch);
      window.seen.gone += !app.payload.solid;
      window.seen.uneven += app.payload.bodies.crank.theta.length !== app.payload.time.length;
    };
  });
  await ask("finer");
  await until(() => mbsd.app.payload.time.length === 37);
  await shown(0.2);
  saw.finer = { steps: await page.evaluate(() => mbsd.app.payload.time.length), ...(await page.evaluate(() => window.seen)) };

  await ask("wrong");
  await until(() => /no parts/.test(document.querySelector(".live .state").textContent));
  saw.wrong = await page.locator(".printed").textContent();
  saw.kept = (await state()).solid;
  await picture("wrong");
  saw.errors = errors;
  await browser.close();
  process.stdout.write(`saw ${JSON.stringify(saw)}\n`, () => process.exit(0));
}

main().catch((error) => { console.log(`failed ${error.stack}`); process.exit(1); });

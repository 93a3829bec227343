/** Uses a page as people do: node use_page.cjs PAGE FOLDER PLAN; pictures go to FOLDER, what was seen to FOLDER/seen.json. */
const fs = require("node:fs");
const path = require("node:path");
const [, , file, folder, planFile] = process.argv;
const { launch, open } = require(process.env.PAGE_BROWSER);
const plan = JSON.parse(fs.readFileSync(planFile, "utf8"));

const frame = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
const state = (page) => page.evaluate(() => {
  const { time, playing, selected, view, shown, theme } = window.mbsd.app.store.state;
  return { time, playing, selected, view, shown, theme };
});
const box = (page, name) => page.evaluate((one) => {
  const { left, top, width, height } = document.querySelector(one).getBoundingClientRect();
  return { left, top, width, height };
}, name);

(async () => {
  const seen = { pins: [] }, browser = await launch(), size = { width: plan.width, height: plan.height };
  const { page, errors, context } = await open(browser, file, { ...size, theme: "dark" });
  seen.stage = await box(page, ".scene");
  await page.evaluate(() => window.mbsd.app.store.set({ shown: {} }));
  for (const [view, moments] of Object.entries(plan.moments)) {
    await page.evaluate((one) => window.mbsd.app.store.set({ view: one }), view);
    for (const [k, { time, joint }] of moments.entries()) {
      await page.evaluate((one) => window.mbsd.app.store.set({ time: one.time, selected: { kind: "joint", name: one.joint } }), { time, joint });
      await frame(page);
      const picture = `${view}-${k}.png`;
      await page.screenshot({ path: path.join(folder, picture), clip: { x: seen.stage.left, y: seen.stage.top, width: seen.stage.width, height: seen.stage.height } });
      seen.pins.push({ view, time, joint, picture });
    }
  }
  await page.evaluate(() => window.mbsd.app.store.set({ view: "3d", time: 0, apart: 0 }));
  await frame(page);
  const heights = () => page.evaluate(() => window.mbsd.app.stage.solid.parts.meshes.map((mesh) => mesh.position.z));
  seen.together = await heights();
  await page.evaluate(() => window.mbsd.app.store.set({ shown: { reactions: true } }));
  await frame(page);
  const arrows = () => page.evaluate(() => [...window.mbsd.app.stage.solid.arrows.straight].filter(([, one]) => one.visible).map(([index, one]) => [index, one.position.z]));
  seen.arrows = { together: await arrows() };
  await page.evaluate(() => window.mbsd.app.store.set({ apart: 1 }));
  await frame(page);
  seen.apart = await heights();
  seen.arrows.apart = await arrows();
  seen.arrows.order = await page.evaluate(() => window.mbsd.app.payload.solid.pieces.map(({ body, name }) => [body, name]));
  await page.evaluate(() => window.mbsd.app.store.set({ shown: {} }));
  seen.lifts = await page.evaluate(() => window.mbsd.app.payload.solid.pieces.map(({ lift }) => lift));
  await page.evaluate(() => window.mbsd.app.store.set({ apart: 0, cut: 0.4, cutSide: "front" }));
  await frame(page);
  await page.screenshot({ path: path.join(folder, "cut.png") });
  seen.cut = await page.evaluate(() => {
    const { section, parts } = window.mbsd.app.stage.solid, [low, high] = parts.reach([0, 0, 1]);
    const place = window.mbsd.app.stage.solid.machine.worldToLocal(section.plane.coplanarPoint(section.place.clone()));
    return { height: place.z, low, high, clipped: parts.materials.every((material) => material.clippingPlanes?.length === 1) };
  });
  await page.evaluate(() => window.mbsd.app.store.set({ cut: 0.5, cutSide: "quarter" }));
  await frame(page);
  seen.quarter = await page.evaluate(() => window.mbsd.app.stage.solid.parts.materials.map((material) => [material.clippingPlanes?.length, material.clipIntersection]));
  seen.sawn = await page.evaluate(() => {
    const { app } = window.mbsd, { parts } = app.stage.solid, last = app.payload.solid.pieces.length - 1;
    Object.assign(app.payload.solid.pieces[0], { cut: [[1, 0, 0, 0.06], [0, 1, 0, 0.01]], gone: false });
    Object.assign(app.payload.solid.pieces[last], { cut: [[1, 0, 0, -9], [0, 1, 0, -9]], gone: true });
    app.store.set({ cutSide: "film", cut: 1 });
    return { last, of: parts.meshes[0].userData };
  });
  await frame(page);
  Object.assign(seen.sawn, await page.evaluate(() => {
    const { section, parts, machine } = window.mbsd.app.stage.solid, { mesh, planes } = section.sawn[0], back = machine.matrixWorld.clone().invert();
    return {
      count: section.sawn.length, own: mesh.material !== parts.materials[0], whole: parts.materials.every((material) => !material.clippingPlanes),
      planes: planes.map((plane) => { const one = plane.clone().applyMatrix4(back); return [...one.normal.toArray(), one.constant]; }), hidden: parts.meshes.filter((one) => !one.visible).length,
    };
  }));
  await page.screenshot({ path: path.join(folder, "sawn.png") });
  await page.evaluate(() => window.mbsd.app.store.set({ cut: 0, cutSide: "front" }));
  await frame(page);
  seen.sawn.after = await page.evaluate(() => window.mbsd.app.stage.solid.parts.meshes.every((mesh) => mesh.visible && !mesh.material.clippingPlanes));
  await page.evaluate(() => {
    const { app } = window.mbsd, { pieces } = app.payload.solid, last = pieces.length - 1;
    pieces.slice(0, -1).forEach((piece) => { delete piece.cut; });
    Object.assign(pieces[last], { cut: [[1, 0, 0, 0.08]], gone: false, fixed: true });
    app.store.set({ cutSide: "film", cut: 1 });
  });
  seen.fixed = [];
  for (const time of [0, 0.31]) {
    await page.evaluate((now) => window.mbsd.app.store.set({ time: now }), time);
    await frame(page);
    seen.fixed.push(await page.evaluate(() => {
      const { section, machine } = window.mbsd.app.stage.solid, { mesh, planes } = section.sawn[0], back = machine.matrixWorld.clone().invert();
      const one = planes[0].clone().applyMatrix4(back);
      return { plane: [...one.normal.toArray(), one.constant], mesh: [...mesh.matrixWorld.elements] };
    }));
  }
  await page.screenshot({ path: path.join(folder, "fixed.png") });
  await page.evaluate(() => window.mbsd.app.store.set({ cut: 0, cutSide: "front", time: 0 }));
  await frame(page);
  seen.whole = await page.evaluate(() => window.mbsd.app.stage.solid.parts.materials.every((material) => !material.clippingPlanes?.length));
  await page.evaluate(() => window.mbsd.app.store.set({ view: "2d" }));
  await frame(page);
  seen.paper = await page.evaluate(() => {
    const { paper } = window.mbsd.app.stage.plane;
    return { scale: paper.scale, origin: paper.pixel(0, 0) };
  });
  await page.evaluate(() => window.mbsd.app.store.set({ view: "2d", selected: null, time: 0 }));
  const scrub = await box(page, ".track .scrub");
  await page.mouse.click(scrub.left + 8 + 0.5 * (scrub.width - 16), scrub.top + scrub.height / 2);
  seen.memory = await page.evaluate(() => [window.mbsd.app.parts.canvases.plane, ...document.querySelectorAll(".chart canvas")].map((canvas) => canvas.getContext("2d")?.getContextAttributes().willReadFrequently));
  seen.scrubbed = await state(page);
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press("Home");
  seen.home = await state(page);
  await page.keyboard.press("ArrowRight");
  seen.stepped = await state(page);
  await page.keyboard.press("Space");
  await page.waitForFunction(() => window.mbsd.app.store.state.time > 0.03, null, { timeout: 60000 });
  seen.playing = await state(page);
  await page.keyboard.press("Space");
  await page.keyboard.press("End");
  seen.end = await state(page);
  await page.keyboard.press("Home");
  await frame(page);
  const [ox, oy] = seen.paper.origin, [px, py] = plan.pin;
  await page.mouse.click(seen.stage.left + ox + seen.paper.scale * px, seen.stage.top + oy - seen.paper.scale * py);
  seen.clicked = await state(page);
  await frame(page);
  seen.charts = await page.evaluate(() => [...document.querySelectorAll(".chart h3")].map((one) => one.textContent.trim()));
  const over = await box(page, ".u-over");
  await page.mouse.move(over.left + 0.2 * over.width, over.top + 20);
  await page.mouse.down();
  await page.mouse.move(over.left + 0.75 * over.width, over.top + 20, { steps: 3 });
  await page.mouse.up();
  await frame(page);
  seen.dragged = await state(page);
  seen.values = await page.evaluate(() => document.querySelector(".values").textContent);
  const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("s")]);
  await download.saveAs(path.join(folder, "curves.csv"));
  const camera = () => page.evaluate(() => {
    const { stage } = window.mbsd.app, { controls } = stage.solid;
    return { azimuth: controls.getAzimuthalAngle(), polar: controls.getPolarAngle(), away: controls.getDistance(), pan: stage.plane.paper.pan };
  });
  await page.keyboard.press("l");
  seen.panned = await camera();
  await page.keyboard.press("0");
  await page.keyboard.press("3");
  await frame(page);
  seen.before = await camera();
  for (const key of ["l", "l", "i"]) await page.keyboard.press(key);
  seen.turned = await camera();
  await page.keyboard.press("0");
  await page.keyboard.press("2");
  await page.keyboard.press("r");
  await frame(page);
  seen.reactions = { ...(await state(page)), legend: await page.evaluate(() => document.querySelector(".legend").textContent) };
  await page.keyboard.press("?");
  seen.help = await page.evaluate(() => document.querySelector("dialog[open]")?.textContent ?? "");
  await page.keyboard.press("Escape");
  await page.keyboard.press("d");
  seen.light = await page.evaluate(() => document.querySelector(".mbsd").dataset.theme);
  seen.small = await page.evaluate(() => {
    const small = [];
    for (const one of document.querySelectorAll("body *")) {
      const words = [...one.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
      if (words && one.checkVisibility() && parseFloat(getComputedStyle(one).fontSize) < 12) small.push(one.outerHTML.slice(0, 80));
    }
    return small;
  });
  seen.unreachable = await page.evaluate(() => [...document.querySelectorAll("button, select, input")].filter((one) => one.checkVisibility() && (one.tabIndex < 0 || !(one.textContent.trim() || one.getAttribute("aria-label")))).map((one) => one.outerHTML.slice(0, 80)));
  await page.evaluate(() => window.mbsd.app.update({ title: "Another", time: window.mbsd.app.payload.time }));
  seen.updated = { ...(await state(page)), title: await page.evaluate(() => document.querySelector("h1").textContent) };
  await page.setViewportSize({ width: 390, height: 780 });
  await frame(page);
  seen.phone = await page.evaluate(() => ({ wide: document.documentElement.scrollWidth, stage: document.querySelector(".scene").getBoundingClientRect().height }));
  seen.errors = errors;
  await context.close();
  await browser.close();
  const blind = await launch(["--disable-3d-apis"]);
  const flat = await open(blind, file, size);
  await frame(flat.page);
  seen.flat = await flat.page.evaluate(() => ({ view: document.querySelector(".mbsd").dataset.view, notice: document.querySelector(".notice").textContent, charts: document.querySelectorAll(".chart").length }));
  seen.flat.errors = flat.errors;
  await blind.close();
  fs.writeFileSync(path.join(folder, "seen.json"), JSON.stringify(seen));
})();

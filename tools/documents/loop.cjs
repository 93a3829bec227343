/**
 * The frames of the loop: node loop.cjs PAGE PLAN FOLDER. The page is that of make view-four-bar; on the left, or above, are
 * the lines, beside them both its views, one over the other.
 */
const fs = require("node:fs");
const path = require("node:path");
const [, , file, planFile, folder] = process.argv;
const { launch, open } = require(process.env.PAGE_BROWSER);
const plan = JSON.parse(fs.readFileSync(planFile, "utf8"));

const BACKDROP = "#0b0e14";
const STYLE = `
  .mbsd { grid-template: ${plan.above ? `${plan.lines_size}px minmax(0, 1fr) / minmax(0, 1fr)` : `minmax(0, 1fr) / ${plan.lines_size}px minmax(0, 1fr)`} !important; grid-template-areas: ${plan.above ? '"code" "stage"' : '"code stage"'} !important; position: fixed !important; }
  .mbsd :is(.top, .side, .bar, .shows, .labels, .notice) { display: none !important; }
  .mbsd .stage { grid-template-rows: minmax(0, 1fr); }
  .mbsd .view { visibility: visible !important; }
  .mbsd .legend { right: 18px; left: auto; bottom: 14px; font-size: 14px; padding: 5px 11px; border-radius: 8px; background: rgb(13 17 23 / 0.82); }
  .loop-code { grid-area: code; margin: 0; padding: 0 0 0 ${1.4 * plan.letters}px; display: flex; align-items: center; background: #0d1117; color: #d7dde5; font: ${plan.letters}px/1.75 "DejaVu Sans Mono", monospace; }
  .loop-code code { font: inherit; white-space: pre; }
  .loop-code .text { color: #9ecbff; }
  .loop-code .figure { color: #79c0ff; }
  .loop-code .call { color: #d2a8ff; }
  .loop-code .changes { color: #0d1117; background: #ffa657; border-radius: 4px; padding: 2px 0; box-shadow: -3px 0 #ffa657; font-weight: 700; }`;

/** Run in the page: its layout, and window.loop(frame), which draws one. */
const prepare = ({ style, lines, changed, low, high, closer: CLOSER, brighter, backdrop }) => {
  const { app } = window.mbsd, { stage } = app, { solid, plane } = stage;
  document.head.append(Object.assign(document.createElement("style"), { textContent: style }));
  const pre = document.createElement("pre");
  pre.className = "loop-code";
  app.parts.root.append(pre);
  const escape = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
  const coloured = (text) => escape(text).replace(/("[^"]*")|\b(\d[\d.]*)\b|\b([a-z_]+)(?=\()|\b(Mechanism)\b/g, (all, string, figure, call, kind) =>
    string ? `<span class="text">${string}</span>` : figure ? `<span class="figure">${figure}</span>` : `<span class="call">${call ?? kind}</span>`);
  const pen = plane.canvas.getContext("2d"), fill = pen.fillRect.bind(pen);
  pen.fillRect = (...rectangle) => { pen.fillStyle = backdrop; fill(...rectangle); }; // both views have one: WebP leaves edges where they differ by little
  let exposure = null;
  const written = (number) => `<code>${lines.split("\n").map((line) => line.split(changed).map(coloured).join(`<span class="changes">${number}</span>`)).join("\n")}</code>`;
  Object.assign(plane, { held: true, corners: [...low, ...high] });
  const base = app.payload, camera = solid.camera, from = {}, to = {};
  app.frame = () => { app.asked = false; };
  const turned = (vector) => vector.clone().transformDirection(solid.machine.matrixWorld);
  const at = (x, y, z) => solid.world(x, y, z);

  /** The camera before the plane, as far as the 2D view is wide, and that of the film. */
  const measure = () => {
    stage.resize();
    plane.draw();
    const { paper } = plane, [width, height] = plane.size, { camera: own, heights } = base.solid, middle = paper.place(width / 2, height / 2);
    const z = Object.values(heights.joints).reduce((sum, one, _, all) => sum + one / all.length, 0), far = 6 * base.solid.size;
    Object.assign(from, { target: at(...middle, z), position: at(...middle, z + far), up: turned(camera.position.clone().set(0, 1, 0)), high: height / paper.scale / solid.radius });
    solid.home();
    const tall = 2 * solid.tangent * camera.position.distanceTo(solid.controls.target);
    Object.assign(to, { target: at(...own.target), position: at(...own.position), up: camera.position.clone().set(0, 0, 1), high: CLOSER * tall });
  };
  const look = (e) => {
    const mixed = (a, b) => Math.exp(Math.log(a) + e * (Math.log(b) - Math.log(a)));
    const [a, b] = [from, to].map(({ position, target }) => position.clone().sub(target)), long = mixed(a.length(), b.length());
    const target = from.target.clone().lerp(to.target, e), angle = a.angleTo(b) || 1e-9;
    const way = a.normalize().multiplyScalar(Math.sin((1 - e) * angle)).add(b.normalize().multiplyScalar(Math.sin(e * angle))).normalize();
    camera.position.copy(target).addScaledVector(way, long);
    camera.up.copy(from.up).lerp(to.up, e).normalize();
    camera.lookAt(target);
    camera.fov = (2 * Math.atan(mixed(from.high, to.high) / 2 / long) * 180) / Math.PI;
    camera.far = 200;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld(true);
  };
  solid.controls.update = () => false;
  app.store.set({ playing: false, selected: null });
  measure();

  window.loop = async ({ patch, number, part, solid: shown, tilt, reactions }) => {
    pre.innerHTML = written(number);
    if (patch !== window.shown) app.update(patch === null ? base : { ...(await window.mbsd.decode(Uint8Array.from(atob(patch), (one) => one.charCodeAt(0)))), solid: base.solid });
    window.shown = patch;
    plane.corners = [...low, ...high];
    app.motion.to(app.clock.start + part * app.payload.period);
    app.store.state.shown = { trails: true, reactions: reactions > 0 };
    app.store.state.time = app.motion.t;
    const [flat, deep] = [plane.canvas, solid.canvas];
    if (shown < 1) plane.draw();
    if (shown > 0) {
      look(tilt);
      const { renderer } = solid, { render } = renderer;
      if (exposure) renderer.render = () => {}; // it is rendered once, below
      solid.draw();
      renderer.render = render;
      renderer.toneMappingExposure = brighter * (exposure ??= renderer.toneMappingExposure);
      for (const material of Object.values(solid.arrows.materials)) material.opacity = reactions;
      solid.renderer.render(solid.scene, camera);
    }
    flat.style.opacity = 1;
    deep.style.opacity = shown;
    stage.legend.key = "";
    stage.legend.draw();
    app.parts.legend.style.opacity = reactions;
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
  };
};

(async () => {
  const browser = await launch(), { page, errors } = await open(browser, file, { width: plan.width, height: plan.height, theme: "dark" });
  await page.evaluate(prepare, { style: STYLE, lines: plan.lines, changed: plan.changed, low: plan.low, high: plan.high, closer: plan.closer, brighter: plan.brighter, backdrop: BACKDROP });
  for (const [k, frame] of plan.frames.entries()) {
    await page.evaluate((one) => window.loop(one), { ...frame, patch: frame.patch === null ? null : plan.patches[frame.patch] });
    await page.screenshot({ path: path.join(folder, `${String(k).padStart(4, "0")}.png`), timeout: 180000 });
  }
  await browser.close();
  if (errors.length) throw new Error(errors.join("\n"));
})();

/** The page of a mechanism in space: where bodies, joints and lines of the skeleton are at given times. */
const { launch, open } = require(process.env.PAGE_BROWSER);

(async () => {
  const browser = await launch(), [file, times] = [process.argv[2], JSON.parse(process.argv[3])];
  const { page, errors } = await open(browser, file, { width: 360, height: 300 });
  const seen = await page.evaluate((times) => times.map((time) => {
    const { app } = window.mbsd, { parts } = app.stage.solid;
    app.store.set({ playing: false, time });
    parts.move(app.motion);
    const bodies = Object.fromEntries([...parts.bodies].map(([name, group]) => [name, (group.updateMatrix(), [...group.matrix.elements])]));
    const joints = Object.fromEntries(Object.keys(app.payload.joints).map((name) => [name, app.motion.joint(name)]));
    const eyes = Object.keys(app.payload.joints).map((name) => [name, app.motion.spot("joint", name)]);
    return { bodies, joints, spots: Object.fromEntries(eyes) };
  }), times);
  console.log(JSON.stringify({ seen, errors }));
  await browser.close();
})();

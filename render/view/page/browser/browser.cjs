/**
 * A page in Debian's Chromium with WebGL in software, for tests and pictures. NODE_PATH is the folder of the locked
 * packages; CHROMIUM the browser's program; GPU=1 draws by the graphics card instead, in a window where there is a DISPLAY.
 */
const { chromium } = require("playwright-core");

const CARD = !!process.env.GPU;
const FLAGS = [
  ...(CARD ? ["--ignore-gpu-blocklist", "--enable-gpu"] : ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]), "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync",
];

/**
 * @param {string[]} more flags
 * @returns the browser
 */
exports.launch = (more = []) =>
  chromium.launch({ executablePath: process.env.CHROMIUM || "/usr/bin/chromium", headless: !(CARD && process.env.DISPLAY), chromiumSandbox: false, args: [...FLAGS, ...more] });

/** A page with its errors: console errors, exceptions, and requests for anything but the file itself. */
exports.open = async (browser, file, { width = 1280, height = 720, theme = "dark", scale = 1, reduced = true, touch = false } = {}) => {
  const context = await browser.newContext({
    viewport: { width, height }, colorScheme: theme, deviceScaleFactor: scale, reducedMotion: reduced ? "reduce" : "no-preference",
    hasTouch: touch, acceptDownloads: true,
  });
  const page = await context.newPage(), errors = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && !/GPU stall|GL Driver/.test(message.text()) && errors.push(message.text()));
  page.on("pageerror", (error) => errors.push(String(error.stack ?? error)));
  page.on("request", (request) => !/^(file|data|blob):/.test(request.url()) && errors.push(`request of ${request.url()}`));
  await page.goto(`file://${file}`);
  await page.waitForFunction(() => window.mbsd?.app && !window.mbsd.app.stage.waits, null, { timeout: 120000 });
  return { page, errors, context };
};

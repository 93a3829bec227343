/**
 * Canvases where the browser draws without a graphics card: it then plays a card for them, too, and shows each picture
 * after some 100 ms, while one in memory is there at once. `willReadFrequently` asks for memory.
 */
let software = null;

/** Whether the browser plays a graphics card for WebGL; null where there is no WebGL at all. */
export function cardIsPlayed() {
  software ??= { played: played() };
  return software.played;
}

function played() {
  const probe = document.createElement("canvas").getContext("webgl2");
  if (!probe) return null;
  const info = probe.getExtension("WEBGL_debug_renderer_info");
  const name = probe.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : probe.RENDERER);
  probe.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

/** What draws on a canvas of the page. @param {HTMLCanvasElement} canvas */
export const pen = (canvas) => canvas.getContext("2d", { willReadFrequently: cardIsPlayed() ?? false });

/** Makes a uPlot, which asks for its canvas itself and without options. @template T @param {() => T} make @returns {T} */
export function charted(make) {
  const { prototype } = HTMLCanvasElement, { getContext } = prototype, willReadFrequently = cardIsPlayed() ?? false;
  prototype.getContext = function (kind, options) { return getContext.call(this, kind, { willReadFrequently, ...options }); };
  try {
    return make();
  } finally {
    prototype.getContext = getContext;
  }
}

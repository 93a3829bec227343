/** Work that may wait until what is on the page has been seen. */
const PATIENCE = 2000;
/** Milliseconds in which a browser that tells of its first paint has painted. */

/** Once what is drawn now has been seen: two frames later, and where the browser tells of paints, after the first one. */
export function afterPaint(f) {
  const ends = performance.now() + PATIENCE, tells = PerformanceObserver.supportedEntryTypes?.includes("paint");
  const look = () => {
    const seen = !tells || performance.getEntriesByName("first-contentful-paint").length || performance.now() > ends;
    if (seen) f();
    else setTimeout(look, 20);
  };
  requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(look)));
}

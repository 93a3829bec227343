/** Fingers, mouse and wheel on a canvas: click, drag, pinch and zoom, as calls with CSS pixels. */

const STILL = 5;
/** Pixels that a click may wander. */

/**
 * @param {HTMLElement} element
 * @param {{click?: Function, grab?: (x: number, y: number) => boolean, drag?: Function, drop?: Function,
 *   pan?: Function, zoom?: Function, hover?: Function}} on  grab says whether something is dragged, else it is panned
 */
export function listen(element, on) {
  /** @type {Map<number, [number, number]>} */
  const down = new Map();
  let start = null, held = false, wandered = false, gap = 0;
  const at = (event) => {
    const box = element.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const spread = () => {
    const [a, b] = [...down.values()];
    return Math.hypot(a[0] - b[0], a[1] - b[1]);
  };
  element.addEventListener("pointerdown", (event) => {
    if (event.button > 1) return;
    element.setPointerCapture(event.pointerId);
    down.set(event.pointerId, at(event));
    if (down.size === 1) {
      start = at(event);
      wandered = false;
      held = on.grab?.(...start) ?? false;
    } else if (down.size === 2) {
      if (held) on.drop?.(...start, wandered); // two fingers pinch, and drag nothing
      held = false;
      gap = spread();
      wandered = true;
    }
  });
  element.addEventListener("pointermove", (event) => {
    const here = at(event), before = down.get(event.pointerId);
    if (!before) return void on.hover?.(...here);
    down.set(event.pointerId, here);
    if (down.size === 2) {
      const now = spread(), [a, b] = [...down.values()];
      on.zoom?.((a[0] + b[0]) / 2, (a[1] + b[1]) / 2, now / gap);
      on.pan?.((here[0] - before[0]) / 2, (here[1] - before[1]) / 2);
      gap = now;
      return;
    }
    if (!wandered && Math.hypot(here[0] - start[0], here[1] - start[1]) < STILL) return;
    wandered = true;
    if (held) on.drag?.(...here);
    else on.pan?.(here[0] - before[0], here[1] - before[1]);
  });
  const up = (event) => {
    if (!down.delete(event.pointerId) || down.size) return;
    if (held) on.drop?.(...at(event), wandered);
    if (!wandered && event.type === "pointerup") on.click?.(...at(event));
    held = false;
  };
  element.addEventListener("pointerup", up);
  element.addEventListener("pointercancel", up);
  element.addEventListener("pointerleave", () => { if (!down.size) on.hover?.(-1, -1); });
  element.addEventListener("wheel", (event) => {
    event.preventDefault();
    on.zoom?.(...at(event), Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0015)));
  }, { passive: false });
}

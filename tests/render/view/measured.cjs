/** What of a page can be measured: targets that are too small for fingers, words over words, words that are cut. */

/** Run in the page. @returns what is visible and smaller than `least` pixels in one direction */
exports.small = (least) => {
  const wanted = "button, select, input, summary, a[href]", found = [];
  for (const one of document.querySelectorAll(wanted)) {
    if (!one.checkVisibility({ visibilityProperty: true })) continue;
    const target = one.matches("input[type=checkbox]") ? one.closest("label") ?? one : one, { width, height } = target.getBoundingClientRect();
    if (Math.min(width, height) < least - 0.01) found.push(`${one.outerHTML.slice(0, 90)}: ${width.toFixed(1)} x ${height.toFixed(1)}`);
  }
  return found;
};

/** Run in the page. @returns pairs of words that cover each other, in the part of the page that is seen */
exports.overlaps = () => {
  /** Whether it has scrolled below the bar that stays. */
  const under = ({ left, right, top, bottom }, holder) => !holder.closest(".bar") && document.elementFromPoint((left + right) / 2, (top + bottom) / 2)?.closest(".bar");
  const words = [], shut = document.querySelector("dialog[open]"), walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  const cut = (box, by) => ({ left: Math.max(box.left, by.left), right: Math.min(box.right, by.right), top: Math.max(box.top, by.top), bottom: Math.min(box.bottom, by.bottom) });
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const holder = node.parentElement;
    if (!node.textContent.trim() || !holder.checkVisibility({ visibilityProperty: true, opacityProperty: true }) || holder.closest("option, select, script, style, noscript, dialog:not([open])")) continue;
    if (shut && !shut.contains(holder)) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    for (const seen of range.getClientRects()) {
      let box = cut(seen, { left: 0, top: 0, right: innerWidth, bottom: innerHeight });
      for (let one = holder; one && one !== document.body; one = one.parentElement) if (getComputedStyle(one).overflow !== "visible") box = cut(box, one.getBoundingClientRect());
      if (box.right - box.left > 1 && box.bottom - box.top > 1 && !under(box, holder)) words.push({ text: node.textContent.trim(), ...box, own: holder });
    }
  }
  for (const one of document.querySelectorAll("select, output, input[type=number]")) if (!shut && one.checkVisibility() && !under(one.getBoundingClientRect(), one)) words.push({ text: one.outerHTML.slice(0, 40), ...cut(one.getBoundingClientRect(), one.closest(".side")?.getBoundingClientRect() ?? { left: 0, top: 0, right: innerWidth, bottom: innerHeight }), own: one });
  const found = [];
  words.forEach((a, k) => words.slice(k + 1).forEach((b) => {
    if (a.own === b.own) return;
    if (Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 3) found.push(`${a.text} | ${b.text}`);
  }));
  return found;
};

/** Run in the page. @returns texts of these elements that are wider or higher than their place */
exports.cut = (selector) => [...document.querySelectorAll(selector)].filter((one) => one.checkVisibility() && (one.scrollWidth > one.clientWidth + 1 || one.scrollHeight > one.clientHeight + 1)).map((one) => one.textContent);

/** Loops that play under the pointer or the focus. */
const still = matchMedia("(prefers-reduced-motion: reduce)");
for (const tile of document.querySelectorAll(".wall > li")) {
  const link = tile.querySelector("a"), { loop } = tile.dataset, box = tile.querySelector(".moving");
  if (!loop) continue;
  let video = null;
  const play = () => {
    if (still.matches || video) return;
    video = Object.assign(document.createElement("video"), { src: loop, muted: true, loop: true, playsInline: true, width: 480, height: 270, ariaHidden: "true" });
    video.addEventListener("playing", () => video && box.append(video), { once: true });
    video.play().catch(() => { video = null; });
  };
  const stop = () => { video?.pause(); video?.remove(); video = null; };
  for (const event of ["pointerenter", "focus"]) link.addEventListener(event, play);
  for (const event of ["pointerleave", "blur"]) link.addEventListener(event, stop);
}

/** The wall: search and filters. The address keeps what is asked for. */
const tiles = [...document.querySelectorAll(".wall > li")], field = document.querySelector(".search"), count = document.querySelector(".count");
const buttons = [...document.querySelectorAll(".filters button")];
const plain = (text) => text.toLowerCase().normalize("NFD").replace(/\p{M}/gu, "");

function show() {
  const words = plain(field.value).split(/\s+/).filter(Boolean), pressed = buttons.find((button) => button.ariaPressed === "true")?.dataset.purpose ?? "";
  let there = 0;
  for (const tile of tiles) {
    const fits = words.every((word) => tile.dataset.words.includes(word)) && (!pressed || tile.dataset.purposes.split("|").includes(pressed));
    tile.hidden = !fits;
    there += fits;
  }
  const all = `${tiles.length} ${tiles.length === 1 ? "machine" : "machines"}`;
  count.textContent = there === tiles.length ? all : there ? `${there} of ${all}` : "No machine answers to that; clear the search or the filter.";
  const asked = new URLSearchParams({ ...(field.value && { q: field.value }), ...(pressed && { does: pressed }) }).toString();
  try { history.replaceState(null, "", asked ? `#${asked}` : location.pathname + location.search); } catch { /* a frame without a history */ }
}

const asked = new URLSearchParams(location.hash.slice(1));
field.value = asked.get("q") ?? "";
for (const button of buttons) {
  button.ariaPressed = String(button.dataset.purpose === asked.get("does"));
  button.addEventListener("click", () => {
    const on = button.ariaPressed !== "true";
    for (const other of buttons) other.ariaPressed = "false";
    button.ariaPressed = String(on);
    show();
  });
}
field.addEventListener("input", show);
document.addEventListener("keydown", (event) => {
  if (event.key === "/" && document.activeElement !== field) { event.preventDefault(); field.focus(); }
  if (event.key === "Escape" && document.activeElement === field) { field.value = ""; show(); }
});

show();

/** Dark or light: as the system has it, or as the button was left. Storage may be refused, then nothing is kept. */
const root = document.documentElement, kept = () => { try { return localStorage.getItem("theme"); } catch { return null; } };
const dark = () => (root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches);
if (kept()) root.dataset.theme = kept();
const button = document.querySelector(".theme"), name = () => { button.textContent = dark() ? "Light" : "Dark"; };
button.addEventListener("click", () => {
  root.dataset.theme = dark() ? "light" : "dark";
  try { localStorage.setItem("theme", root.dataset.theme); } catch { /* nothing is kept */ }
  name();
});
name();

/** Colours of the skeleton's roles (mbsd/drawing/look.py), in the two themes. */

const LIGHT = {
  ink: "#20252b", quiet: "#5d6670", paper: "#ffffff", faint: "#e9ecef", driver: "#c2410c", load: "#4b5563",
  wrong: "#c81e1e", x: "#d0453a", y: "#2f8f4e", grid: "#e7eaee",
};
const DARK = {
  ink: "#e6e9ee", quiet: "#98a3b1", paper: "#10141b", faint: "#222a35", driver: "#ff8a4c", load: "#a9b6c6",
  wrong: "#ff6b6b", x: "#ff7b6e", y: "#5fd08a", grid: "#1a212b",
};
/** Of curves that belong to no body: components of a vector, energies. */
const LINES = { light: ["#20252b", "#0f766e", "#9d3f86", "#6b6f00"], dark: ["#e6e9ee", "#4fd0c4", "#e79ad2", "#c9c95a"] };
/** Of bodies where arrows are shown: signal colours belong to quantities alone. */
const SLATE = {
  light: ["#51606e", "#6a5f57", "#4a6668", "#655a70", "#5f6650"], dark: ["#a4b1bd", "#b9aea6", "#9fb8ba", "#b6abc0", "#b0b7a1"],
};

/** Signal colours and heads of arrows, those of shared/contract/signals.py: by the row of the legend. */
export const QUANTITIES = {
  light: {
    velocities: "#0a8a72", accelerations: "#6a1fc0", forces: "#e06400", weights: "#453500", reactions: "#4a93f0",
    torques: "#b5123c", trails: "#1f9fb5",
  },
  dark: {
    velocities: "#4fd0a4", accelerations: "#b848fa", forces: "#ff9a1a", weights: "#f5ee7a", reactions: "#74b4ff",
    torques: "#ee3a2e", trails: "#a8f4fb",
  },
};
export const HEADS = { velocities: "open", accelerations: "open double", forces: "solid", weights: "solid", reactions: "solid double", torques: "solid" };

/**
 * @param {boolean} dark  @param {Record<string, {inks: [string, string]}>} bodies  inks on light and on dark paper
 * @param {boolean} neutral whether bodies are grey, because arrows are shown
 */
export function inks(dark, bodies, neutral = false) {
  const roles = dark ? DARK : LIGHT, theme = dark ? "dark" : "light", slate = SLATE[theme], order = Object.keys(bodies);
  const lines = LINES[theme];
  return {
    ...roles,
    /** @param {string} role */
    of(role) {
      const body = role.startsWith("body:") ? role.slice(5) : null;
      if (body === null) return (neutral && role === "driver" ? roles.quiet : roles[role]) ?? roles.ink;
      if (!bodies[body]) return roles.ink;
      return neutral ? slate[order.indexOf(body) % slate.length] : bodies[body].inks[dark ? 1 : 0];
    },
    /** Of a curve: of its body, else one after another. */
    line(line, index) { return line.body ? this.of(`body:${line.body}`) : lines[index % lines.length]; },
    arrows: QUANTITIES[theme],
    trail: QUANTITIES[theme].trails,
  };
}

/** Whether any quantity is shown as arrows. @param {Record<string, boolean>} shown */
export const showsArrows = (shown) => ["velocities", "accelerations", "forces", "reactions"].some((quantity) => shown[quantity]);

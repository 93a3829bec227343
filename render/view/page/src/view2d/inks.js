/** Colours of the skeleton's roles (mbsd/drawing/look.py), in the two themes. */

const LIGHT = {
  ink: "#20252b", quiet: "#5d6670", paper: "#ffffff", faint: "#e9ecef", driver: "#c2410c", load: "#4b5563",
  wrong: "#c81e1e", x: "#d0453a", y: "#2f8f4e", trail: "#d1500a", grid: "#e7eaee",
};
const DARK = {
  ink: "#e6e9ee", quiet: "#98a3b1", paper: "#10141b", faint: "#222a35", driver: "#ff8a4c", load: "#a9b6c6",
  wrong: "#ff6b6b", x: "#ff7b6e", y: "#5fd08a", trail: "#ff7a2f", grid: "#1a212b",
};
const BODIES_LIGHT = ["#0b62a8", "#00805e", "#a83a82", "#8a6d00", "#5a4fcf", "#3b7d8c", "#8f4a1d", "#4d6b1f"];
const BODIES_DARK = ["#5db2ff", "#37d3a4", "#f08bd0", "#e2bd4b", "#a59bff", "#74cde0", "#e89a68", "#a9cf6b"];

/** Of the arrows: by quantity. */
export const QUANTITIES = {
  light: { velocities: "#0f8f57", accelerations: "#7b3fe4", forces: "#c05a00", reactions: "#0b62c4" },
  dark: { velocities: "#29db8a", accelerations: "#b880ff", forces: "#ff8f21", reactions: "#4da8ff" },
};

/** @param {boolean} dark  @param {Record<string, {colour: number}>} bodies */
export function inks(dark, bodies) {
  const roles = dark ? DARK : LIGHT, palette = dark ? BODIES_DARK : BODIES_LIGHT;
  return {
    ...roles,
    /** @param {string} role */
    of(role) {
      if (role.startsWith("body:")) return palette[(bodies[role.slice(5)]?.colour ?? 0) % palette.length];
      return roles[role] ?? roles.ink;
    },
    body: (index) => palette[index % palette.length],
    arrows: QUANTITIES[dark ? "dark" : "light"],
  };
}

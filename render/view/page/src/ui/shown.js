/** What may be shown over the machine: words, labels and keys; only what a machine has. */

export const SHOWN = [
  { word: "reactions", label: "Reactions", key: "r", there: (p) => has(p, "reactions") },
  { word: "forces", label: "Forces", key: "f", there: (p) => has(p, "forces") },
  { word: "velocities", label: "Velocities", key: "v", there: (p) => has(p, "velocities") },
  { word: "accelerations", label: "Accelerations", key: "a", there: (p) => has(p, "accelerations") },
  { word: "trails", label: "Trails", key: "t", there: (p) => p.trails.length > 0 },
  { word: "names", label: "Names", key: "n", there: () => true },
  { word: "centres", label: "Centres of mass", key: "c", there: (p) => Object.values(p.bodies).some((b) => b.mass > 0) },
  { word: "ghosts", label: "Poses", key: "g", there: (p) => Object.keys(p.bodies).length > 0 },
  { word: "glass", label: "Transparent", key: "x", there: (p) => !!p.solid },
  { word: "clearance", label: "Clearances", key: "k", there: (p) => !!p.clearance && !!p.solid },
];

const has = (payload, quantity) =>
  payload.arrows.list.some((one) => one.quantity === quantity) || payload.arcs.list.some((one) => one.quantity === quantity);

/** @param {import("../data/decode.js").Payload} payload */
export function initiallyShown(payload) {
  return { trails: true, names: !payload.solid, centres: !payload.solid };
}

/** The kinds of things that a page can show, and where its payload has them. */
export const KINDS = {
  joint: "joints", body: "bodies", driver: "drivers", point: "points", force: "forces", contact: "contacts",
};

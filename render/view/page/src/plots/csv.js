/** The curves that are shown, as a table for other programs. */

/** @param {Float64Array} time  @param {import("../data/quantities.js").Chart[]} charts  @param {string} of */
export function csv(time, charts, of) {
  const columns = charts.flatMap(({ title, unit, lines }) => lines.map(({ name, values }) => {
    const words = lines.length > 1 ? `${title} ${name}` : title;
    return { head: `${[of, words].filter(Boolean).join(" ")}${unit === "1" ? "" : ` [${unit}]`}`, values };
  }));
  const plain = (text) => (/^[=+\-@\t\r\n]/.test(text) ? `'${text}` : text); // else a spreadsheet takes it for a formula
  const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const rows = [["time [s]", ...columns.map((column) => column.head)].map(plain).map(quoted).join(",")];
  for (let k = 0; k < time.length; k++) rows.push([time[k], ...columns.map(({ values }) => Number(values[k].toPrecision(7)))].join(","));
  return `${rows.join("\n")}\n`;
}

/** @param {string} text  @param {string} name */
export function download(text, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** Processor time of a browser, which another load of the machine does not change much (Linux). */
const fs = require("node:fs");

/** Seconds of processor time of all processes below one, this one itself not counted. @param {number} above its id */
exports.used = (above = process.pid) => {
  const parents = new Map(), times = new Map();
  for (const pid of fs.readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      const fields = fs.readFileSync(`/proc/${pid}/stat`, "utf8").replace(/^.*\) /, "").split(" ");
      parents.set(pid, fields[1]);
      times.set(pid, (Number(fields[11]) + Number(fields[12])) / 100);
    } catch { /* it has ended */ }
  }
  const ours = (pid) => pid === String(above) || (parents.has(pid) && ours(parents.get(pid)));
  return [...times].filter(([pid]) => pid !== String(process.pid) && ours(pid)).reduce((sum, [, time]) => sum + time, 0);
};

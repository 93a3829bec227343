/**
 * The payload from its bytes, as render/view/document.py writes them: a header in JSON with arrays beside it.
 * What is in a payload is told in render/view/payload.py.
 *
 * @typedef {Record<string, any>} Payload
 */

const KINDS = {
  f4: Float32Array, f8: Float64Array, i1: Int8Array, u1: Uint8Array, i2: Int16Array, u2: Uint16Array, u4: Uint32Array,
};

/** @param {Uint8Array} bytes compressed or not  @returns {Promise<Payload>} */
export async function decode(bytes) {
  return unpack(isPlain(bytes) ? bytes : await inflate(bytes));
}

/** @param {string} text base64  @returns {Uint8Array} */
export function fromBase64(text) {
  const raw = atob(text.trim());
  const bytes = new Uint8Array(raw.length);
  for (let k = 0; k < raw.length; k++) bytes[k] = raw.charCodeAt(k);
  return bytes;
}

/** @param {Uint8Array} bytes */
function isPlain(bytes) {
  return bytes[0] === 0x4d && bytes[1] === 0x42 && bytes[2] === 0x53 && bytes[3] === 0x56;
}

/** @param {Uint8Array} bytes */
async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** @param {Uint8Array} bytes  @returns {Payload} */
function unpack(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const version = view.getUint32(4, true);
  if (version !== 1) throw new Error(`the payload is of version ${version}, this page reads version 1`);
  const length = view.getUint32(8, true);
  const start = Math.ceil((12 + length) / 8) * 8;
  const header = new TextDecoder().decode(bytes.subarray(12, 12 + length));
  return JSON.parse(header, (_, value) =>
    value !== null && typeof value === "object" && Array.isArray(value.$) ? array(bytes, start, value.$) : value);
}

/** @param {Uint8Array} bytes  @param {number} start  @param {[keyof KINDS, number, number]} what */
function array(bytes, start, [type, offset, count]) {
  const kind = KINDS[type];
  const size = kind.BYTES_PER_ELEMENT;
  const from = start + offset;
  const mixed = new Uint8Array(count * size);
  for (let plane = 0; plane < size; plane++) {
    const base = from + plane * count;
    for (let k = 0; k < count; k++) mixed[k * size + plane] = bytes[base + k];
  }
  return new kind(mixed.buffer);
}

/**
 * The socket to a live page's server: frames in, wishes out; it comes back by itself. studio/live/messages.py and
 * session.py say what is in them.
 */
const AGAIN = 800;
/** Milliseconds until the next try. */

export class Connection {
  /**
   * @param {(header: Record<string, any>, payload: Uint8Array) => void} heard  in the order in which they were sent
   * @param {(there: boolean) => void} told whether the server is there
   */
  constructor(heard, told) {
    this.heard = heard;
    this.told = told;
    this.open();
  }

  open() {
    const { protocol, host, pathname } = location;
    this.socket = new WebSocket(`${protocol === "https:" ? "wss" : "ws"}://${host}${pathname.replace(/[^/]*$/, "")}socket`);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => this.told(true);
    this.socket.onmessage = ({ data }) => this.take(data);
    this.socket.onclose = () => {
      this.told(false);
      setTimeout(() => this.open(), AGAIN);
    };
  }

  /** @param {ArrayBuffer} data */
  take(data) {
    const size = new DataView(data).getUint32(0, true);
    this.heard(JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, size))), new Uint8Array(data, 4 + size));
  }

  /** @param {Record<string, any>} wish */
  say(wish) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(wish));
  }
}

/** Calls `f` at once, and then with the newest value alone, once a frame at most; `drop` forgets one that waits. */
export function newest(f) {
  let waiting = null, busy = false;
  const next = () => {
    busy = waiting !== null;
    if (!busy) return;
    const [now] = waiting;
    waiting = null;
    requestAnimationFrame(next);
    f(now);
  };
  const call = (value) => {
    waiting = [value];
    if (!busy) next();
  };
  call.drop = () => { waiting = null; };
  return call;
}

// The engine: Sixfold as a WebAssembly module, in a worker, so that the page answers while it computes.

// Calls the module (crates/wasm describes its memory). This class and the next function also run in the worker,
// which gets their source: they use nothing else of this page.
class Host {
  static async start(bytes) {
    const host = new Host();
    const { instance } = await WebAssembly.instantiate(bytes, {});
    host.exports = instance.exports;
    return host;
  }

  respond(request) {
    const { memory, reserve, call, release } = this.exports;
    const text = new TextEncoder().encode(request);
    const asked = reserve(text.length);
    if (asked === 0) return JSON.stringify({ error: "the request does not fit in the memory of the page" });
    new Uint8Array(memory.buffer, asked + 4, text.length).set(text);
    const answered = call(asked);
    const length = new DataView(memory.buffer).getUint32(answered, true);
    const response = new TextDecoder().decode(new Uint8Array(memory.buffer, answered + 4, length));
    release(answered);
    return response;
  }
}

function serve() {
  let host = null;
  onmessage = async ({ data }) => {
    try {
      if (data.bytes) host = await Host.start(data.bytes);
      const begun = performance.now();
      const response = data.bytes ? "" : host.respond(data.request);
      postMessage({ number: data.number, response, ms: performance.now() - begun });
    } catch (error) {
      postMessage({ number: data.number, failure: String(error) });
    }
  };
}

// The engine stopped in a request: a fault of Sixfold, not of the input. It has started again.
export class EngineFailure extends Error {}

// The reader stopped a request.
export class EngineStopped extends Error {}

export class Engine {
  // Starts the engine from the bytes of the module.
  static async start(bytes) {
    const engine = new Engine();
    engine.bytes = bytes;
    await engine.restart();
    return engine;
  }

  // The promise of the last request: requests are answered in their order.
  last = Promise.resolve();
  // The mesh that the module keeps.
  kept = null;
  // The time of the last request in milliseconds.
  ms = 0;

  async restart() {
    this.worker?.terminate();
    for (const { reject } of this.waiting?.values() ?? []) reject(new EngineStopped("the computation was stopped, and nothing is changed"));
    this.kept = null;
    this.waiting = new Map();
    this.number = 0;
    const source = `${Host};(${serve})();`;
    try {
      const address = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
      this.worker = new Worker(address);
      this.worker.onmessage = ({ data }) => {
        const { resolve, reject } = this.waiting.get(data.number);
        this.waiting.delete(data.number);
        this.ms = data.ms;
        if (data.failure === undefined) resolve(data.response);
        else reject(new EngineFailure(data.failure));
      };
      this.worker.onerror = (event) => {
        for (const { reject } of this.waiting.values()) reject(new EngineFailure(event.message ?? "the worker"));
      };
      await this.post({ bytes: this.bytes });
      URL.revokeObjectURL(address);
    } catch {
      // A page that may not start workers computes itself.
      this.worker = null;
      this.host = await Host.start(this.bytes);
    }
  }

  post(message) {
    return new Promise((resolve, reject) => {
      this.number += 1;
      this.waiting.set(this.number, { resolve, reject });
      this.worker.postMessage({ ...message, number: this.number });
    });
  }

  async respond(request) {
    if (this.worker) return this.post({ request });
    try {
      const begun = performance.now();
      const response = this.host.respond(request);
      this.ms = performance.now() - begun;
      return response;
    } catch (error) {
      throw new EngineFailure(String(error));
    }
  }

  // Asks about a mesh. `subject` has the fields `mesh`, `triangulate` and `creases` of a request, and is the same
  // object for the same mesh, so that the mesh is sent once. Returns the response. Throws an Error with the message
  // of the engine if the request is wrong, or an EngineFailure.
  ask(subject, request) {
    const answer = this.last.then(() => this.answer(subject, request));
    this.last = answer.catch(() => {});
    return answer;
  }

  async answer(subject, request) {
    const isKept = this.kept === subject;
    const asked = isKept ? { mesh: "last", ...request } : { ...subject, ...request };
    let response;
    try {
      response = JSON.parse(await this.respond(JSON.stringify(asked)));
    } catch (error) {
      if (error instanceof EngineStopped) throw error;
      error.request = JSON.stringify({ ...request, mesh: "…" });
      await this.restart();
      throw error;
    }
    if (response.error !== undefined) {
      // The module keeps the mesh of the last request without an error.
      throw new Error(response.error);
    }
    this.kept = subject;
    return response;
  }
}

// Returns the bytes of text in base64.
export function fromBase64(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}

// Returns the text in base64 of bytes.
export function toBase64(bytes) {
  let text = "";
  for (let i = 0; i < bytes.length; i += 0x8000) text += String.fromCharCode(...bytes.subarray(i, i + 0x8000));
  return btoa(text);
}

export async function gunzip(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export async function gzip(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new CompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

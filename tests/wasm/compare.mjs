// Compares the responses of WebAssembly modules with those of the native program:
// node compare.mjs RESPOND MODULE.wasm… REQUESTS.jsonl…
// A module can be compressed (`.wasm.gz`). Each file of requests goes in order to one engine of each program, so a request can
// name the mesh of an earlier one of the same file as "last".
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { basename } from "node:path";
import { gunzipSync } from "node:zlib";

const [respondPath, ...paths] = process.argv.slice(2);
const modulePaths = paths.filter((path) => /\.wasm(\.gz)?$/.test(path));
const requestPaths = paths.filter((path) => path.endsWith(".jsonl"));

// The weights of these schemes have no sine or cosine. Those of the others can differ in the last bits, because the native
// program and a module have different functions for them. Shapes do not call these functions.
const EXACT_SCHEMES = ["catmull-clark", "midpoint", "bilinear"];
const TOLERANCE = 1e-6;

// Returns whether the response must be the same text.
function isExact(request) {
  try {
    const { subdivide, stencil } = JSON.parse(request).ask;
    const scheme = (subdivide ?? stencil)?.scheme;
    return scheme === undefined || EXACT_SCHEMES.includes(scheme);
  } catch {
    return true;
  }
}

// Returns a function from requests to responses, and one for the size of the memory.
async function start(path) {
  const bytes = readFileSync(path);
  // The module has no imports: an import would be an error here.
  const { instance } = await WebAssembly.instantiate(path.endsWith(".gz") ? gunzipSync(bytes) : bytes, {});
  const { memory, reserve, call, release } = instance.exports;
  const respond = (request) => {
    const text = new TextEncoder().encode(request);
    const asked = reserve(text.length);
    new Uint8Array(memory.buffer, asked + 4, text.length).set(text);
    const answered = call(asked);
    const length = new DataView(memory.buffer).getUint32(answered, true);
    const response = new TextDecoder().decode(new Uint8Array(memory.buffer, answered + 4, length));
    release(answered);
    return response;
  };
  return { respond, memory: () => memory.buffer.byteLength };
}

// Returns the path of the first difference. Numbers with a fraction are equal up to the tolerance.
function difference(ours, native, path = "") {
  if (typeof ours === "number" && typeof native === "number") {
    const areEqual = Number.isInteger(ours) && Number.isInteger(native) ? ours === native : Math.abs(ours - native) <= TOLERANCE;
    return areEqual ? null : `${path}: ${ours}, native ${native}`;
  }
  if (ours === null || native === null || typeof ours !== "object" || typeof native !== "object") {
    return ours === native ? null : `${path}: ${JSON.stringify(ours)}, native ${JSON.stringify(native)}`;
  }
  const keys = new Set([...Object.keys(ours), ...Object.keys(native)]);
  for (const key of keys) {
    const found = difference(ours[key], native[key], `${path}/${key}`);
    if (found) return found;
  }
  return null;
}

let faults = 0;
function fault(message) {
  faults += 1;
  console.error(message);
}

for (const requestsPath of requestPaths) {
  const text = readFileSync(requestsPath, "utf8");
  const requests = text.trimEnd().split("\n");
  const { stdout, status } = spawnSync(respondPath, { input: text, encoding: "utf8", maxBuffer: 1 << 30 });
  const native = stdout.trimEnd().split("\n");
  if (status !== 0 || native.length !== requests.length) fault(`${respondPath} does not answer ${requestsPath}`);
  for (const modulePath of modulePaths) {
    const { respond, memory } = await start(modulePath);
    let identical = 0;
    requests.forEach((request, i) => {
      const ours = respond(request);
      identical += ours === native[i];
      if (ours === native[i]) return;
      const found = difference(JSON.parse(ours), JSON.parse(native[i]));
      if (found || isExact(request)) fault(`${request.slice(0, 200)}\n  ${found ?? "the numbers differ in the last bits"}`);
    });
    // A second time, the memory of the first responses is used again.
    const before = memory();
    requests.forEach(respond);
    if (memory() > before) fault(`the memory of ${modulePath} grows from ${before} to ${memory()} bytes`);
    const errors = native.filter((response) => response.startsWith('{"error"')).length;
    console.log(
      `${basename(modulePath)}, ${basename(requestsPath)}: ${requests.length} requests, ${errors} of them errors, ` +
        `${identical} responses identical`,
    );
  }
}
console.log(`${faults} faults`);
process.exit(faults === 0 && modulePaths.length > 0 && requestPaths.length > 0 ? 0 : 1);

// Compares the responses of the WebAssembly module with those of the native program:
// node compare.mjs MODULE.wasm REQUESTS.jsonl NATIVE.jsonl
import { readFileSync } from "node:fs";

const [modulePath, requestsPath, nativePath] = process.argv.slice(2);
const lines = (path) => readFileSync(path, "utf8").trimEnd().split("\n");

// The module has no imports: an import would be an error here.
const { instance } = await WebAssembly.instantiate(readFileSync(modulePath), {});
const { memory, reserve, call, release } = instance.exports;

function respond(request) {
  const text = new TextEncoder().encode(request);
  const asked = reserve(text.length);
  new Uint8Array(memory.buffer, asked + 4, text.length).set(text);
  const answered = call(asked);
  const length = new DataView(memory.buffer).getUint32(answered, true);
  const response = new TextDecoder().decode(new Uint8Array(memory.buffer, answered + 4, length));
  release(answered);
  return response;
}

// Returns the path of the first difference. Sines and cosines can differ in the last bits, so numbers with a
// fraction are equal up to 1e-6.
function difference(ours, native, path = "") {
  if (typeof ours === "number" && typeof native === "number") {
    const areEqual = Number.isInteger(ours) && Number.isInteger(native) ? ours === native : Math.abs(ours - native) <= 1e-6;
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

const [requests, native] = [lines(requestsPath), lines(nativePath)];
let faults = requests.length === native.length && requests.length > 0 ? 0 : 1;
let identical = 0;
requests.forEach((request, i) => {
  const ours = respond(request);
  identical += ours === native[i];
  const found = difference(JSON.parse(ours), JSON.parse(native[i]));
  if (found) {
    faults += 1;
    console.error(`${request.slice(0, 200)}\n  ${found}`);
  }
});
// A second time, the memory of the first responses is used again.
const before = memory.buffer.byteLength;
requests.forEach(respond);
if (memory.buffer.byteLength > before) {
  faults += 1;
  console.error(`the memory grows from ${before} to ${memory.buffer.byteLength} bytes`);
}
console.log(`${requests.length} requests, ${identical} responses identical, ${faults} faults`);
process.exit(faults === 0 ? 0 : 1);

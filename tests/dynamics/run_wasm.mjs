// Call an entry of the library for browsers: run_wasm.mjs LIBRARY CALL, which has the image of the memory at a base, the
// addresses of three rows of arguments, and the results of the functions of C by the bits of their arguments. Prints
// the image after the call.
import { readFileSync } from "node:fs";

const [library, call] = process.argv.slice(2).map((each) => readFileSync(each));
const { entry, rows, base, image, results } = JSON.parse(call);
const bits = (...numbers) => Buffer.from(new Float64Array(numbers).buffer).toString("hex");
const called = (name) => (...numbers) => Buffer.from(results[name][bits(...numbers)], "hex").readDoubleLE();
const env = new Proxy({}, { get: (_, name) => called(name.replace("call_", "")) });
const { exports } = (await WebAssembly.instantiate(library, { env })).instance;
const given = Buffer.from(image, "base64");
exports.memory.grow(Math.ceil((base + given.length) / 65536));
const memory = Buffer.from(exports.memory.buffer);
memory.set(given, base);
const status = exports[entry](...rows);
if (status) throw new Error(`status ${status}`);
process.stdout.write(memory.subarray(base, base + given.length).toString("base64"));

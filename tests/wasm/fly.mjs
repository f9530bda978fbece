// What the modules give under node, as JSON on standard output. SPDX-License-Identifier: MIT
//
//   node fly.mjs FOLDER_OF_MODULES '[[kind, detector, roll, pixel, height offset, side, knows, seed], ...]'

import { readFileSync } from "node:fs";

import { Goe, LiveFlight } from "../../port/wasm/goe.mjs";

const [folder, flights] = process.argv.slice(2);
const [bytes, flight, golden] = ["goe", "flight", "golden"].map((name) => readFileSync(`${folder}/${name}.wasm`));
const goe = await Goe.load(bytes);
const live = await LiveFlight.load(goe, flight);

/** As fly_main.c prints it. */
function line(report) {
  const values = Float32Array.from(live.fieldNames, (name) => report[name]);
  const bits = [...new Uint32Array(values.buffer)].map((word) => word.toString(16).padStart(8, "0")).join("");
  return `${bits} ${report.status} ${report.reason}`;
}

function fly(values) {
  const controls = Object.fromEntries(live.controlNames.map((name, i) => [name, values[i]]));
  return live.fly(controls).map(line);
}

const begin = performance.now();
const hash = await goe.goldenHash(golden);
const golden_ms = performance.now() - begin;
console.log(JSON.stringify({
  version: live.version,
  imports: WebAssembly.Module.imports(new WebAssembly.Module(bytes)),
  exports: Object.keys(goe.calls),
  flightImports: WebAssembly.Module.imports(new WebAssembly.Module(flight)).map((one) => one.name),
  selfCheck: goe.selfCheck(),
  hash,
  golden_ms,
  flights: JSON.parse(flights ?? "[]").map(fly),
}));

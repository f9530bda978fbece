// The modules, for a page or for node.
// SPDX-License-Identifier: MIT

const utf8 = new TextDecoder();

/** Text with an ending zero, at an address of a memory. */
function textAt(memory, address) {
  const bytes = new Uint8Array(memory.buffer, address);
  return utf8.decode(bytes.slice(0, bytes.indexOf(0)));
}

/** Names one after the other, as live.h has them. */
function namesAt(memory, address) {
  const names = [];
  for (let name = textAt(memory, address); name; name = textAt(memory, address)) {
    names.push(name);
    address += name.length + 1;
  }
  return names;
}

/** The library: goe.wasm, whose calls are those of goe.h, with addresses for pointers. */
export class Goe {
  /** @param {BufferSource} bytes goe.wasm */
  static async load(bytes) {
    const { instance } = await WebAssembly.instantiate(bytes, {});
    return new Goe(instance.exports);
  }

  constructor(calls) {
    this.calls = calls;
    this.memory = calls.memory;
  }

  /** The calls of a module that calls the library. */
  async attach(bytes) {
    const { instance } = await WebAssembly.instantiate(bytes, { env: this.calls });
    return instance.exports;
  }

  /** 0 if the arithmetic is right: goe_self_check of goe.h. */
  selfCheck() {
    return this.calls.goe_self_check();
  }

  /**
   * Flies the embedded logs of the tests through this very instance, and returns the hash of all that comes out, 16 digits.
   * @param {BufferSource} bytes golden.wasm
   */
  async goldenHash(bytes) {
    const { golden_hash } = await this.attach(bytes);
    return textAt(this.memory, golden_hash());
  }
}

/** The flight of live.h: flight.wasm next to a library. */
export class LiveFlight {
  /** @param {BufferSource} bytes flight.wasm */
  static async load(goe, bytes) {
    return new LiveFlight(goe.memory, await goe.attach(bytes));
  }

  constructor(memory, calls) {
    this.memory = memory;
    this.calls = calls;
    this.version = textAt(memory, calls.live_version());
    this.controlNames = namesAt(memory, calls.live_control_names());
    this.fieldNames = namesAt(memory, calls.live_field_names());
  }

  /**
   * Flies the approach that the controls say, by the names of LIVE_CONTROLS, and returns a report for each image: the names of
   * LIVE_FIELDS, status and reason as words.
   */
  fly(controls) {
    const given = new Float32Array(this.memory.buffer, this.calls.live_controls(), this.controlNames.length);
    this.controlNames.forEach((name, i) => {
      if (!Number.isFinite(controls[name])) throw new RangeError(`the control ${name} is not a number`);
      given[i] = controls[name];
    });
    if (this.calls.live_start() === 0) throw new RangeError("the library refuses these settings");
    const reports = [];
    while (this.calls.live_next() === 1) reports.push(this.report());
    return reports;
  }

  report() {
    const values = new Float32Array(this.memory.buffer, this.calls.live_fields(), this.fieldNames.length);
    const report = { status: this.word("live_status"), reason: this.word("live_reason") };
    this.fieldNames.forEach((name, i) => (report[name] = values[i]));
    return report;
  }

  word(call) {
    return textAt(this.memory, this.calls[call]());
  }
}

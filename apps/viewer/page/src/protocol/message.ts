// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The eight bytes that every message begins with, and reading what follows without trust: whatever
// a message claims, nothing is read beyond its end (docs/viewer_protocol.md).

export const protocolVersion = 1;

export const fromServer = {
  hello: 1,
  points: 2,
  snapshot: 3,
  mesh: 4,
  shell: 5,
  slice: 6,
  pick: 7,
  feel: 8,
  recording: 9,
  progress: 10,
  scene: 11,
  files: 12,
  done: 13,
  error: 14,
} as const;

export const toServer = {
  drive: 64,
  slice: 65,
  shell: 66,
  mesh: 67,
  pick: 68,
  feel: 69,
  openRecording: 70,
  follow: 71,
  build: 72,
  saveScene: 73,
  openScene: 74,
  saveField: 75,
  list: 76,
  rate: 77,
} as const;

/** What a message that cannot be read throws: which one, and what is wrong with it. */
export class UnreadableMessage extends Error {}

/** One message from the server. */
export class Message {
  readonly type: number;
  readonly id: number;
  private readonly view: DataView;

  constructor(readonly bytes: ArrayBuffer) {
    if (bytes.byteLength < 8) throw new UnreadableMessage("a message of fewer than 8 bytes");
    this.view = new DataView(bytes);
    this.type = this.u16(0);
    const version = this.u16(2);
    if (version !== protocolVersion) {
      throw new UnreadableMessage(
        `the server speaks version ${version} of the protocol, this page version ${protocolVersion}: reload the page`,
      );
    }
    this.id = this.u32(4);
  }

  u8(at: number): number {
    this.reach(at, 1);
    return this.view.getUint8(at);
  }
  u16(at: number): number {
    this.reach(at, 2);
    return this.view.getUint16(at, true);
  }
  u32(at: number): number {
    this.reach(at, 4);
    return this.view.getUint32(at, true);
  }
  i32(at: number): number {
    this.reach(at, 4);
    return this.view.getInt32(at, true);
  }
  f32(at: number): number {
    this.reach(at, 4);
    return this.view.getFloat32(at, true);
  }
  f64(at: number): number {
    this.reach(at, 8);
    return this.view.getFloat64(at, true);
  }
  /** As a number, which is exact below 2^53. */
  u64(at: number): number {
    this.reach(at, 8);
    return Number(this.view.getBigUint64(at, true));
  }

  // Arrays are laid over the message: the machines that browsers run on are little-endian.
  f32s(at: number, length: number): Float32Array {
    return new Float32Array(this.bytes, this.reach(at, 4 * length, 4), length);
  }
  f64s(at: number, length: number): Float64Array {
    return new Float64Array(this.bytes, this.reach(at, 8 * length, 8), length);
  }
  u32s(at: number, length: number): Uint32Array {
    return new Uint32Array(this.bytes, this.reach(at, 4 * length, 4), length);
  }
  u16s(at: number, length: number): Uint16Array {
    return new Uint16Array(this.bytes, this.reach(at, 2 * length, 2), length);
  }
  u8s(at: number, length: number): Uint8Array {
    return new Uint8Array(this.bytes, this.reach(at, length), length);
  }

  /** JSON from `at` on, to the end or for so many bytes. */
  json(at = 8, length = this.bytes.byteLength - at): unknown {
    const text = new TextDecoder("utf-8").decode(this.u8s(at, length));
    try {
      return JSON.parse(text);
    } catch {
      throw new UnreadableMessage(`message ${this.type}: what should be JSON is none`);
    }
  }

  private reach(at: number, length: number, alignment = 1): number {
    const whole = Number.isSafeInteger(at) && Number.isSafeInteger(length) && at >= 0 && length >= 0;
    if (!whole || at + length > this.bytes.byteLength) {
      throw new UnreadableMessage(
        `message ${this.type}: ${length} bytes at ${at} lie beyond its ${this.bytes.byteLength}`,
      );
    }
    if (at % alignment !== 0) throw new UnreadableMessage(`message ${this.type}: unaligned array`);
    return at;
  }
}

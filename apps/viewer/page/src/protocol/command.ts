// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Writes the page's messages (docs/viewer_protocol.md, "From the page").
import { protocolVersion, toServer } from "./message";
import type { Axis } from "./shapes";

/** Sets the id of a command that is ready to be sent. */
export function withId(command: ArrayBuffer, id: number): ArrayBuffer {
  new DataView(command).setUint32(4, id, true);
  return command;
}

function begin(type: number, length: number): [ArrayBuffer, DataView] {
  const bytes = new ArrayBuffer(length);
  const view = new DataView(bytes);
  view.setUint16(0, type, true);
  view.setUint16(2, protocolVersion, true);
  return [bytes, view];
}

export function jsonCommand(type: number, content: unknown): ArrayBuffer {
  const text = new TextEncoder().encode(JSON.stringify(content));
  const [bytes] = begin(type, 8 + text.length);
  new Uint8Array(bytes).set(text, 8);
  return bytes;
}

export function emptyCommand(type: number): ArrayBuffer {
  return begin(type, 8)[0];
}

export function sliceCommand(axis: Axis, where: number, samples: number): ArrayBuffer {
  const [bytes, view] = begin(toServer.slice, 24);
  view.setUint8(8, axis);
  view.setUint16(10, samples, true);
  view.setFloat64(16, where, true);
  return bytes;
}

/** @param step in voxels; 0 leaves it to the server */
export function shellCommand(rank: number, step = 0): ArrayBuffer {
  const [bytes, view] = begin(toServer.shell, 12);
  view.setUint16(8, rank, true);
  view.setUint16(10, step, true);
  return bytes;
}

export function meshCommand(kind: "object" | "link", index: number): ArrayBuffer {
  const [bytes, view] = begin(toServer.mesh, 12);
  view.setUint8(8, kind === "link" ? 1 : 0);
  view.setUint16(10, index, true);
  return bytes;
}

export function pickCommand(point: readonly [number, number, number]): ArrayBuffer {
  const [bytes, view] = begin(toServer.pick, 32);
  point.forEach((x, n) => view.setFloat64(8 + 8 * n, x, true));
  return bytes;
}

export function rateCommand(perSecond: number): ArrayBuffer {
  const [bytes, view] = begin(toServer.rate, 10);
  view.setUint16(8, perSecond, true);
  return bytes;
}

function drive(kind: number, keepsOrientation: boolean, target: readonly number[]): ArrayBuffer {
  const [bytes, view] = begin(toServer.drive, 16 + 8 * target.length);
  view.setUint8(8, kind);
  view.setUint8(9, keepsOrientation ? 0 : 1);
  view.setUint16(10, kind === 2 ? target.length : 0, true);
  target.forEach((x, n) => view.setFloat64(16 + 8 * n, x, true));
  return bytes;
}

export function holdCommand(): ArrayBuffer {
  return drive(0, true, []);
}

/** @param pose target of the tool link in W: x, y, z and a quaternion x, y, z, w */
export function toolCommand(pose: readonly number[], keepsOrientation: boolean): ArrayBuffer {
  return drive(1, keepsOrientation, pose);
}

export function jointsCommand(targets: readonly number[]): ArrayBuffer {
  return drive(2, true, targets);
}

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// MESH, SHELL and SLICE: what of the field is to be drawn.
import { UnreadableMessage, type Message } from "./message";

export interface MeshAnswer {
  generation: number;
  isLink: boolean;
  index: number;
  simplified: boolean;
  /** Shape (v,3) [m]: objects in W, links in the link's frame. */
  vertices: Float32Array;
  triangles: Uint32Array;
}

export function readMesh(message: Message): MeshAnswer {
  const [v, t] = [message.u32(16), message.u32(20)];
  const triangles = message.u32s(24 + 12 * v, 3 * t);
  if (triangles.some((vertex) => vertex >= v)) {
    throw new UnreadableMessage("a mesh whose triangles have vertices that are not there");
  }
  return {
    generation: message.u32(8),
    isLink: message.u8(12) === 1,
    index: message.u16(14),
    simplified: message.u8(13) === 1,
    vertices: message.f32s(24, 3 * v),
    triangles,
  };
}

/** Faces of cells, four words each, as the wire has them (see quad.ts). */
export interface ShellPart {
  generation: number;
  rank: number;
  step: number;
  part: number;
  parts: number;
  quads: Uint32Array;
}

export function readShellPart(message: Message): ShellPart {
  return {
    generation: message.u32(8),
    rank: message.u16(12),
    step: message.u16(14),
    part: message.u32(16),
    parts: message.u32(20),
    quads: message.u32s(32, 4 * message.u32(24)),
  };
}

export type Axis = 0 | 1 | 2;
export const axisNames = ["x", "y", "z"] as const;

export interface SliceAnswer {
  generation: number;
  axis: Axis;
  step: number;
  index: number;
  width: number;
  height: number;
  where: number;
  codes: Uint8Array | Uint16Array;
}

export function readSlice(message: Message): SliceAnswer {
  const [axis, bytes] = [message.u8(12), message.u8(13)];
  if (axis > 2) throw new UnreadableMessage(`a slice along axis ${axis}`);
  const [width, height] = [message.u32(20), message.u32(24)];
  return {
    generation: message.u32(8),
    axis: axis as Axis,
    step: message.u16(14),
    index: message.i32(16),
    width,
    height,
    where: message.f64(32),
    codes: bytes === 2 ? message.u16s(40, width * height) : message.u8s(40, width * height),
  };
}

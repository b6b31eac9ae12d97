// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// POINTS and SNAPSHOT: the arm at one moment, and what it feels.
import type { Message } from "./message";

/** In the order of the wire. */
export const statuses = [
  "ok",
  "started",
  "beyond joint limits",
  "outside field",
  "deadline missed",
  "time stood still",
  "time ran backwards",
  "not finite",
  "wrong size",
  "jumped",
  "not passive",
] as const;
export const drivers = ["hold", "tool", "joints", "recording"] as const;
export const limiterModes = ["none", "strict", "device"] as const;
export const dragLimits = ["none", "damping", "mass", "quantisation", "force", "torque"] as const;

/** Body points that snapshots talk about. */
export interface BodyPoints {
  link: Uint32Array;
  /** p_LR in its link's frame, shape (n,3) [m]. */
  place: Float32Array;
  /** Share of the surface, shape (n,) [m²]. */
  area: Float32Array;
  /** Among all body points. */
  index: Uint32Array;
}

export function readPoints(message: Message): BodyPoints {
  const n = message.u32(8);
  return {
    link: message.u32s(16, n),
    place: message.f32s(16 + 4 * n, 3 * n),
    area: message.f32s(16 + 16 * n, n),
    index: message.u32s(16 + 20 * n, n),
  };
}

export interface Reason {
  point: number;
  link: number;
  object: number;
  kind: number;
  rank: number;
  share: number;
  distance: number;
  timeToContact: number;
}

export interface Snapshot {
  generation: number;
  number: number;
  time: number;
  ticks: number;
  skipped: number;
  missed: number;
  refused: number;
  status: number;
  driver: number;
  limiterMode: number;
  limit: number;
  passive: boolean;
  pointsFelt: number;
  energy: number;
  force: Float32Array;
  moment: Float32Array;
  tool: Float32Array;
  toolVelocity: Float32Array;
  masterForce: number;
  power: number;
  scale: number;
  felt: number;
  lag: number;
  highestViscosity: number;
  pulledTo: Float32Array;
  reason: Reason;
  tickP50: number;
  tickP99: number;
  tickLargest: number;
  lateness: number;
  recordingTime: number;
  q: Float64Array;
  qd: Float64Array;
  tau: Float64Array;
  links: Float32Array;
  pointViscosity: Float32Array;
  pointDrag: Float32Array;
}

export function readSnapshot(message: Message): Snapshot {
  const [n, l, p] = [message.u16(56), message.u16(58), message.u16(60)];
  const links = 264 + 24 * n;
  const viscosity = links + 28 * l;
  return {
    generation: message.u32(8),
    number: message.u32(12),
    time: message.f64(16),
    ticks: message.u64(24),
    skipped: message.u64(32),
    missed: message.u64(40),
    refused: message.u64(48),
    status: message.u8(64),
    driver: message.u8(65),
    limiterMode: message.u8(66),
    limit: message.u8(67),
    passive: message.u8(69) === 1,
    pointsFelt: message.u16(70),
    energy: message.f64(72),
    force: message.f32s(104, 3),
    moment: message.f32s(116, 3),
    tool: message.f32s(128, 7),
    toolVelocity: message.f32s(156, 3),
    masterForce: message.f32(168),
    power: message.f32(172),
    scale: message.f32(176),
    felt: message.f32(188),
    lag: message.f32(192),
    highestViscosity: message.f32(196),
    pulledTo: message.f32s(200, 3),
    reason: {
      point: message.i32(212),
      link: message.i32(216),
      object: message.i32(220),
      kind: message.i32(224),
      rank: message.i32(228),
      share: message.f32(232),
      distance: message.f32(236),
      timeToContact: message.f32(240),
    },
    tickP50: message.f32(244),
    tickP99: message.f32(248),
    tickLargest: message.f32(252),
    lateness: message.f32(256),
    recordingTime: message.f32(260),
    q: message.f64s(264, n),
    qd: message.f64s(264 + 8 * n, n),
    tau: message.f64s(264 + 16 * n, n),
    links: message.f32s(links, 7 * l),
    pointViscosity: message.f32s(viscosity, p),
    pointDrag: message.f32s(viscosity + 4 * p, 3 * p),
  };
}

function areEqual(a: ArrayLike<number>, b: ArrayLike<number>): boolean {
  return a.length === b.length && Array.prototype.every.call(a, (x: number, n: number) => x === b[n]);
}

/** Whether nothing that is drawn differs: an arm at rest need not be drawn again. */
export function isSameMoment(a: Snapshot, b: Snapshot | null): boolean {
  if (!b || a.generation !== b.generation) return false;
  const parts = ["q", "force", "pulledTo", "pointViscosity", "pointDrag"] as const;
  return parts.every((part) => areEqual(a[part], b[part]));
}

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// How far ahead of the tool the hand may be: without a limit a key held down in heavy layers would
// wind up a pull that is let go of later.
import type { Vec3 } from "../protocol/hello";

/** The target, or the point towards it that is `most` from the tool. */
export function limitLead(target: Vec3, tool: Vec3, most: number): Vec3 {
  const lead = target.map((x, n) => x - tool[n]!) as Vec3;
  const length = Math.hypot(...lead);
  if (!(length > most)) return target;
  return tool.map((x, n) => x + (lead[n]! * most) / length) as Vec3;
}

/** A stick's rest is not exactly zero: nothing below the dead zone, then from zero on. */
export function withDeadZone(x: number, dead = 0.12): number {
  const size = Math.abs(x);
  return size <= dead || !Number.isFinite(x) ? 0 : (Math.sign(x) * (Math.min(1, size) - dead)) / (1 - dead);
}

/** Strength of the rumble, 0..1: in proportion to the drag, half at `halfAt`, full at twice that. */
export function rumble(felt: number, halfAt: number): number {
  if (!(felt > 0) || !(halfAt > 0)) return 0;
  return Math.min(1, felt / (2 * halfAt));
}

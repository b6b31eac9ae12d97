// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

import { expect, test } from "vitest";
import { limitLead, rumble, withDeadZone } from "../../src/input/lead";
import type { Vec3 } from "../../src/protocol/hello";
import { seeded } from "./seeded";

test("a target is never farther ahead than allowed, and keeps its direction", () => {
  const random = seeded(3);
  for (let trial = 0; trial < 500; ++trial) {
    const point = (): Vec3 => [random() - 0.5, random() - 0.5, random() - 0.5];
    const [target, tool] = [point(), point()];
    const kept = limitLead(target, tool, 0.2);
    const [lead, wanted] = [kept, target].map((end) => end.map((x, n) => x - tool[n]!)) as [Vec3, Vec3];
    expect(Math.hypot(...lead)).toBeLessThanOrEqual(0.2 + 1e-12);
    const along = lead.reduce((sum, x, n) => sum + x * wanted[n]!, 0);
    expect(along).toBeCloseTo(Math.hypot(...lead) * Math.hypot(...wanted), 12);
  }
});

test("a stick at rest moves nothing, a full one everything", () => {
  expect(withDeadZone(0.05)).toBe(0);
  expect(withDeadZone(1)).toBe(1);
  expect(withDeadZone(-1)).toBe(-1);
  expect(withDeadZone(NaN)).toBe(0);
});

test("rumble is in proportion to the drag until it is full", () => {
  expect(rumble(1, 2)).toBe(0.25);
  expect(rumble(2, 2)).toBe(0.5);
  expect(rumble(100, 2)).toBe(1);
  expect(rumble(NaN, 2)).toBe(0);
});

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

import { expect, test } from "vitest";
import { HeavyPointer, mobility } from "../../src/input/heavy_pointer";

test("in free space the pointer goes where the mouse goes", () => {
  const pointer = new HeavyPointer(10, 20);
  pointer.move(5, -7, mobility(0, 2));
  expect([pointer.x, pointer.y]).toEqual([15, 13]);
});

test("more drag never makes it lighter, and no drag stops it", () => {
  let before = 1;
  for (let felt = 0.01; felt < 1e6; felt *= 1.7) {
    const share = mobility(felt, 2);
    expect(share).toBeLessThanOrEqual(before);
    expect(share).toBeGreaterThan(0);
    before = share;
  }
  expect(mobility(2, 2)).toBe(0.5);
});

test("a force that is no number makes nothing heavy", () => {
  expect(mobility(NaN, 2)).toBe(1);
  expect(mobility(-3, 2)).toBe(1);
  expect(mobility(3, 0)).toBe(1);
});

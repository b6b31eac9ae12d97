// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

import { Quaternion, Vector3 } from "three";
import { expect, test } from "vitest";
import { placePoints } from "../../src/view/rigid";
import { seeded } from "./seeded";

test("points move with their links as three.js moves them", () => {
  const random = seeded(11);
  const spread = (): number => 4 * random() - 2;
  for (let trial = 0; trial < 200; ++trial) {
    const rotation = new Quaternion(spread(), spread(), spread(), spread()).normalize();
    const origin = new Vector3(spread(), spread(), spread());
    const p = new Vector3(spread(), spread(), spread());
    const poses = new Float32Array([9, 9, 9, 0, 0, 0, 1, ...origin.toArray(), ...rotation.toArray()]);
    const out = new Float32Array(3);
    placePoints(new Float32Array(p.toArray()), new Uint32Array([1]), poses, out);
    const expected = p.clone().applyQuaternion(rotation).add(origin).toArray();
    expected.forEach((x, n) => expect(out[n]).toBeCloseTo(x, 5));
  }
});

test("a point of a link that has no pose stays where it was", () => {
  const out = new Float32Array([1, 2, 3]);
  placePoints(new Float32Array(3), new Uint32Array([4]), new Float32Array(7), out);
  expect([...out]).toEqual([1, 2, 3]);
});

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

import { Box3, Ray as ThreeRay, Vector3 } from "three";
import { expect, test } from "vitest";
import type { Vec3 } from "../../src/protocol/hello";
import { firstQuadHit } from "../../src/view/quad";
import { seeded } from "./seeded";

// The six faces of a box of cells, as the server would send them.
function box(lo: Vec3, hi: Vec3, object: number): number[] {
  const size = hi.map((x, n) => x - lo[n]!);
  return [0, 1, 2, 3, 4, 5].flatMap((face) => {
    const axis = face >> 1;
    const first = [...lo];
    if (face & 1) first[axis] = hi[axis]! - 1;
    const [a, b] = [0, 1, 2].filter((n) => n !== axis).map((n) => size[n]!);
    return [first[0]! | (first[1]! << 16), first[2]! | (a! << 16), b! | (face << 16), object];
  });
}

test("a ray meets the faces of a box of cells where it meets the box", () => {
  const random = seeded(7);
  const [origin, cell] = [[-0.1, 0.2, -0.3] as Vec3, 0.004];
  let hits = 0;
  for (let trial = 0; trial < 2000; ++trial) {
    const lo = [0, 1, 2].map(() => Math.floor(random() * 400)) as Vec3;
    const hi = lo.map((x) => x + 1 + Math.floor(random() * 200)) as Vec3;
    const from = [0, 1, 2].map(() => random() * 8 - 4) as Vec3;
    const to = lo.map((x, n) => origin[n]! + cell * (x + (1.4 * random() - 0.2) * (hi[n]! - x))) as Vec3;
    const direction = to.map((x, n) => x - from[n]!) as Vec3;
    const corner = (c: Vec3): Vector3 => new Vector3(...c).multiplyScalar(cell).add(new Vector3(...origin));
    const other = new ThreeRay(new Vector3(...from), new Vector3(...direction).normalize());
    const solid = new Box3(corner(lo), corner(hi));
    if (solid.containsPoint(other.origin)) continue;
    const expected = other.intersectBox(solid, new Vector3());
    const quads = new Uint32Array(box(lo, hi, 3));
    const hit = firstQuadHit({ origin: from, direction }, quads, origin, cell, () => true);
    expect(hit !== null, `trial ${trial}`).toBe(expected !== null);
    if (!hit || !expected) continue;
    hits += 1;
    expect(hit.object).toBe(3);
    expect(hit.at).toBeCloseTo(expected.distanceTo(other.origin) / new Vector3(...direction).length(), 9);
  }
  expect(hits).toBeGreaterThan(500);
});

test("what is hidden is looked through", () => {
  const quads = new Uint32Array([...box([10, 0, 0], [20, 10, 10], 0), ...box([30, 0, 0], [40, 10, 10], 1)]);
  const ray = { origin: [0, 5, 5] as Vec3, direction: [1, 0, 0] as Vec3 };
  const seen = firstQuadHit(ray, quads, [0, 0, 0], 1, (object) => object !== 0);
  expect(seen).toEqual({ at: 30, object: 1, axis: 0, sign: -1 });
});

test("faces that no wire can mean are passed over", () => {
  const quads = new Uint32Array([0, 0xffff0000, 0xffff | (9 << 16), 0]);
  const ray = { origin: [0, 0, 0] as Vec3, direction: [1, 1, 1] as Vec3 };
  expect(firstQuadHit(ray, quads, [0, 0, 0], 1, () => true)).toBeNull();
});

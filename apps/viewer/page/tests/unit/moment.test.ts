// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

import { Quaternion } from "three";
import { expect, test } from "vitest";
import { indexAt, posesAt, reasonAt, statusAt } from "../../src/play/moment";
import type { Recording } from "../../src/protocol/recording";
import { seeded } from "./seeded";

function recording(frames: number[], poses: number[]): Recording {
  return {
    name: "log",
    number: 1,
    duration: frames.at(-1) ?? 0,
    t: new Float64Array(),
    columns: new Map(),
    statuses: [
      { row: 0, status: "started" },
      { row: 10, status: "ok" },
    ],
    reasons: [
      { row: 5, reason: { link: "a", object: "b", rank: 1, distanceMm: 2 } },
      { row: 8, reason: null },
    ],
    frames: new Float64Array(frames),
    poses: new Float32Array(poses),
    links: 1,
  };
}

test("the entry at a time is the last that is not after it, as a plain search finds", () => {
  const random = seeded(5);
  for (let trial = 0; trial < 300; ++trial) {
    const times = Array.from({ length: Math.floor(20 * random()) }, () => random()).sort((a, b) => a - b);
    const time = 1.2 * random() - 0.1;
    const plain = times.filter((t) => t <= time).length - 1;
    expect(indexAt(times, time)).toBe(Math.max(0, plain));
  }
});

test("half way between two frames a link is half way, turned half as far", () => {
  const turned = new Quaternion().setFromAxisAngle({ x: 0, y: 0, z: 1 } as never, 1);
  const [qx, qy, qz, qw] = turned.toArray() as [number, number, number, number];
  for (const sign of [1, -1]) {
    const two = recording([0, 2], [0, 0, 0, 0, 0, 0, 1, 4, 2, 0, sign * qx, sign * qy, sign * qz, sign * qw]);
    const out = new Float32Array(7);
    posesAt(two, 1, out);
    expect([out[0], out[1]]).toEqual([2, 1]);
    expect(Math.abs(2 * Math.atan2(out[5]!, out[6]!))).toBeCloseTo(0.5, 3);
    posesAt(two, 99, out);
    expect(out[0]).toBe(4);
    posesAt(two, -1, out);
    expect(out[0]).toBe(0);
  }
});

test("a status and a reason hold from their row on", () => {
  const some = recording([], []);
  expect(statusAt(some, 9)).toBe("started");
  expect(statusAt(some, 10)).toBe("ok");
  expect(reasonAt(some, 4)).toBeNull();
  expect(reasonAt(some, 6)?.object).toBe("b");
  expect(reasonAt(some, 8)).toBeNull();
});

test("a recording without frames leaves the arm where it is", () => {
  const out = new Float32Array([1, 2, 3, 0, 0, 0, 1]);
  posesAt(recording([], []), 0.5, out);
  expect([...out]).toEqual([1, 2, 3, 0, 0, 0, 1]);
});

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

import { expect, test } from "vitest";
import { Player } from "../../src/play/player";
import { recordedColumns } from "../../src/play/recorded_columns";
import type { Recording } from "../../src/protocol/recording";

function lasting(duration: number): Recording {
  return { duration } as Recording;
}

test("two recordings share one time, which ends with the longer", () => {
  const player = new Player(() => undefined);
  player.put(0, lasting(2));
  player.put(1, lasting(5));
  player.loop = false;
  player.play(true);
  player.step(4);
  expect([player.time, player.playing]).toEqual([4, true]);
  player.step(4);
  expect([player.time, player.playing]).toEqual([5, false]);
  player.play(true);
  expect(player.time).toBe(0);
});

test("a loop begins anew, at any speed", () => {
  const player = new Player(() => undefined);
  player.put(0, lasting(2));
  player.speed = 4;
  player.play(true);
  player.step(0.75);
  expect(player.time).toBeCloseTo(1, 12);
  expect(player.playing).toBe(true);
});

test("scrubbing stays within the recording, and nothing plays where nothing is", () => {
  const player = new Player(() => undefined);
  player.play(true);
  expect(player.playing).toBe(false);
  player.put(0, lasting(2));
  player.seek(-1);
  expect(player.time).toBe(0);
  player.seek(9);
  expect(player.time).toBe(2);
  player.put(0, null);
  expect([player.time, player.isOpen]).toEqual([0, false]);
});

test("columns of a recording: norm of the force, work of the torques, speed of the tool", () => {
  const still = [0, 0, 0, 0, 0, 0, 1];
  const recording: Recording = {
    name: "felt",
    number: 1,
    duration: 2,
    t: new Float64Array([0, 1, 2]),
    columns: new Map([
      ["q_a", new Float64Array([0, 0.5, 1])],
      ["tau_a", new Float64Array([0, -2, -4])],
      ["fx", new Float64Array([3, 0, NaN])],
      ["fy", new Float64Array([0, 0, 0])],
      ["fz", new Float64Array([4, 0, 0])],
    ]),
    statuses: [{ row: 0, status: "started" }, { row: 1, status: "ok" }],
    reasons: [],
    frames: new Float64Array([0, 1, 2]),
    poses: new Float32Array([...still, 0, 2, ...still.slice(2), 0, 2, ...still.slice(2)]),
    links: 1,
  };
  const [t, force, viscosity, speed, energy, , status] = recordedColumns(recording, 0);
  expect(t).toEqual([0, 1, 2]);
  expect(force).toEqual([5, 0, null]);
  expect(viscosity).toEqual([null, null, null]);
  expect(speed).toEqual([2, 0, 0]);
  expect(energy).toEqual([0, 1, 3]);
  expect(status).toEqual([1, 0, 0]);
});

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

import { expect, test } from "vitest";
import { RollingRecord } from "../../src/strip/rolling_record";

test("columns stay of one length, and nothing older than the window by more than its step is kept", () => {
  const record = new RollingRecord(2, 10);
  for (let i = 0; i <= 3000; ++i) record.add(i / 60, [i, i % 3 ? null : -i]);
  const [times, a, b] = record.columns();
  expect(a?.length).toBe(times.length);
  expect(b?.length).toBe(times.length);
  expect(times.at(-1)).toBe(50);
  expect(times[0]).toBeGreaterThan(50 - 10 - 1);
  expect(times[0]).toBeLessThanOrEqual(40);
  expect(a?.at(-1)).toBe(3000);
});

test("time that goes back begins the record anew; a repeated time adds nothing", () => {
  const record = new RollingRecord(1, 10);
  record.add(5, [1]);
  record.add(5, [2]);
  expect(record.length).toBe(1);
  record.add(1, [3]);
  expect(record.columns()).toEqual([[1], [3]]);
});

test("what is no number is a gap", () => {
  const record = new RollingRecord(2, 10);
  record.add(0, [NaN, Infinity]);
  expect(record.columns()).toEqual([[0], [null], [null]]);
});

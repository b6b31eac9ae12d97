// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

import { expect, test } from "vitest";
import { bytesText, clockText, forceText, lengthText, plainNumber, secondsText, sizeText } from "../../src/text/units";

test("a size is told as each unit would make it", () => {
  const size = [120, 80, 40] as const;
  expect(sizeText(size, "mm")).toBe("120 × 80.0 × 40.0 mm");
  expect(sizeText(size, "cm")).toBe("1.20 × 0.800 × 0.400 m");
  expect(sizeText(size, "m")).toBe("120 × 80.0 × 40.0 m");
  expect(sizeText(size, "in")).toBe("3.05 × 2.03 × 1.02 m");
  expect(sizeText([5000, 1, 1], "m")).toBe("5.00 × 0.00100 × 0.00100 km");
});

test("lengths, forces and times have the unit in which they are read easily", () => {
  expect([lengthText(0.031), lengthText(0.0123456), lengthText(2.5)]).toEqual(["31 mm", "12.3 mm", "2.50 m"]);
  expect([forceText(0.0321), forceText(12.34), forceText(0)]).toEqual(["32.1 mN", "12.3 N", "0 N"]);
  expect([secondsText(0.4), secondsText(2)]).toEqual(["400 ms", "2.00 s"]);
  expect([clockText(62.349), clockText(-1)]).toEqual(["1:02.35", "0:00.00"]);
  expect([bytesText(12), bytesText(98370944)]).toEqual(["12 B", "98.4 MB"]);
  expect([plainNumber(32), plainNumber(13.35), plainNumber(4.123456)]).toEqual(["32", "13.35", "4.123"]);
});

test("what is no number reads as none", () => {
  for (const text of [lengthText, forceText, secondsText, plainNumber]) expect(text(NaN)).toBe("–");
});

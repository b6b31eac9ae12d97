// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

import { expect, test } from "vitest";
import type { Field, Robot } from "../../src/protocol/hello";
import { reasonLine, recordedReasonLine } from "../../src/text/reason";

const field = { objects: [{ name: "bench" }, { name: "vessel" }] } as Field;
const robot = { links: [{ name: "base" }, { name: "link_5" }] } as Robot;
const felt = { point: 12, link: 1, object: 1, kind: 1, rank: 2, share: 0.4, distance: 0.031, timeToContact: 0.4 };

test("a reason names link, object, rank, distance and time", () => {
  expect(reasonLine(felt, field, robot)).toBe(
    "link_5 → vessel, rank 2, at least 31 mm, 400 ms to contact",
  );
});

test("where nothing is felt there is no reason", () => {
  expect(reasonLine({ ...felt, point: -1 }, field, robot)).toBeNull();
  expect(recordedReasonLine(null)).toBeNull();
});

test("what is only remembered has no object to name", () => {
  expect(reasonLine({ ...felt, object: -1 }, field, robot)).toContain("only remembered");
});

test("touching has no distance, and an unknown time is left out", () => {
  expect(reasonLine({ ...felt, kind: 3 }, field, robot)).toBe("link_5 → vessel, at its surface");
  expect(reasonLine({ ...felt, timeToContact: 0 }, field, robot)).not.toContain("contact");
});

test("a recorded reason reads like a live one", () => {
  const reason = { link: "link_5", object: "vessel", rank: 2, distanceMm: 31 };
  expect(recordedReasonLine(reason)).toBe("link_5 → vessel, rank 2, at least 31 mm");
});

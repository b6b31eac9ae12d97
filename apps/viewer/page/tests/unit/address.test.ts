// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

import { expect, test } from "vitest";
import { readAddress } from "../../src/app/address";

test("an address says what is to be seen", () => {
  expect(readAddress("?shot&theme=light&view=top&slice=z:0.95&cut=off&shells=1,6&panels=off")).toEqual({
    theme: "light",
    view: "top",
    slice: { axis: 2, where: 0.95 },
    cutAway: false,
    shells: [1, 6],
    panels: false,
  });
  expect(readAddress("?shells=all&slice=off")).toMatchObject({ shells: "all", slice: "off" });
});

test("what is not understood is as if it were not there", () => {
  const nothing = readAddress("");
  for (const odd of ["?theme=pink&view=&slice=w:1", "?slice=y", "?slice=y:", "?slice=y:tall&shells=-1,x", "?cut=maybe"]) {
    expect(readAddress(odd)).toEqual(nothing);
  }
});

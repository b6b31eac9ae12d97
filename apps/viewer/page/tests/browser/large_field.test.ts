// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A field of about 100 MB: many things that lean, with their distances kept. How long it takes
// to open and to draw a frame is printed, and promised nowhere here: a shared machine and a software
// renderer would only be lucky or not.
import { statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { seeded } from "../unit/seeded";
import { launch, openPage, scratchFolder, Server, vicinity } from "./viewer";

const folder = scratchFolder();
const field = join(folder, "large.vicinity");
let browser: Browser;

/** Leaning cylinders on a grid: nothing is parallel to the voxels, so that few bricks are alike. */
function leaningCylinders(): string {
  const random = seeded(1);
  const turn = (): string => (6 * random() - 3).toFixed(3);
  const objects = Array.from({ length: 16 }, (_, n) => {
    const place = [n % 4, Math.floor(n / 4), 0].map((x) => (0.62 * x).toFixed(3));
    return (
      `  - name: cylinder_${n}\n    primitive: {cylinder: {radius: 0.1, height: 0.4}}\n` +
      `    pose: {xyz: [${place.join(", ")}], rpy: [${turn()}, ${turn()}, ${turn()}]}\n`
    );
  });
  return `voxel_size: 0.0025\ndefaults: {shape: distance}\nobjects:\n${objects.join("")}`;
}

beforeAll(async () => {
  const scene = join(folder, "large.yaml");
  writeFileSync(scene, leaningCylinders());
  vicinity(["build", scene, "-o", field]);
  browser = await launch();
});

afterAll(async () => {
  await browser?.close();
});

test("a field of 100 MB opens and is orbited; how fast is printed", async () => {
  const megabytes = statSync(field).size / 1e6;
  const server = await Server.start([field]);
  const begun = performance.now();
  const { page, complaints } = await openPage(browser, server.address);
  const seconds = (performance.now() - begun) / 1000;

  const canvas = (await page.locator("#canvas").boundingBox())!;
  await page.mouse.move(canvas.x + 0.2 * canvas.width, canvas.y + 0.3 * canvas.height);
  await page.mouse.down();
  for (let n = 0; n < 60; ++n) {
    await page.mouse.move(canvas.x + (0.2 + 0.005 * n) * canvas.width, canvas.y + 0.3 * canvas.height);
  }
  await page.mouse.up();
  const times = await page.evaluate(() => {
    return (window as never as { vicinity: { frameTimes(): number[] } }).vicinity.frameTimes();
  });
  const sorted = [...times].sort((a, b) => a - b);
  const at = (share: number): string => (sorted[Math.floor(share * (sorted.length - 1))] ?? NaN).toFixed(1);
  console.log(
    `${megabytes.toFixed(0)} MB open in ${seconds.toFixed(2)} s; ${sorted.length} frames of ` +
      `${at(0.5)} ms (median), ${at(0.99)} ms (p99) while orbited, by a software renderer`,
  );
  expect(megabytes).toBeGreaterThan(80);
  expect(times.length).toBeGreaterThan(0);
  expect(complaints).toEqual([]);
  await page.context().close();
  await server.stop();
});

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// How long a large field takes to open and to be orbited, in numbers that are printed and promised
// nowhere here: a shared machine and a software renderer would only be lucky or not. VICINITY_FIELD
// names the field, VICINITY_RANKS how many of its shells are shown (default 0; `all`).
import { statSync } from "node:fs";
import { expect, test } from "vitest";
import { openPage, Server, theBrowser, type OpenPage } from "../browser/viewer";

const field = process.env.VICINITY_FIELD ?? "";
const shells = process.env.VICINITY_RANKS ?? "";

test("a large field opens and is orbited; how fast is printed", async () => {
  const megabytes = statSync(field).size / 1e6;
  // A browser that somebody uses: it has started, and its own first seconds are over.
  await (await (await theBrowser()).newContext()).newPage();
  await new Promise((settled) => setTimeout(settled, 5000));
  const served = performance.now();
  const server = await Server.start([field]);
  const seconds = (from: number, to: number): string => ((to - from) / 1000).toFixed(2);
  console.log(`${megabytes.toFixed(0)} MB: served after ${seconds(served, performance.now())} s`);
  // The first page also waits for the browser to make its shaders, which it then keeps.
  const open = async (which: string): Promise<OpenPage> => {
    const opened = await openPage(`${server.address}?shells=${shells}`, { width: 1366, height: 768 });
    const drawn = await opened.page.evaluate(() => performance.now());
    const marks = await opened.page.evaluate(() =>
      performance.getEntriesByType("mark").map(({ name, startTime }) => `${name} ${(startTime / 1000).toFixed(2)} s`),
    );
    console.log(`${which} page: all drawn ${seconds(0, drawn)} s after it was asked for (${marks.join(", ")})`);
    return opened;
  };
  await (await open("first")).page.context().close();
  const { page, complaints } = await open("next");

  const canvas = (await page.locator("#canvas").boundingBox())!;
  await page.mouse.move(canvas.x + 0.2 * canvas.width, canvas.y + 0.3 * canvas.height);
  await page.mouse.down();
  for (let n = 0; n < 60; ++n) {
    await page.mouse.move(canvas.x + (0.2 + 0.005 * n) * canvas.width, canvas.y + 0.3 * canvas.height);
  }
  await page.mouse.up();
  const sorted = (await page.evaluate(() => window.vicinity.frameTimes())).sort((a, b) => a - b);
  const at = (share: number): string => (sorted[Math.floor(share * (sorted.length - 1))] ?? NaN).toFixed(1);
  console.log(`orbited in ${sorted.length} frames of ${at(0.5)} ms (median), ${at(0.99)} ms (p99)`);
  expect(sorted.length).toBeGreaterThan(0);
  expect(complaints).toEqual([]);
  await page.context().close();
  await server.stop();
});

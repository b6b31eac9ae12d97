// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Recordings: the output of `vicinity replay`, dropped on the page, scrubbed, one beside another.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { dropFile, hotCell, hotCellField, hotCellStart, longestWait_ms, openPage, scratchFolder, Server, vicinity } from "./viewer";

const folder = scratchFolder();
let server: Server;
let page: Page;
let complaints: string[];

/** What the arm would have felt while its first joint swings, in 2 s. @return the file */
function record(name: string, swing: number): string {
  const start = hotCellStart.split(",").map(Number);
  const lines = ["t," + start.map((_, n) => `joint_${n + 1}`).join(",")];
  for (let k = 0; k <= 40; ++k) {
    const q = start.map((x, n) => (n === 0 ? x + swing * Math.sin(0.1 * k) : x));
    lines.push([0.05 * k, ...q].join(","));
  }
  const log = join(folder, `${name}_log.csv`);
  writeFileSync(log, lines.join("\n") + "\n");
  const felt = join(folder, `${name}.csv`);
  vicinity(["replay", hotCellField(), "--scene", hotCell, "--trajectory", log, "-o", felt]);
  return felt;
}

beforeAll(async () => {
  server = await Server.start([hotCellField(), "--scene", hotCell, "--start", hotCellStart]);
  ({ page, complaints } = await openPage(`${server.address}?view=front&slice=off`));
  await page.keyboard.press("Escape");
});

afterAll(async () => {
  await page?.context().close();
  await server?.stop();
});

/** Whether the left and the right half of the view are the same, and what both are, in short. */
async function halves(): Promise<{ alike: boolean; left: number; right: number }> {
  return page.evaluate(async () => {
    const png = atob(window.vicinity.picture().split(",")[1]!);
    const bitmap = await createImageBitmap(new Blob([Uint8Array.from(png, (c) => c.charCodeAt(0))]));
    const [width, height] = [bitmap.width / 2, bitmap.height];
    const context = new OffscreenCanvas(bitmap.width, height).getContext("2d", { willReadFrequently: true })!;
    context.drawImage(bitmap, 0, 0);
    const short = (x: number): number => {
      const { data } = context.getImageData(x, 0, width, height);
      return data.reduce((sum, byte) => (Math.imul(sum, 31) + byte) | 0, 0);
    };
    const [left, right] = [short(0), short(width)];
    return { alike: left === right, left, right };
  });
}

async function scrubTo(seconds: number): Promise<void> {
  await page.locator("[data-control=scrub]").fill(String(seconds));
  await page.getByText(`0:${seconds.toFixed(2).padStart(5, "0")} / 0:02.00`).waitFor();
}

test("a recording is dropped and scrubbed: force, status and reason are those of its row", async () => {
  const file = record("one", 0.3);
  await page.getByRole("tab", { name: "Play" }).click();
  await dropFile(page, file);
  await page.getByText("/ 0:02.00").waitFor();
  const [head, ...rows] = readFileSync(file, "utf8").trim().split("\n").map((line) => line.split(","));
  for (const seconds of [1.2, 0.4]) {
    await scrubTo(seconds);
    // The page keeps every row of so short a recording.
    const row = rows.filter(([t]) => Number(t) <= seconds + 1e-9).at(-1)!;
    const of = (name: string): string => row[head!.indexOf(name)]!;
    const force = Math.hypot(...["fx", "fy", "fz"].map((name) => Number(of(name))));
    expect(force).toBeGreaterThan(0);
    const said = page.locator("#right .said");
    const text = await said.textContent();
    expect(text).toContain("one.csv");
    expect(text).toContain(of("status"));
    expect(text).toContain(`${of("reason_link")} → ${of("reason_object")}, rank ${of("reason_rank")}`);
    const reading = page.locator("[data-reading=force]");
    await expect.poll(async () => Number(await reading.textContent()), { timeout: longestWait_ms }).toBeCloseTo(force, 2);
  }
});

test("a second recording stands beside it at the same time, and the same one looks the same", async () => {
  await dropFile(page, record("two", -0.5));
  await expect.poll(async () => (await halves()).alike, { timeout: longestWait_ms }).toBe(false);
  await scrubTo(1.6);
  const apart = await halves();
  expect(apart.alike).toBe(false); // each half has its own arm
  expect(await page.locator("#right .said").textContent()).toContain("two.csv");
  await page.locator("#right").getByLabel("Right", { exact: true }).selectOption("one.csv");
  await expect.poll(halves, { timeout: longestWait_ms }).toEqual({ alike: true, left: apart.left, right: apart.left });
  // Both start at the same place: what differs is their motion, not their drawing.
  await page.locator("#right").getByLabel("Right", { exact: true }).selectOption("two.csv");
  await scrubTo(0);
  await expect.poll(async () => (await halves()).alike, { timeout: longestWait_ms }).toBe(true);
  expect(complaints).toEqual([]);
});

test("it plays by itself, and the live arm follows it when asked", async () => {
  const clock = page.locator("#right .clock");
  const before = await clock.textContent();
  await page.getByRole("button", { name: "Play or pause (Space)" }).click();
  await expect.poll(() => clock.textContent(), { timeout: longestWait_ms }).not.toBe(before);
  await page.getByRole("button", { name: "Play or pause (Space)" }).click();
  const q = (): Promise<number> => page.evaluate(() => window.vicinity.snapshot().q[0]!);
  const rest = await q();
  await page.getByRole("button", { name: "Feel it live" }).click();
  await expect.poll(async () => Math.abs((await q()) - rest), { timeout: longestWait_ms }).toBeGreaterThan(0.01);
  expect(complaints).toEqual([]);
});

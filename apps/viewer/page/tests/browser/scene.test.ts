// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// From STL to feel: dropped, its unit stated, placed, built, felt, saved and opened again.
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { dropFile, openPage, scratchFolder, Server, vicinity } from "./viewer";

const folder = scratchFolder();
let server: Server;

/** A box as a binary STL, without a unit as all are. */
function boxStl(size: readonly [number, number, number]): Buffer {
  const corner = (n: number): number[] => [n & 1, (n >> 1) & 1, (n >> 2) & 1].map((x, axis) => x * size[axis]!);
  const faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
  const triangles = faces.flatMap(([a, b, c, d]) => [[a!, b!, c!], [a!, c!, d!]]);
  const bytes = Buffer.alloc(84 + 50 * triangles.length);
  bytes.writeUInt32LE(triangles.length, 80);
  triangles.forEach((triangle, n) => {
    triangle.flatMap(corner).forEach((x, k) => bytes.writeFloatLE(x, 84 + 50 * n + 12 + 4 * k));
  });
  return bytes;
}

beforeAll(async () => {
  const scene = join(folder, "start.yaml");
  writeFileSync(
    scene,
    "voxel_size: 0.01\nobjects:\n  - name: post\n    primitive: {box: {size: [0.1, 0.1, 0.4]}}\n    pose: {xyz: [0, 0, 0.2]}\n",
  );
  server = await Server.start([scene]);
});

afterAll(async () => {
  await server?.stop();
});

/** Where a length along x is seen from the front, and which way: the gizmo's red arrow. */
async function dragAlongX(page: Page, from: readonly [number, number, number], way: number): Promise<void> {
  const [origin, beside] = await page.evaluate(([x, y, z]) => {
    return [window.vicinity.onPage([x, y, z]), window.vicinity.onPage([x + 0.1, y, z])] as const;
  }, from);
  const length = Math.hypot(beside.x - origin.x, beside.y - origin.y);
  const at = (pixels: number): [number, number] => [
    origin.x + (pixels * (beside.x - origin.x)) / length,
    origin.y + (pixels * (beside.y - origin.y)) / length,
  ];
  const grip = 30; // [px] from the gizmo's middle, within its arrow
  await page.mouse.move(...at(grip));
  await page.mouse.down();
  for (let n = 1; n <= 4; ++n) await page.mouse.move(...at(grip + (way * n) / 4));
  await page.mouse.up();
}

/** Writes down every percentage that the bar of the build has shown. */
function watchProgress(page: Page): Promise<void> {
  return page.evaluate(() => {
    const bar = document.querySelector("#left progress")!;
    const shown: string[] = [];
    new MutationObserver(() => shown.push(bar.nextElementSibling!.textContent ?? "")).observe(bar.parentElement!, {
      subtree: true,
      childList: true,
      characterData: true,
      attributes: true,
    });
    Object.assign(window, { progressShown: shown });
  });
}

test("an STL is dropped, its unit stated, placed, built, saved and opened again", async () => {
  const { page, complaints } = await openPage(`${server.address}?view=front`);
  await page.getByRole("tab", { name: "Edit scene" }).click();
  const file = join(folder, "flange.stl");
  writeFileSync(file, boxStl([120, 80, 40]));
  await dropFile(page, file);

  const dialog = page.getByRole("dialog", { name: "Unit of flange.stl" });
  await dialog.waitFor();
  const text = (await dialog.textContent()) ?? "";
  for (const size of ["120 × 80.0 × 40.0 mm", "120 × 80.0 × 40.0 m", "3.05 × 2.03 × 1.02 m"]) {
    expect(text).toContain(size);
  }
  const add = dialog.getByRole("button", { name: "Add to the scene" });
  expect(await add.isDisabled()).toBe(true); // nothing is guessed
  await dialog.getByText("millimetres", { exact: true }).click();
  await add.click();

  // The gizmo stands at its origin; its arrow carries it along x, and along nothing else.
  const place = (axis: string): Promise<number> => page.getByLabel(`Place ${axis}`).inputValue().then(Number);
  expect([await place("x"), await place("y"), await place("z")]).toEqual([0, 0, 0]);
  await dragAlongX(page, [0, 0, 0], 90);
  const x = await place("x");
  expect(x).toBeGreaterThan(0.1); // beside the post, which ends at 0.05 m
  expect([await place("y"), await place("z")]).toEqual([0, 0]);
  await page.getByLabel("q", { exact: true }).fill("3");
  await page.getByLabel("q", { exact: true }).press("Enter");
  await page.getByLabel("Coding", { exact: true }).fill("30, 20, 10");
  await page.getByLabel("Coding", { exact: true }).press("Enter");
  await watchProgress(page);
  await page.getByRole("button", { name: "Build", exact: true }).click();
  await page.getByText(/^Built in/).waitFor();
  const shown = await page.evaluate(() => (window as never as { progressShown: string[] }).progressShown);
  expect(shown.some((text) => /^\S+, \d+ %$/.test(text))).toBe(true);
  await page.getByRole("tab", { name: "View" }).click();
  await page.locator("#left").getByRole("button", { name: "Hide flange" }).waitFor();

  await page.getByRole("tab", { name: "Edit scene" }).click();
  await page.getByLabel("Name", { exact: true }).first().fill("mine.yaml");
  await page.getByLabel("Name", { exact: true }).first().press("Tab");
  await page.getByRole("button", { name: "Save scene" }).click();
  await page.getByText("Saved as mine.yaml.").waitFor();
  await page.getByRole("button", { name: "Save field" }).click();
  await page.getByText(/^Saved as mine.vicinity/).waitFor();
  expect(complaints).toEqual([]);
  await page.context().close();

  // The command line reads what was saved, and finds the same field in it.
  const saved = join(server.folder, "mine.yaml");
  expect(readFileSync(saved, "utf8")).toContain("flange");
  const rebuilt = join(server.folder, "again.vicinity");
  vicinity(["build", saved, "-o", rebuilt]);
  const near = [x + 0.14, 0.04, 0.02].map(String); // 20 mm beside the flange
  const of = (field: string): unknown => JSON.parse(vicinity(["query", field, "--json", "--", ...near]));
  expect(existsSync(join(server.folder, "mine.vicinity"))).toBe(true);
  expect(of(join(server.folder, "mine.vicinity"))).toEqual(of(rebuilt));
  expect(of(rebuilt)).toMatchObject({ kind: "neighbour", object: "flange", rank: 1, viscosity: 30 });

  // Opened again, by a page that knows nothing of it.
  const again = await openPage(server.address);
  await again.page.getByRole("tab", { name: "Edit scene" }).click();
  await again.page.getByLabel("Open", { exact: true }).selectOption("mine.yaml");
  await again.page.getByText("mine.yaml is open; build it to feel it.").waitFor();
  await again.page.locator("#left").getByRole("button", { name: "flange", exact: true }).click();
  expect(await again.page.getByLabel("Place x").inputValue()).toBe(String(x));
  expect(await again.page.getByLabel("Coding", { exact: true }).inputValue()).toBe("30, 20, 10");
  expect(again.complaints).toEqual([]);
  await again.page.context().close();
});

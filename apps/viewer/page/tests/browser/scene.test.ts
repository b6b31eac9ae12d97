// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// From STL to feel: dropped, its unit stated, placed, built, felt, saved and opened again.
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { launch, openPage, scratchFolder, Server, vicinity } from "./viewer";

let browser: Browser;
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
  const folder = scratchFolder();
  const scene = join(folder, "start.yaml");
  writeFileSync(
    scene,
    "voxel_size: 0.01\nobjects:\n  - name: post\n    primitive: {box: {size: [0.1, 0.1, 0.4]}}\n    pose: {xyz: [0, 0, 0.2]}\n",
  );
  browser = await launch();
  server = await Server.start([scene]);
});

afterAll(async () => {
  await browser?.close();
  await server?.stop();
});

async function drop(page: Page, name: string, bytes: Buffer): Promise<void> {
  await page.evaluate(
    ({ name, bytes }) => {
      const data = new DataTransfer();
      data.items.add(new File([new Uint8Array(bytes)], name));
      window.dispatchEvent(new DragEvent("drop", { dataTransfer: data, cancelable: true }));
    },
    { name, bytes: [...bytes] },
  );
}

test("an STL is dropped, its unit stated, placed, built, saved and opened again", async () => {
  const { page, complaints } = await openPage(browser, server.address);
  await page.getByRole("tab", { name: "Edit scene" }).click();
  await drop(page, "flange.stl", boxStl([120, 80, 40]));

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

  await page.getByLabel("Place x").fill("0.3");
  await page.getByLabel("Place x").press("Enter");
  await page.getByLabel("q", { exact: true }).fill("3");
  await page.getByLabel("q", { exact: true }).press("Enter");
  await page.getByLabel("Coding", { exact: true }).fill("30, 20, 10");
  await page.getByLabel("Coding", { exact: true }).press("Enter");
  await page.getByRole("button", { name: "Build", exact: true }).click();
  await page.getByText(/^Built in/).waitFor();
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
  const near = ["0.44", "0.04", "0.02"]; // 20 mm beside the flange
  const of = (field: string): unknown => JSON.parse(vicinity(["query", field, "--json", "--", ...near]));
  expect(existsSync(join(server.folder, "mine.vicinity"))).toBe(true);
  expect(of(join(server.folder, "mine.vicinity"))).toEqual(of(rebuilt));
  expect(of(rebuilt)).toMatchObject({ kind: "neighbour", object: "flange", rank: 1, viscosity: 30 });

  // Opened again, by a page that knows nothing of it.
  const again = await openPage(browser, server.address);
  await again.page.getByRole("tab", { name: "Edit scene" }).click();
  await again.page.getByLabel("Open", { exact: true }).selectOption("mine.yaml");
  await again.page.getByText("mine.yaml is open; build it to feel it.").waitFor();
  await again.page.locator("#left").getByRole("button", { name: "flange", exact: true }).click();
  expect(await again.page.getByLabel("Place x").inputValue()).toBe("0.3");
  expect(await again.page.getByLabel("Coding", { exact: true }).inputValue()).toBe("30, 20, 10");
  expect(again.complaints).toEqual([]);
  await again.page.context().close();
});

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The page beside a server that has the hot cell at a coarse resolution, and its arm.
import { createHash } from "node:crypto";
import { join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { launch, openPage, repository, scratchFolder, Server, vicinity } from "./viewer";

const scene = join(repository, "scenes/hot_cell.yaml");
const start = "0.08,-0.15,0,2.416,0,-0.695,0"; // between the risers, before the vessel
let browser: Browser;
let server: Server;
let field: string;

beforeAll(async () => {
  field = join(scratchFolder(), "hot_cell.vicinity");
  vicinity(["build", scene, "--voxel-size", "0.012", "-o", field]);
  browser = await launch();
  server = await Server.start([field, "--scene", scene, "--start", start]);
});

afterAll(async () => {
  await browser?.close();
  await server?.stop();
});

/** The pixels that WebGL drew, in short. */
async function picture(page: Page): Promise<string> {
  const png = await page.evaluate(() => (window as never as { vicinity: { picture(): string } }).vicinity.picture());
  return createHash("sha256").update(png).digest("hex");
}

/** Waits until the slice that the page has is another one. */
async function untilCut(page: Page, act: () => Promise<void>): Promise<void> {
  const index = (): Promise<string> =>
    page.evaluate(() => (window as never as { vicinity: { slice(): string } }).vicinity.slice());
  const before = await index();
  await act();
  await expect.poll(index, { timeout: 60_000 }).not.toBe(before);
}

test("the page loads, draws, and its console has nothing to complain about", async () => {
  const { page, complaints } = await openPage(browser, server.address);
  expect(await page.title()).toContain("hot_cell.vicinity");
  expect(await page.locator("[data-reading=status]").textContent()).not.toBe("–");
  const reading = page.getByRole("figure", { name: "Legend of ranks" });
  expect(await reading.textContent()).toContain("32");
  // Nothing but this server was asked for anything.
  const hosts = await page.evaluate(() => performance.getEntriesByType("resource").map(({ name }) => new URL(name).host));
  expect(new Set(hosts)).toEqual(new Set([new URL(server.address).host]));
  expect(complaints).toEqual([]);
  await page.context().close();
});

test("moving the slice changes the picture, and moving it back brings the same one again", async () => {
  const { page, complaints } = await openPage(browser, server.address);
  await page.keyboard.press("Escape"); // hold: an arm at rest leaves the picture alone
  const where = page.getByLabel("Where the slice is, in metres");
  const cutAt = async (metres: string): Promise<string> => {
    await untilCut(page, async () => {
      await where.fill(metres);
      await where.press("Enter");
    });
    return picture(page);
  };
  const first = await cutAt("1.15");
  const other = await cutAt("0.5");
  expect(other).not.toBe(first);
  expect(await cutAt("1.15")).toBe(first);
  await untilCut(page, () => page.getByRole("button", { name: "x", exact: true }).click());
  expect(await picture(page)).not.toBe(first);
  expect(complaints).toEqual([]);
  await page.context().close();
});

test("a click says what the voxel is, as query does", async () => {
  const { page, complaints } = await openPage(browser, `${server.address}?view=front&slice=y:1.15`);
  const box = (await page.locator("#canvas").boundingBox())!;
  await page.mouse.click(box.x + 0.42 * box.width, box.y + 0.5 * box.height);
  await page.locator("[data-picked=point]").waitFor();
  const picked = async (name: string): Promise<string> => (await page.locator(`[data-picked=${name}]`).textContent()) ?? "";
  const [i, j, k] = (await picked("voxel")).split(", ").map(Number) as [number, number, number];
  const { origin, h } = await page.evaluate(() => {
    const hello = (window as never as { vicinity: { hello(): { field: { origin: number[]; voxelSize: number } } } }).vicinity.hello();
    return { origin: hello.field.origin, h: hello.field.voxelSize };
  });
  const middle = [i, j, k].map((n, axis) => String(origin[axis]! + h * (n + 0.5)));
  const said = JSON.parse(vicinity(["query", field, "--json", "--", ...middle])) as Record<string, unknown>;
  expect(await picked("kind")).toBe(said.kind);
  expect(await picked("viscosity")).toContain(String(said.viscosity));
  expect(complaints).toEqual([]);
  await page.context().close();
});

test("a page of another origin is refused", async () => {
  const own = new URL(server.address);
  const other = await Server.start([field, "--scene", scene]);
  const page = await (await browser.newContext()).newPage();
  await page.goto(other.address);
  const outcome = await page.evaluate(async (address) => {
    const socket = new WebSocket(`ws://${address}/ws`);
    const opened = await new Promise<boolean>((resolve) => {
      socket.onopen = () => resolve(true);
      socket.onerror = () => resolve(false);
    });
    const put = await fetch(`http://${address}/upload?name=a.stl`, { method: "PUT", body: "solid" }).then(
      () => "answered",
      () => "refused",
    );
    return { opened, put };
  }, own.host);
  expect(outcome).toEqual({ opened: false, put: "refused" });
  await page.context().close();
  await other.stop();
});

test("at 200 % zoom on a laptop everything is reachable and nothing overflows", async () => {
  const { page, complaints } = await openPage(browser, server.address, { width: 1366, height: 768, zoom: 2 });
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
  expect(overflow).toBe(false);
  const view = (await page.locator("#stage").boundingBox())!;
  expect(view.width).toBeGreaterThan(600);
  expect(view.height).toBeGreaterThan(180);
  for (const name of ["Scene panel", "Arm panel"]) {
    await page.getByRole("button", { name }).click();
    const tabs = page.locator(name === "Scene panel" ? "#left" : "#right").getByRole("tab");
    for (const tab of await tabs.all()) await tab.click();
    expect(await tabs.first().isVisible()).toBe(true);
    await page.getByRole("button", { name }).click();
  }
  await page.keyboard.press("?");
  expect(await page.getByRole("dialog", { name: "Keys" }).isVisible()).toBe(true);
  expect(complaints).toEqual([]);
  await page.context().close();
});

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The page beside a server that has the hot cell at a coarse resolution, and its arm: what is seen
// and clicked is what the field holds.
import { createServer } from "node:http";
import type { AddressInfo } from "node:net";
import type { Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, expect, test } from "vitest";
import { boundaryColour, innerColour, innerHatchColour, rankColour, type Colour } from "../../src/colour/rank_palette";
import type { Hello, Vec3 } from "../../src/protocol/hello";
import { seeded } from "../unit/seeded";
import {
  coloursAt,
  hotCell,
  hotCellField,
  hotCellStart,
  longestWait_ms,
  openPage,
  query,
  Server,
  theBrowser,
  vicinity,
  type Queried,
  type Rgb,
} from "./viewer";

let server: Server;
let page: Page; // the cut at y = 1.15, from the front, near enough to tell voxels apart
let complaints: string[];
let hello: Hello;

beforeAll(async () => {
  server = await Server.start([hotCellField(), "--scene", hotCell, "--start", hotCellStart]);
  ({ page, complaints } = await openPage(`${server.address}?view=front&slice=y:1.15`));
  hello = await page.evaluate(() => window.vicinity.hello());
  await page.keyboard.press("Escape"); // hold: an arm at rest leaves the picture alone
  for (let n = 0; n < 9; ++n) await page.keyboard.press("+");
});

afterEach(() => expect(complaints).toEqual([]));

afterAll(async () => {
  await page?.context().close();
  await server?.stop();
});

/** Ticks or clears a box of "Also show". */
async function show(name: string, shown: boolean): Promise<void> {
  await page.locator("#left").getByRole("checkbox", { name, exact: true }).setChecked(shown);
}

async function showAllButTheSlice(shown: boolean): Promise<void> {
  for (const name of ["Objects", "Arm", "Body points", "Drag"]) await show(name, shown);
}

/** Waits until the slice that the page has is another one. */
async function untilCut(act: () => Promise<void>): Promise<void> {
  const slice = (): Promise<string> => page.evaluate(() => window.vicinity.slice());
  const before = await slice();
  await act();
  await expect.poll(slice, { timeout: longestWait_ms }).not.toBe(before);
}

async function cutAt(y: number): Promise<void> {
  const where = page.getByLabel("Where the slice is, in metres");
  await untilCut(async () => {
    await where.fill(String(y));
    await where.press("Enter");
  });
}

/** The middle of the voxel that a point lies in. */
function middle(point: Vec3): Vec3 {
  const { origin, voxelSize: h } = hello.field;
  return point.map((x, n) => origin[n]! + h * (Math.floor((x - origin[n]!) / h) + 0.5)) as Vec3;
}

/** Middles of voxels of the cut at y that are within the view, under no card, and away from the tool's ring. */
async function seenVoxels(y: number, count: number): Promise<Vec3[]> {
  const random = seeded(7);
  const { origin, dims, voxelSize: h } = hello.field;
  const points = Array.from({ length: count }, () =>
    middle([origin[0] + random() * h * dims[0], y, origin[2] + random() * h * dims[2]]),
  );
  const seen = await page.evaluate((points) => {
    const box = document.getElementById("canvas")!.getBoundingClientRect();
    const [a, b, c] = window.vicinity.snapshot().tool;
    const ring = window.vicinity.onPage([a!, b!, c!]);
    return points.map((point) => {
      const { x, y } = window.vicinity.onPage(point);
      const inside = x > box.left + 4 && x < box.right - 4 && y > box.top + 4 && y < box.bottom - 4;
      const covered = inside && document.elementFromPoint(x, y)?.id !== "canvas";
      return inside && !covered && Math.hypot(x - ring.x, y - ring.y) > 40;
    });
  }, points);
  return points.filter((_, n) => seen[n]);
}

function isColour(seen: Rgb, colour: Colour): boolean {
  return seen.every((x, n) => Math.abs(x - 255 * colour[n]!) < 3);
}

/** Whether a pixel is what the slice paints for such a voxel. */
function isPainted(seen: Rgb, voxel: Queried): boolean {
  if (voxel.kind === "boundary") return isColour(seen, boundaryColour);
  if (voxel.kind === "inner") return isColour(seen, innerColour) || isColour(seen, innerHatchColour);
  return isColour(seen, rankColour(voxel.rank, hello.field.ranks));
}

test("the page loads, draws, asks nobody but its server, and has nothing to complain about", async () => {
  expect(await page.title()).toContain("hot_cell.vicinity");
  await expect.poll(() => page.locator("[data-reading=status]").textContent(), { timeout: longestWait_ms }).not.toBe("–");
  expect(await page.getByRole("figure", { name: "Legend of ranks" }).textContent()).toContain("32");
  const hosts = await page.evaluate(() => performance.getEntriesByType("resource").map(({ name }) => new URL(name).host));
  expect(new Set(hosts)).toEqual(new Set([new URL(server.address).host]));
});

test("the slice moves, and each of its pixels has the colour of the voxel that query finds there", async () => {
  await showAllButTheSlice(false);
  const painted: Map<string, Rgb>[] = [];
  for (const y of [1.15, 0.5, 1.15]) {
    if (painted.length > 0) await cutAt(y);
    const points = await seenVoxels(y, 600);
    const voxels = query(hotCellField(), points.map(([x, , z]) => middle([x, y, z])));
    const at = (await page.evaluate(() => window.vicinity.slice())).split(" ").map(Number);
    expect(at).toEqual([1, Math.floor((y - hello.field.origin[1]) / hello.field.voxelSize)]);
    const colours = await coloursAt(page, voxels.map(({ point }) => point));
    const full = voxels.map((voxel, n) => ({ voxel, seen: colours[n]! })).filter(({ voxel }) => voxel.kind !== "empty");
    expect(full.length).toBeGreaterThan(40);
    expect(full.filter(({ voxel, seen }) => !isPainted(seen, voxel))).toEqual([]);
    expect(new Set(full.map(({ voxel }) => voxel.rank)).size).toBeGreaterThan(4);
    // By where across the slice they are: what covers it may have moved meanwhile.
    painted.push(new Map(voxels.map(({ point: [x, , z] }, n) => [`${x} ${z}`, colours[n]!])));
  }
  const differing = (n: number): number[] => {
    const shared = [...painted[0]!.keys()].filter((at) => painted[n]!.has(at));
    return [shared.length, shared.filter((at) => String(painted[n]!.get(at)) !== String(painted[0]!.get(at))).length];
  };
  const [sharedBefore, differingBefore] = differing(1);
  expect(sharedBefore).toBeGreaterThan(40);
  expect(differingBefore).toBeGreaterThan(0);
  const [sharedAgain, differingAgain] = differing(2);
  expect(sharedAgain).toBeGreaterThan(40);
  expect(differingAgain).toBe(0);
  // A key moves it by a voxel.
  const index = async (): Promise<number> => Number((await page.evaluate(() => window.vicinity.slice())).split(" ")[1]);
  const before = await index();
  await page.locator("#canvas").focus();
  await untilCut(() => page.keyboard.press("]"));
  expect(await index()).toBe(before + 1);
  await untilCut(() => page.keyboard.press("["));
});

test("a click says what the voxel is, as query does", async () => {
  const voxels = query(hotCellField(), await seenVoxels(1.15, 300));
  const kinds = [...new Set(voxels.map(({ kind, rank }) => `${kind} ${rank}`))];
  const chosen = kinds.map((name) => voxels.find(({ kind, rank }) => `${kind} ${rank}` === name)!).slice(0, 6);
  expect(chosen.length).toBeGreaterThan(3);
  const card = page.locator(".card.pick");
  for (const { point } of chosen) {
    const at = await page.evaluate((point) => window.vicinity.onPage(point), point);
    await page.mouse.click(at.x, at.y);
    const { origin, voxelSize: h } = hello.field;
    const index = point.map((x, n) => Math.floor((x - origin[n]!) / h)).join(", ");
    await card.getByText(index, { exact: true }).waitFor();
    const said = JSON.parse(vicinity(["query", hotCellField(), "--json", "--", ...point.map(String)])) as Record<string, unknown>;
    const picked = async (name: string): Promise<string | null> => {
      const value = card.locator(`[data-picked=${name}]`);
      return (await value.count()) > 0 ? value.textContent() : null;
    };
    expect(await picked("kind")).toBe(said.kind);
    expect(await picked("object")).toBe(said.object);
    expect(Number(await picked("rank"))).toBe(said.rank);
    expect(Number.parseFloat((await picked("viscosity"))!)).toBe(said.viscosity);
    await card.getByRole("button").click(); // it would cover the next one
  }
});

test("two clicks measure the length between them", async () => {
  const points = await seenVoxels(1.15, 300);
  const [from, to] = [points[0]!, points.find(([x]) => Math.abs(x - points[0]![0]) > 0.3)!];
  await page.locator("#canvas").focus();
  await page.keyboard.press("m");
  for (const point of [from, to]) {
    const at = await page.evaluate((point) => window.vicinity.onPage(point), point);
    await page.mouse.click(at.x, at.y);
  }
  const label = page.locator("[data-reading=measured]");
  await label.waitFor();
  const [value, unit] = ((await label.textContent()) ?? "").split(" ");
  const length = Number(value) * (unit === "mm" ? 0.001 : 1);
  expect(Math.abs(length - Math.hypot(...from.map((x, n) => x - to[n]!)))).toBeLessThan(hello.field.voxelSize);
  await page.keyboard.press("Escape");
  await label.waitFor({ state: "hidden" });
});

test("an object that is hidden takes its layers with it, and comes back as it was", async () => {
  const voxels = query(hotCellField(), await seenVoxels(1.15, 600)).filter(({ kind }) => kind === "neighbour");
  const name = voxels[0]!.object;
  const own = voxels.filter(({ object }) => object === name);
  const looks = (): Promise<Rgb[]> => coloursAt(page, own.map(({ point }) => point));
  const before = await looks();
  await page.locator("#left").getByRole("button", { name, exact: true }).click();
  await page.locator("#canvas").focus();
  await page.keyboard.press("h");
  await page.locator("#left").getByRole("button", { name: `Show ${name}` }).waitFor();
  const hidden = await looks();
  expect(own.filter((voxel, n) => isPainted(hidden[n]!, voxel))).toEqual([]);
  await page.keyboard.press("Shift+H");
  expect(await looks()).toEqual(before);
  await showAllButTheSlice(true);
});

/** Contrast of two CSS colours, as WCAG 2 has it. */
function contrast(a: string, b: string): number {
  const luminance = (css: string): number => {
    const [red, green, blue] = (css.match(/[\d.]+/g) ?? []).slice(0, 3).map((byte) => {
      const x = Number(byte) / 255;
      return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * red! + 0.7152 * green! + 0.0722 * blue!;
  };
  const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
  return (high! + 0.05) / (low! + 0.05);
}

test("keys list themselves, and turn dark into light, which can be read and is remembered", async () => {
  await page.locator("#canvas").focus();
  await page.keyboard.press("?");
  const keys = page.getByRole("dialog", { name: "Keys" });
  await keys.waitFor();
  for (const text of ["orbit", "measure", "lead the tool", "gamepad", "play, pause"]) {
    expect(await keys.textContent()).toContain(text);
  }
  await page.keyboard.press("Escape");
  await keys.waitFor({ state: "hidden" });
  await page.locator("#canvas").focus();
  for (const theme of ["light", "dark"]) {
    await page.keyboard.press("t");
    const look = await page.evaluate(() => {
      const { color, backgroundColor } = getComputedStyle(document.body);
      return { color, backgroundColor, theme: document.documentElement.dataset.theme, kept: localStorage.getItem("vicinity-theme") };
    });
    expect(look).toMatchObject({ theme, kept: theme });
    expect(contrast(look.color, look.backgroundColor)).toBeGreaterThan(7);
  }
});

test("a browser without WebGL says so", async () => {
  const page = await (await (await theBrowser()).newContext()).newPage();
  await page.addInitScript(() => (HTMLCanvasElement.prototype.getContext = () => null));
  await page.goto(server.address);
  expect(await page.getByRole("alert").textContent()).toContain("no WebGL 2");
  await page.context().close();
});

test("a page of another origin is refused", async () => {
  // A site that allows itself everything.
  const site = createServer((_, answer) => answer.setHeader("Content-Type", "text/html").end("<!doctype html>"));
  await new Promise<void>((listening) => site.listen(0, "127.0.0.1", listening));
  const foreign = await (await (await theBrowser()).newContext()).newPage();
  await foreign.goto(`http://127.0.0.1:${(site.address() as AddressInfo).port}/`);
  const outcome = await foreign.evaluate(async (address) => {
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
  }, new URL(server.address).host);
  expect(outcome).toEqual({ opened: false, put: "refused" });
  await foreign.context().close();
  site.close();
});

test("at 200 % zoom on a laptop everything is reachable and nothing overflows", async () => {
  const zoomed = await openPage(server.address, { width: 1366, height: 768, zoom: 2 });
  const narrow = zoomed.page;
  const overflow = await narrow.evaluate(() => document.documentElement.scrollWidth > innerWidth);
  expect(overflow).toBe(false);
  const view = (await narrow.locator("#stage").boundingBox())!;
  expect(view.width).toBeGreaterThan(600);
  expect(view.height).toBeGreaterThan(180);
  for (const [name, side] of [["Scene panel", "#left"], ["Arm panel", "#right"]] as const) {
    await narrow.getByRole("button", { name }).click();
    const tabs = narrow.locator(side).getByRole("tab");
    for (const tab of await tabs.all()) await tab.click();
    expect(await tabs.first().isVisible()).toBe(true);
    await narrow.getByRole("button", { name }).click();
  }
  expect(zoomed.complaints).toEqual([]);
  await narrow.context().close();
});

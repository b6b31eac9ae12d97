// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// What the page shows while the arm is led is what the command line says for the same pose.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import { launch, openPage, repository, scratchFolder, Server, vicinity } from "./viewer";

interface Moment {
  status: number;
  q: number[];
  qd: number[];
  tool: number[];
  velocity: number[];
  force: number[];
  tau: number[];
  viscosity: number;
}

const scene = join(repository, "scenes/hot_cell.yaml");
const folder = scratchFolder();
const field = join(folder, "hot_cell.vicinity");
let browser: Browser;

beforeAll(async () => {
  vicinity(["build", scene, "--voxel-size", "0.012", "-o", field]);
  browser = await launch();
});

afterAll(async () => {
  await browser?.close();
});

/** The page's own snapshot, as numbers. */
function moment(page: Page): Promise<Moment> {
  return page.evaluate(() => {
    type Arrays = Record<"q" | "qd" | "tool" | "toolVelocity" | "force" | "tau", ArrayLike<number>>;
    type Snapshot = Arrays & { status: number; highestViscosity: number };
    const held = window as never as { vicinity: { snapshot(): Snapshot } };
    const s = held.vicinity.snapshot();
    return {
      status: s.status,
      q: Array.from(s.q),
      qd: Array.from(s.qd),
      tool: Array.from(s.tool),
      velocity: Array.from(s.toolVelocity),
      force: Array.from(s.force),
      tau: Array.from(s.tau),
      viscosity: s.highestViscosity,
    };
  });
}

/** Where on the page the tool's ring is. */
function ringAt(page: Page): Promise<{ x: number; y: number }> {
  return page.evaluate(() => {
    const held = window as never as { vicinity: { toolOnPage(): { x: number; y: number } } };
    return held.vicinity.toolOnPage();
  });
}

/** Drags the ring along a way and keeps what was felt at each step. */
async function dragRing(page: Page, way: readonly [number, number], steps: number): Promise<Moment[]> {
  const moments: Moment[] = [];
  const from = await ringAt(page);
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  for (let n = 1; n <= steps; ++n) {
    await page.mouse.move(from.x + (way[0] * n) / steps, from.y + (way[1] * n) / steps);
    await page.waitForTimeout(40);
    moments.push(await moment(page));
  }
  await page.mouse.up();
  return moments;
}

test("a probe that is dragged feels F = -mu S v with the viscosity that query says", async () => {
  // Over the bench beside the cone, 1.2 m into the cell.
  const server = await Server.start([field, "--start", "1.2,0.5,0.95"]);
  const { page, complaints } = await openPage(browser, `${server.address}?view=front`);
  const moments = await dragRing(page, [0, 150], 60);
  const felt = moments.filter(({ force }) => Math.hypot(...force) > 0);
  expect(felt.length).toBeGreaterThan(3);
  for (const { tool, velocity, force, viscosity } of felt) {
    const said = JSON.parse(vicinity(["query", field, "--json", "--", ...tool.slice(0, 3).map(String)])) as {
      viscosity: number;
    };
    expect(viscosity).toBe(said.viscosity);
    velocity.forEach((v, n) => expect(force[n]).toBeCloseTo(-said.viscosity * v, 4)); // S is 1 m²
  }
  const shown = await page.locator("[data-reading=force]").textContent();
  expect(Number(shown)).toBeGreaterThanOrEqual(0);
  expect(complaints).toEqual([]);
  await page.context().close();
  await server.stop();
});

test("an arm that is dragged feels what replay says for the same pose and velocities", async () => {
  const start = "0.08,-0.15,0,2.416,0,-0.695,0"; // between the risers, before the vessel
  const server = await Server.start([field, "--scene", scene, "--start", start]);
  const { page, complaints } = await openPage(browser, `${server.address}?view=front`);
  const moments = await dragRing(page, [-120, -30], 40);
  const felt = moments.filter(({ status, force }) => status === 0 && Math.hypot(...force) > 0);
  expect(felt.length).toBeGreaterThan(3);
  for (const { q, qd, force, tau } of felt.slice(0, 6)) {
    // A log that passes through that pose at those velocities; its second line is the moment.
    const names = q.map((_, n) => `joint_${n + 1}`);
    const line = (t: number): string =>
      [t, ...q.map((x, n) => x + qd[n]! * (t - 0.001)), ...qd].map(String).join(",");
    const log = join(folder, "log.csv");
    const header = ["t", ...names, ...names.map((name) => `qd_${name}`)].join(",");
    writeFileSync(log, [header, line(0), line(0.001), line(0.002)].join("\n") + "\n");
    const out = join(folder, "felt.csv");
    const columns = ["t=t", ...names.flatMap((name) => [`${name}=${name}`, `qd_${name}=qd_${name}`])].join(",");
    vicinity(["replay", field, "--scene", scene, "--trajectory", log, "--columns", columns, "-o", out]);
    const [head, , second] = readFileSync(out, "utf8").split("\n").map((row) => row.split(","));
    const said = (name: string): number => Number(second![head!.indexOf(name)]);
    ["fx", "fy", "fz"].forEach((name, n) => expect(force[n]).toBeCloseTo(said(name), 3));
    names.forEach((name, n) => expect(tau[n]).toBeCloseTo(said(`tau_${name}`), 4));
  }
  expect(complaints).toEqual([]);
  await page.context().close();
  await server.stop();
});

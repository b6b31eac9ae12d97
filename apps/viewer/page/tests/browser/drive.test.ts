// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// What the page shows while the arm is led is what the command line says for the same pose.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { expect, test } from "vitest";
import { hotCell, hotCellField, hotCellStart, longestWait_ms, openPage, scratchFolder, Server, vicinity } from "./viewer";

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

const folder = scratchFolder();

/** The page's own snapshot, as numbers. */
function moment(page: Page): Promise<Moment> {
  return page.evaluate(() => {
    const s = window.vicinity.snapshot();
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

/**
 * Drags the ring along a way, there and back, until something has been felt often enough.
 * @return the moments at which it was, and what the panel said of the drag meanwhile
 */
async function dragRing(page: Page, way: readonly [number, number]): Promise<{ felt: Moment[]; readings: Set<string> }> {
  const felt: Moment[] = [];
  const readings = new Set<string>();
  const from = await page.evaluate(() => {
    const [x, y, z] = window.vicinity.snapshot().tool;
    return window.vicinity.onPage([x!, y!, z!]);
  });
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  for (let n = 1; n <= 80 && felt.length < 6; ++n) {
    const share = Math.sin((Math.PI / 40) * n);
    await page.mouse.move(from.x + way[0] * share, from.y + way[1] * share);
    const now = await moment(page);
    if (now.status === 0 && Math.hypot(...now.force) > 0) felt.push(now);
    readings.add((await page.locator("[data-tool=drag]").textContent()) ?? "");
  }
  await page.mouse.up();
  return { felt, readings };
}

test("a probe that is dragged feels F = -mu S v with the viscosity that query says", async () => {
  // Over the bench beside the cone, 1.2 m into the cell.
  const field = hotCellField();
  const server = await Server.start([field, "--start", "1.2,0.5,0.95"]);
  const { page, complaints } = await openPage(`${server.address}?view=front`);
  const { felt, readings } = await dragRing(page, [0, 150]);
  expect(felt.length).toBeGreaterThan(3);
  expect([...readings].some((text) => Number.parseFloat(text) > 0)).toBe(true);
  for (const { tool, velocity, force, viscosity } of felt) {
    const said = JSON.parse(vicinity(["query", field, "--json", "--", ...tool.slice(0, 3).map(String)])) as {
      viscosity: number;
    };
    expect(viscosity).toBe(said.viscosity);
    velocity.forEach((v, n) => expect(force[n]).toBeCloseTo(-said.viscosity * v, 4)); // S is 1 m²
  }
  expect(complaints).toEqual([]);
  await page.context().close();
  await server.stop();
});

test("an arm that is dragged feels what replay says for the same pose and velocities", async () => {
  const server = await Server.start([hotCellField(), "--scene", hotCell, "--start", hotCellStart]);
  const { page, complaints } = await openPage(`${server.address}?view=front`);
  const { felt } = await dragRing(page, [-120, -30]);
  expect(felt.length).toBeGreaterThan(3);
  for (const { q, qd, force, tau } of felt) {
    // A log that passes through that pose at those velocities; its second line is the moment.
    const names = q.map((_, n) => `joint_${n + 1}`);
    const line = (t: number): string =>
      [t, ...q.map((x, n) => x + qd[n]! * (t - 0.001)), ...qd].map(String).join(",");
    const log = join(folder, "log.csv");
    const header = ["t", ...names, ...names.map((name) => `qd_${name}`)].join(",");
    writeFileSync(log, [header, line(0), line(0.001), line(0.002)].join("\n") + "\n");
    const out = join(folder, "felt.csv");
    const columns = ["t=t", ...names.flatMap((name) => [`${name}=${name}`, `qd_${name}=qd_${name}`])].join(",");
    vicinity(["replay", hotCellField(), "--scene", hotCell, "--trajectory", log, "--columns", columns, "-o", out]);
    const [head, , second] = readFileSync(out, "utf8").split("\n").map((row) => row.split(","));
    const said = (name: string): number => Number(second![head!.indexOf(name)]);
    ["fx", "fy", "fz"].forEach((name, n) => expect(force[n]).toBeCloseTo(said(name), 3));
    names.forEach((name, n) => expect(tau[n]).toBeCloseTo(said(`tau_${name}`), 4));
  }
  expect(complaints).toEqual([]);
  await page.context().close();
  await server.stop();
});

interface Effect {
  type: string;
  duration: number;
  strongMagnitude: number;
  weakMagnitude: number;
  felt: number;
}

test("a gamepad leads the tool and rumbles in proportion to the drag", async () => {
  const server = await Server.start([hotCellField(), "--start", "1.2,0.5,0.95"]);
  const { page, complaints } = await openPage(`${server.address}?view=front`, {
    // A pad that this machine does not have: its rumble is written down, with the drag of that moment.
    before: (page) =>
      page.addInitScript(() => {
        const effects: object[] = [];
        const buttons = Array.from({ length: 17 }, () => ({ pressed: false, touched: false, value: 0 }));
        const vibrationActuator = {
          playEffect: (type: string, parameters: object): Promise<string> => {
            effects.push({ type, ...parameters, felt: window.vicinity.snapshot().felt });
            return Promise.resolve("complete");
          },
        };
        const pad = { id: "Pad of the test", index: 0, connected: true, mapping: "standard", axes: [0, 0, 0, 0], buttons, vibrationActuator };
        navigator.getGamepads = () => [null, pad as never];
        Object.assign(window, { pad, effects });
      }),
  });
  const effects = (): Promise<Effect[]> => page.evaluate(() => (window as never as { effects: Effect[] }).effects);
  await page.getByText("Pad of the test: rumble 0 %").waitFor();
  expect(await effects()).toEqual([]); // nothing is felt in free space
  const press = (button: number, value: number): Promise<void> =>
    page.evaluate(([button, value]) => {
      (window as never as { pad: { buttons: { value: number }[] } }).pad.buttons[button!]!.value = value!;
    }, [button, value]);
  const height = (): Promise<number> => page.evaluate(() => window.vicinity.snapshot().tool[2]!);
  const before = await height();
  // Down into the bench's layers and up again, until it has rumbled often enough.
  for (let n = 0; n < 60 && (await effects()).length < 4; ++n) {
    const down = n % 20 < 10;
    await press(6, down ? 1 : 0);
    await press(7, down ? 0 : 1);
    await page.waitForTimeout(300);
  }
  await press(6, 0);
  await press(7, 0);
  expect(Math.abs((await height()) - before)).toBeGreaterThan(0.01);
  const rumbled = await effects();
  expect(rumbled.length).toBeGreaterThan(3);
  for (const { type, felt, duration, strongMagnitude, weakMagnitude } of rumbled) {
    expect(type).toBe("dual-rumble");
    expect(duration).toBeGreaterThan(100); // longer than the pause until the next
    expect(strongMagnitude).toBeCloseTo(Math.min(1, felt / 4), 12); // half at 2 N
    expect(weakMagnitude).toBe(strongMagnitude);
    expect(felt).toBeGreaterThan(0);
  }
  // At rest it falls silent.
  await page.keyboard.press("Escape");
  await expect.poll(() => page.evaluate(() => window.vicinity.snapshot().felt), { timeout: longestWait_ms }).toBe(0);
  await page.getByText("Pad of the test: rumble 0 %").waitFor();
  expect(complaints).toEqual([]);
  await page.context().close();
  await server.stop();
});

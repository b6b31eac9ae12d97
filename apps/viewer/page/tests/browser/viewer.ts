// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A server on a free port and a page in headless Chromium, for tests. Environment: VICINITY, the
// program; VICINITY_SCENES, the folder of scenes; CHROMIUM, the browser (default /usr/bin/chromium).
import { spawn, spawnSync, type ChildProcess } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium, type Browser, type Page } from "playwright-core";
import type { Hello, Vec3 } from "../../src/protocol/hello";
import type { Snapshot } from "../../src/protocol/snapshot";

const repository = fileURLToPath(new URL("../../../../../", import.meta.url));
const program = resolve(process.env.VICINITY ?? join(repository, "build/release/apps/cli/vicinity"));
const browserPath = process.env.CHROMIUM ?? "/usr/bin/chromium";

/** The demo's cell, and its arm between the risers, before the vessel. */
export const hotCell = join(process.env.VICINITY_SCENES ?? join(repository, "scenes"), "hot_cell.yaml");
export const hotCellStart = "0.08,-0.15,0,2.416,0,-0.695,0";

declare global {
  interface Window {
    /** What the page tells scripts (src/page.ts). */
    vicinity: {
      hello(): Hello;
      snapshot(): Snapshot;
      frameTimes(): number[];
      onPage(point: Vec3): { x: number; y: number };
      picture(): string;
      slice(): string;
    };
  }
}

for (const needed of [program, browserPath]) {
  if (!existsSync(needed)) throw new Error(`${needed} is not there: set VICINITY and CHROMIUM`);
}

const scratch: string[] = [];
const children: ChildProcess[] = [];
process.on("exit", () => {
  for (const child of children) child.kill(); // a test that failed has not stopped its server
  for (const folder of scratch) rmSync(folder, { recursive: true, force: true });
});

export function scratchFolder(): string {
  const folder = mkdtempSync(join(tmpdir(), "vicinity-page-"));
  scratch.push(folder);
  return folder;
}

/** Runs the program to its end. @return what it printed */
export function vicinity(args: readonly string[], input = ""): string {
  const ran = spawnSync(program, args, { encoding: "utf8", input });
  if (ran.status !== 0) throw new Error(`vicinity ${args.join(" ")}: ${ran.stderr}`);
  return ran.stdout;
}

export class Server {
  private constructor(
    readonly address: string,
    readonly folder: string,
    private readonly child: ChildProcess,
  ) {}

  static start(args: readonly string[], folder = scratchFolder()): Promise<Server> {
    const child = spawn(program, ["serve", ...args, "--port", "0", "--folder", folder]);
    children.push(child);
    return new Promise((resolve, reject) => {
      let said = "";
      const listen = (chunk: Buffer): void => {
        said += chunk.toString();
        const address = /Open (http:\/\/\S+)/.exec(said)?.[1];
        if (address) resolve(new Server(address, folder, child));
      };
      child.stdout.on("data", listen);
      child.stderr.on("data", listen);
      child.on("exit", (code) => reject(new Error(`vicinity serve ended with ${code}: ${said}`)));
    });
  }

  async stop(): Promise<void> {
    const ended = new Promise((resolve) => this.child.once("exit", resolve));
    this.child.kill("SIGINT");
    await ended;
    rmSync(this.folder, { recursive: true, force: true });
  }
}

let built: string | null = null;

/** The hot cell at 12 mm, built once for all tests. */
export function hotCellField(): string {
  if (built === null) {
    const field = join(scratchFolder(), "hot_cell.vicinity");
    vicinity(["build", hotCell, "--voxel-size", "0.012", "-o", field]);
    built = field;
  }
  return built;
}

let launched: Promise<Browser> | null = null;

/** One browser for all tests; it ends with them. */
export function theBrowser(): Promise<Browser> {
  launched ??= chromium.launch({
    executablePath: browserPath,
    args: [
      "--no-sandbox",
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
      "--ignore-gpu-blocklist",
      "--disable-gpu-rasterization", // as a browser does by itself where there is no graphics card
      "--disable-background-networking",
    ],
  });
  return launched;
}

/** Of one wait: a page that a busy machine draws is slow, one that has hung is not waited for. */
export const longestWait_ms = 120_000;

/** A page and everything that its console complained about. */
export interface OpenPage {
  page: Page;
  complaints: string[];
}

export async function openPage(
  address: string,
  options: { width?: number; height?: number; zoom?: number; before?: (page: Page) => Promise<void> } = {},
): Promise<OpenPage> {
  const zoom = options.zoom ?? 1;
  // Small, because a processor draws it; as wide as both panels need beside the view.
  const context = await (await theBrowser()).newContext({
    viewport: {
      width: Math.round((options.width ?? 1012) / zoom),
      height: Math.round((options.height ?? 560) / zoom),
    },
    deviceScaleFactor: zoom,
    colorScheme: "dark",
  });
  const page = await context.newPage();
  page.setDefaultTimeout(longestWait_ms);
  const complaints: string[] = [];
  page.on("console", (message) => {
    // A software renderer tells that reading pixels back is slow; that is no fault of the page.
    const isAboutReading = message.text().includes("GPU stall due to ReadPixels");
    if (["error", "warning"].includes(message.type()) && !isAboutReading) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(error.message));
  await options.before?.(page);
  await page.goto(address);
  await ready(page);
  return { page, complaints };
}

/** Meshes, slice and first snapshot are drawn. */
export async function ready(page: Page): Promise<void> {
  await page.waitForFunction(() => document.documentElement.dataset.ready === "true", null, {
    polling: 20,
  });
}

export type Rgb = [red: number, green: number, blue: number];

/** Colours that the view shows at points of the workplace, 0..255. */
export async function coloursAt(page: Page, points: readonly Vec3[]): Promise<Rgb[]> {
  return page.evaluate(async (points) => {
    const png = atob(window.vicinity.picture().split(",")[1]!);
    const bitmap = await createImageBitmap(new Blob([Uint8Array.from(png, (c) => c.charCodeAt(0))]));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const context = canvas.getContext("2d", { willReadFrequently: true })!;
    context.drawImage(bitmap, 0, 0);
    const box = document.getElementById("canvas")!.getBoundingClientRect();
    return points.map((point) => {
      const at = window.vicinity.onPage(point);
      const [x, y] = [(at.x - box.left) * devicePixelRatio, (at.y - box.top) * devicePixelRatio];
      const [red, green, blue] = context.getImageData(Math.floor(x), Math.floor(y), 1, 1).data;
      return [red!, green!, blue!] as [number, number, number];
    });
  }, points as Vec3[]);
}

/** What `vicinity query` says of many points at once. */
export interface Queried {
  point: Vec3;
  kind: string;
  object: string;
  rank: number;
  viscosity: number;
}

export function query(field: string, points: readonly Vec3[]): Queried[] {
  const lines = vicinity(["query", field], ["x,y,z", ...points.map((point) => point.join(","))].join("\n") + "\n");
  const [head, ...rows] = lines.trim().split("\n").map((line) => line.split(","));
  return rows.map((row, n) => {
    const of = (name: string): string => row[head!.indexOf(name)] ?? "";
    const [rank, viscosity] = [Number(of("rank")), Number(of("viscosity"))];
    return { point: points[n]!, kind: of("kind"), object: of("object"), rank, viscosity };
  });
}

/** Drops a file on the page as a person does, from a folder of this machine. */
export async function dropFile(page: Page, file: string): Promise<void> {
  const browser = await page.context().newCDPSession(page);
  const data = { items: [], files: [file], dragOperationsMask: 1 };
  const drag = (type: "dragEnter" | "dragOver" | "drop"): Promise<unknown> =>
    browser.send("Input.dispatchDragEvent", { type, x: 500, y: 200, data });
  await drag("dragEnter");
  // A person lets go when the page shows that it would take the file. A browser drops nothing on a
  // page that has not said so yet.
  await drag("dragOver");
  await page.locator("body.dropping").waitFor();
  await drag("dragOver");
  await drag("drop");
  await page.locator("body:not(.dropping)").waitFor();
  await browser.detach();
}

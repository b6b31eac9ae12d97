// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A server on a free port and a page in headless Chromium, for tests. Environment: VICINITY, the
// program; CHROMIUM, the browser (default /usr/bin/chromium).
import { spawn, spawnSync, type ChildProcess } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium, type Browser, type Page } from "playwright-core";

export const repository = fileURLToPath(new URL("../../../../../", import.meta.url));
const program = resolve(process.env.VICINITY ?? join(repository, "build/release/apps/cli/vicinity"));
const browserPath = process.env.CHROMIUM ?? "/usr/bin/chromium";

for (const needed of [program, browserPath]) {
  if (!existsSync(needed)) throw new Error(`${needed} is not there: set VICINITY and CHROMIUM`);
}

export function scratchFolder(): string {
  return mkdtempSync(join(tmpdir(), "vicinity-page-"));
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

export function launch(): Promise<Browser> {
  return chromium.launch({
    executablePath: browserPath,
    args: [
      "--no-sandbox",
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
      "--ignore-gpu-blocklist",
      "--disable-background-networking",
    ],
  });
}

/** A page and everything that its console complained about. */
export interface OpenPage {
  page: Page;
  complaints: string[];
}

export async function openPage(
  browser: Browser,
  address: string,
  options: { width?: number; height?: number; zoom?: number } = {},
): Promise<OpenPage> {
  const zoom = options.zoom ?? 1;
  const context = await browser.newContext({
    viewport: {
      width: Math.round((options.width ?? 1100) / zoom),
      height: Math.round((options.height ?? 640) / zoom),
    },
    deviceScaleFactor: zoom,
    colorScheme: "dark",
  });
  const page = await context.newPage();
  page.setDefaultTimeout(60_000);
  const complaints: string[] = [];
  page.on("console", (message) => {
    // A software renderer tells that reading pixels back is slow; that is no fault of the page.
    const isAboutReading = message.text().includes("GPU stall due to ReadPixels");
    if (["error", "warning"].includes(message.type()) && !isAboutReading) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(error.message));
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

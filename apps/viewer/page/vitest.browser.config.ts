// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Tests of the page in a real browser, beside a real server: one after the other, because both want
// the whole machine, and in one process, which keeps the browser. VICINITY names the program.
import { defineConfig } from "vitest/config";

export default defineConfig({
  test: {
    include: ["tests/{browser,measure}/**/*.test.ts"],
    fileParallelism: false,
    pool: "forks",
    isolate: false,
    poolOptions: { forks: { singleFork: true } },
    testTimeout: 300_000,
    hookTimeout: 300_000,
  },
});

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Tests of pure functions: no page, no server.
import { defineConfig } from "vitest/config";

export default defineConfig({
  test: {
    include: ["tests/unit/**/*.test.ts"],
    // Nothing here keeps anything: three.js need be read once only.
    pool: "threads",
    isolate: false,
    poolOptions: { threads: { singleThread: true } },
    testTimeout: 60_000, // for a machine that others share
  },
});

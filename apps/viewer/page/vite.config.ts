// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Bundles the page: every byte comes from the server that also sends the field.
import { defineConfig } from "vite";

export default defineConfig({
  base: "./",
  build: {
    target: "es2022",
    assetsInlineLimit: 0, // the server's content security policy knows no data: addresses
    chunkSizeWarningLimit: 1200, // three.js alone is 700 kB before compression
    modulePreload: { polyfill: false },
  },
});

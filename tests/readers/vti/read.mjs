// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Opens an image as VTK's own pages do and says, as JSON, what VTK found: origin, spacing, cells along
// each axis and the ranks, x fastest.
//
//   node read.mjs IMAGE.vti

import { readFile } from "node:fs/promises";
import assert from "node:assert/strict";
import vtkXMLImageDataReader from "@kitware/vtk.js/IO/XML/XMLImageDataReader.js";

globalThis.Node ??= { ELEMENT_NODE: 1 }; // the one thing of a browser that the reader asks for

const bytes = new Uint8Array(await readFile(process.argv[2]));
const reader = vtkXMLImageDataReader.newInstance();
assert.ok(reader.parseAsArrayBuffer(bytes.buffer));
const image = reader.getOutputData(0);
console.log(
  JSON.stringify({
    origin: image.getOrigin(),
    spacing: image.getSpacing(),
    cells: image.getDimensions().map((points) => points - 1),
    rank: [...image.getCellData().getArrayByName("rank").getData()],
  }),
);

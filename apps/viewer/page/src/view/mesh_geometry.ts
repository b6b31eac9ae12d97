// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Triangles as something to draw: sharp edges stay sharp, round things look round.
import { BufferAttribute, BufferGeometry, EdgesGeometry } from "three";
import { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";

const crease = 0.6; // rad; the sides of a cylinder in 16 parts meet at 0.39
// Creases and edges are looked for by hashing corners: beyond, this takes longer than it is worth.
const mostTriangles = 20000;

export function meshGeometry(vertices: Float32Array, triangles: Uint32Array): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(vertices, 3));
  geometry.setIndex(new BufferAttribute(triangles, 1));
  if (triangles.length / 3 <= mostTriangles) return toCreasedNormals(geometry, crease);
  geometry.computeVertexNormals();
  return geometry;
}

/** Lines where surfaces meet at an angle; null where there are too many triangles to look. */
export function edgesOf(geometry: BufferGeometry): EdgesGeometry | null {
  const count = (geometry.getIndex() ?? geometry.getAttribute("position")).count / 3;
  return count <= mostTriangles ? new EdgesGeometry(geometry, 28) : null;
}

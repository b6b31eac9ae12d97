// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Faces of voxels as the wire has them, four words a quad:
//
//   word 0   i | j << 16         first cell
//   word 1   k | a << 16         a faces along the first axis in the face
//   word 2   b | face << 16      b along the second; 0 -x, 1 +x, 2 -y, 3 +y, 4 -z, 5 +z
//   word 3   object
import type { Vec3 } from "../protocol/hello";

export interface Ray {
  origin: Vec3;
  direction: Vec3;
}

export interface QuadHit {
  /** Along the ray's direction, in its lengths. */
  at: number;
  object: number;
  axis: 0 | 1 | 2;
  sign: 1 | -1;
}

/**
 * Where a ray first meets a quad of those objects that are shown.
 * @param origin of the workspace [m]; @param cell edge of a cell [m]
 * @param counts whether a hit there, on that object, counts
 */
export function firstQuadHit(
  ray: Ray,
  quads: Uint32Array,
  origin: Vec3,
  cell: number,
  counts: (object: number, at: number) => boolean,
): QuadHit | null {
  let best: QuadHit | null = null;
  for (let n = 0; n + 3 < quads.length; n += 4) {
    const [w0, w1, w2] = [quads[n]!, quads[n + 1]!, quads[n + 2]!];
    const face = (w2 >>> 16) & 0xff;
    if (face > 5) continue;
    const axis = (face >> 1) as 0 | 1 | 2;
    const towards = ray.direction[axis];
    if (towards === 0) continue;
    const first = [w0 & 0xffff, w0 >>> 16, w1 & 0xffff] as const;
    const plane = origin[axis] + cell * (first[axis] + (face & 1));
    const at = (plane - ray.origin[axis]) / towards;
    if (!(at > 0) || (best && at >= best.at)) continue;
    const [u, v] = axis === 0 ? [1, 2] as const : axis === 1 ? [0, 2] as const : [0, 1] as const;
    const along = (ray.origin[u] + at * ray.direction[u] - origin[u]) / cell - first[u];
    if (along < 0 || along > w1 >>> 16) continue;
    const across = (ray.origin[v] + at * ray.direction[v] - origin[v]) / cell - first[v];
    if (across < 0 || across > (w2 & 0xffff)) continue;
    const object = quads[n + 3]! & 0xffff;
    if (counts(object, at)) best = { at, object, axis, sign: face & 1 ? 1 : -1 };
  }
  return best;
}

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Moves points from their links' frames to the workspace.

/**
 * p_WR of each point.
 * @param place p_LR, shape (n,3); @param link index of each; @param poses X_WL, shape (links,7)
 * @param out shape (n,3); where a point's link has no pose it stays as it was
 */
export function placePoints(
  place: Float32Array,
  link: Uint32Array,
  poses: Float32Array,
  out: Float32Array,
): void {
  for (let n = 0; n < link.length; ++n) {
    const at = 7 * link[n]!;
    if (at + 7 > poses.length) continue;
    const [px, py, pz] = [place[3 * n]!, place[3 * n + 1]!, place[3 * n + 2]!];
    const [x, y, z, w] = [poses[at + 3]!, poses[at + 4]!, poses[at + 5]!, poses[at + 6]!];
    // p + 2 w (r x p) + 2 r x (r x p), r the vector part
    const [cx, cy, cz] = [y * pz - z * py, z * px - x * pz, x * py - y * px];
    out[3 * n] = poses[at]! + px + 2 * (w * cx + y * cz - z * cy);
    out[3 * n + 1] = poses[at + 1]! + py + 2 * (w * cy + z * cx - x * cz);
    out[3 * n + 2] = poses[at + 2]! + pz + 2 * (w * cz + x * cy - y * cx);
  }
}

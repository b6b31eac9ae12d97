// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// What a ray from the pointer meets first, of all that is seen: objects, shells and the slice, less
// what is cut away.
import { Plane, Raycaster, Vector2, Vector3 } from "three";
import type { Vec3 } from "../protocol/hello";
import type { Axis } from "../protocol/shapes";
import type { Stage } from "./stage";
import type { Workplace } from "./workplace";

export interface SurfaceHit {
  /** A hair behind what is seen, so that it lies in the voxel that is meant [m]. */
  point: Vector3;
  /** Index of the object whose surface it is; null for a layer or the slice. */
  object: number | null;
}

/** Whether the slice shows something at a point of its plane. */
function sliceIsPaintedAt(workplace: Workplace, point: Vector3): boolean {
  const cut = workplace.slice.latest;
  if (!cut) return false;
  const { field } = workplace.hello;
  const [u, v] = ([0, 1, 2] as Axis[])
    .filter((axis) => axis !== cut.axis)
    .map((axis) => Math.floor((point.getComponent(axis) - field.origin[axis]) / (field.voxelSize * cut.step)));
  if (u === undefined || v === undefined || u < 0 || v < 0 || u >= cut.width || v >= cut.height) return false;
  const record = field.records[cut.codes[v * cut.width + u] ?? 0];
  return record !== undefined && record.kind !== "empty" && !workplace.hidden.has(record.object);
}

export function surfaceUnder(
  pointer: { x: number; y: number },
  stage: Stage,
  workplace: Workplace,
): SurfaceHit | null {
  const ray = new Raycaster();
  ray.setFromCamera(new Vector2(pointer.x, pointer.y), stage.camera);
  const { origin, direction } = ray.ray;
  const at = (distance: number): Vector3 => origin.clone().addScaledVector(direction, distance);
  const isSeen = (distance: number): boolean =>
    !workplace.slice.cutsAwayAt(at(distance));
  const behind = 1e-3 * workplace.hello.field.voxelSize;
  const candidates: { at: number; object: number | null }[] = [];

  const mesh = workplace.shown.objects ? workplace.objects.hit(ray, isSeen) : null;
  if (mesh) candidates.push(mesh);
  const words = { origin: origin.toArray() as Vec3, direction: direction.toArray() as Vec3 };
  const shell = workplace.shells.hit(words, isSeen);
  if (shell) candidates.push({ at: shell.at, object: shell.rank === 0 ? shell.object : null });

  const cut = workplace.slice.latest;
  let plane: number | null = null;
  if (cut && workplace.slice.shown) {
    const normal = new Vector3().setComponent(cut.axis, 1);
    const met = ray.ray.intersectPlane(new Plane(normal, -cut.where), new Vector3());
    if (met && workplace.box.containsPoint(met)) plane = met.distanceTo(origin);
    if (met && plane !== null && sliceIsPaintedAt(workplace, met)) candidates.push({ at: plane, object: null });
  }
  candidates.sort((a, b) => a.at - b.at);
  const [first] = candidates;
  if (first) {
    const onSlice = first.object === null && first.at === plane;
    return { point: at(first.at + (onSlice ? 0 : behind)), object: first.object };
  }
  return plane === null ? null : { point: at(plane), object: null };
}

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A scene that is being edited: the scene file as JSON. What the page has no field for stays as it
// was, so that opening and saving loses nothing.
import type { LengthUnit } from "../text/units";
import type { Vec3 } from "../protocol/hello";

export type SceneObject = Record<string, unknown>;
export type Quaternion = [number, number, number, number];

export interface Draft {
  name: string;
  scene: Record<string, unknown>;
}

export function emptyDraft(): Draft {
  return { name: "scene.yaml", scene: { voxel_size: 0.005, bounds: "auto", objects: [] } };
}

/** The objects themselves: changing one changes the draft. */
export function objectsOf(draft: Draft): SceneObject[] {
  if (!Array.isArray(draft.scene.objects)) draft.scene.objects = [];
  return draft.scene.objects as SceneObject[];
}

export function nameOf(object: SceneObject): string {
  return typeof object.name === "string" ? object.name : "";
}

/** A plain name that no object has yet: "part", "part_2", ... */
export function freeName(draft: Draft, wanted: string): string {
  const plain = wanted.replace(/\.[^.]*$/, "").replace(/[^A-Za-z0-9_.-]+/g, "_") || "part";
  const taken = new Set(objectsOf(draft).map(nameOf));
  let name = plain;
  for (let n = 2; taken.has(name); ++n) name = `${plain}_${n}`;
  return name;
}

/** @param mesh as the server named the upload */
export function addMesh(draft: Draft, file: string, mesh: string, units: LengthUnit): SceneObject {
  const pose = { xyz: [0, 0, 0], quaternion: [0, 0, 0, 1] };
  const object: SceneObject = { name: freeName(draft, file), mesh, units, pose };
  objectsOf(draft).push(object);
  return object;
}

export function removeObject(draft: Draft, object: SceneObject): void {
  draft.scene.objects = objectsOf(draft).filter((other) => other !== object);
}

/** What holds for an object: its own value, else that of the defaults, else the library's. */
export function settingOf(draft: Draft, object: SceneObject, key: "m" | "q" | "shape" | "coding" | "skin"): unknown {
  const defaults = draft.scene.defaults;
  const shared = typeof defaults === "object" && defaults !== null ? (defaults as SceneObject)[key] : undefined;
  return object[key] ?? shared ?? { m: 4, q: 6, shape: "sphere", coding: "paper", skin: 100 }[key];
}

export function setSetting(object: SceneObject, key: string, value: unknown): void {
  if (value === undefined) delete object[key];
  else object[key] = value;
}

function numbers(value: unknown, length: number, otherwise: number[]): number[] {
  const fits = Array.isArray(value) && value.length === length && value.every((x) => typeof x === "number");
  return fits ? (value as number[]) : otherwise;
}

/** Roll, pitch, yaw about the fixed x, y, z, as in a URDF, as a quaternion x, y, z, w. */
export function fromRpy([roll, pitch, yaw]: Vec3): Quaternion {
  const [cr, sr] = [Math.cos(roll / 2), Math.sin(roll / 2)];
  const [cp, sp] = [Math.cos(pitch / 2), Math.sin(pitch / 2)];
  const [cy, sy] = [Math.cos(yaw / 2), Math.sin(yaw / 2)];
  return [
    sr * cp * cy - cr * sp * sy,
    cr * sp * cy + sr * cp * sy,
    cr * cp * sy - sr * sp * cy,
    cr * cp * cy + sr * sp * sy,
  ];
}

export function toRpy([x, y, z, w]: Quaternion): Vec3 {
  const pitch = Math.asin(Math.min(1, Math.max(-1, 2 * (w * y - z * x))));
  return [
    Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
    pitch,
    Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
  ];
}

export interface Placement {
  xyz: Vec3;
  quaternion: Quaternion;
  scale: number;
}

export function placementOf(object: SceneObject): Placement {
  const pose = (typeof object.pose === "object" && object.pose !== null ? object.pose : {}) as SceneObject;
  const rpy = numbers(pose.rpy, 3, [0, 0, 0]) as Vec3;
  return {
    xyz: [...numbers(pose.xyz, 3, [0, 0, 0])] as Vec3,
    quaternion: [...numbers(pose.quaternion, 4, fromRpy(rpy))] as Quaternion,
    scale: typeof object.scale === "number" ? object.scale : 1,
  };
}

/** Ten digits are plenty, and keep a hand-written file readable. */
function tidy(x: number): number {
  return Number(x.toPrecision(10)) + 0;
}

export function place(object: SceneObject, { xyz, quaternion, scale }: Placement): void {
  object.pose = { xyz: xyz.map(tidy), quaternion: quaternion.map(tidy) };
  if (scale === 1) delete object.scale;
  else object.scale = tidy(scale);
}

/** Whether two objects are the same thing in the same place, however their poses are written. */
export function standAlike(a: SceneObject, b: SceneObject): boolean {
  const [own, other] = [placementOf(a), placementOf(b)];
  const numbersOf = ({ xyz, scale }: Placement): number[] => [...xyz, scale];
  const turned = own.quaternion.reduce((sum, x, n) => sum + x * other.quaternion[n]!, 0);
  return (
    a.mesh === b.mesh &&
    a.units === b.units &&
    numbersOf(own).every((x, n) => Math.abs(x - numbersOf(other)[n]!) < 1e-9) &&
    Math.abs(turned) > 1 - 1e-12
  );
}

/** "32, 25 20" as a list, a name as a name; null where it is neither. */
export function parseCoding(text: string, presets: readonly string[]): string | number[] | null {
  const trimmed = text.trim();
  if (presets.includes(trimmed)) return trimmed;
  const parts = trimmed.replace(/^\[|\]$/g, "").split(/[\s,;]+/).filter((part) => part !== "");
  const values = parts.map(Number);
  const usable = values.length > 0 && values.every((mu) => Number.isFinite(mu) && mu >= 0);
  return usable ? values : null;
}

/** What a person should know before building; empty where all is well. */
export function oddities(draft: Draft): string[] {
  const { voxel_size: h } = draft.scene;
  const odd: string[] = [];
  if (!(typeof h === "number" && h > 0)) odd.push("The voxel size must be a positive length.");
  if (objectsOf(draft).length === 0) odd.push("There is no object yet: drop an STL on the page.");
  for (const object of objectsOf(draft)) {
    const coding = settingOf(draft, object, "coding");
    const q = settingOf(draft, object, "q");
    if (Array.isArray(coding) && typeof q === "number" && coding.length < q) {
      odd.push(`${nameOf(object)}: ${q} ranks need as many viscosities; the coding has ${coding.length}.`);
    }
    if (typeof object.mesh === "string" && typeof object.units !== "string") {
      odd.push(`${nameOf(object)}: the unit of its mesh is not stated.`);
    }
  }
  return odd;
}

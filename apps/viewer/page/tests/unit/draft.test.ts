// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

import { Euler, Quaternion as ThreeQuaternion } from "three";
import { expect, test } from "vitest";
import {
  addMesh,
  emptyDraft,
  fromRpy,
  objectsOf,
  oddities,
  parseCoding,
  place,
  placementOf,
  settingOf,
  standAlike,
  toRpy,
  type Draft,
} from "../../src/scene/draft";
import { seeded } from "./seeded";

test("roll, pitch and yaw turn as three.js turns about fixed axes, and come back", () => {
  const random = seeded(13);
  for (let trial = 0; trial < 500; ++trial) {
    const rpy: [number, number, number] = [6 * random() - 3, 3 * random() - 1.5, 6 * random() - 3];
    const expected = new ThreeQuaternion().setFromEuler(new Euler(...rpy, "ZYX"));
    const found = new ThreeQuaternion(...fromRpy(rpy));
    expect(Math.abs(expected.dot(found)), rpy.join()).toBeCloseTo(1, 12);
    toRpy(fromRpy(rpy)).forEach((x, n) => expect(x).toBeCloseTo(rpy[n]!, 9));
  }
});

test("keys that the page does not know are kept", () => {
  const scene = { voxel_size: 0.004, remark: "kept", objects: [{ name: "a", primitive: { box: {} }, inner: "raster" }] };
  const draft: Draft = { name: "cell.yaml", scene };
  const [object] = objectsOf(draft);
  place(object!, { xyz: [1, 2, 3], quaternion: [0, 0, 0, 1], scale: 1 });
  expect(JSON.parse(JSON.stringify(draft.scene))).toEqual({
    ...scene,
    objects: [{ ...scene.objects[0], pose: { xyz: [1, 2, 3], quaternion: [0, 0, 0, 1] } }],
  });
});

test("names are plain and differ", () => {
  const draft = emptyDraft();
  addMesh(draft, "Flange (2).stl", "meshes/Flange (2).stl", "mm");
  addMesh(draft, "Flange (2).stl", "meshes/Flange (2).stl", "mm");
  expect(objectsOf(draft).map((object) => object.name)).toEqual(["Flange_2_", "Flange_2__2"]);
});

test("an object's own setting comes before the defaults, and those before the library's", () => {
  const draft: Draft = { name: "", scene: { defaults: { m: 2 }, objects: [{ name: "a", q: 3 }] } };
  const [object] = objectsOf(draft);
  expect(["m", "q", "skin"].map((key) => settingOf(draft, object!, key as "m"))).toEqual([2, 3, 100]);
});

test("a placement reads rpy and quaternion alike", () => {
  const turned = placementOf({ pose: { xyz: [1, 0, 0], rpy: [0, 0, Math.PI / 2] } });
  expect(turned.quaternion[2]).toBeCloseTo(Math.SQRT1_2, 12);
  expect(placementOf({ pose: { quaternion: [0, 0, "1", 1] } }).quaternion).toEqual([0, 0, 0, 1]);
  expect(placementOf({})).toEqual({ xyz: [0, 0, 0], quaternion: [0, 0, 0, 1], scale: 1 });
});

test("the same place is known by rpy and by quaternion, and a moved or rescaled thing is not", () => {
  const one = { mesh: "a.stl", units: "mm", pose: { xyz: [1, 2, 3], rpy: [0, 0, 1] } };
  const half = [0, 0, -Math.sin(0.5), -Math.cos(0.5)];
  expect(standAlike(one, { ...one, pose: { xyz: [1, 2, 3], quaternion: half } })).toBe(true);
  expect(standAlike(one, { ...one, pose: { xyz: [1, 2, 3.001], rpy: [0, 0, 1] } })).toBe(false);
  expect(standAlike(one, { ...one, pose: { xyz: [1, 2, 3], rpy: [0, 0, 1.01] } })).toBe(false);
  expect(standAlike(one, { ...one, units: "in" })).toBe(false);
});

test("a coding is a name or a list of viscosities", () => {
  expect(parseCoding(" jnd ", ["jnd"])).toBe("jnd");
  expect(parseCoding("[32, 25; 20 17]", [])).toEqual([32, 25, 20, 17]);
  for (const wrong of ["", "heavy", "32, -1", "1e999"]) expect(parseCoding(wrong, ["jnd"])).toBeNull();
});

test("what would be refused is said before building", () => {
  const draft = emptyDraft();
  expect(oddities(draft)).toHaveLength(1);
  const object = addMesh(draft, "a.stl", "meshes/a.stl", "mm");
  expect(oddities(draft)).toEqual([]);
  object.coding = [1, 2];
  expect(oddities(draft)[0]).toContain("6 ranks need as many viscosities");
});
